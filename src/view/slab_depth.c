// slab_depth.c - a frame of a light slab with depth: each camera where it sees the ray's surface
//
// Gortler, Grzeszczuk, Szeliski, Cohen 1996 (Lumigraph), 3.4 "depth correction". A ray is given by
// (s, t) and (u, v); its point of disparity q (view.h) appears to the camera at c in
// (s, t) + q ((u, v) - c): a straight walk over that camera's disparities. The four cameras around
// the ray walk together from near to far, a texel a step; the first that meets the disparity it
// walks at has found the surface that the ray meets first. Every texel then counts as far as its
// own disparity says that it shows this surface, so that neither a camera to which the point is
// hidden nor a texel beyond a silhouette has a say.
#include "math/bilinear.h"
#include "view/slab.h"

#include "base/thread.h"

#include <math.h>
#include <string.h>

// Steps of a walk at most: a texel each up to that many.
static const int most_steps = 256;
// Cameras of less weight have no say in where the surface is, so that what is said does not hang on
// the last bit of a weight.
static const double negligible = 1e-4;
// What a ray says, compared with one whose surface has been found.
static const double guessed = 1e-3;

// One of the cameras around a ray.
struct camera {
    int view;
    const float *rgb;        // [height][width][3]
    const float *disparity;  // [height][width]
    double weight;
    double shift[2];  // texels per unit of disparity
    double speed;     // length of shift
};

// A ray and its cameras.
struct around {
    const struct slab_frame *frame;
    double texel[2];
    int count;
    struct camera camera[4];
};

struct frame {
    const struct slab_frame *of;
    double range[2];  // of all disparities but the background's
};

// ---------------------------------------------------------------- one camera

static void place_at(double at[2], const struct around *a, const struct camera *c, double q)
{
    for (int axis = 0; axis < 2; axis++)
        at[axis] = a->texel[axis] + q * c->shift[axis];
}

static bool within(const struct around *a, const double at[2])
{
    return at[0] >= 0.0 && at[0] <= a->frame->width && at[1] >= 0.0 && at[1] <= a->frame->height;
}

// What the camera sees nearest to where it would see the ray's point of disparity `q`.
static double disparity_at(const struct around *a, const struct camera *c, double q)
{
    double at[2];
    place_at(at, a, c, q);
    if (!within(a, at))
        return (double)RELUME_SLAB_BACKGROUND;
    const int width = a->frame->width, height = a->frame->height;
    const int x = index_clamped(relume_whole(at[0]), width);
    const int y = index_clamped(relume_whole(at[1]), height);
    return (double)c->disparity[(size_t)y * (size_t)width + (size_t)x];
}

// 1 while taking one disparity for the other is wrong by a texel, 0 from two texels on.
static double agreement(double speed, double q, double other)
{
    return fmin(fmax(2.0 - fabs(q - other) * speed, 0.0), 1.0);
}

// What the camera sees where it would see the ray's point of disparity `q`: bilinear over the
// texels that agree with `surface`. Sums of r, g, b, disparity and weight.
static void gather(double sum[5], const struct around *a, const struct camera *c, double q,
                   double surface)
{
    double at[2];
    place_at(at, a, c, q);
    if (!within(a, at))
        return;
    slab_need(a->frame, c->view, relume_whole(floor(at[0] - 0.5)),
              relume_whole(floor(at[1] - 0.5)));
    const struct bilinear b =
        bilinear_at(at[0] - 0.5, at[1] - 0.5, a->frame->width, a->frame->height, EDGE_CLAMPED);
    for (int k = 0; k < 4; k++) {
        const double found = (double)c->disparity[b.at[k]];
        const double w = bilinear_share(&b, k, c->weight) * agreement(c->speed, surface, found);
        for (size_t i = 0; i < 3; i++)
            sum[i] += w * (double)c->rgb[3 * b.at[k] + i];
        sum[3] += w * found;
        sum[4] += w;
    }
}

// ---------------------------------------------------------------- one ray

// Adds the camera's disparity and its weight where it sees what is walked at.
static void meet(double sum[2], const struct around *a, const struct camera *c, double q,
                 double step)
{
    const double found = disparity_at(a, c, q);
    if (c->weight > negligible && found > (double)RELUME_SLAB_BACKGROUND &&
        fabs(found - q) <= step) {
        sum[0] += c->weight * found;
        sum[1] += c->weight;
    }
}

static double walking_speed(const struct camera *c)
{
    return c->weight > negligible ? c->speed : 0.0;
}

// The first disparity, from near to far, at which a camera sees what it walks at.
static bool walk(double *q, const struct around *a, double nearest, double farthest)
{
    double speed = 0.0;
    if (!(nearest >= farthest))
        return false;
    for (int i = 0; i < a->count; i++)
        speed = fmax(speed, walking_speed(&a->camera[i]));
    const int steps = relume_whole(fmin(fmax(ceil((nearest - farthest) * speed), 1.0), most_steps));
    const double step = (nearest - farthest) / steps;
    for (int k = 0; k <= steps; k++) {
        double sum[2] = {0.0, 0.0};
        for (int i = 0; i < a->count; i++)
            meet(sum, a, &a->camera[i], nearest - k * step, step);
        if (sum[1] > 0.0) {
            *q = sum[0] / sum[1];
            return true;
        }
    }
    return false;
}

static bool gather_all(double sum[5], const struct around *a, double q, double surface)
{
    for (int k = 0; k < 5; k++)
        sum[k] = 0.0;
    for (int i = 0; i < a->count; i++)
        gather(sum, a, &a->camera[i], q, surface);
    return sum[4] > 1e-6;
}

// Background is taken where the st plane is; so is what no camera sees as it should be.
static double shade(float rgb[3], const struct around *a, double nearest, double farthest)
{
    double q, sum[5];
    bool seen = false;
    if (walk(&q, a, nearest, farthest)) {
        for (int round = 0; round < 2 && gather_all(sum, a, q, q); round++)
            q = sum[3] / sum[4];
        seen = gather_all(sum, a, q, q);
    }
    if (!seen)
        seen = gather_all(sum, a, 0.0, (double)RELUME_SLAB_BACKGROUND);
    if (!seen) {
        struct around flat = *a;
        for (int i = 0; i < a->count; i++)
            flat.camera[i].speed = 0.0;
        gather_all(sum, &flat, 0.0, 0.0);
    }
    for (int k = 0; k < 3; k++)
        rgb[k] = sum[4] > 0.0 ? (float)(sum[k] / sum[4]) : 0.0f;
    return seen ? sum[4] : guessed * sum[4];
}

static void find_cameras(struct around *a, const struct slab_frame *f, const struct slab_ray *ray)
{
    const struct neighbours across = slab_columns_at(f->slab, false, ray->at[0]);
    const struct neighbours down = slab_rows_at(f->slab, false, ray->at[1]);
    *a = (struct around){.frame = f, .texel = {ray->texel[0], ray->texel[1]}};
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++) {
            struct camera *c = &a->camera[a->count++];
            const int view = f->slab->view[(size_t)down.index[j] * (size_t)f->slab->columns +
                                           (size_t)across.index[i]];
            c->view = view;
            c->rgb = f->views[view].data;
            c->disparity = f->params.disparity[view].data;
            c->weight = across.weight[i] * down.weight[j];
            slab_shift(c->shift, f, ray, f->slab->u[across.index[i]], f->slab->v[down.index[j]]);
            c->speed = hypot(c->shift[0], c->shift[1]);
        }
}

double slab_depth_shade(float rgb[3], const struct slab_frame *frame, const struct slab_ray *ray,
                        const double range[2])
{
    struct around a;
    find_cameras(&a, frame, ray);
    return shade(rgb, &a, range[1], range[0]);
}

static void shade_ray(double sum[4], const void *context, const struct slab_ray *ray)
{
    const struct frame *f = context;
    float rgb[3];
    if (!(slab_depth_shade(rgb, f->of, ray, f->range) > 0.0))
        rgb[0] = rgb[1] = rgb[2] = f->of->params.nothing;
    for (int k = 0; k < 3; k++)
        sum[k] += (double)rgb[k];
    sum[3] += 1.0;
}

static void draw_row(void *context, size_t row, int worker)
{
    const struct frame *f = context;
    const struct relume_image *out = f->of->out;
    (void)worker;
    float *rgb = out->data + 3 * row * (size_t)out->width;
    for (int x = 0; x < out->width; x++, rgb += 3)
        slab_pixel(rgb, f->of, x, (int)row, shade_ray, f);
}

// ---------------------------------------------------------------- frame

static bool usable(const struct slab_frame *f)
{
    int width = f->width, height = f->height;
    return slab_views_fit(&width, &height, f->needed, f->views, f->params.disparity,
                          f->slab->views);
}

void slab_depth_extent(double range[2], const struct slab_frame *f)
{
    range[0] = (double)INFINITY;
    range[1] = -(double)INFINITY;
    for (int i = 0; i < f->slab->columns * f->slab->rows; i++) {
        const int view = f->slab->view[i];
        double one[2];
        if (!f->needed[view])
            continue;
        if (f->params.range)
            memcpy(one, f->params.range[view], sizeof one);
        else if (!relume_slab_range(one, &f->params.disparity[view]))
            continue;
        range[0] = fmin(range[0], one[0]);
        range[1] = fmax(range[1], one[1]);
    }
}

void slab_depth_range(double range[2], const struct slab_frame *f)
{
    slab_depth_extent(range, f);
    range[1] = fmin(range[1], relume_slab_eye_disparity(f->slab, f->eye));
}

relume_status slab_frame_depth(const struct slab_frame *f)
{
    struct frame frame = {.of = f};
    if (!usable(f))
        return RELUME_EINVAL;
    slab_depth_range(frame.range, f);
    thread_for(f->params.threads, (size_t)f->out->height, draw_row, &frame);
    return RELUME_OK;
}

relume_status slab_value_depth(float rgb[3], const struct slab_frame *f, const double st[2])
{
    double range[2];
    if (!usable(f))
        return RELUME_EINVAL;
    slab_depth_range(range, f);
    const struct slab_ray ray = slab_ray_at(f, st);
    slab_depth_shade(rgb, f, &ray, range);
    return RELUME_OK;
}
