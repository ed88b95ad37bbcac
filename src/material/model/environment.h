// environment.h - environment light on measured materials: prefiltered maps for models of
// lobes, sums over the measured lights for all others (Meseth 2008, 9.4; McAllister, Lastra,
// Heidrich 2002)
#ifndef MODEL_ENVIRONMENT_H
#define MODEL_ENVIRONMENT_H

#include <relume/base.h>
#include <relume/light.h>
#include <relume/material/btf.h>

// An environment as lobes see it. Never changes. Thread-safety: safe.
typedef struct relume_prefiltered_maps relume_prefiltered_maps;

enum {
    RELUME_PREFILTERED_EXPONENTS = 15,  // 2^(i / 2): 1, 1.41, 2, ... 128; the thesis ends at 32
    RELUME_PREFILTERED_STEPS = 33,      // of a cosine from -1 to 1
};

// How an environment is prefiltered. Borrowed during the call.
struct relume_prefiltered_maps_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int height;  // of the maps, pixels; they are twice as wide; default 48, [4, 512]
    // The cosine of the lowest measured lights, below which values fall to 0 at the horizon
    // (relume_btf_fitted_info.rim); default 0: they do not fall.
    double rim;
    int threads;  // default: all cores
};
#define relume_prefiltered_maps_params(...)                                                        \
    (&(const struct relume_prefiltered_maps_params){RELUME_SIZED(relume_prefiltered_maps_params),  \
                                                    __VA_ARGS__})

// `light` is an environment; its colour and rotation are taken over. RELUME_EINVAL, RELUME_ENOMEM.
relume_status relume_prefiltered_maps_create(relume_prefiltered_maps **out,
                                             const struct relume_light *light,
                                             const struct relume_prefiltered_maps_params *params);
void relume_prefiltered_maps_destroy(relume_prefiltered_maps **prefiltered);

// Plain arrays for other renderers; they belong to the maps. Maps are spherical (row 0 is up
// +y, the middle column -z, +x to its right, pixel centres at +0.5), so that bilinear lookups
// repeat in columns and clamp in rows. E is the radiance of the environment.
struct relume_prefiltered_maps_info {
    int width, height;
    // [height][width][3]: the sum of E fall(n.l) dw / pi over n.l > 0, fall(z) being
    // min(z / rim, 1): what a value of 1 for all lights shows on a surface facing the direction n.
    const float *diffuse;
    // [15][height][width][3]: the mean of E under the lobe max(d.l, 0)^e about the direction d:
    // (e + 1) / (2 pi) times the sum of E max(d.l, 0)^e dw. Means change little from exponent to
    // exponent: between them they are linear in log2(e), beyond them the last ones.
    const float *specular;
    // [2][15][33]: what part of a lobe, by the cosine between its axis and the normal, arrives:
    // [0] where values include n.l, by fall(z); [1] times z, where they do not. Below the rim the
    // lobe is that at the rim of the same azimuth.
    const float *part;
};
// It and its arrays belong to the maps.
const struct relume_prefiltered_maps_info *relume_prefiltered_maps_info(
    const relume_prefiltered_maps *prefiltered);

// The maps in a unit direction of the world, `exponent` > 0.
void relume_prefiltered_maps_diffuse(float rgb[3], const relume_prefiltered_maps *prefiltered,
                                     struct relume_vec3 normal);
// The mean under a lobe about a unit direction, `exponent` > 0.
void relume_prefiltered_maps_specular(float rgb[3], const relume_prefiltered_maps *prefiltered,
                                      struct relume_vec3 axis, double exponent);
// What a lobe height * max(0, axis.l)^exponent shows on a surface facing `normal`. `cosine`: values
// do not include n.l.
void relume_prefiltered_maps_lobe(float rgb[3], const relume_prefiltered_maps *prefiltered,
                                  struct relume_vec3 normal, struct relume_vec3 axis,
                                  double exponent, bool cosine);

// What an environment sends to a surface that lies one way in the world: each measured light stands
// for the directions around it, with the weights that interpolation gives it, so that the sum over
// lights is the integral over the sphere. Thread-safety: safe.
typedef struct relume_btf_oriented_light relume_btf_oriented_light;

// Axes of the sample's frame in the world: unit vectors, orthogonal. Left-handed frames (mirrored
// texture coordinates) are fine.
struct relume_btf_frame {
    struct relume_vec3 right, up, normal;  // along the sample's rows, up in its picture, off it
};

// How environment light on one orientation is prepared. Borrowed during the call.
struct relume_btf_oriented_light_params {
    size_t struct_size;  // filled by the macro (base.h)
    // Prefiltered maps of this orientation, for models of lobes: exact at the horizon, where those
    // of the environment know only the mean of a lobe. They take 0.1 s or so of one core: for flat
    // surfaces.
    bool own_maps;
    int threads;  // default: all cores
};
#define relume_btf_oriented_light_params(...)                                                      \
    (&(const struct relume_btf_oriented_light_params){                                             \
        RELUME_SIZED(relume_btf_oriented_light_params), __VA_ARGS__})

// Some 2000 directions are interpolated: a few milliseconds. Both objects must outlive it.
// RELUME_ENOMEM.
relume_status relume_btf_oriented_light_create(
    relume_btf_oriented_light **out, const relume_btf_fitted *model,
    const relume_prefiltered_maps *prefiltered, const struct relume_btf_frame *frame,
    const struct relume_btf_oriented_light_params *params);
void relume_btf_oriented_light_destroy(relume_btf_oriented_light **ambient);

// The weights of the measured lights [lights][3]: red, green, blue of the light i times a value
// under that light, summed over i, is the value under the environment. For renderers of linear
// models.
const float *relume_btf_oriented_light_weights(const relume_btf_oriented_light *ambient);

// One texel of a level of detail from a direction in the frame of the sample, under the
// environment. Models of lobes (laf, slaf, rfnl, rfnlc) look their lobes up in the prefiltered
// maps, all others are summed over the measured lights.
void relume_btf_oriented_light_evaluate(const relume_btf_oriented_light *ambient, int level, int x,
                                        int y, struct relume_vec3 view, float rgb[3]);

// For surfaces that bend. Between measured lights values are interpolated, so that a light
// represents the directions around it; here by a cosine lobe of the same integral, mean direction
// and mean cosine, and the radiance under that lobe is one lookup: an orientation costs as many as
// there are lights, and none where a model of lobes is looked up itself.
struct relume_btf_light_lobe {
    struct relume_vec3 axis;  // unit, in the frame of the sample
    double exponent;          // [1, 128]
    double weight;            // integral over directions / pi, n.l and all
};

// Never changes. Thread-safety: safe.
typedef struct relume_btf_environment relume_btf_environment;

// Some milliseconds. Model and maps must outlive it; the rim of the maps is the model's
// own. RELUME_ENOMEM.
relume_status relume_btf_environment_create(relume_btf_environment **out,
                                            const relume_btf_fitted *model,
                                            const relume_prefiltered_maps *prefiltered);
void relume_btf_environment_destroy(relume_btf_environment **sky);
// [lights]; they belong to the sky.
const struct relume_btf_light_lobe *relume_btf_environment_cones(const relume_btf_environment *sky);
// The part of the environment that light number `i` of the model represents in an orientation:
// relume_btf_oriented_light_weights.
void relume_btf_environment_weight(float rgb[3], const relume_btf_environment *sky,
                                   const struct relume_btf_frame *frame, int i);

#endif
