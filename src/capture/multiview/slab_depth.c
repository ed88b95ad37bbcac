// slab_depth.c - relume_slab_depth: a slab gets depth images
#include "capture/multiview/slab_depth.h"

#include "core/base/log.h"
#include "core/base/params.h"
#include "core/base/memory.h"
#include "core/base/outdir.h"
#include "core/base/scratch.h"
#include "capture/multiview/views.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BINS = 100000 };  // of relative error, up to 1

// ---------------------------------------------------------------- depth of a view

// Distance along the ray of a pixel: a point of disparity q lies at 1 / (1 + q) of the way from the
// camera to the st plane.
static double way_to_plane(const struct slab_depth *d, int view, int x, int y)
{
    const struct relume_geometry *g = &d->m->geometry;
    const double *uv = d->m->view[view].uv;
    const int width = relume_capture_width(d->capture), height = relume_capture_height(d->capture);
    const double s = g->st_min[0] + (x + 0.5) / width * (g->st_max[0] - g->st_min[0]);
    const double t = g->st_max[1] - (y + 0.5) / height * (g->st_max[1] - g->st_min[1]);
    return hypot(hypot(s - uv[0], t - uv[1]), g->uv_z - g->st_z);
}

static size_t texel_at(const struct slab_depth *d, int x, int y)
{
    int i = x / d->factor, j = y / d->factor;
    i = i < d->sweep.width ? i : d->sweep.width - 1;
    j = j < d->sweep.height ? j : d->sweep.height - 1;
    return (size_t)j * (size_t)d->sweep.width + (size_t)i;
}

// `mask` may be empty.
static void fill_depth(struct relume_image *depth, const struct slab_depth *d, int view,
                       const float *plane, const struct relume_image *mask)
{
    for (int y = 0; y < depth->height; y++)
        for (int x = 0; x < depth->width; x++) {
            const size_t i = (size_t)y * (size_t)depth->width + (size_t)x;
            const double q = d->first + (double)plane[texel_at(d, x, y)] * d->step;
            depth->data[i] = mask->data && mask->data[i] < 0.5f
                                 ? INFINITY
                                 : (float)(way_to_plane(d, view, x, y) / (1.0 + q));
        }
}

static void compare(struct slab_depth *d, int view, const struct relume_image *depth,
                    const struct relume_image *truth)
{
    const size_t n = (size_t)depth->width * (size_t)depth->height;
    for (size_t i = 0; i < n; i++) {
        const double is = (double)depth->data[i], should = (double)truth->data[i];
        if (!isfinite(should) || !isfinite(is) || should <= 0.0)
            continue;
        const double whole =
            way_to_plane(d, view, (int)(i % (size_t)depth->width), (int)(i / (size_t)depth->width));
        const double bin = fabs(is - should) / should * BINS;
        d->bins[bin < BINS - 1 ? (size_t)bin : BINS - 1]++;
        d->bad += fabs(whole / is - whole / should) > d->step;
        d->compared++;
    }
}

static double median_of(const struct slab_depth *d)
{
    size_t seen = 0;
    int bin = 0;
    for (; bin < BINS - 1 && (seen += d->bins[bin]) * 2 < d->compared; bin++)
        ;
    return d->compared ? (bin + 0.5) / BINS : 0.0;
}

// ---------------------------------------------------------------- files

static relume_status save_depth(struct slab_depth *d, int view, const float *plane,
                                const outdir *dir, const char *name)
{
    struct relume_image depth = {0}, mask = {0}, truth = {0};
    relume_status status = relume_image_create(&depth, relume_capture_width(d->capture),
                                               relume_capture_height(d->capture), 1);
    if (!status)
        status = relume_capture_mask(&mask, d->capture, view, d->p.log);
    if (!status)
        status = relume_capture_depth(&truth, d->capture, view, d->p.log);
    if (!status) {
        fill_depth(&depth, d, view, plane, &mask);
        if (truth.data)
            compare(d, view, &depth, &truth);
        status = save_inside(dir, name, &depth, false, d->p.log);
    }
    relume_image_destroy(&depth);
    relume_image_destroy(&mask);
    relume_image_destroy(&truth);
    return status;
}

static relume_status save_confidence(struct slab_depth *d, const float *confidence, int view,
                                     const outdir *dir)
{
    struct relume_image image;
    relume_status status = relume_image_create(&image, relume_capture_width(d->capture),
                                               relume_capture_height(d->capture), 1);
    if (status)
        return status;
    double sum = 0.0;
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            const float c = confidence[texel_at(d, x, y)];
            image.data[(size_t)y * (size_t)image.width + (size_t)x] = c;
            sum += c >= 0.5f;
        }
    d->trusted += sum / ((double)image.width * image.height * d->m->views);
    char name[48];
    snprintf(name, sizeof name, "view%03d_confidence.exr", view);
    status = save_inside(dir, name, &image, true, d->p.log);
    relume_image_destroy(&image);
    return status;
}

static relume_status save_views(struct slab_depth *d, const outdir *dir)
{
    const size_t n = (size_t)d->sweep.width * (size_t)d->sweep.height;
    float *plane = mem_array(2 * n, sizeof *plane);
    relume_status status = plane ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; i < d->m->views && !status; i++) {
        char name[48];
        snprintf(name, sizeof name, "view%03d_depth.exr", i);
        slab_depth_confirm(plane, plane + n, d, i);
        status = save_depth(d, i, plane, dir, name);
        if (!status)
            status = save_confidence(d, plane + n, i, dir);
        if (!status && !log_progress(d->p.log, "confirming", (i + 1.0) / d->m->views))
            status = RELUME_ECANCEL;
    }
    mem_free(plane);
    return status;
}

// The capture as it was, named from its new place.
static relume_status write_manifest(const struct slab_depth *d, const char *path, const outdir *dir)
{
    struct arena arena = {NULL};
    struct relume_manifest m = *d->m;
    struct relume_manifest_view *view = arena_array(&arena, (size_t)m.views, sizeof *view);
    bool whole = view != NULL;
    for (int i = 0; whole && i < m.views; i++) {
        const struct relume_manifest_view *from = &d->m->view[i];
        view[i] = *from;
        view[i].depth = arena_format(&arena, "view%03d_depth.exr", i);
        view[i].mask = from->mask ? path_from(&arena, dir, path, from->mask) : NULL;
        view[i].images = arena_array(&arena, (size_t)m.lights, sizeof *view[i].images);
        whole = view[i].depth && view[i].images && (!from->mask || view[i].mask);
        for (int k = 0; whole && k < m.lights; k++)
            whole = (view[i].images[k] = path_from(&arena, dir, path, from->images[k])) != NULL;
    }
    m.view = view;
    const relume_status status = whole ? save_manifest(dir, &m, d->p.log) : RELUME_ENOMEM;
    arena_free(&arena);
    return status;
}

// ---------------------------------------------------------------- all

static relume_status check(const struct slab_depth *d)
{
    const double *range = d->p.range;
    if (d->m->geometry.projection != RELUME_SLAB || d->m->views < 2)
        return log_fail(d->p.log, RELUME_EINVAL,
                        "depth from views: expected a slab of two views or more; found %s, %d",
                        relume_projection_name(d->m->geometry.projection), d->m->views);
    if (d->m->slabs > 1)
        return log_fail(d->p.log, RELUME_EINVAL,
                        "depth from views: expected one slab; found %d in one capture",
                        d->m->slabs);
    if ((range[0] != 0.0 || range[1] != 0.0) && !(range[0] > 0.0 && range[1] > range[0]))
        return log_fail(d->p.log, RELUME_EINVAL,
                        "depth range: expected 0 < nearest < farthest; found %g, %g", range[0],
                        range[1]);
    if (d->p.planes && (d->p.planes < 8 || d->p.planes > 256))
        return log_fail(d->p.log, RELUME_EINVAL, "planes: expected 8 to 256; found %d",
                        d->p.planes);
    if (relume_capture_width(d->capture) < 16 || relume_capture_height(d->capture) < 16)
        return log_fail(d->p.log, RELUME_EINVAL,
                        "depth from views: expected views of 16 x 16 pixels or more");
    return RELUME_OK;
}

static relume_status sweep_views(struct slab_depth *d)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < d->m->views && !status; i++) {
        status = slab_depth_view(d, i);
        if (!status && !log_progress(d->p.log, "sweeping", (i + 1.0) / d->m->views))
            status = RELUME_ECANCEL;
    }
    return status;
}

static relume_status make_folder(struct slab_depth *d, const char *path)
{
    outdir *dir;
    relume_status status = outdir_open(&dir, path, d->p.force, d->p.log);
    if (status)
        return status;
    status = slab_depth_load(d, outdir_path(dir));
    if (!status)
        status = slab_depth_planes(d);
    if (!status)
        status = sweep_views(d);
    if (!status)
        status = save_views(d, dir);
    if (!status)
        status = write_manifest(d, path, dir);
    return outdir_end(&dir, status);
}

static void report_on(struct relume_slab_depth_report *r, const struct slab_depth *d)
{
    const double whole = fabs(d->m->geometry.uv_z - d->m->geometry.st_z);
    *r = (struct relume_slab_depth_report){
        .views = d->m->views,
        .planes = d->planes,
        .lights = d->lights,
        .width = d->sweep.width,
        .height = d->sweep.height,
        .range = {whole / (1.0 + d->first + d->step * (d->planes - 1)), whole / (1.0 + d->first)},
        .plane_step = d->step,
        .trusted = d->trusted,
        .compared = d->compared,
        .median_relative = median_of(d),
        .bad = d->compared ? (double)d->bad / (double)d->compared : 0.0,
    };
}

relume_status relume_slab_depth(struct relume_slab_depth_report *report,
                                const relume_capture *capture, const char *dir,
                                const struct relume_slab_depth_params *params)
{
    struct slab_depth d = {.capture = capture,
                           .m = relume_capture_manifest(capture),
                           .p = PARAMS_WORK(relume_slab_depth_params, params)};
    relume_status status = check(&d);
    if (status)
        return status;
    const size_t views = (size_t)d.m->views;
    d.picture = mem_array(views, sizeof *d.picture);
    d.plane = mem_array(views, sizeof *d.plane);
    d.at = mem_array(views, sizeof *d.at);
    d.bins = mem_zeroed(BINS, sizeof *d.bins);
    status = d.picture && d.plane && d.at && d.bins ? make_folder(&d, dir) : RELUME_ENOMEM;
    if (!status && report)
        report_on(report, &d);
    if (d.memory)
        scratch_unmap(d.memory, d.memory_bytes);
    mem_free(d.picture);
    mem_free(d.plane);
    mem_free(d.at);
    mem_free(d.bins);
    return status;
}
