// slab_ray.c - the rays of a pixel in a slab's frame
#include "view/slab.h"

static struct slab_ray ray_from(const struct slab_frame *f, double s, double t)
{
    const relume_slab *slab = f->slab;
    const double u = slab_hit(f->eye.x, s, f->reach), v = slab_hit(f->eye.y, t, f->reach);
    return (struct slab_ray){
        .uv = {u, v},
        .at = {slab_nearest(slab->u, slab->columns, u), slab_nearest(slab->v, slab->rows, v)},
    };
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
    const struct relume_geometry *g = &f->slab->geometry;
    struct slab_ray ray = ray_from(f, st[0], st[1]);
    ray.texel[0] = (st[0] - g->st_min[0]) / (g->st_max[0] - g->st_min[0]) * f->width;
    ray.texel[1] = (g->st_max[1] - st[1]) / (g->st_max[1] - g->st_min[1]) * f->height;
    return ray;
}

void slab_pixel(float rgb[3], const struct slab_frame *f, int column, int row, slab_shader *shade,
                const void *context)
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

void slab_shift(double shift[2], const struct slab_frame *frame, const struct slab_ray *ray,
                double u, double v)
{
    const struct relume_geometry *g = &frame->slab->geometry;
    shift[0] = (ray->uv[0] - u) / (g->st_max[0] - g->st_min[0]) * frame->width;
    shift[1] = (v - ray->uv[1]) / (g->st_max[1] - g->st_min[1]) * frame->height;
}
