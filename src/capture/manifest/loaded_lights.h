// loaded_lights.h - the lights of a file, with what pairing them with photographs needs
#ifndef CAPTURE_LOADED_LIGHTS_H
#define CAPTURE_LOADED_LIGHTS_H

#include "capture/manifest/light_names.h"

#include <relume/image/directions.h>

struct loaded_lights {
    struct relume_captured_lights lights;
    int *line;      // [lights.count] of a text, or NULL
    bool numbered;  // the names may be an index and no names
    bool unit;      // most vectors have unit length, or are no vectors of a text
};

// Reads what relume_captured_lights_load() reads. On failure `out` is empty.
relume_status loaded_lights_load(struct loaded_lights *out, const char *path, bool positions,
                                 const struct relume_log *log);
void loaded_lights_free(struct loaded_lights *list);
// The names, which borrow from `list` and `path`.
struct light_names loaded_lights_names(const struct loaded_lights *list, const char *path);

#endif
