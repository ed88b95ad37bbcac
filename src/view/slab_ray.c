// slab_ray.c - the ray of a pixel in a slab's frame
#include "view/slab.h"

struct slab_ray slab_ray_of(const struct slab_frame *frame, int column, int row)
{
    return (struct slab_ray){
        .uv = {slab_hit(frame->eye.x, slab_s(frame, column), frame->reach),
               slab_hit(frame->eye.y, slab_t(frame, row), frame->reach)},
        .texel = {(column + 0.5) / frame->out->width * frame->width,
                  (row + 0.5) / frame->out->height * frame->height},
    };
}

struct slab_ray slab_ray_at(const struct slab_frame *f, const double st[2])
{
    const struct relume_geometry *g = &f->slab->geometry;
    return (struct slab_ray){
        .uv = {slab_hit(f->eye.x, st[0], f->reach), slab_hit(f->eye.y, st[1], f->reach)},
        .texel = {(st[0] - g->st_min[0]) / (g->st_max[0] - g->st_min[0]) * f->width,
                  (g->st_max[1] - st[1]) / (g->st_max[1] - g->st_min[1]) * f->height},
    };
}

void slab_shift(double shift[2], const struct slab_frame *frame, const struct slab_ray *ray,
                double u, double v)
{
    const struct relume_geometry *g = &frame->slab->geometry;
    shift[0] = (ray->uv[0] - u) / (g->st_max[0] - g->st_min[0]) * frame->width;
    shift[1] = (v - ray->uv[1]) / (g->st_max[1] - g->st_min[1]) * frame->height;
}
