// view.h - from relit views to a frame: light slabs and panoramas (Wong 1998, 6.3, 8.1, 8.2)
#ifndef RELUME_VIEW_H
#define RELUME_VIEW_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

struct relume_view_params {
    int threads;    // default: all cores
    bool constant;  // slab: the nearest view instead of the quadralinear basis
};
#define relume_view_params(...) (&(const struct relume_view_params){__VA_ARGS__})

// Where the pixels of a view lie: create `*out` with three channels, the world position that each
// pixel centre sees, not finite where `depth` is infinite. `uv` is the camera's place in a slab;
// `depth` (one channel) may be NULL for planar views, which then lie on z = 0. RELUME_EINVAL,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_surface(struct relume_image *out,
                                           const struct relume_geometry *geometry,
                                           const double uv[2], const struct relume_image *depth,
                                           int width, int height);

// ------------------------------------------------------------------ light slab
// The cameras of a slab as a grid. Never changes. Thread-safety: safe.
typedef struct relume_slab relume_slab;

// `uv[views]` must be the crossings of a grid (rows and columns may be unevenly spaced, one row or
// one column is fine), in any order; else RELUME_EINVAL. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_slab_create(relume_slab **out,
                                               const struct relume_geometry *geometry,
                                               const double (*uv)[2], int views);
RELUME_API void relume_slab_destroy(relume_slab **slab);

// The grid, for clients that draw themselves.
struct relume_slab_grid {
    int columns, rows;
    const double *u, *v;  // [columns], [rows], ascending
    const int *view;      // [rows][columns]: which view stands there
};
RELUME_API struct relume_slab_grid relume_slab_grid(const relume_slab *slab);

// The middle of the uv grid, on the uv plane.
RELUME_API struct relume_vec3 relume_slab_middle(const relume_slab *slab);

// Where the ray from `eye` through (s, t) on the st plane meets the uv plane. An eye on the uv
// plane meets it in itself. The eye may stand before, on or behind the uv plane; on the st plane or
// beyond it there is no light that a camera has seen, and the answer is false.
RELUME_API bool relume_slab_uv(double uv[2], const relume_slab *slab, struct relume_vec3 eye,
                               double s, double t);

// The up to four views and weights (summing to 1) for a point of the uv plane; returns how many,
// 0 outside the grid (1e-9 of its size beside it is still inside). Views of weight 0 are left out.
RELUME_API int relume_slab_blend(int view[4], double weight[4], const relume_slab *slab,
                                 const double uv[2], const struct relume_view_params *params);

// Mark in needed[views] the views that a frame from `eye` can touch (seed Fig 8-13); returns how
// many, 0 when the eye sees nothing of the slab.
RELUME_API int relume_slab_needs(bool *needed, const relume_slab *slab, struct relume_vec3 eye,
                                 const struct relume_view_params *params);

// The window st_min..st_max as seen from `eye`. `views` are the relit images by view number, read
// where needed; a pixel whose ray misses the uv grid is black. `out` has the wanted size already.
// A captured eye and size give back that view bit by bit. RELUME_EINVAL for an eye that sees
// nothing or a needed view that is missing or of another size; RELUME_ENOMEM.
RELUME_RESULT relume_status relume_slab_frame(struct relume_image *out, const relume_slab *slab,
                                              struct relume_vec3 eye,
                                              const struct relume_image *views,
                                              const struct relume_view_params *params);

// ------------------------------------------------------------------ panorama
// Angles in degrees: pan > 0 turns right (-z towards +x), tilt > 0 looks up; tilt is applied
// first, then pan. The horizontal field of view is 2 atan(1 / zoom).
struct relume_look {
    double pan_deg, tilt_deg, zoom;  // zoom 0 means 1
};

// Unit direction through the (fractional) position (x, y) of a width x height frame; pixel centres
// are at +0.5.
RELUME_API struct relume_vec3 relume_look_ray(struct relume_look look, int width, int height,
                                              double x, double y);

// Unit direction at the (fractional) position (x, y) of a panorama image; pixel centres are at
// +0.5. A cube's faces lie side by side, its width is 6 x its height. Zero for other projections.
RELUME_API struct relume_vec3 relume_panorama_ray(const struct relume_geometry *geometry, int width,
                                                  int height, double x, double y);
// The inverse: false when the panorama does not show that direction (above and below a cylinder) or
// the direction is zero. x is in [0, width), for a cube on the face that shows it.
RELUME_API bool relume_panorama_pixel(double xy[2], const struct relume_geometry *geometry,
                                      int width, int height, struct relume_vec3 direction);

// Bilinear value in a direction, continuous over the wrap, the poles and the cube's edges; black
// and false where there is nothing.
RELUME_API bool relume_panorama_sample(float rgb[3], const struct relume_geometry *geometry,
                                       const struct relume_image *image,
                                       struct relume_vec3 direction);

// A perspective frame; `out` has the wanted size already. RELUME_EINVAL when `image` is no panorama
// of three channels or `look` is not finite.
RELUME_RESULT relume_status relume_panorama_frame(struct relume_image *out,
                                                  const struct relume_geometry *geometry,
                                                  const struct relume_image *image,
                                                  struct relume_look look,
                                                  const struct relume_view_params *params);

#ifdef __cplusplus
}
#endif
#endif
