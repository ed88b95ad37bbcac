// store.h - samples of every type of file on their way into memory
#ifndef VOLUME_STORE_H
#define VOLUME_STORE_H

#include "shape/volume/volume.h"

// What a file's samples are.
struct sample_type {
    const char *name;  // without its end
    int bytes;
    char kind;  // 'u', 'i' or 'f'
};
// The type called `name`, and whether its samples are big-endian; NULL: there is none. A name
// without an end is that of the file's own `big`.
const struct sample_type *sample_type_find(const char *name, bool *big);

// A volume that is being filled. What it becomes is `volume`.
struct store {
    relume_volume *volume;
    const struct sample_type *type;
    bool big;
    double slope, intercept;  // value = slope sample + intercept
    size_t filled;            // samples
    const char *path;         // of messages
    const struct relume_log *log;
};
// Whether a volume may have that size: RELUME_EUNFIT, RELUME_ELIMIT with a sentence.
relume_status store_check(const struct store *s, const int64_t size[3]);
// The empty volume of that size. `path` is what sentences call it. RELUME_EUNFIT, RELUME_ELIMIT
// with a sentence, RELUME_ENOMEM, RELUME_EIO.
relume_status store_begin(struct store *s, const int64_t size[3],
                          const struct relume_volume_params *params);
// Bytes that one layer takes in the file.
size_t store_layer_bytes(const struct store *s);
// The next `count` samples. RELUME_EDAMAGED with a sentence for what is not finite.
relume_status store_put(struct store *s, const void *samples, size_t count);
// RELUME_EUNFIT with a sentence when all are alike; else the volume is whole.
relume_status store_end(struct store *s);

#endif
