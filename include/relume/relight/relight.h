// relight.h - lights become weights, weights and codes become a linear image (Wong 1998, Eq. 7.6)
#ifndef RELUME_RELIGHT_H
#define RELUME_RELIGHT_H

#include <relume/base.h>
#include <relume/format/coder.h>
#include <relume/image.h>
#include <relume/light.h>

#ifdef __cplusplus
extern "C" {
#endif

// ------------------------------------------------------------------ weight grid
// The basis of a coder at a grid of directions, between which it is bilinear: near lights and
// environments ask for thousands of directions a pixel. Rows go by the angle from the pole, columns
// by azimuth, so that no crease of the map cuts a cell. A full sphere has two rows at the horizon,
// for bases that jump there. Interpolants have cusps at the lights: there cells are divided until
// values in [0, 1] agree to 1/255, whatever they are. What is linear over triangles of lights
// (`delaunay`) has creases everywhere and no grid: its nodes are the lights, between which it is
// exact. Never changes. Thread-safety: safe.
typedef struct relume_weight_grid relume_weight_grid;

struct relume_weight_grid_params {
    size_t struct_size;  // filled by the macro (base.h)
    int steps;  // a grid, with so many columns in 90 degrees, [2, 1024]; default: triangles where
                // the basis has them, else 96, fewer where that takes more than 256 MB. Then
                // reflectance of smooth bases agrees to 1e-3 of white
    bool sums;  // for environments alone: where the basis interpolates, only the triangles between
                // lights that relume_environment_weights goes by, at no cost
    int threads;  // default: all cores
};
#define relume_weight_grid_params(...)                                                             \
    (&(const struct relume_weight_grid_params){RELUME_SIZED(relume_weight_grid_params),            \
                                               __VA_ARGS__})

// RELUME_EINVAL (steps), RELUME_ENOMEM. `coder` must live as long as the grid.
RELUME_RESULT relume_status
relume_weight_grid_create(relume_weight_grid **out, const relume_coder *coder,
                          const struct relume_weight_grid_params *params);
RELUME_API void relume_weight_grid_destroy(relume_weight_grid **grid);

// ------------------------------------------------------------------ environment
// Add an environment light to weights[3][K] and constant[3]: sum over the map of E dw / pi times
// the basis (Wong 1998, Eq. 7.6). Bases that interpolate are asked over flat triangles of the
// lights, whatever their interpolant, so that no weight of a captured value is negative. Directions
// below the horizon of a hemispherical capture are 0. For codes of the linear domain.
RELUME_API void relume_environment_weights(float *weights, float constant[3],
                                           const relume_weight_grid *grid,
                                           const struct relume_light *light);

// ------------------------------------------------------------------ refit
// Codes of the display domain once more in linear light, so that an environment is one weight
// vector there too: decoded at the captured directions, made linear, learned by `pca`. One codebook
// becomes one codebook, other codes become planes of half floats. Never changes. Thread-safety:
// safe.
typedef struct relume_refit relume_refit;

// ------------------------------------------------------------------ relighting
struct relume_relight_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    unsigned cpu_off;  // RELUME_CPU_* features not to use; ~0u runs the plain C reference
    int threads;       // default: all cores
    // Three channels of the size of the codes: the world position that each pixel sees, not
    // finite for background. Only near lights read it.
    const struct relume_image *surface;
    const relume_weight_grid *grid;  // of the codes' coder, for near lights and environments, or of
                                     // the refit's, for environments; default: made for the call
    const relume_refit *refit;       // of display-domain codes, for environments; default: these
                                     // are summed over the captured lights, at a cost for each
    float exposure_ev;               // relume_relight_rgba8: multiply by 2^EV before coding
};
#define relume_relight_params(...)                                                                 \
    (&(const struct relume_relight_params){RELUME_SIZED(relume_relight_params), __VA_ARGS__})

// The value of every pixel under the sum of `n` lights, linear, three channels; values below zero
// (ringing of the basis) are kept. Linear-domain codes fold all lights into one weight vector;
// display-domain codes are decoded light by light, linearised, then summed.
// A light below the horizon of a hemispherical capture is a warning (once) in the log.
// `out` is created when its data is NULL, else it must have the size of `codes`.
// Near lights evaluate the basis at every pixel's own direction and add nothing to background; from
// below the horizon of a hemispherical capture areas add nothing, others are taken at the horizon.
// Returns RELUME_EINVAL (a light that relume_light_check refuses, a near light without a surface),
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_relight(struct relume_image *out,
                                           const struct relume_codes *codes,
                                           const struct relume_light *lights, int n,
                                           const struct relume_relight_params *params);

// The same as a picture for the screen: out[height][width][4], sRGB-coded, clipped, alpha 255;
// aligned to 4 bytes.
// Codes of one codebook are relit and coded once, and a pixel is one look-up. Same errors.
RELUME_RESULT relume_status relume_relight_rgba8(uint8_t *out, const struct relume_codes *codes,
                                                 const struct relume_light *lights, int n,
                                                 const struct relume_relight_params *params);

#ifdef __cplusplus
}
#endif
#endif
