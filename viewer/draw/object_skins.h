// object_skins.h - opacity and emission of materials on the GPU
#ifndef VIEWER_OBJECT_SKINS_H
#define VIEWER_OBJECT_SKINS_H

#include "gl/program.h"

#include <relume/world/object.h>

// Zeroed it holds nothing.
struct object_skins {
    GLuint *texture;  // [materials]; 0: the material has none
    bool sends;       // some material sends light of its own
    bool holes;       // some material has holes
};

// RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status object_skins_create(struct object_skins *s, const struct gl *gl,
                                  const struct relume_objects_info *info,
                                  const struct relume_log *log);
void object_skins_destroy(struct object_skins *s, const struct gl *gl,
                          const struct relume_objects_info *info);

#endif
