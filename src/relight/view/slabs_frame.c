// slabs_frame.c - a picture of several slabs: each pixel's ray in every slab that it passes
//
// A slab is a function of rays (Gortler et al. 1996), whichever way a picture stands to its planes:
// what a pixel shows is the mean of the slabs that know its ray, weighted so that none of them ends
// abruptly where another one goes on; through a lens, the mean of that over its pinholes.
#include "relight/view/slabs.h"

#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "image/geometry/geometry.h"
#include "relight/view/slab_set.h"
#include "relight/view/view.h"

#include <string.h>

// A slab with a picture before it, all in the slab's frame.
struct seen {
    struct slab_frame frame;
    vec3 corner, right, down;  // from the eye
    double range[2];           // of disparities, ...
    double extent[2];          // ... also of what lies behind the eye
    bool any;                  // views are needed
    bool beside;               // ... for rays that pass no slab's cameras
};

struct picture {
    const relume_slab_set *slabs;
    struct relume_image *out;
    int pinholes;
    struct seen *seen;  // [pinholes][slabs]
    bool by_depth;
    const struct relume_view_params *params;
    double pixel[2];  // of the window; 0 for a ray
    bool fill;        // also rays that pass no slab's cameras
};

// From how far aside cameras still see something of a ray.
static const double most_aside = 100.0 * M_PI / 180.0;
// Without depth: less than that; from 44 degrees on the st plane is too far from the scene.
static const double least_flat = 1.4;
// Rays are looked at so far apart to learn which cameras those beside all grids need.
enum { SAMPLES = 32 };

bool slabs_ray(double uv[2], double st[2], const relume_slab *slab, vec3 eye, vec3 direction)
{
    const struct relume_geometry *g = &slab->geometry;
    const double way = (g->st_z - eye.z) / direction.z;
    if (!(way > 0.0) || !isfinite(way))
        return false;
    st[0] = eye.x + way * direction.x;
    st[1] = eye.y + way * direction.y;
    return relume_slab_uv(uv, slab, eye, st[0], st[1]);
}

// ---------------------------------------------------------------- which views

static vec3 way_to(const struct seen *s, double x, double y)
{
    return vec3_add(s->corner, vec3_along(vec3_scale(s->right, x), s->down, y));
}

// Where the rays of a window cross the st plane of a slab, as a rectangle. The window's corners
// bound it unless some of them look away from the plane: then it may be anywhere.
static bool find_reach(double min[2], double max[2], const struct seen *s)
{
    const relume_slab *slab = s->frame.slab;
    int hits = 0;
    for (int axis = 0; axis < 2; axis++) {
        min[axis] = (double)INFINITY;
        max[axis] = -(double)INFINITY;
    }
    for (int i = 0; i < 4; i++) {
        double uv[2], st[2];
        const vec3 across = vec3_scale(s->right, i % 2);
        const vec3 down = vec3_scale(s->down, i / 2);
        if (!slabs_ray(uv, st, slab, s->frame.eye, vec3_add(s->corner, vec3_add(across, down))))
            continue;
        hits++;
        for (int axis = 0; axis < 2; axis++) {
            min[axis] = fmin(min[axis], st[axis]);
            max[axis] = fmax(max[axis], st[axis]);
        }
    }
    for (int axis = 0; hits < 4 && axis < 2; axis++) {
        min[axis] = slab->geometry.st_min[axis];
        max[axis] = slab->geometry.st_max[axis];
    }
    for (int axis = 0; axis < 2; axis++)
        if (!(min[axis] <= slab->geometry.st_max[axis] && max[axis] >= slab->geometry.st_min[axis]))
            return false;
    return hits > 0;
}

static struct seen see(const relume_slab *slab, const struct relume_window *window)
{
    const struct relume_pose *pose = &slab->geometry.pose;
    struct seen s = {
        .frame = {.slab = slab, .eye = relume_pose_local(pose, window->eye)},
        .corner = relume_pose_turn_back(pose, vec3_sub(window->corner, window->eye)),
        .right = relume_pose_turn_back(pose, window->right),
        .down = relume_pose_turn_back(pose, window->down),
    };
    s.any = slab_reach(&s.frame.reach, slab, s.frame.eye);
    return s;
}

static int mark(bool *needed, struct seen *s, const struct relume_view_params *params)
{
    const struct relume_view_params pinhole = {.interpolation = params->interpolation};
    double min[2], max[2];
    const int n = s->any && find_reach(min, max, s)
                      ? slab_mark(needed, s->frame.slab, s->frame.eye, min, max, &pinhole)
                      : 0;
    s->any = n > 0;
    return n;
}

// What a slab has to say of a ray beside its grid: endless at its border, nothing from far aside.
static double beside_weight(struct slab_ray *ray, const struct seen *s, vec3 way)
{
    const double aside = slab_ray_beside(ray, &s->frame, way);
    return aside < most_aside ? 1.0 / fmax(aside * aside, 1e-12) - 1.0 / (most_aside * most_aside)
                              : 0.0;
}

static bool passes(const struct seen *s, double x, double y)
{
    double uv[2], st[2], weight[4];
    int view[4];
    return slabs_ray(uv, st, s->frame.slab, s->frame.eye, way_to(s, x, y)) &&
           relume_slab_blend(view, weight, s->frame.slab, uv, NULL) > 0;
}

static bool passes_any(const struct seen *seen, int slabs, double x, double y)
{
    bool any = false;
    for (int i = 0; i < slabs && !any; i++)
        any = passes(&seen[i], x, y);
    return any;
}

// The cameras nearest to a ray that passes those of no slab.
static int mark_beside(bool *needed, struct seen *seen, int slabs, double x, double y)
{
    int n = 0;
    if (passes_any(seen, slabs, x, y))
        return 0;
    for (int i = 0; i < slabs; i++) {
        struct slab_ray ray;
        double weight[4];
        int view[4];
        if (!(beside_weight(&ray, &seen[i], way_to(&seen[i], x, y)) > 0.0))
            continue;
        const int around = relume_slab_blend(view, weight, seen[i].frame.slab, ray.at, NULL);
        for (int k = 0; k < around; k++)
            needed[view[k]] = true;
        seen[i].beside = true;
        n += around;
    }
    return n;
}

static double sample_place(int i)
{
    return (i + 0.5) / SAMPLES;
}

// Of all slabs from one pinhole; returns how many.
static int mark_all(bool *needed, struct seen *seen, int slabs,
                    const struct relume_view_params *params, bool fill)
{
    int n = 0;
    for (int i = 0; i < slabs; i++)
        n += mark(needed, &seen[i], params);
    for (int k = 0; fill && k < SAMPLES * SAMPLES; k++)
        n += mark_beside(needed, seen, slabs, sample_place(k % SAMPLES), sample_place(k / SAMPLES));
    return n;
}

static struct relume_window pinhole_of(const struct relume_window *window,
                                       const struct relume_view_params *params, int i, int n)
{
    return slab_is_lens(params) ? relume_lens_window(window, params->aperture, params->focus, i, n)
                                : *window;
}

// 0 when the lens does not fit.
static int count_pinholes(const struct relume_window *window, int width,
                          const struct relume_view_params *params)
{
    if (!slab_is_lens(params))
        return 1;
    return relume_lens_fits(window, params->aperture, params->focus)
               ? relume_lens_points(window, params->aperture, params->focus, width)
               : 0;
}

// A single ray that no slab knows stays unknown.
static bool has_extent(const struct relume_window *w)
{
    return vec3_length(w->right) > 0.0 || vec3_length(w->down) > 0.0;
}

bool relume_slab_set_passes(const relume_slab_set *slabs, const struct relume_window *window,
                            double x, double y)
{
    bool any = false;
    for (int i = 0; i < slabs->count && !any; i++) {
        const struct seen s = see(slabs->slab[i], window);
        any = passes(&s, x, y);
    }
    return any;
}

int relume_slab_set_needs(bool *needed, const relume_slab_set *slabs,
                          const struct relume_window *window, int width,
                          const struct relume_view_params *params)
{
    const struct relume_view_params p = PARAMS(relume_view_params, params);
    const int pinholes = count_pinholes(window, width, &p);
    int n = 0;
    memset(needed, 0, (size_t)slabs->views * sizeof *needed);
    for (int k = 0; k < pinholes; k++) {
        const struct relume_window from = pinhole_of(window, &p, k, pinholes);
        struct seen seen[RELUME_MOST_SLABS];
        for (int i = 0; i < slabs->count; i++)
            seen[i] = see(slabs->slab[i], &from);
        mark_all(needed, seen, slabs->count, &p, has_extent(window));
    }
    for (int i = 0; i < slabs->views; i++)
        n += needed[i];
    return n;
}

// ---------------------------------------------------------------- one pixel

// Adds what a slab says of a ray, times its weight: r, g, b, weight. False without weight.
typedef bool (*ray_adder)(double sum[4], const struct picture *p, const struct seen *s, double x,
                          double y);

static bool add_passing(double sum[4], const struct picture *p, const struct seen *s, double x,
                        double y)
{
    double uv[2], st[2];
    if (!slabs_ray(uv, st, s->frame.slab, s->frame.eye, way_to(s, x, y)))
        return false;
    double weight = relume_slab_weight(s->frame.slab, uv, st);
    if (!(weight > 0.0))
        return false;
    const struct slab_ray ray = slab_ray_at(&s->frame, st);
    float rgb[3];
    if (p->by_depth)
        weight *= slab_depth_shade(rgb, &s->frame, &ray, s->range);
    else
        slab_flat_shade(rgb, &s->frame, &ray);
    for (int c = 0; c < 3; c++)
        sum[c] += weight * (double)rgb[c];
    sum[3] += weight;
    return true;
}

static bool leads_away(const struct seen *s, vec3 way)
{
    const struct relume_geometry *g = &s->frame.slab->geometry;
    return way.z * (g->uv_z - g->st_z) < 0.0;
}

// Whether the ray goes through the st window.
static bool in_window(const struct seen *s, const struct slab_ray *ray)
{
    double reach;
    return slab_reach(&reach, s->frame.slab, s->frame.eye) && ray->texel[0] >= 0.0 &&
           ray->texel[0] <= s->frame.width && ray->texel[1] >= 0.0 &&
           ray->texel[1] <= s->frame.height;
}

// The same of a ray that passes the cameras of no slab, as those nearest to it see it.
static bool add_beside(double sum[4], const struct picture *p, const struct seen *s, double x,
                       double y)
{
    struct slab_ray ray;
    const vec3 way = way_to(s, x, y);
    double weight = beside_weight(&ray, s, way);
    float rgb[3] = {0.0f, 0.0f, 0.0f};
    if (!(weight > 0.0))
        return false;
    if (p->by_depth)
        weight *= slab_depth_beside(rgb, &s->frame, &ray, s->extent, leads_away(s, way));
    else if (leads_away(s, way) && in_window(s, &ray) && weight > least_flat)
        slab_flat_shade(rgb, &s->frame, &ray);
    else
        return false;
    for (int c = 0; c < 3; c++)
        sum[c] += weight * (double)rgb[c];
    sum[3] += weight;
    return weight > 0.0;
}

// Texels of a slab's view between the places of two rays.
static double texels_between(const struct seen *s, vec3 a, vec3 b)
{
    const struct relume_geometry *g = &s->frame.slab->geometry;
    double uv[2], from[2], to[2];
    if (!slabs_ray(uv, from, s->frame.slab, s->frame.eye, a) ||
        !slabs_ray(uv, to, s->frame.slab, s->frame.eye, b))
        return 0.0;
    return hypot((to[0] - from[0]) / (g->st_max[0] - g->st_min[0]) * s->frame.width,
                 (to[1] - from[1]) / (g->st_max[1] - g->st_min[1]) * s->frame.height);
}

// Texels as large as a pixel of the window: from far aside the places of its rays on the st plane
// are as far apart as one likes.
static double texels_as_large(const struct seen *s, vec3 pixel)
{
    const struct relume_geometry *g = &s->frame.slab->geometry;
    return vec3_length(pixel) / (g->st_max[0] - g->st_min[0]) * s->frame.width;
}

// Of a ray that passes the slab's cameras, or one beside them, what it covers to both sides.
static void find_footprint(struct footprint side[2], const struct picture *p, const struct seen *s,
                           double x, double y, bool beside)
{
    const double dx = p->pixel[0], dy = p->pixel[1];
    const vec3 way = way_to(s, x, y);
    side[0] = slab_footprint(p->params, beside ? texels_as_large(s, vec3_scale(s->right, dx))
                                               : texels_between(s, way, way_to(s, x + dx, y)));
    side[1] = slab_footprint(p->params, beside ? texels_as_large(s, vec3_scale(s->down, dy))
                                               : texels_between(s, way, way_to(s, x, y + dy)));
}

// The mean over what a pixel at (x, y) covers, where the slab knows its middle.
static void add(double sum[4], const struct picture *p, const struct seen *s, double x, double y,
                bool beside)
{
    const double dx = p->pixel[0], dy = p->pixel[1];
    const ray_adder add_ray = beside ? add_beside : add_passing;
    struct footprint side[2];
    find_footprint(side, p, s, x, y, beside);
    const struct footprint across = side[0], down = side[1];
    const int n = across.count * down.count;
    double own[4] = {0.0, 0.0, 0.0, 0.0};
    if (n == 1) {
        add_ray(sum, p, s, x, y);
        return;
    }
    if (!add_ray(own, p, s, x, y))
        return;
    memset(own, 0, sizeof own);
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++)
            add_ray(own, p, s, x + footprint_place(across, i) * dx,
                    y + footprint_place(down, j) * dy);
    for (int c = 0; c < 4; c++)
        sum[c] += own[c] / n;
}

// At (x, y) of the window. False, and `nothing`, where no slab has weight.
static bool shade(float rgb[3], const struct picture *p, double x, double y)
{
    double mean[3] = {0.0, 0.0, 0.0};
    int n = 0;
    for (int k = 0; k < p->pinholes; k++) {
        double sum[4] = {0.0, 0.0, 0.0, 0.0};
        const struct seen *seen = &p->seen[k * p->slabs->count];
        for (int i = 0; i < p->slabs->count; i++)
            if (seen[i].any)
                add(sum, p, &seen[i], x, y, false);
        const bool empty = p->fill && !(sum[3] > 0.0) && !passes_any(seen, p->slabs->count, x, y);
        for (int i = 0; empty && i < p->slabs->count; i++)
            if (seen[i].beside)
                add(sum, p, &seen[i], x, y, true);
        for (int c = 0; c < 3 && sum[3] > 0.0; c++)
            mean[c] += sum[c] / sum[3];
        n += sum[3] > 0.0;
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = n ? (float)(mean[c] / n) : p->params->nothing;
    return n > 0;
}

static void draw_row(void *context, size_t row, int worker)
{
    const struct picture *p = context;
    (void)worker;
    float *rgb = p->out->data + 3 * row * (size_t)p->out->width;
    for (int x = 0; x < p->out->width; x++, rgb += 3)
        shade(rgb, p, (x + 0.5) / p->out->width, ((double)row + 0.5) / p->out->height);
}

// ---------------------------------------------------------------- picture

struct job {
    struct picture picture;
    struct relume_view_params params;
    bool *needed;
};

// What slab `i` needs from every pinhole to be drawn; the views' disparities are looked through
// once.
static void prepare_slab(struct job *job, int i, const struct slab_frame *common)
{
    const struct picture *p = &job->picture;
    double range[2];
    bool known = false;
    for (int k = 0; k < p->pinholes; k++) {
        struct seen *s = &p->seen[k * p->slabs->count + i];
        const struct slab_frame own = s->frame;
        s->frame = *common;
        s->frame.slab = own.slab;
        s->frame.eye = own.eye;
        s->frame.reach = own.reach;
        if (!p->by_depth || !(s->any || s->beside))
            continue;
        if (!known)
            slab_depth_extent(range, &s->frame);
        known = true;
        s->range[0] = range[0];
        s->range[1] = fmin(range[1], relume_slab_eye_disparity(own.slab, own.eye));
        s->extent[0] = range[0];
        s->extent[1] = range[1];
    }
}

// RELUME_EINVAL when the window sees nothing or something needed is missing.
static relume_status prepare(struct job *job, const struct relume_window *window,
                             const struct relume_image *views)
{
    struct picture *p = &job->picture;
    const int slabs = p->slabs->count;
    struct slab_frame common = {.views = views, .params = job->params, .needed = job->needed};
    int n = 0;
    for (int k = 0; k < p->pinholes; k++) {
        const struct relume_window from = pinhole_of(window, &job->params, k, p->pinholes);
        for (int i = 0; i < slabs; i++)
            p->seen[k * slabs + i] = see(p->slabs->slab[i], &from);
        n += mark_all(job->needed, &p->seen[k * slabs], slabs, &job->params, p->fill);
    }
    common.slab = p->slabs->slab[0];
    if (n == 0 || job->params.part ||
        !slab_views_fit(&common, p->by_depth ? job->params.disparity : NULL))
        return RELUME_EINVAL;
    for (int i = 0; i < slabs; i++)
        prepare_slab(job, i, &common);
    return RELUME_OK;
}

static relume_status begin(struct job *job, const relume_slab_set *slabs,
                           const struct relume_window *window, int width,
                           const struct relume_image *views,
                           const struct relume_view_params *params)
{
    *job = (struct job){.picture = {.slabs = slabs, .params = &job->params}};
    if (params)
        job->params = *params;
    struct picture *p = &job->picture;
    p->by_depth =
        job->params.disparity && (job->params.interpolation == RELUME_INTERPOLATE_DEFAULT ||
                                  job->params.interpolation == RELUME_INTERPOLATE_DEPTH);
    p->fill = has_extent(window);
    p->pinholes = count_pinholes(window, width, &job->params);
    if (p->pinholes == 0 ||
        (job->params.interpolation == RELUME_INTERPOLATE_DEPTH && !job->params.disparity))
        return RELUME_EINVAL;
    job->needed = mem_zeroed((size_t)slabs->views, sizeof *job->needed);
    p->seen = mem_array((size_t)p->pinholes * (size_t)slabs->count, sizeof *p->seen);
    if (!job->needed || !p->seen)
        return RELUME_ENOMEM;
    return prepare(job, window, views);
}

static void end(struct job *job)
{
    mem_free(job->needed);
    mem_free(job->picture.seen);
}

relume_status relume_slab_set_frame(struct relume_image *out, const relume_slab_set *slabs,
                                    const struct relume_window *window,
                                    const struct relume_image *views,
                                    const struct relume_view_params *params)
{
    struct job job;
    if (!out->data || out->channels != 3)
        return RELUME_EINVAL;
    const relume_status status = begin(&job, slabs, window, out->width, views, params);
    job.picture.out = out;
    job.picture.pixel[0] = 1.0 / out->width;
    job.picture.pixel[1] = 1.0 / out->height;
    if (!status)
        thread_for(job.params.threads, (size_t)out->height, draw_row, &job.picture);
    end(&job);
    return status;
}

relume_status relume_slab_set_value(float rgb[3], const relume_slab_set *slabs, vec3 eye,
                                    vec3 direction, const struct relume_image *views,
                                    const struct relume_view_params *params)
{
    struct job job;
    const struct relume_window window = {.eye = eye, .corner = vec3_add(eye, direction)};
    if (slab_is_lens(params))
        return RELUME_EINVAL;
    relume_status status = begin(&job, slabs, &window, 1, views, params);
    if (!status && !shade(rgb, &job.picture, 0.0, 0.0))
        status = RELUME_EINVAL;
    end(&job);
    return status;
}

// As far as one slab knows it: the weight of its nearest camera.
static double nearest_in(int *view, double place[2], const relume_slab *slab, vec3 eye,
                         vec3 direction)
{
    const struct relume_geometry *g = &slab->geometry;
    const vec3 way = relume_pose_turn_back(&g->pose, direction);
    double uv[2], st[2], weights[4];
    int views[4], best = 0;
    if (!slabs_ray(uv, st, slab, relume_pose_local(&g->pose, eye), way))
        return 0.0;
    const int n = relume_slab_blend(views, weights, slab, uv, NULL);
    for (int i = 1; i < n; i++)
        best = weights[i] > weights[best] ? i : best;
    if (n == 0)
        return 0.0;
    *view = views[best];
    place[0] = (st[0] - g->st_min[0]) / (g->st_max[0] - g->st_min[0]);
    place[1] = (g->st_max[1] - st[1]) / (g->st_max[1] - g->st_min[1]);
    return weights[best] * relume_slab_weight(slab, uv, st);
}

bool relume_slab_set_nearest(int *view, double place[2], const relume_slab_set *slabs, vec3 eye,
                             vec3 direction)
{
    double most = 0.0;
    for (int i = 0; i < slabs->count; i++) {
        double found[2] = {0.0, 0.0};
        int which = 0;
        const double weight = nearest_in(&which, found, slabs->slab[i], eye, direction);
        if (!(weight > most))
            continue;
        most = weight;
        *view = which;
        place[0] = found[0];
        place[1] = found[1];
    }
    return most > 0.0;
}
