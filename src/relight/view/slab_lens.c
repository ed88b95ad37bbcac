// slab_lens.c - a frame of a light slab through a synthetic aperture
//
// Isaksen, McMillan, Gortler 2000 (dynamically reparameterized light fields): all cameras within
// the aperture look at the point where the ray crosses the plane in focus; what lies on that plane
// adds up, the rest is blurred. A camera counts by the bilinear basis of its place, taken at the
// point of the aperture nearest to it: whole within the aperture, falling to nothing over one step
// of the grid beside it. So a pinhole is the quadralinear basis with another plane in focus, and a
// frame changes smoothly with the aperture and the eye.
#include "core/math/bilinear.h"
#include "relight/view/slab.h"

#include "core/base/memory.h"
#include "relight/view/view.h"

#include <math.h>

struct camera {
    const float *rgb;  // [height][width][3]
    struct relume_slab_lens lens;
};

struct frame {
    const struct slab_frame *of;
    double radius;
    double focus;  // disparity of the plane in focus
    int count;
    struct camera *camera;
};

// ---------------------------------------------------------------- weights

// The bilinear basis at `away` from its camera, with the next ones at step[0] below, step[1] above.
static double hat(double away, const double step[2])
{
    return fmax(1.0 - fabs(away) / step[away > 0.0], 0.0);
}

double relume_slab_lens_weight(const struct relume_slab_lens *camera, const double uv[2],
                               double radius)
{
    const double away[2] = {uv[0] - camera->place[0], uv[1] - camera->place[1]};
    const double distance = hypot(away[0], away[1]);
    const double left = distance > radius ? 1.0 - radius / distance : 0.0;
    return hat(left * away[0], camera->step[0]) * hat(left * away[1], camera->step[1]);
}

static void find_steps(double step[2], const double *lines, int n, int i, double slack)
{
    step[0] = i > 0 ? lines[i] - lines[i - 1] : slack;
    step[1] = i < n - 1 ? lines[i + 1] - lines[i] : slack;
}

struct relume_slab_lens relume_slab_lens(const relume_slab *slab, int column, int row)
{
    struct relume_slab_lens lens = {.place = {slab->u[column], slab->v[row]}};
    find_steps(lens.step[0], slab->u, slab->columns, column, slab->slack);
    find_steps(lens.step[1], slab->v, slab->rows, row, slab->slack);
    return lens;
}

// ---------------------------------------------------------------- pixels

// Adds the bilinear value at a place in texels; nothing outside the view.
static bool add_sample(double sum[3], const struct slab_frame *f, const float *rgb,
                       const double at[2], double weight)
{
    if (!(at[0] >= 0.0 && at[0] <= f->width && at[1] >= 0.0 && at[1] <= f->height))
        return false;
    const struct bilinear b =
        bilinear_at(at[0] - 0.5, at[1] - 0.5, f->width, f->height, EDGE_CLAMPED);
    for (size_t k = 0; k < 3; k++)
        sum[k] += weight * bilinear_value(&b, rgb, 3, k);
    return true;
}

static void shade_ray(double sum[4], const void *context, const struct slab_ray *ray)
{
    const struct frame *f = context;
    for (int i = 0; i < f->count; i++) {
        const struct camera *c = &f->camera[i];
        const double weight = relume_slab_lens_weight(&c->lens, ray->at, f->radius);
        double shift[2];
        if (weight == 0.0)
            continue;
        slab_shift(shift, f->of, ray, c->lens.place[0], c->lens.place[1]);
        const double at[2] = {ray->texel[0] + f->focus * shift[0],
                              ray->texel[1] + f->focus * shift[1]};
        if (add_sample(sum, f->of, c->rgb, at, weight))
            sum[3] += weight;
    }
}

// ---------------------------------------------------------------- frame

static void find_cameras(struct frame *f)
{
    const relume_slab *slab = f->of->slab;
    for (int row = 0; row < slab->rows; row++)
        for (int column = 0; column < slab->columns; column++) {
            const int view = slab->view[(size_t)row * (size_t)slab->columns + (size_t)column];
            if (f->of->needed[view])
                f->camera[f->count++] = (struct camera){
                    f->of->views[view].data,
                    relume_slab_lens(slab, column, row),
                };
        }
}

relume_status slab_frame_lens(const struct slab_frame *f)
{
    const relume_slab *slab = f->slab;
    const struct relume_view_params *p = &f->params;
    struct frame frame = {
        .of = f,
        .radius = 0.5 * p->aperture,
        .focus = relume_slab_plane_disparity(slab, slab->geometry.st_z + p->focus),
    };
    if (!(p->aperture >= 0.0) || !isfinite(p->aperture) || !(frame.focus > -1.0) ||
        !isfinite(frame.focus))
        return RELUME_EINVAL;
    frame.camera = mem_array((size_t)slab->columns * (size_t)slab->rows, sizeof *frame.camera);
    if (!frame.camera)
        return RELUME_ENOMEM;
    find_cameras(&frame);
    slab_draw(f, shade_ray, &frame);
    mem_free(frame.camera);
    return RELUME_OK;
}
