// trace.h - rays against triangles; the only door to Embree
#ifndef MESH_TRACE_H
#define MESH_TRACE_H

#include "mesh/mesh.h"

// Triangles ready for rays. Never changes. Thread-safety: safe.
typedef struct tracer tracer;

// Borrows `mesh`, which must outlive the tracer and stay as it is. Returns RELUME_ENOMEM,
// RELUME_ESYSTEM when Embree cannot run here.
relume_status trace_create(tracer **out, const struct mesh *mesh, const struct relume_log *log);
void trace_destroy(tracer **t);

struct trace_hit {
    uint32_t triangle;
    float u, v;  // weights of the second and third corner
    float distance;
};
// The nearest triangle along `direction` (unit) from `origin`; false when there is none.
bool trace_closest(const tracer *t, const float origin[3], const float direction[3],
                   struct trace_hit *hit);

// Whether each of `count` origins sees infinitely far along `direction`.
void trace_unblocked(const tracer *t, float (*origins)[3], int count, const float direction[3],
                     bool *seen);

// `p` on a surface moved just off it along `normal`, by steps of its own floating-point spacing
// (Waechter and Binder 2019), so that thin plates keep their two sides at any distance.
void trace_leave(const float p[3], const float normal[3], float out[3]);

#endif
