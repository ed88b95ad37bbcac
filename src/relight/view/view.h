// view.h - slabs and panoramas: cameras around a ray, disparities, pixels of a look
#ifndef VIEW_VIEW_H
#define VIEW_VIEW_H

#include <relume/relight/view.h>

// Where the pixels of a view lie: create `*out` with three channels, the world position that each
// pixel centre sees, not finite where `depth` is infinite. `uv` is the camera's place in a slab;
// `depth` (one channel) may be NULL for planar views, which then lie on z = 0. RELUME_EINVAL,
// RELUME_ENOMEM.
relume_status relume_view_positions(struct relume_image *out,
                                    const struct relume_geometry *geometry, const double uv[2],
                                    const struct relume_image *depth, int width, int height);

// ------------------------------------------------------------------ light slab
// The cameras of a slab as a grid. Never changes. Thread-safety: safe.
typedef struct relume_slab relume_slab;

// `uv[views]` must be the crossings of a grid (rows and columns may be unevenly spaced, one row or
// one column is fine), in any order; else RELUME_EINVAL. RELUME_ENOMEM.
relume_status relume_slab_create(relume_slab **out, const struct relume_geometry *geometry,
                                 const double (*uv)[2], int views);
void relume_slab_destroy(relume_slab **slab);

// The grid, for clients that draw themselves.
struct relume_slab_grid {
    int columns, rows;
    const double *u, *v;  // [columns], [rows], ascending
    const int *view;      // [rows][columns]: which view stands there
    int views;            // arrays by view number are so long
};
// A copy; what it points to belongs to the slab.
struct relume_slab_grid relume_slab_grid(const relume_slab *slab);

// The middle of the uv grid, on the uv plane.
struct relume_vec3 relume_slab_middle(const relume_slab *slab);

// Where the ray from `eye` through (s, t) on the st plane crosses the uv plane. An eye on the uv
// plane is its own crossing. The eye may stand before, on or behind the uv plane; on the st plane
// or beyond it there is no light that a camera has seen, and the answer is false.
bool relume_slab_uv(double uv[2], const relume_slab *slab, struct relume_vec3 eye, double s,
                    double t);

// The share of the window that `eye` sees through the uv grid, 0 to 1. The other rays of a frame
// are those of the nearest camera.
double relume_slab_share(const relume_slab *slab, struct relume_vec3 eye);

// The up to four views and weights (summing to 1) for a point of the uv plane; returns how many,
// 0 outside the grid (1e-9 of its size beside it is still inside). Views of weight 0 are left out.
int relume_slab_blend(int view[4], double weight[4], const relume_slab *slab, const double uv[2],
                      const struct relume_view_params *params);

// Depth as disparity: `*out` is created with one channel. A point of disparity q that the camera at
// c sees in (s, t) is seen by the camera at c' in (s, t) + q (c - c'): 0 on the st plane, rising
// towards the cameras. Where `depth` is infinite it is RELUME_SLAB_BACKGROUND, twice that beside a
// surface, whose colour such a texel may have some of. `depth` is one channel of distances along
// the rays of the camera at `uv`. RELUME_EINVAL, RELUME_ENOMEM.
#define RELUME_SLAB_BACKGROUND (-1.0f)
// The disparities of one view. RELUME_EINVAL, RELUME_ENOMEM.
relume_status relume_slab_disparity(struct relume_image *out, const relume_slab *slab,
                                    const double uv[2], const struct relume_image *depth);
// The least and the greatest of such an image, background left out; false when all is background.
bool relume_slab_range(double range[2], const struct relume_image *disparity);
// The disparity of the plane at height z; that which is nearest to an eye, infinite for one on or
// beyond the uv plane. What rises above it lies behind the eye.
double relume_slab_plane_disparity(const relume_slab *slab, double z);
// The disparity that is nearest to an eye, infinite for one on or beyond the uv plane.
double relume_slab_eye_disparity(const relume_slab *slab, struct relume_vec3 eye);

// What a camera weighs in a frame through an aperture of `radius` around the point `uv` of the uv
// plane, not normalised.
struct relume_slab_lens {
    double place[2];    // u, v of the camera
    double step[2][2];  // u, v: to the next line of the grid below and above
};
// Of the camera in that column and row of the grid.
struct relume_slab_lens relume_slab_lens(const relume_slab *slab, int column, int row);
// 0 outside the aperture.
double relume_slab_lens_weight(const struct relume_slab_lens *camera, const double uv[2],
                               double radius);

// Mark in needed[views] the views that a frame from `eye` can touch (seed Fig 8-13); returns how
// many, 0 when the eye sees nothing of the slab.
int relume_slab_needs(bool *needed, const relume_slab *slab, struct relume_vec3 eye,
                      const struct relume_view_params *params);

// Of each view that such a frame of frame[0] x frame[1] pixels can touch, the part that it reads,
// of params->size; nothing of the others. By depth params->range is looked at, for the views that
// relume_slab_needs marks; NULL: no disparities. Returns as relume_slab_needs; -1 when memory is
// short.
int relume_slab_parts(struct relume_rect *part, const relume_slab *slab, struct relume_vec3 eye,
                      const int frame[2], const struct relume_view_params *params);

// The window st_min..st_max as seen from `eye`. `views` are the relit images by view number, read
// where needed. A pixel whose ray misses the uv grid shows what the cameras nearest to it see of
// its point: on the st plane, or by depth on the surface. A pixel that covers several texels is
// their mean. `out` has the wanted size already.
// A captured eye and size give back that view bit by bit, unless an aperture or a focus is given.
// RELUME_EINVAL for an eye that sees nothing, a needed view or disparity that is missing or of
// another size, a plane of focus on or behind the cameras; RELUME_ENOMEM.
relume_status relume_slab_frame(struct relume_image *out, const relume_slab *slab,
                                struct relume_vec3 eye, const struct relume_image *views,
                                const struct relume_view_params *params);

// What such a frame by depth shows at (s, t): `params` must have disparities, and of these and of
// `views` those are read that relume_slab_blend names for the ray. RELUME_EINVAL likewise and for a
// ray that misses the grid.
relume_status relume_slab_value(float rgb[3], const relume_slab *slab, struct relume_vec3 eye,
                                const double st[2], const struct relume_image *views,
                                const struct relume_view_params *params);

// Unit direction at the (fractional) position (x, y) of a panorama image; pixel centres are at
// +0.5. A cube's faces lie side by side, its width is 6 x its height. Zero for other projections.
struct relume_vec3 relume_panorama_ray(const struct relume_geometry *geometry, int width,
                                       int height, double x, double y);
// The inverse: false when the panorama does not show that direction (above and below a cylinder) or
// the direction is zero. x is in [0, width), for a cube on the face that shows it.
bool relume_panorama_pixel(double xy[2], const struct relume_geometry *geometry, int width,
                           int height, struct relume_vec3 direction);

// Bilinear value in a direction, continuous over the wrap, the poles and the cube's edges; black
// and false where there is nothing. Of `params`, which may be NULL, `need` is looked at, for view
// 0, and `filter`, where it is RELUME_FILTER_NEAREST: then it is the nearest texel's.
bool relume_panorama_sample(float rgb[3], const struct relume_geometry *geometry,
                            const struct relume_image *image, struct relume_vec3 direction,
                            const struct relume_view_params *params);

#endif
