// slab_ray.c - the rays of a pixel in a slab's frame
#include "relight/view/slab.h"

#include "core/base/thread.h"
#include "core/math/vec.h"
#include "relight/view/view.h"

static struct slab_ray ray_from(const struct slab_frame *f, double s, double t)
{
    const relume_slab *slab = f->slab;
    const double u = slab_hit(f->eye.x, s, f->reach), v = slab_hit(f->eye.y, t, f->reach);
    return (struct slab_ray){
        .uv = {u, v},
        .at = {slab_nearest(slab->u, slab->columns, u), slab_nearest(slab->v, slab->rows, v)},
    };
}

static void place_in_views(struct slab_ray *ray, const struct slab_frame *f, double s, double t)
{
    const struct relume_geometry *g = &f->slab->geometry;
    ray->texel[0] = (s - g->st_min[0]) / (g->st_max[0] - g->st_min[0]) * f->width;
    ray->texel[1] = (g->st_max[1] - t) / (g->st_max[1] - g->st_min[1]) * f->height;
}

struct slab_ray slab_ray_of(const struct slab_frame *frame, double x, double y)
{
    struct slab_ray ray = ray_from(frame, slab_s(frame, x), slab_t(frame, y));
    ray.texel[0] = x / frame->out->width * frame->width;
    ray.texel[1] = y / frame->out->height * frame->height;
    return ray;
}

struct slab_ray slab_ray_at(const struct slab_frame *f, const double st[2])
{
    struct slab_ray ray = ray_from(f, st[0], st[1]);
    place_in_views(&ray, f, st[0], st[1]);
    return ray;
}

// Lines that rise less than this over the planes cross them too far away.
static const double flattest = 1e-3;

// Where a grid's cameras stand that look at `middle` most as the eye does along `way`: nearest to
// where the line from there back to the eye crosses their plane; past the horizon as far that way.
static void nearest_cameras(double at[2], const relume_slab *slab, vec3 middle, vec3 way)
{
    const double up = (slab->geometry.uv_z - middle.z) / fabs(way.z);
    at[0] = slab_nearest(slab->u, slab->columns, middle.x - fabs(up) * way.x);
    at[1] = slab_nearest(slab->v, slab->rows, middle.y - fabs(up) * way.y);
}

double slab_ray_beside(struct slab_ray *ray, const struct slab_frame *f, vec3 direction)
{
    const struct relume_geometry *g = &f->slab->geometry;
    const vec3 way = vec3_unit(direction);
    const double to_uv = (g->uv_z - f->eye.z) / way.z, to_st = (g->st_z - f->eye.z) / way.z;
    if (!(fabs(way.z) > flattest) || (way.z * (g->uv_z - g->st_z) > 0.0 && to_uv <= 0.0))
        return M_PI;
    const vec3 window =
        vec3_of(0.5 * (g->st_min[0] + g->st_max[0]), 0.5 * (g->st_min[1] + g->st_max[1]), g->st_z);
    const vec3 middle = vec3_along(f->eye, way, vec3_dot(vec3_sub(window, f->eye), way));
    *ray = (struct slab_ray){
        .uv = {f->eye.x + to_uv * way.x, f->eye.y + to_uv * way.y},
    };
    nearest_cameras(ray->at, f->slab, middle, way);
    place_in_views(ray, f, f->eye.x + to_st * way.x, f->eye.y + to_st * way.y);
    const vec3 camera = vec3_of(ray->at[0], ray->at[1], g->uv_z);
    return vec3_angle(vec3_unit(vec3_sub(middle, camera)), way);
}

static void draw_pixel(float rgb[3], const struct slab_frame *f, int column, int row,
                       slab_shader *shade, const void *context)
{
    const struct footprint across = slab_footprint(&f->params, (double)f->width / f->out->width);
    const struct footprint down = slab_footprint(&f->params, (double)f->height / f->out->height);
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++) {
            const struct slab_ray ray = slab_ray_of(f, column + 0.5 + footprint_place(across, i),
                                                    row + 0.5 + footprint_place(down, j));
            shade(sum, context, &ray);
        }
    for (int c = 0; c < 3; c++)
        rgb[c] = sum[3] > 0.0 ? (float)(sum[c] / sum[3]) : f->params.nothing;
}

struct drawing {
    const struct slab_frame *frame;
    slab_shader *shade;
    const void *context;
};

static void draw_row(void *context, size_t row, int worker)
{
    const struct drawing *d = context;
    const struct relume_image *out = d->frame->out;
    (void)worker;
    float *rgb = out->data + 3 * row * (size_t)out->width;
    for (int x = 0; x < out->width; x++, rgb += 3)
        draw_pixel(rgb, d->frame, x, (int)row, d->shade, d->context);
}

void slab_draw(const struct slab_frame *frame, slab_shader *shade, const void *context)
{
    struct drawing d = {frame, shade, context};
    thread_for(frame->params.threads, (size_t)frame->out->height, draw_row, &d);
}

void slab_shift(double shift[2], const struct slab_frame *frame, const struct slab_ray *ray,
                double u, double v)
{
    const struct relume_geometry *g = &frame->slab->geometry;
    shift[0] = (ray->uv[0] - u) / (g->st_max[0] - g->st_min[0]) * frame->width;
    shift[1] = (v - ray->uv[1]) / (g->st_max[1] - g->st_min[1]) * frame->height;
}
