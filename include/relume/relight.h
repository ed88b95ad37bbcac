// relight.h - lights become weights, weights and codes become a linear image (Wong 1998, Eq. 7.6)
#ifndef RELUME_RELIGHT_H
#define RELUME_RELIGHT_H

#include <relume/base.h>
#include <relume/coder.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

enum relume_light_kind {
    RELUME_LIGHT_DIRECTIONAL = 0,
    RELUME_LIGHT_POINT,  // the direction differs from pixel to pixel: needs `surface`
};

// A light of value 1 gives a white Lambertian surface facing it the value 1.
struct relume_light {
    enum relume_light_kind kind;
    struct relume_vec3 direction;  // directional: towards the light; any length but 0
    struct relume_vec3 position;   // point: world units; the same value at every distance
    float rgb[3];                  // linear value of the light
};

// Read a SPEC: "dir x y z [rgb r g b]". RELUME_EINVAL with a sentence in `log`.
RELUME_RESULT relume_status relume_light_parse(struct relume_light *out, const char *spec,
                                               const struct relume_log *log);

struct relume_relight_params {
    const struct relume_log *log;
    unsigned cpu_off;  // RELUME_CPU_* features not to use; ~0u runs the plain C reference
    int threads;       // default: all cores
    // Three channels of the size of the codes: the world position that each pixel sees, not
    // finite for background. Only point lights read it (Wong 1998, Eq. 7.7 with its sign
    // corrected).
    const struct relume_image *surface;
    float exposure_ev;  // relume_relight_rgba8: multiply by 2^EV before coding
};
#define relume_relight_params(...) (&(const struct relume_relight_params){__VA_ARGS__})

// The value of every pixel under the sum of `n` lights, linear, three channels; values below zero
// (ringing of the basis) are kept. Linear-domain codes fold all lights into one weight vector;
// display-domain codes are decoded light by light, linearised, then summed.
// A light below the horizon of a hemispherical capture is a warning (once) in the log.
// `out` is created when its data is NULL, else it must have the size of `codes`.
// Point lights evaluate the basis at every pixel's own direction and add nothing to background.
// Returns RELUME_EINVAL (a zero direction, a point light without a surface), RELUME_ENOMEM.
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

// What code vector v of codebook `book` adds to a pixel: rgb[v][3], for clients that look up pixels
// themselves. Sums over books are in the file's domain: linear under all `n` lights, or display
// under one light whose colour is left out. A single codebook gives linear values under all lights
// in either domain. Directional lights only, others are left out. RELUME_EINVAL when there is no
// such book or when several books in the display domain meet any number of lights but one;
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_relight_book(float *rgb, const struct relume_codes *codes,
                                                int book, const struct relume_light *lights, int n);

// The same at one pixel under directional lights, in double precision: the slow reference.
RELUME_API void relume_relight_pixel(double rgb[3], const struct relume_codes *codes, int x, int y,
                                     const struct relume_light *lights, int n);

#ifdef __cplusplus
}
#endif
#endif
