// slab_depth.c - a frame of a light slab with depth: each camera where it sees the ray's surface
//
// Gortler, Grzeszczuk, Szeliski, Cohen 1996 (Lumigraph), 3.4 "depth correction". A ray is given by
// (s, t) and (u, v); its point of disparity q (view.h) appears to the camera at c in
// (s, t) + q ((u, v) - c): a straight walk over that camera's disparities. The four cameras around
// the ray walk together from near to far, a texel a step; the first that finds the disparity it
// walks at has found the surface that the ray hits first. Every texel then counts as far as its
// own disparity says that it shows this surface, so that neither a camera to which the point is
// hidden nor a texel beyond a silhouette has a say.
#include "core/math/bilinear.h"
#include "relight/view/slab.h"
#include "relight/view/view.h"

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
    struct relume_rect part;  // of the view, that is there:
    const float *rgb;         // [height][width][3]
    const float *disparity;   // [height][width]
    double weight;
    double shift[2];  // texels per unit of disparity
    double speed;     // length of shift, as far as it separates one disparity from another
    double pace;      // length of shift
};

// A ray and its cameras.
struct around {
    const struct slab_frame *frame;
    double texel[2];
    int rounds;    // that place the surface between texels
    double slope;  // most by which disparities of one surface differ within a step; 0: a step
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
    const int x = index_clamped(relume_whole(at[0]) - c->part.left, c->part.width);
    const int y = index_clamped(relume_whole(at[1]) - c->part.top, c->part.height);
    return (double)c->disparity[(size_t)y * (size_t)c->part.width + (size_t)x];
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
    const struct bilinear b = bilinear_within(at[0] - 0.5, at[1] - 0.5, c->part.left, c->part.top,
                                              c->part.width, c->part.height, EDGE_CLAMPED);
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

// Where the ray passes through a surface between two steps: from before what the camera sees to
// behind it.
static bool find_crossing(double *q, const struct around *a, const struct camera *c, double found,
                          double step)
{
    const double from = *q + step, before = disparity_at(a, c, from);
    const double ahead = from - before, behind = found - *q;
    if (!(before > (double)RELUME_SLAB_BACKGROUND && ahead > 0.0 && behind > 0.0 &&
          fabs(found - before) <= a->slope))
        return false;
    *q += step * behind / (ahead + behind);
    return true;
}

// Adds the camera's disparity and its weight where it sees what is walked at.
static void add_seen(double sum[2], const struct around *a, const struct camera *c, double q,
                     double step)
{
    double found = disparity_at(a, c, q);
    if (!(c->weight > negligible && found > (double)RELUME_SLAB_BACKGROUND))
        return;
    if (fabs(found - q) > step) {
        if (!(a->slope > 0.0 && find_crossing(&q, a, c, found, step)))
            return;
        found = q;
    }
    sum[0] += c->weight * found;
    sum[1] += c->weight;
}

static int count_steps(const struct around *a, double from, double to)
{
    double pace = 0.0;
    for (int i = 0; i < a->count; i++)
        if (a->camera[i].weight > negligible)
            pace = fmax(pace, a->camera[i].pace);
    return relume_whole(fmin(fmax(ceil(fabs(from - to) * pace), 1.0), most_steps));
}

// The first disparity, on the way from the eye, at which a camera sees what it walks at.
static bool walk(double *q, const struct around *a, double from, double to)
{
    const int steps = count_steps(a, from, to);
    const double step = (from - to) / steps;
    for (int k = 0; k <= steps; k++) {
        double sum[2] = {0.0, 0.0};
        for (int i = 0; i < a->count; i++)
            add_seen(sum, a, &a->camera[i], from - k * step, step);
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

// The surface that the ray hits first.
static bool gather_surface(double sum[5], const struct around *a, double from, double to)
{
    double q;
    if (!walk(&q, a, from, to))
        return false;
    for (int round = 0; round < a->rounds && gather_all(sum, a, q, q); round++)
        q = sum[3] / sum[4];
    return gather_all(sum, a, q, q);
}

// Background is taken where the st plane is; so is what no camera sees as it should be.
static double shade(float rgb[3], const struct around *a, double nearest, double farthest)
{
    double sum[5];
    bool seen = nearest >= farthest && gather_surface(sum, a, nearest, farthest);
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
    *a = (struct around){.frame = f, .texel = {ray->texel[0], ray->texel[1]}, .rounds = 2};
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++) {
            const int view = f->slab->view[(size_t)down.index[j] * (size_t)f->slab->columns +
                                           (size_t)across.index[i]];
            if (!f->needed[view])
                continue;
            struct camera *c = &a->camera[a->count++];
            c->view = view;
            c->part = slab_part(f, view);
            c->rgb = f->views[view].data;
            c->disparity = f->params.disparity[view].data;
            c->weight = across.weight[i] * down.weight[j];
            slab_shift(c->shift, f, ray, f->slab->u[across.index[i]], f->slab->v[down.index[j]]);
            c->speed = c->pace = hypot(c->shift[0], c->shift[1]);
        }
}

double slab_depth_shade(float rgb[3], const struct slab_frame *frame, const struct slab_ray *ray,
                        const double range[2])
{
    struct around a;
    find_cameras(&a, frame, ray);
    return shade(rgb, &a, range[1], range[0]);
}

// ---------------------------------------------------------------- one ray beside the grid

// Cut to the disparities at which a camera has the ray's points in its picture.
static void clip(double part[2], const struct around *a, const struct camera *c)
{
    const int size[2] = {a->frame->width, a->frame->height};
    for (int axis = 0; axis < 2; axis++) {
        const double first = -a->texel[axis] / c->shift[axis];
        const double last = (size[axis] - a->texel[axis]) / c->shift[axis];
        if (!isfinite(first) || !isfinite(last))
            continue;
        part[0] = fmax(part[0], fmin(first, last));
        part[1] = fmin(part[1], fmax(first, last));
    }
}

// A part of a ray, from the eye on; false when no camera has any of it in its picture.
struct stretch {
    double from, to;
};

static bool stretch_of(struct stretch *out, const struct around *a, double least, double most,
                       bool away)
{
    double all[2] = {(double)INFINITY, -(double)INFINITY};
    for (int i = 0; i < a->count; i++) {
        double own[2] = {least, most};
        clip(own, a, &a->camera[i]);
        if (own[0] > own[1])
            continue;
        all[0] = fmin(all[0], own[0]);
        all[1] = fmax(all[1], own[1]);
    }
    *out = (struct stretch){all[away], all[!away]};
    return all[0] <= all[1];
}

// Of the slope: a ray less deep than this behind a surface is treated as one beside it.
static const double shallow = 1.0 / 3.0;

// Whether a camera sees through all of it: nowhere does the ray pass behind what it sees.
static bool is_clear(const struct around *a, const struct camera *c, const struct stretch *s)
{
    const int steps = count_steps(a, s->from, s->to);
    for (int k = 0; k <= steps; k++) {
        const double q = s->from + k * (s->to - s->from) / steps;
        if (disparity_at(a, c, q) > q + shallow * a->slope)
            return false;
    }
    return true;
}

static bool gather_clear(double sum[5], const struct around *a, const struct stretch *s)
{
    bool clear = false;
    for (int i = 0; i < a->count && !clear; i++)
        clear = is_clear(a, &a->camera[i], s);
    return clear && (gather_all(sum, a, 0.0, (double)RELUME_SLAB_BACKGROUND) ||
                     gather_all(sum, a, s->to, (double)RELUME_SLAB_BACKGROUND));
}

// Of a surface that leans up to so many times as much as the cameras stand apart ...
static const double most_slope = 12.0;
// Points so far away are as good as at infinity.
static const double endless = -0.98;

// Seen from far aside a surface of any slope moves by many texels between disparities: what is one
// surface is decided as by cameras as far apart as those of the grid.
static void look_from_aside(struct around *a)
{
    const relume_slab *slab = a->frame->slab;
    const struct slab_ray corner = {.uv = {slab->u[slab->columns - 1], slab->v[slab->rows - 1]}};
    double across[2];
    slab_shift(across, a->frame, &corner, slab->u[0], slab->v[0]);
    const double most = fmax(hypot(across[0], across[1]), 1.0);
    a->slope = most_slope / most;
    for (int i = 0; i < a->count; i++) {
        a->camera[i].speed = fmin(a->camera[i].pace, most);
        if (a->camera[i].pace > most)
            a->rounds = 0;
    }
}

double slab_depth_beside(float rgb[3], const struct slab_frame *frame, const struct slab_ray *ray,
                         const double range[2], bool away)
{
    // The disparity of the eye; of one on or behind the cameras endless.
    const struct relume_geometry *g = &frame->slab->geometry;
    const bool before = (g->uv_z - frame->eye.z) * (g->uv_z - g->st_z) > 0.0;
    const double eye =
        before ? relume_slab_plane_disparity(frame->slab, frame->eye.z) : (double)INFINITY;
    struct around a;
    struct stretch whole, surfaces;
    double sum[5];
    find_cameras(&a, frame, ray);
    look_from_aside(&a);
    const double nearest = away ? fmin(range[1], eye) : range[1];
    const double farthest = away ? range[0] : fmax(range[0], eye);
    const bool found = stretch_of(&surfaces, &a, farthest, nearest, away) &&
                       gather_surface(sum, &a, surfaces.from, surfaces.to);
    if (!found && !(stretch_of(&whole, &a, away ? endless : eye, nearest, away) &&
                    gather_clear(sum, &a, &whole)))
        return 0.0;
    for (int k = 0; k < 3; k++)
        rgb[k] = (float)(sum[k] / sum[4]);
    return sum[4];
}

// ---------------------------------------------------------------- pixels

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

// ---------------------------------------------------------------- frame

static bool usable(const struct slab_frame *f)
{
    struct slab_frame copy = *f;
    return slab_views_fit(&copy, f->params.disparity);
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
    slab_draw(f, shade_ray, &frame);
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
