// enhance.h - passes that show more of a surface than its photograph: normals, enhanced shading,
// luminance, differences
#ifndef RELUME_ENHANCE_H
#define RELUME_ENHANCE_H

#include <relume/base.h>
#include <relume/frame.h>
#include <relume/image.h>
#include <relume/light.h>
#include <relume/relight/normals.h>

#ifdef __cplusplus
extern "C" {
#endif

// "colour", "normals", "specular", "diffuse-gain", "unsharp", "luminance", "false-colour",
// "difference"; NULL when out of range.
RELUME_API const char *relume_pass_name(enum relume_pass pass);
// RELUME_EINVAL when `name` is none of these.
RELUME_RESULT relume_status relume_pass_parse(enum relume_pass *out, const char *name);

// What a pass scales to the picture, luminances.
struct relume_pass_range {
    float low, high;  // a hundredth of the picture is darker, or brighter; background left out
    float pivot;      // diffuse gain: the share of the full shading that stays as it is
    float scale;      // diffuse gain: a factor, so that the brightest stays as bright; specular: of
                      // the highlight
};

// How a pass shows a picture. Values are those of linear light; pictures are borrowed during the
// call.
struct relume_pass_params {
    size_t struct_size;  // filled by the macro (base.h)
    float gain;      // diffuse gain: of the shading's curvature; unsharp: of the detail; default 2
    float specular;  // the highlight where it is brightest, in `high`s of the picture; default 0.6
    float exponent;  // of the highlight; default 40
    int radius;      // unsharp: detail is finer than this, pixels; default 4
    float low, top;  // false colour: from here to there; default: from the picture
    bool fixed;      // nothing is scaled to the picture: low 0, high, pivot and scale 1
    const struct relume_pass_range
        *range;   // measured before; default: of the picture that is given
    int threads;  // default: all cores
    // Specular: unit vectors towards the viewer, three channels. Default: +z everywhere.
    const struct relume_image *towards;
    const struct relume_image *reference;  // difference: a linear picture of the same size
};
#define relume_pass_params(...)                                                                    \
    (&(const struct relume_pass_params){RELUME_SIZED(relume_pass_params), __VA_ARGS__})

// `normal` less its mean over (2 radius + 1)^2 pixels: what unsharp exaggerates. `out` is created.
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_normals_detail(struct relume_image *out,
                                                  const struct relume_image *normal, int radius,
                                                  int threads);

#ifdef __cplusplus
}
#endif
#endif
