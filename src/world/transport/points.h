// points.h - surfaces as points, each of which stands for a piece of surface around it (surfels:
// Pfister et al. 2000)
//
// They are spread evenly by area: any run of points that follow one another is, so that each of
// many users can take a run of its own. The same mesh and count give the same points.
#ifndef TRANSPORT_POINTS_H
#define TRANSPORT_POINTS_H

#include "world/transport/transport.h"

struct point {
    vec3 place, normal;  // unit, on the side that light gets to
    double area;         // of the piece; those of all points add up to the mesh's
    bool open, both;     // light gets there, and to the other side, too
    uint32_t triangle;
    float u, v;  // where on it: weights of its second and third corner
};

// Zeroed: there are none.
struct points {
    struct point *at;  // [count]
    size_t count;
};

// `count` points of the objects, fewer where they have holes, none where they have no area. The
// side that light gets to is the one from which a ray leaves the objects, whichever way their
// triangles are turned. RELUME_ENOMEM; `out` is none then. points_forget frees them.
relume_status points_of_objects(struct points *out, const struct mesh *mesh, const tracer *objects,
                                size_t count, int threads);
// The same of a captured scene; the side is that of the captured eye.
relume_status points_of_scene(struct points *out, const struct scenery *c, size_t count);
void points_forget(struct points *p);

// What a point of the scene sends under the present light, were there no objects: what its pixels
// show.
void points_scene_sent(float rgb[3], const struct scenery *c, const struct point *p);
// What a point of the objects sends along its normal: what the lamps bring there, and `n` arrivals.
// `key` chooses among the samples of environments.
void points_object_sent(float rgb[3], const struct world *w, const struct point *p, uint64_t key,
                        const struct arrival *arrivals, int n);
// The same, of one that shines: what it sends on average, each direction by its cosine.
void points_object_mean(float rgb[3], const struct world *w, const struct point *p, uint64_t key,
                        const struct arrival *arrivals, int n);
// A direction (unit) before it, as often as the cosine is.
vec3 points_direction(const struct point *p, double u, double v);

#endif
