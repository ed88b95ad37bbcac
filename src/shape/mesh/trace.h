// trace.h - rays against triangles; the only door to Embree
#ifndef MESH_TRACE_H
#define MESH_TRACE_H

#include "shape/mesh/mesh.h"

#include <relume/shape/billboards.h>

// Triangles ready for rays. Never changes. Thread-safety: safe.
typedef struct tracer tracer;

// A cloud of billboards in place of a stretch of triangles: rays meet its texels of which half or
// more is covered, and get what these show.
struct trace_cloud {
    const struct relume_billboards *cloud;
    size_t first, count;  // triangles of the mesh; those of the cloud are counted from `first`
    float slack;          // rays that begin so near to a billboard's plane pass through it: they
                          // begin on the surface that it stands for
};

// Borrows `mesh`, which must outlive the tracer and stay as it is. Returns RELUME_ENOMEM,
// RELUME_ESYSTEM when Embree cannot run here.
relume_status trace_create(tracer **out, const struct mesh *mesh, const struct relume_log *log);
void trace_destroy(tracer **t);

// Places that rays pass through: of triangle (u, v), for a ray in `direction` (unit); `layers`: for
// trace_layer.
struct trace_holes {
    bool (*let_through)(const void *context, uint32_t triangle, float u, float v,
                        const float direction[3], bool layers);
    const void *context;
};

struct trace_hit {
    uint32_t triangle;
    float u, v;  // weights of the second and third corner
    float distance;
    signed char side;  // 0, or of a billboard: 1 seen from where its normal points, -1 from behind
};
// trace_create with `n` clouds, in order of their triangles, which are borrowed too, and holes
// (NULL: none).
relume_status trace_create_clouds(tracer **out, const struct mesh *mesh,
                                  const struct trace_cloud *cloud, int n,
                                  const struct trace_holes *holes, const struct relume_log *log);
// The nearest triangle along `direction` (unit) from `origin`; false when there is none.
bool trace_closest(const tracer *t, const float origin[3], const float direction[3],
                   struct trace_hit *hit);

// The same of all that is there in part, for who puts layers one over the other.
bool trace_layer(const tracer *t, const float origin[3], const float direction[3],
                 struct trace_hit *hit);
// Whether a ray goes through there.
bool trace_lets_through(const tracer *t, uint32_t triangle, float u, float v,
                        const float direction[3]);

// Whether each of `count` origins sees infinitely far along `direction`.
void trace_unblocked(const tracer *t, float (*origins)[3], int count, const float direction[3],
                     bool *seen);
// Whether each sees the place `to`.
void trace_seen(const tracer *t, float (*origins)[3], int count, const float to[3], bool *seen);

// `p` on a surface moved just off it along `normal`, by steps of its own floating-point spacing
// (Waechter and Binder 2019), so that thin plates keep their two sides at any distance.
void trace_leave(const float p[3], const float normal[3], float out[3]);

#endif
