// depths.h - disparities of a slab's views on the GPU, uploaded when first needed
#ifndef VIEWER_DEPTHS_H
#define VIEWER_DEPTHS_H

#include "core/base/budget.h"
#include "gl/gl.h"
#include "relight/view/view.h"

#include <relume/relight/view.h>

// Where depth comes from: a pack, or a test. The caller destroys the image.
struct depth_source {
    relume_status (*depth)(struct relume_image *out, void *user, int view);
    void *user;
};

struct depths {
    const struct gl *gl;
    struct depth_source source;
    const relume_slab **slab;  // [views]: the view's
    int views;
    GLuint *texture;         // [views], one channel of float; 0: not uploaded
    double (*range)[2];      // [views]; from above to below: all background
    double (*uv)[2];         // [views]
    struct budget memory;    // of the textures; `most` is to be set after depths_create
    bool *ranged;            // [views]: the range is known
    struct relume_rect *at;  // [views]: what the texture holds of the view, ...
    bool *cut;               // ... if it was asked for a part
};

// Of one slab, or of several that share their view numbers. `gl`, the slabs and what the source
// refers to must outlive it. RELUME_ENOMEM.
relume_status depths_create(struct depths *depths, const struct gl *gl,
                            const relume_slab *const *slab, int slabs,
                            const struct depth_source *source);
void depths_destroy(struct depths *depths);

// Upload what needed[views] marks and is not there; `range` becomes that of all of these. Others
// leave the graphics memory, the least recently used first, once all take more than the budget.
relume_status depths_use(struct depths *depths, const bool *needed, double range[2]);
// Know the ranges of needed[views] without uploading them.
relume_status depths_find_ranges(struct depths *depths, const bool *needed);
// As depths_use, of part[views] alone; where these are empty nothing.
relume_status depths_use_parts(struct depths *depths, const bool *needed,
                               const struct relume_rect *part, double range[2]);

#endif
