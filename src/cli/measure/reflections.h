// reflections.h - error and time of three ways to reflections that follow no rays, against exact
// rays (Meseth 2008, chapter 11). Times are of the processor.
#ifndef MEASURE_REFLECTIONS_H
#define MEASURE_REFLECTIONS_H

#include <relume/base.h>

enum {
    MIRROR_POSITIONS = 20000,  // that a curved mirror shows
    MIRROR_METHODS = 4,
    REFLECTED_RAYS = 200000,
    TRACING_METHODS = 7,
};

// One method to find where a curved mirror shows positions: Newton's method on a Bezier patch, or
// the cubic of one triangle out of n x n x 2.
struct mirror_result {
    int triangles;      // n; 0: the patch
    double seconds;     // per position
    double iterations;  // of Newton's method, mean; 0: the cubic
    double error;       // largest distance between the unit vector that leaves the mirror and the
                        // one that the law of reflection asks for
    int found;          // of MIRROR_POSITIONS
};
// Measures all methods of the mirror. RELUME_ENOMEM, RELUME_ECANCEL.
relume_status measure_mirrors(struct mirror_result out[MIRROR_METHODS],
                              const struct relume_log *log);

// One method to find what rays off a mirror ball hit: the cells of an octree, or the ray tracer,
// which is exact.
struct tracing_result {
    int depth;          // of the octree; 0: the ray tracer
    bool cone;          // cells are no finer than the ray is wide, 0.01 of its length
    double build_s;     // of the octree or the ray tracer
    size_t bytes;       // of the octree
    double rays_per_s;  // on one core
    double one_only;    // share of the rays that hit something by one method and not by the other
    double error;       // median distance between the hits of both, relative to the mesh's diagonal
};
struct traced_mesh {
    const char *name;
    size_t triangles;
    struct tracing_result result[TRACING_METHODS];
};
// Measures all methods of tracing on the mesh of the file `path`, which `out` borrows; NULL: a
// teapot. An input status, RELUME_ENOMEM, RELUME_ECANCEL.
relume_status measure_tracing(struct traced_mesh *out, const char *path,
                              const struct relume_log *log);

#endif
