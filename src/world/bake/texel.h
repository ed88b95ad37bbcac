// texel.h - what a texel of the atlas shows under every light, from every view
#ifndef BAKE_TEXEL_H
#define BAKE_TEXEL_H

#include "shape/atlas/atlas.h"
#include "world/bake/convolve.h"
#include "world/object/drawn_objects.h"
#include "world/object/object.h"

#include <relume/world/bake.h>

// What is baked, and how.
struct baking {
    const relume_objects *o;
    const struct baked_basis *basis;
    struct atlas_corner (*triangle)[3];  // as many as the objects have, in their order
    struct atlas atlas;
    uint32_t *used;                     // [atlas.used]: texels that hold something
    uint32_t *number;                   // [texels]: of these, which one; UINT32_MAX: none
    struct relume_object_light *light;  // [lights]: what shines; where any light does, lamps of 1
    int lights;
    bool fixed;
    bool matte;  // all materials look alike from all views
    int side, views;
    int count;                     // numbers of light in each view: 1, or those of the basis
    struct convolved **convolved;  // [materials]; NULL: asked light by light
    int rays, bounces, threads;
    size_t taught;  // texels that components are learned from
    const struct relume_log *log;
    // [used][count][3]: the light that is sent, the mean over views, and what of the bounce before
    float *sent, *bounced;
};

// Numbers of one texel.
static inline size_t baking_length(const struct baking *b)
{
    return (size_t)b->views * (size_t)b->count * 3;
}

// Memory that a texel needs while it is baked. RELUME_ENOMEM.
struct texel_scratch {
    float *samples;  // [lights][views][3]
    float *vector;   // [views][count][3]
};
relume_status scratch_make(struct texel_scratch *out, const struct baking *b);
void scratch_free(struct texel_scratch *s);

// The point that a texel holds, on the outside; how far its neighbours are in texture coordinates.
void texel_point(struct surface_point *out, const struct baking *b, uint32_t texel);
// What it shows of light that comes straight: out[views][count][3]. RELUME_ENOMEM.
relume_status texel_direct(float *out, const struct baking *b, const struct surface_point *p,
                           struct texel_scratch *s);
// What it shows of the light that others send is added: from[used][count][3].
void texel_gather(float *out, const struct baking *b, const struct surface_point *p, uint32_t texel,
                  const float *from);
// The mean over the views, by their cosines: out[count][3].
void texel_mean(float *out, const struct baking *b, const float *vector);

#endif
