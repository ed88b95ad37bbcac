// enhance.h - passes that show more of a surface than its photograph: normals, enhanced shading,
// luminance, differences
#ifndef RELUME_ENHANCE_H
#define RELUME_ENHANCE_H

#include <relume/base.h>
#include <relume/image.h>
#include <relume/light.h>
#include <relume/normals.h>

#ifdef __cplusplus
extern "C" {
#endif

enum relume_pass {
    RELUME_PASS_COLOUR = 0,
    RELUME_PASS_NORMALS,       // the unit vectors themselves, -1 to 1
    RELUME_PASS_SPECULAR,      // specular enhancement (Malzbender et al. 2001, 4.2)
    RELUME_PASS_DIFFUSE_GAIN,  // the same, 4.1
    RELUME_PASS_UNSHARP,       // shading by normals whose detail is exaggerated
    RELUME_PASS_LUMINANCE,     // Rec. 709
    RELUME_PASS_FALSE_COLOUR,  // luminance from dark blue (0) to yellow (`top`)
    RELUME_PASS_DIFFERENCE,    // absolute, from `reference`
    RELUME_PASSES
};
// "colour", "normals", "specular", "diffuse-gain", "unsharp", "luminance", "false-colour",
// "difference"; NULL when out of range.
RELUME_API const char *relume_pass_name(enum relume_pass pass);
// RELUME_EINVAL when `name` is none of these.
RELUME_RESULT relume_status relume_pass_parse(enum relume_pass *out, const char *name);
// Whether the pass needs to know normals.
RELUME_API bool relume_pass_needs_normals(enum relume_pass pass);

struct relume_pass_params {
    float gain;      // diffuse gain: of the shading's curvature; unsharp: of the detail; default 2
    float specular;  // value of the highlight where it is brightest; default 0.6
    float exponent;  // of the highlight; default 40
    int radius;      // unsharp: detail is finer than this, pixels; default 4
    float top;       // false colour: what is brightest; default 1
    int threads;     // default: all cores
    // Specular: unit vectors towards the viewer, three channels. Default: +z everywhere.
    const struct relume_image *towards;
    const struct relume_image *reference;  // difference: a linear picture of the same size
};
#define relume_pass_params(...) (&(const struct relume_pass_params){__VA_ARGS__})

// Replace `image`, a view relit by `lights`, by what `pass` shows of it; linear, three channels.
// `normals` may be NULL where the pass needs none. Only directional lights are enhanced; what
// others add stays as it is. RELUME_EINVAL for sizes that disagree, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_pass_apply(struct relume_image *image, enum relume_pass pass,
                                              const struct relume_normals *normals,
                                              const struct relume_light *lights, int n,
                                              const struct relume_pass_params *params);

// `normal` less its mean over (2 radius + 1)^2 pixels: what unsharp exaggerates. `out` is created.
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_normals_detail(struct relume_image *out,
                                                  const struct relume_image *normal, int radius,
                                                  int threads);

#ifdef __cplusplus
}
#endif
#endif
