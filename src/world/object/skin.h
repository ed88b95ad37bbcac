// skin.h - what is there of a surface, and what it sends of its own
#ifndef OBJECT_SKIN_H
#define OBJECT_SKIN_H

#include "world/object/object.h"

// What of a surface is there at a point, in [0, 1].
float skin_opacity(const relume_objects *o, const struct surface_point *p);
// Which rays pass through the objects; false: none of their materials has holes. `o` is borrowed.
bool skin_holes(struct trace_holes *out, const relume_objects *o);
// A part of what a point sends of its own is added.
void skin_add_emission(float rgb[3], const relume_objects *o, const struct surface_point *p,
                       float part);

// The layers along a ray of the eye, from the nearest on.
struct skin_layers {
    float left;  // which part of what is behind shows; 1 to begin with
    float part;  // of the layer in hand
    int count;
    vec3 from;
};
// The next one that is nearer than `farthest`; false: there is none, or it would not show.
bool skin_layer(struct surface_point *out, struct skin_layers *l, const relume_objects *o,
                const struct ray *ray, double farthest);

struct skin_factors {
    enum relume_object_cover cover;
    float cutoff, opacity, emission[3];
    const struct relume_image *opaque;   // one channel, that multiplies the opacity; NULL: none
    const struct relume_image *emitted;  // three, linear, that multiply the emission; NULL: none
};
// skin_destroy frees it, and takes NULL. RELUME_ENOMEM.
relume_status skin_make(const struct relume_object_skin **out, const struct skin_factors *factors,
                        int threads);
void skin_destroy(const struct relume_object_skin **skin);

#endif
