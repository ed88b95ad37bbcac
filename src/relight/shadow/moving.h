// moving.h - shadows and highlights that wander with the light
//
// Between two captured lights interpolation fades one shadow out and another in. Where depth is
// known the edge can move instead. With rho_i captured under light i, w_i the weights of the lights
// around a direction L, V the share of a pixel that light from L reaches, by depth, and f what the
// pixel would show if nothing stood in the light,
//     rho(L) = sum_i w_i rho_i + V(L) f(L) - sum_i w_i V(L_i) f(L_i),
// sums as the codes are interpolated, in their domain. Under a captured light that is the
// photograph; between them the residual rho_i - V(L_i) f(L_i), which is small, is interpolated in
// place of the shadow.
//
// A view sees fronts alone. How deep the things are that light is stopped by is learnt from the
// photographs: where light arrives, nothing stood in its way (Savarese et al. 2007 carve volumes by
// that). f is matte: colour times max(0, a + b.L), by least squares over the lights that arrive.
//
// Without depth highlights can wander in the same way: V is 1, and f a share of what a surface of
// the pixel's normal, colour and gloss shows (GGX, relume/material/maps.h). The share is that with
// which the captured lights, each left out, are foretold best: where the model does not fit it is
// 0.
#ifndef SHADOW_MOVING_H
#define SHADOW_MOVING_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/format/coder.h>
#include <relume/image.h>
#include <relume/light.h>
#include <relume/pack.h>

// Whether rays can be traced through views of that geometry: not cubes and cylinders with discs.
bool relume_shadows_suit(const struct relume_geometry *geometry);

// One view whose shadows can be traced. Thread-safety: one thread at a time.
typedef struct relume_shadows relume_shadows;

// `depth` is one channel of distances along rays, infinite for background; `model` what
// relume_shadows_learn found. Both are copied. RELUME_EINVAL for geometries that do not suit and
// images of other sizes, RELUME_ENOMEM.
relume_status relume_shadows_create(relume_shadows **out, const struct relume_geometry *geometry,
                                    const double uv[2], const struct relume_image *depth,
                                    const struct relume_image *model);
void relume_shadows_destroy(relume_shadows **shadows);
// Shadows or highlights of a view of a file, ready to be added; NULL when the file has neither.
// Where the file was opened with `keep_going` a damaged model is a warning, said once, and NULL.
// The caller destroys `*out`. RELUME_EINVAL for a view that is not there, RELUME_EDAMAGED,
// RELUME_ENOMEM.
relume_status relume_shadows_open(relume_shadows **out, relume_pack *pack, int view);
// What is kept, bytes: it grows with the captured lights that were asked for.
uint64_t relume_shadows_bytes(const relume_shadows *shadows);

enum { RELUME_SHADOW_REACHED = 36 };
// What share of each pixel, and a little of those beside it, light from a unit direction (world)
// reaches: `out[height][width]`, 0 to RELUME_SHADOW_REACHED. Background is reached. RELUME_ENOMEM.
relume_status relume_shadows_trace(uint8_t *out, const relume_shadows *shadows,
                                   struct relume_vec3 direction, int threads);

// How a view is learnt. Borrowed during the call.
struct relume_shadows_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;       // default: all cores
    const bool *skip;  // [lights]: those that are left out; default: none
};
#define relume_shadows_params(...)                                                                 \
    (&(const struct relume_shadows_params){RELUME_SIZED(relume_shadows_params), __VA_ARGS__})

// Learn a view of a capture with distant lights: `*model` is created with RELUME_SHADOW_CHANNELS
// channels. All photographs of the view are held at two bytes a pixel. RELUME_EINVAL where there is
// no depth or the geometry does not suit, an input status, RELUME_ENOMEM.
relume_status relume_shadows_learn(struct relume_image *model, const relume_capture *capture,
                                   int view, const struct relume_shadows_params *params);

// What relume_shadows_judge finds: PSNR in dB of display values over all pixels of some captured
// lights that are left out and met again. Plain data.
struct relume_shadows_gain {
    double faded_db;   // by interpolation, `chord` or `delaunay`, whichever is better
    double traced_db;  // with shadows traced
    int lights;        // that were left out
};
// Whether tracing helps a view; `display`: codes will be of the display domain. At least 8 lights,
// else RELUME_EINVAL. Errors of relume_shadows_learn.
relume_status relume_shadows_judge(struct relume_shadows_gain *out, const relume_capture *capture,
                                   int view, bool display,
                                   const struct relume_shadows_params *params);

// As relume_shadows_create, of what relume_gloss_learn found, for planar views that are seen
// orthographically. RELUME_EINVAL for other channels, RELUME_ENOMEM.
relume_status relume_gloss_create(relume_shadows **out, const struct relume_image *model);

// Learn the view of a planar orthographic capture with distant lights; `display`: codes will be of
// the display domain. `*model` is created with RELUME_GLOSS_CHANNELS channels. `skip` must be NULL.
// RELUME_EINVAL for other captures, errors of relume_maps_fit and relume_coder_learn.
relume_status relume_gloss_learn(struct relume_image *model, const relume_capture *capture,
                                 bool display, const struct relume_shadows_params *params);
// As relume_shadows_judge, `traced_db` being that of wandering highlights; means of the lights'
// decibels. Of pictures more than 64 pixels wide or high 8 x 8 pieces of 8 pixels are judged,
// spread evenly.
relume_status relume_gloss_judge(struct relume_shadows_gain *out, const relume_capture *capture,
                                 bool display, const struct relume_shadows_params *params);

// Add the last two terms to a picture of one light, which is linear and becomes black where it
// would be less. The picture is the rectangle of the view at `left`, `top` of its size, relit from
// codes of `coder` and `domain` (`display`: its curve). Area lights are 4 x 4 patches. Highlights
// do not wander under near lights. RELUME_EINVAL for environments, RELUME_ENOMEM.
relume_status relume_shadows_add(struct relume_image *picture, int left, int top,
                                 relume_shadows *shadows, const struct relume_codes *codes,
                                 const struct relume_light *light, int threads);

enum { RELUME_SHADOW_LAMPS = 64 };
// Finds the bright sources of an environment map, such as the sun or windows, whose shadows have
// edges. They are those of RELUME_SHADOW_LAMPS lights (relume_environment_sample) that have more
// than an even share of the luminance and lie within the captured lights of the coder. The first
// *count of `out[RELUME_SHADOW_LAMPS]` are directional lights. RELUME_ENOMEM.
relume_status relume_shadows_bright_sources(struct relume_light *out, int *count,
                                            const struct relume_light *environment,
                                            const relume_coder *coder);
// The same as relume_shadows_add for one of them: the picture is what an environment that has
// nothing but this source shows (relume_environment_weights), whatever the domain of the codes. So
// what the source takes off in a pixel is at most what it brings there.
relume_status relume_shadows_add_bright_source(struct relume_image *picture, int left, int top,
                                               relume_shadows *shadows, const relume_coder *coder,
                                               const struct relume_light *source, int threads);

// The captured lights around a direction, by which the sums above go: `light` and `weight` have
// all lights of the coder, the first *count are in use; at most 4 of traced shadows, none
// where the direction is a captured light's. `direction` is unit, as relume_coder_clamp gives it;
// `summed`: for a bright source of an environment. RELUME_ENOMEM.
relume_status relume_shadows_around(int *light, float *weight, int *count, relume_shadows *shadows,
                                    const relume_coder *coder, struct relume_vec3 direction,
                                    bool summed);

// What these weights are of traced shadows: a `table` of the lights of `coder`, interpolated over
// triangles. It belongs to the shadows. RELUME_EINVAL for highlights, RELUME_ENOMEM.
relume_status relume_shadows_between(const relume_coder **out, relume_shadows *shadows,
                                     const relume_coder *coder);

// How the rays of a view lie in its coordinates, whose origin is the eye, or of parallel rays the
// middle of the plane; the axis is -z, the pole of panoramas y. A pixel is scale x + shift, of x
// and y for parallel rays, x / z and y / z, or of azimuth (from -z to x) and tangent of the
// elevation, or elevation.
enum relume_shadows_rays {
    RELUME_RAYS_PARALLEL,
    RELUME_RAYS_EYE,
    RELUME_RAYS_CYLINDER,
    RELUME_RAYS_SPHERE
};

enum { RELUME_SHADOW_TILE = 8 };  // pixels, along a side

// What is kept of a view, as long as the shadows are.
struct relume_shadows_stage {
    int width, height;
    const float *gloss;  // [height][width][RELUME_GLOSS_CHANNELS]: of highlights; the rest is of
                         // traced shadows, where this is NULL
    const float *matte;  // [height][width][RELUME_SHADOW_CHANNELS - 1]: colour, a, b
    enum relume_shadows_rays rays;
    struct relume_pose pose;       // directions of the view in the world
    double scale[2], shift[2];     // pixels of coordinates
    double axis;                   // z of rays: -1, or 1 where the eye is behind its window
    double pixel;                  // the side of a pixel at distance 1, of parallel rays anywhere
    double least_side;             // at least that, of a pixel at any distance
    struct relume_vec3 low, high;  // a box around the surface
    const float *far;    // [height][width]: distance along the axis, from the pole's axis or from
                         // the eye; infinite: background
    const float *thick;  // [height][width]: behind it, where light is stopped
    const float
        *front;         // [rows][columns] of tiles: what is nearest in a tile or in those beside it
    const float *span;  // [height + 1][width + 1][2]: nearest and farthest of the pixels around a
                        // corner
};
void relume_shadows_look(struct relume_shadows_stage *out, const relume_shadows *shadows);

#endif
