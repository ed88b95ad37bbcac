// refine.h - directions of lights refined by the photographs of a matte surface
#ifndef ACQUIRE_REFINE_H
#define ACQUIRE_REFINE_H

#include <relume/capture/acquire.h>

// How lights are refined. Borrowed while relume_acquire_refine runs; `curl` is filled.
struct relume_acquire_refine_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;
    bool brightness;  // of the lights alone; their directions stay
    // Of the linear map that the images leave open, what makes the surface one of heights (its
    // slopes have no curl; Yuille, Snow 1997) counts more than nearness to the lights given, within
    // some degrees.
    bool integrable;
    double *curl;  // [2], or NULL: RMS of the curl before and after, relative to the surface's
                   // curvature
};
#define relume_acquire_refine_params(...)                                                          \
    (&(const struct relume_acquire_refine_params){RELUME_SIZED(relume_acquire_refine_params),      \
                                                  __VA_ARGS__})
// Better directions and intensities from the images of a planar capture with distant lights, or
// with `brightness` the power of near ones:
// surface vectors and lights in turn minimise what Lambert's law misses, shadows and highlights
// left out; the linear map that the images leave open (it contains the bas-relief ambiguity,
// Belhumeur, Kriegman, Yuille 1999) is the one that brings the lights nearest to those given.
// direction[lights] are replaced; intensity[lights] gets relative brightness, mean 1; *residual the
// median miss / albedo before and after. Where the surface does not determine lights better than
// they are (it faces one way, or gloss passes for light: halves of it disagree), they stay,
// intensities are 1, both residuals are equal and curl is 0, with a warning. RELUME_EUNFIT where
// the lights do not span space or there are fewer than 6, RELUME_ENOMEM.
relume_status relume_acquire_refine(struct relume_vec3 *direction, double *intensity,
                                    double residual[2], const relume_capture *capture,
                                    const struct relume_acquire_refine_params *params);

#endif
