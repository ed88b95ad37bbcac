// slab_set.h - several light slabs around an object, blended where they overlap
//
// Each slab is one of view.h in a frame of its own (struct relume_geometry, `pose`); a frame looks
// at the object from anywhere: every ray of it is looked up in the slabs whose cameras it passes.
#ifndef RELUME_SLAB_SET_H
#define RELUME_SLAB_SET_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/image.h>
#include <relume/relight/view.h>

#ifdef __cplusplus
extern "C" {
#endif

// Never changes. Thread-safety: safe.
typedef struct relume_slab_set relume_slab_set;

// View i of `views` stands at uv[i] of slab[slab_of[i]]; `slab_of` may be NULL for one slab.
// RELUME_EINVAL when a pose is no rotation or the cameras of a slab are no grid;
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_slab_set_create(relume_slab_set **out,
                                                   const struct relume_geometry *slab, int slabs,
                                                   const double (*uv)[2], const int *slab_of,
                                                   int views);
RELUME_API void relume_slab_set_destroy(relume_slab_set **slabs);

// The middle of the object: the mean of the middles of the st windows.
RELUME_API struct relume_vec3 relume_slab_set_middle(const relume_slab_set *slabs);

// A perspective picture in the world: the eye, and the window that it looks through. Its place
// (x, y), both in [0, 1], rows from the top, is corner + x right + y down.
struct relume_window {
    // World: the eye, the upper left corner, the upper and the left edge.
    struct relume_vec3 eye, corner, right, down;
};

// Whether anything is not zero.
RELUME_API bool relume_look_at_given(const struct relume_look_at *look_at);

#ifdef __cplusplus
}
#endif
#endif
