// reflection.h - edited reflections: what a mirror shows is moved by hand, smoothly over its
// surface, and nothing else changes (Ritschel 2009, "Perceptually-motivated, interactive rendering
// and editing of global illumination", chapter 7)
//
// A constraint says that the reflection direction r at a place p of the surface, as an eye saw it,
// shall be e instead. Between constraints a rotation is found at each place q (moving least
// squares, Eq. 7.2, 7.3, 7.5):
//     R(q) = argmin over rotations of sum_n w_n |R r_n - e_n|^2,   w_n = 1 / d(p_n, q)^2
// which is the rotational factor of M = sum_n w_n e_n r_n^T with determinant +1 (orthogonal
// Procrustes; the inverse in the thesis's Eq. 7.4 stands on the wrong side and is not needed). Of
// one constraint, and wherever M leaves a turn open, it is the least rotation. d is never taken
// below 1/1000 of the size of the surface, so that constraints are met to 1e-5 or so.
//
// Regions bound the effect: a(q) is 1 within, 0 outside, with a smooth step between; the rotation
// is that of a R + (1 - a) r r^T (Eq. 7.7), so that r goes over into R r. A constraint counts in
// the regions that hold its place; outside all of them it does nothing. Where regions overlap each
// counts by its a. Without regions every constraint counts everywhere.
#ifndef RELUME_REFLECTION_H
#define RELUME_REFLECTION_H

#include <relume/base.h>

#ifdef __cplusplus
extern "C" {
#endif

// An edit that can be asked. Never changes. Thread-safety: safe.
typedef struct relume_reflection relume_reflection;

// How an edit is taken.
struct relume_reflection_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const char *name;               // how sentences call the edit; default: "reflections"
    int threads;                    // default: all cores
    const relume_reflection *like;  // of the same surface: what it has measured is not measured
                                    // again, while an edit is being changed; NULL: all is
};
#define relume_reflection_params(...)                                                              \
    (&(const struct relume_reflection_params){RELUME_SIZED(relume_reflection_params), __VA_ARGS__})

// A place of the surface: of triangle (vertex[0], vertex[1], vertex[2]), weighted by weight[].
// Vertices and weights count only for distances along the surface.
struct relume_reflection_place {
    struct relume_vec3 position;  // world units
    uint32_t vertex[3];           // of the surface that the edit was made with
    double weight[3];             // of these; their sum is 1
};

#ifdef __cplusplus
}
#endif
#endif
