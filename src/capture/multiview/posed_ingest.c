// posed_ingest.c - relume_posed_ingest: photographs from known poses, resampled to a slab
//
// The world of the slab: the st plane through the middle of what the cameras look at, across their
// mean direction, the cameras' middle 3 above it.
#include "capture/multiview/views.h"
#include "core/math/bilinear.h"

#include "core/base/log.h"
#include "core/base/params.h"
#include "core/base/memory.h"
#include "core/base/outdir.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"
#include "core/math/sort.h"
#include "core/math/vec.h"
#include "capture/multiview/views_colmap.h"

#include <stdio.h>
#include <string.h>

enum { MOST_NEIGHBOURS = 8, MOST_WIDTH = 1024 };
static const double height_of_eyes = 3.0;

struct posed {
    struct posed_model model;
    const struct relume_posed_params *p;
    const struct relume_ingest_params *common;
    const char *photos;
    vec3 origin, axis[3];  // of the slab's world, in the model's
    double scale;          // model units to world units
    int columns, rows, width, height;
    struct relume_geometry geometry;
};

// ---------------------------------------------------------------- world

static vec3 camera_axis(const struct posed_camera *c, int k)
{
    return vec3_of(c->rotation[3 * k], c->rotation[3 * k + 1], c->rotation[3 * k + 2]);
}

static relume_status choose_axes(struct posed *s)
{
    vec3 ahead = {0}, down = {0};
    for (int i = 0; i < s->model.count; i++) {
        ahead = vec3_add(ahead, camera_axis(&s->model.camera[i], 2));
        down = vec3_add(down, camera_axis(&s->model.camera[i], 1));
    }
    const vec3 across = vec3_cross(down, ahead);
    if (vec3_length(ahead) < 0.5 * s->model.count || vec3_length(across) < 1e-6)
        return log_fail(s->common->log, RELUME_EUNFIT,
                        "%s: the cameras look in too many directions for one slab; expected them "
                        "to look the same way",
                        s->photos);
    s->axis[2] = vec3_scale(vec3_unit(ahead), -1.0);
    s->axis[0] = vec3_unit(across);
    s->axis[1] = vec3_cross(s->axis[2], s->axis[0]);
    return RELUME_OK;
}

// Median distance of the model's points along the mean direction; 0: none.
static double distance_of_points(const struct posed *s, vec3 middle)
{
    double *away = mem_array(s->model.points, sizeof *away);
    if (!away || !s->model.points) {
        mem_free(away);
        return 0.0;
    }
    for (size_t i = 0; i < s->model.points; i++)
        away[i] = vec3_dot(vec3_sub(middle, s->model.point[i]), s->axis[2]);
    sort_doubles(away, s->model.points);
    const double median = away[s->model.points / 2];
    mem_free(away);
    return median;
}

// Where the optical axes come nearest to each other; 0 where they are parallel.
static double distance_of_axes(const struct posed *s, vec3 middle)
{
    double a[9] = {0.0}, b[3] = {0.0};
    for (int i = 0; i < s->model.count; i++) {
        const vec3 d = camera_axis(&s->model.camera[i], 2);
        const double v[3] = {d.x, d.y, d.z};
        const vec3 o = vec3_sub(s->model.camera[i].place, middle);
        const double c[3] = {o.x, o.y, o.z};
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) {
                const double m = (j == k) - v[j] * v[k];
                a[3 * j + k] += m / s->model.count;
                b[j] += m * c[k] / s->model.count;
            }
    }
    const double det = a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) +
                       a[2] * (a[3] * a[7] - a[4] * a[6]);
    if (det < 1e-6 || !lsq_solve(a, 3, b, 1))
        return 0.0;
    return -vec3_dot(vec3_of(b[0], b[1], b[2]), s->axis[2]);
}

static relume_status choose_world(struct posed *s)
{
    vec3 sum = {0};
    for (int i = 0; i < s->model.count; i++)
        sum = vec3_add(sum, s->model.camera[i].place);
    const vec3 middle = vec3_scale(sum, 1.0 / s->model.count);
    const relume_status status = choose_axes(s);
    if (status)
        return status;
    double distance = s->p->distance;
    if (distance == 0.0)
        distance = distance_of_points(s, middle);
    if (distance <= 0.0)
        distance = distance_of_axes(s, middle);
    if (!(distance > 0.0))
        return log_fail(s->common->log, RELUME_EUNFIT,
                        "%s: the distance of the scene is unknown (no points3D.txt, parallel "
                        "cameras); expected --distance in units of the model",
                        s->photos);
    s->scale = height_of_eyes / distance;
    s->origin = vec3_sub(middle, vec3_scale(s->axis[2], distance));
    return RELUME_OK;
}

static vec3 to_model(const struct posed *s, vec3 p)
{
    vec3 out = s->origin;
    out = vec3_along(out, s->axis[0], p.x / s->scale);
    out = vec3_along(out, s->axis[1], p.y / s->scale);
    return vec3_along(out, s->axis[2], p.z / s->scale);
}

static vec3 to_world(const struct posed *s, vec3 p)
{
    const vec3 d = vec3_scale(vec3_sub(p, s->origin), s->scale);
    return vec3_of(vec3_dot(d, s->axis[0]), vec3_dot(d, s->axis[1]), vec3_dot(d, s->axis[2]));
}

// ---------------------------------------------------------------- window

// Where the middle of a photograph lies on the st plane.
static vec3 looked_at(const struct posed *s, const struct posed_camera *c)
{
    const double x = (0.5 * c->width - c->center[0]) / c->focal[0];
    const double y = (0.5 * c->height - c->center[1]) / c->focal[1];
    vec3 ray = camera_axis(c, 2);
    ray = vec3_along(ray, camera_axis(c, 0), x);
    ray = vec3_along(ray, camera_axis(c, 1), y);
    const vec3 eye = to_world(s, c->place), end = to_world(s, vec3_add(c->place, ray));
    const vec3 d = vec3_sub(end, eye);
    return vec3_along(eye, d, d.z < 0.0 ? -eye.z / d.z : 0.0);
}

// As much as a photograph shows, around the mean of what they look at.
static void choose_window(struct posed *s)
{
    const struct posed_camera *first = &s->model.camera[0];
    const int n = s->model.count;
    double middle[2] = {0.0, 0.0}, half[2] = {0.0, 0.0};
    for (int i = 0; i < n; i++) {
        const struct posed_camera *c = &s->model.camera[i];
        const vec3 at = looked_at(s, c);
        middle[0] += at.x / n;
        middle[1] += at.y / n;
        half[0] += 0.5 * height_of_eyes * c->width / c->focal[0] / n;
        half[1] += 0.5 * height_of_eyes * c->height / c->focal[1] / n;
    }
    s->width = s->p->width ? s->p->width : first->width < MOST_WIDTH ? first->width : MOST_WIDTH;
    s->height = relume_whole(round(s->width * half[1] / half[0]));
    s->height = s->height < 1 ? 1 : s->height;
    s->geometry = relume_geometry_default(RELUME_SLAB, s->width, s->height);
    s->geometry.uv_z = height_of_eyes;
    for (int k = 0; k < 2; k++) {
        s->geometry.st_min[k] = middle[k] - half[k];
        s->geometry.st_max[k] = middle[k] + half[k];
    }
}

static void place_views(const struct posed *s, struct relume_manifest_view *view)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < s->model.count; i++) {
        const vec3 at = to_world(s, s->model.camera[i].place);
        low[0] = fmin(low[0], at.x);
        low[1] = fmin(low[1], at.y);
        high[0] = fmax(high[0], at.x);
        high[1] = fmax(high[1], at.y);
    }
    for (int i = 0; i < s->columns * s->rows; i++) {
        const double a = s->columns > 1 ? (double)(i % s->columns) / (s->columns - 1) : 0.5;
        const double b = s->rows > 1 ? (double)(i / s->columns) / (s->rows - 1) : 0.5;
        view[i].uv[0] = low[0] + a * (high[0] - low[0]);
        view[i].uv[1] = high[1] - b * (high[1] - low[1]);
    }
}

// ---------------------------------------------------------------- one view

// The photographs that stand nearest to an eye, and what they weigh.
struct nearest {
    int count, camera[MOST_NEIGHBOURS + 1];
    double away[MOST_NEIGHBOURS + 1];
};

static struct nearest nearest_to(const struct posed *s, vec3 eye)
{
    struct nearest n = {.count = 0};
    const int wanted = s->p->neighbours ? s->p->neighbours : 4;
    for (int i = 0; i < s->model.count; i++) {
        const double away = vec3_length(vec3_sub(to_world(s, s->model.camera[i].place), eye));
        int at = n.count <= wanted ? n.count++ : wanted + 1;
        for (; at > 0 && n.away[at - 1] > away; at--)
            if (at <= wanted) {
                n.away[at] = n.away[at - 1];
                n.camera[at] = n.camera[at - 1];
            }
        if (at <= wanted) {
            n.away[at] = away;
            n.camera[at] = i;
        }
    }
    return n;
}

// Buehler et al. 2001: falls to zero at the first one that is left out, so that nothing jumps; a
// photograph from the very eye has all the say.
static double weight_of(const struct nearest *n, int k, int wanted)
{
    const double reach = n->count > wanted ? n->away[wanted] : 2.0 * n->away[n->count - 1];
    const double near = 1e-6 * (reach + 1e-9);
    return fmax(1.0 - n->away[k] / (reach + near), 1e-6) / (n->away[k] + near);
}

struct blending {
    const struct posed *s;
    const struct posed_camera *camera;
    const struct relume_image *photo;
    double weight;
    float *sum, *total;
};

// The weight of a photograph falls over the outermost twentieth of it.
static double rim(double at, int size)
{
    return fmin(1.0, fmax(0.0, fmin(at, size - at) / (0.05 * size)) + 1e-3);
}

static void blend_row(void *context, size_t item, int worker)
{
    const struct blending *b = context;
    const struct posed *s = b->s;
    const struct relume_geometry *g = &s->geometry;
    (void)worker;
    const double t =
        g->st_max[1] - ((double)item + 0.5) / s->height * (g->st_max[1] - g->st_min[1]);
    for (int x = 0; x < s->width; x++) {
        const double at = g->st_min[0] + (x + 0.5) / s->width * (g->st_max[0] - g->st_min[0]);
        double xy[2];
        const vec3 d = vec3_sub(to_model(s, vec3_of(at, t, 0.0)), b->camera->place);
        const vec3 p =
            vec3_of(vec3_dot(d, camera_axis(b->camera, 0)), vec3_dot(d, camera_axis(b->camera, 1)),
                    vec3_dot(d, camera_axis(b->camera, 2)));
        if (!posed_project(xy, b->camera, p) || !(xy[0] >= 0.0) || !(xy[1] >= 0.0) ||
            xy[0] > b->photo->width || xy[1] > b->photo->height)
            continue;
        const size_t i = item * (size_t)s->width + (size_t)x;
        const float w =
            (float)(b->weight * rim(xy[0], b->photo->width) * rim(xy[1], b->photo->height));
        const struct bilinear texels =
            bilinear_at(xy[0] - 0.5, xy[1] - 0.5, b->photo->width, b->photo->height, EDGE_CLAMPED);
        for (size_t c = 0; c < 3; c++)
            b->sum[3 * i + c] += w * bilinear_valuef(&texels, b->photo->data, 3, c);
        b->total[i] += w;
    }
}

static relume_status load_photo(struct relume_image *out, const struct posed *s,
                                const struct posed_camera *c)
{
    char *path = mem_format("%s/%s", s->photos, c->name);
    relume_status status =
        path ? relume_image_load(out, path,
                                 relume_image_params(.log = s->common->log,
                                                     .limits = s->common->limits,
                                                     .transfer = s->common->transfer))
             : RELUME_ENOMEM;
    if (!status && (out->width != c->width || out->height != c->height)) {
        status = log_fail(s->common->log, RELUME_EUNFIT,
                          "%s: %d x %d pixels; expected %d x %d as in cameras.txt", path,
                          out->width, out->height, c->width, c->height);
        relume_image_destroy(out);
    }
    mem_free(path);
    return status;
}

// `total` holds one number a pixel.
static relume_status render_view(const struct posed *s, struct relume_image *out, float *total,
                                 const double uv[2])
{
    const size_t n = (size_t)s->width * (size_t)s->height;
    const struct nearest nearest = nearest_to(s, vec3_of(uv[0], uv[1], height_of_eyes));
    const int wanted = s->p->neighbours ? s->p->neighbours : 4;
    relume_status status = RELUME_OK;
    memset(out->data, 0, 3 * n * sizeof *out->data);
    memset(total, 0, n * sizeof *total);
    for (int k = 0; k < nearest.count && k < wanted && !status; k++) {
        struct relume_image photo;
        const struct posed_camera *c = &s->model.camera[nearest.camera[k]];
        status = load_photo(&photo, s, c);
        struct blending b = {s, c, &photo, weight_of(&nearest, k, wanted), out->data, total};
        if (!status)
            thread_for(s->common->threads, (size_t)s->height, blend_row, &b);
        relume_image_destroy(&photo);
    }
    for (size_t i = 0; i < 3 * n; i++)
        out->data[i] = total[i / 3] > 0.0f ? out->data[i] / total[i / 3] : 0.0f;
    return status;
}

// ---------------------------------------------------------------- all

static relume_status render_views(struct posed *s, struct relume_manifest_view *view,
                                  const outdir *dir)
{
    struct relume_image out;
    relume_status status = relume_image_create(&out, s->width, s->height, 3);
    float *total = mem_array((size_t)s->width * (size_t)s->height, sizeof *total);
    if (!total)
        status = RELUME_ENOMEM;
    const int n = s->columns * s->rows;
    for (int i = 0; i < n && !status; i++) {
        view[i].images = arena_array(&s->model.arena, 1, sizeof *view[i].images);
        if (!view[i].images ||
            !(view[i].images[0] = arena_format(&s->model.arena, "view%03d.exr", i)))
            status = RELUME_ENOMEM;
        if (!status)
            status = render_view(s, &out, total, view[i].uv);
        if (!status)
            status = save_inside(dir, view[i].images[0], &out, true, s->common->log);
        if (!status && !log_progress(s->common->log, "resampling", (i + 1.0) / n))
            status = RELUME_ECANCEL;
    }
    mem_free(total);
    relume_image_destroy(&out);
    return status;
}

static relume_status write_slab(struct posed *s, const char *path)
{
    static const struct relume_vec3 front = {0.0, 0.0, 1.0};
    const int n = s->columns * s->rows;
    struct relume_manifest_view *view = arena_array(&s->model.arena, (size_t)n, sizeof *view);
    outdir *dir;
    relume_status status =
        view ? outdir_open(&dir, path, s->common->force, s->common->log) : RELUME_ENOMEM;
    if (status)
        return status;
    place_views(s, view);
    status = render_views(s, view, dir);
    const struct relume_manifest m = {
        .transfer = {.curve = RELUME_CURVE_LINEAR},
        .geometry = s->geometry,
        .lights = 1,
        .directions = s->common->lights ? s->common->lights : &front,
        .views = n,
        .view = view,
    };
    if (!status)
        status = save_manifest(dir, &m, s->common->log);
    return outdir_end(&dir, status);
}

static relume_status check(const struct posed *s)
{
    const struct relume_posed_params *p = s->p;
    if (s->columns < 1 || s->rows < 1 || s->columns > 256 || s->rows > 256 || p->width < 0 ||
        p->width > 65536 || p->neighbours < 0 || p->neighbours > MOST_NEIGHBOURS ||
        !(p->distance >= 0.0) || isinf(p->distance))
        return log_fail(s->common->log, RELUME_EINVAL,
                        "poses: expected a grid of 1 to 256 by 1 to 256, a width up to 65536, 1 to "
                        "8 neighbours and a distance above 0");
    if (s->common->lights && s->common->light_count != 1)
        return log_fail(s->common->log, RELUME_EINVAL,
                        "poses: expected one light for photographs of known poses; found %d",
                        s->common->light_count);
    return RELUME_OK;
}

relume_status relume_posed_ingest(const char *dir, const char *model, const char *photos,
                                  const struct relume_posed_params *posed,
                                  const struct relume_ingest_params *params)
{
    const struct relume_posed_params own = PARAMS(relume_posed_params, posed);
    const struct relume_ingest_params common = PARAMS_WORK(relume_ingest_params, params);
    struct posed s = {.p = &own, .common = &common, .photos = photos};
    s.columns = s.p->grid[0] ? s.p->grid[0] : 5;
    s.rows = s.p->grid[1] ? s.p->grid[1] : s.columns;
    relume_status status = check(&s);
    if (!status)
        status = posed_model_read(&s.model, model, s.common->log);
    if (!status)
        status = choose_world(&s);
    if (!status) {
        choose_window(&s);
        status = write_slab(&s, dir);
    }
    posed_model_free(&s.model);
    return status;
}
