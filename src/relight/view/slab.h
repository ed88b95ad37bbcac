// slab.h - what slab.c and slab_frame.c share
#ifndef VIEW_SLAB_H
#define VIEW_SLAB_H

#include "image/image/footprint.h"
#include "relight/view/view.h"

#include <relume/relight/view.h>

struct relume_slab {
    struct relume_geometry geometry;
    int views;  // arrays by view number are so long
    int columns, rows;
    double slack;  // ON_LINE in world units
    double *u;
    double *v;
    int *view;
};
// As relume_slab_create, of the views of slab `which` only; the numbers of views stay. `slab_of`
// may be NULL: all are.
relume_status slab_create(relume_slab **out, const struct relume_geometry *geometry,
                          const double (*uv)[2], const int *slab_of, int which, int views);

// Up to two neighbours on a line with their weights, none of them 0.
struct neighbours {
    int count;
    int index[2];
    double weight[2];
};

// How far along the way from the eye (0) to the st plane (1) the uv plane lies; false when the eye
// sees nothing of the slab from there.
bool slab_reach(double *reach, const relume_slab *slab, struct relume_vec3 eye);
// The nearest place on or between the lines.
static inline double slab_nearest(const double *lines, int n, double at)
{
    return at < lines[0] ? lines[0] : at > lines[n - 1] ? lines[n - 1] : at;
}
// u (or v) of the ray from `eye` through `st`. Exact for a reach of 0, monotone in `st`, rounding
// included.
double slab_hit(double eye, double st, double reach);

// The cameras around a point of the uv plane, by column and by row; none outside the grid.
struct neighbours slab_columns_at(const relume_slab *slab, bool constant, double u);
struct neighbours slab_rows_at(const relume_slab *slab, bool constant, double v);

// Mark the views around the rays from `eye` through a rectangle of the st plane, cut to the window;
// returns how many.
int slab_mark(bool *needed, const relume_slab *slab, struct relume_vec3 eye, const double st_min[2],
              const double st_max[2], const struct relume_view_params *params);
// One frame of one slab, as the ways to draw it share it.
struct slab_frame {
    const relume_slab *slab;
    const struct relume_image *out;
    const struct relume_image *views;
    int width, height;  // of a view
    struct relume_vec3 eye;
    double reach;
    struct relume_view_params params;
    const bool *needed;  // [views]
};
// What a view's image holds of it.
static inline struct relume_rect slab_part(const struct slab_frame *f, int view)
{
    return f->params.part ? f->params.part[view] : (struct relume_rect){0, 0, f->width, f->height};
}
// Whether the views that are needed are there, of three channels and of one size, which is set
// unless it is known; and so their disparities when there are any.
bool slab_views_fit(struct slab_frame *frame, const struct relume_image *disparity);
relume_status slab_frame_depth(const struct slab_frame *frame);
relume_status slab_frame_lens(const struct slab_frame *frame);
// What slab_frame_depth gives a pixel that looks at (s, t).
relume_status slab_value_depth(float rgb[3], const struct slab_frame *frame, const double st[2]);
// The farthest and the nearest disparity in a frame's views ...
void slab_depth_extent(double range[2], const struct slab_frame *frame);
// ... and that its rays can hit.
void slab_depth_range(double range[2], const struct slab_frame *frame);
struct slab_ray;
// A ray by depth. Returns the share of the cameras around it that see its surface, 1e-3 of that
// where what is there is only guessed.
double slab_depth_shade(float rgb[3], const struct slab_frame *frame, const struct slab_ray *ray,
                        const double range[2]);
// A ray beside the grid, of slab_ray_beside, by depth, `away` from the cameras or towards them;
// `range` is of all their disparities. 0 where none of the cameras sees what it
// hits, nor that it hits nothing.
double slab_depth_beside(float rgb[3], const struct slab_frame *frame, const struct slab_ray *ray,
                         const double range[2], bool away);
// A ray by the quadralinear basis, or of the nearest camera.
void slab_flat_shade(float rgb[3], const struct slab_frame *frame, const struct slab_ray *ray);

// Samples a side of what a pixel covers.
static inline struct footprint slab_footprint(const struct relume_view_params *params,
                                              double texels)
{
    const bool one = params->one || params->filter == RELUME_FILTER_NEAREST;
    return footprint_of(one ? 0.0 : texels, FOOTPRINT_MOST);
}

static inline bool slab_is_lens(const struct relume_view_params *params)
{
    return params && (params->aperture != 0.0 || params->focus != 0.0);
}

// The place on the st plane that a column (row) of the frame looks at, centres at +0.5.
static inline double slab_s(const struct slab_frame *f, double x)
{
    const struct relume_geometry *g = &f->slab->geometry;
    return g->st_min[0] + x / f->out->width * (g->st_max[0] - g->st_min[0]);
}
static inline double slab_t(const struct slab_frame *f, double y)
{
    const struct relume_geometry *g = &f->slab->geometry;
    return g->st_max[1] - y / f->out->height * (g->st_max[1] - g->st_min[1]);
}

static inline void slab_need(const struct slab_frame *f, int view, int x, int y)
{
    if (f->params.need)
        f->params.need(f->params.user, view, x, y);
}

// The ray of a pixel: where it crosses the uv plane, and the place in a view (texels, centres at
// +0.5) that shows its point on the st plane. Rays that miss the grid ask the cameras around `at`,
// its place nearest to `uv`.
struct slab_ray {
    double uv[2], at[2], texel[2];
};
// At (x, y) of the frame, pixel centres at +0.5.
struct slab_ray slab_ray_of(const struct slab_frame *frame, double x, double y);
struct slab_ray slab_ray_at(const struct slab_frame *frame, const double st[2]);
// Of the line from the eye along `direction`, wherever the eye stands: `at` is where cameras see it
// most from its own side. Returns from how far aside, as an angle; pi where they see nothing of it.
double slab_ray_beside(struct slab_ray *ray, const struct slab_frame *frame,
                       struct relume_vec3 direction);
// All pixels of the frame, each the mean of what it covers: a shader adds to r, g, b and weight
// what a ray sees.
typedef void slab_shader(double sum[4], const void *context, const struct slab_ray *ray);
void slab_draw(const struct slab_frame *frame, slab_shader *shade, const void *context);
// How far the texel of the ray's point moves in the view of the camera at (u, v) when the point's
// disparity rises by 1.
void slab_shift(double shift[2], const struct slab_frame *frame, const struct slab_ray *ray,
                double u, double v);

// All the weight on one of them.
static inline struct neighbours one_neighbour(int index)
{
    return (struct neighbours){1, {index, index}, {1.0, 0.0}};
}

#endif
