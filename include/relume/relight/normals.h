// normals.h - which way the surface faces, and how much it reflects, from its relit reflectance
//
// Photometric stereo (Woodham 1980) on what the file shows under the captured directions. Shadows
// and highlights are no Lambertian shading: the darkest and brightest samples of a pixel are left
// out, the others are weighed by how well they fit (Cauchy weights, Holland and Welsch 1977). Where
// it is known from where the surface is seen its material is found too, as in photometric.h.
#ifndef RELUME_NORMALS_H
#define RELUME_NORMALS_H

#include <relume/base.h>
#include <relume/format/coder.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// Both have the size of the view and three channels. Thread-safety: plain data.
struct relume_normals {
    struct relume_image normal;  // unit vectors, world; zero where nothing is known (black pixels)
    struct relume_image albedo;  // linear value under a light of 1 from the normal's direction
};

// How normals are fitted. Borrowed during the call.
struct relume_normals_params {
    size_t struct_size;            // filled by the macro (base.h)
    const struct relume_log *log;  // progress
    unsigned cpu_off;              // as relume_relight_params
    int threads;                   // default: all cores
    bool plain;                    // least squares of all samples: no trimming, no weights
    struct relume_vec3 eye;        // towards the eye, any length, where that is the same
                                   // everywhere (planar views seen orthographically): gloss and
                                   // metal are then not taken for matte; default: all is matte
};
#define relume_normals_params(...)                                                                 \
    (&(const struct relume_normals_params){RELUME_SIZED(relume_normals_params), __VA_ARGS__})

// Fit every pixel of `codes`; the caller destroys `out`, which is empty on failure. RELUME_EUNFIT
// when the captured directions do not span space, RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_normals_fit(struct relume_normals *out,
                                               const struct relume_codes *codes,
                                               const struct relume_normals_params *params);
RELUME_API void relume_normals_destroy(struct relume_normals *normals);

#ifdef __cplusplus
}
#endif
#endif
