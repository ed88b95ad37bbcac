// slab_depth_search.c - pictures of a slab loaded, planes chosen, views swept
#include "capture/multiview/slab_depth.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/scratch.h"
#include "core/base/thread.h"
#include "capture/multiview/semiglobal.h"
#include "capture/multiview/plane_sweep_picture.h"

#include <errno.h>
#include <math.h>
#include <string.h>

enum { MOST_PLANES = 256, LEAST_PLANES = 8, MOST_WIDTH = 1024 };
static const size_t default_memory = (size_t)1 << 30;
// Where depth is looked for when nobody knows: 4 and 0.4 times the distance of the st plane.
static const double farthest = -0.75, nearest = 1.5;

// ---------------------------------------------------------------- pictures

static size_t view_bytes(const struct slab_depth *d, int factor)
{
    const size_t n = (size_t)(relume_capture_width(d->capture) / factor) *
                     (size_t)(relume_capture_height(d->capture) / factor);
    return (n * 3 * (size_t)d->lights + 63) / 64 * 64 + (n * sizeof(float) + 63) / 64 * 64;
}

static void choose_size(struct slab_depth *d)
{
    const int width = relume_capture_width(d->capture);
    const size_t memory = d->p.memory ? d->p.memory : default_memory;
    d->factor = plane_sweep_factor(width, d->p.max_width ? d->p.max_width : MOST_WIDTH);
    while (view_bytes(d, d->factor) * (size_t)d->m->views > memory && width / d->factor > 32)
        d->factor++;
    d->sweep.width = width / d->factor;
    d->sweep.height = relume_capture_height(d->capture) / d->factor;
}

static relume_status map_memory(struct slab_depth *d, const char *near)
{
    const size_t each = view_bytes(d, d->factor), views = (size_t)d->m->views;
    const size_t planes = (size_t)d->sweep.width * (size_t)d->sweep.height * sizeof(float);
    d->memory_bytes = each * views;
    d->memory = scratch_map(near, d->memory_bytes);
    if (!d->memory)
        return log_fail(d->p.log, RELUME_EIO, "%s: no room for %zu bytes beside it; %s", near,
                        d->memory_bytes, strerror(errno));
    for (size_t i = 0; i < views; i++) {
        uint8_t *start = (uint8_t *)d->memory + i * each;
        d->plane[i] = (float *)(void *)start;
        d->picture[i] = start + (planes + 63) / 64 * 64;
    }
    return RELUME_OK;
}

static void place_cameras(struct slab_depth *d)
{
    const struct relume_geometry *g = &d->m->geometry;
    const double x = d->sweep.width / (g->st_max[0] - g->st_min[0]);
    const double y = d->sweep.height / (g->st_max[1] - g->st_min[1]);
    for (int i = 0; i < d->m->views; i++) {
        d->at[i][0] = d->m->view[i].uv[0] * x;
        d->at[i][1] = -d->m->view[i].uv[1] * y;
    }
}

static relume_status load_view(struct slab_depth *d, int view)
{
    const size_t n = 3 * (size_t)d->sweep.width * (size_t)d->sweep.height;
    for (int k = 0; k < d->lights; k++) {
        struct relume_image image;
        const relume_status status =
            relume_capture_image(&image, d->capture, view, d->light[k], d->p.log);
        if (status)
            return status;
        plane_sweep_picture(d->picture[view] + (size_t)k * n, &image, d->factor);
        relume_image_destroy(&image);
    }
    return log_progress(d->p.log, "reading", (view + 1.0) / d->m->views) ? RELUME_OK
                                                                         : RELUME_ECANCEL;
}

relume_status slab_depth_load(struct slab_depth *d, const char *near)
{
    d->lights = d->m->lights < DEPTH_LIGHTS ? d->m->lights : DEPTH_LIGHTS;
    for (int k = 0; k < d->lights; k++)
        d->light[k] = (int)((2 * k + 1) * (long)d->m->lights / (2 * d->lights));
    choose_size(d);
    d->sweep.channels = 3 * d->lights;
    d->sweep.views = d->m->views;
    d->sweep.picture = d->picture;
    d->sweep.at = (const double(*)[2])d->at;
    place_cameras(d);
    relume_status status = map_memory(d, near);
    for (int i = 0; i < d->m->views && !status; i++)
        status = load_view(d, i);
    return status;
}

// ---------------------------------------------------------------- planes

static int middle_view(const struct slab_depth *d)
{
    double mean[2] = {0.0, 0.0};
    int best = 0;
    for (int i = 0; i < d->m->views; i++)
        for (int k = 0; k < 2; k++)
            mean[k] += d->at[i][k] / d->m->views;
    for (int i = 1; i < d->m->views; i++)
        if (hypot(d->at[i][0] - mean[0], d->at[i][1] - mean[1]) <
            hypot(d->at[best][0] - mean[0], d->at[best][1] - mean[1]))
            best = i;
    return best;
}

// Costs of one row summed over a few pixels; a plane counts where it alone fits.
static void vote(size_t *votes, const uint8_t *cost, int width, int planes)
{
    enum { WINDOW = 6, AS_GOOD = 6 };
    for (int x = WINDOW; x < width - WINDOW; x++) {
        int sum[MOST_PLANES], best = 0, good = 0;
        for (int q = 0; q < planes; q++) {
            sum[q] = 0;
            for (int i = x - WINDOW; i <= x + WINDOW; i++)
                sum[q] += cost[q * width + i];
            if (sum[q] < sum[best])
                best = q;
        }
        for (int q = 0; q < planes; q++)
            good += sum[q] <= sum[best] + AS_GOOD * (2 * WINDOW + 1);
        if (good <= planes / 16 + 3)
            votes[best]++;
    }
}

// The planes that more than one in 300 votes is for, and one more on either side.
static void voted_range(double range[2], const size_t *votes, int planes, double step)
{
    size_t all = 0;
    int low = planes, high = -1;
    for (int q = 0; q < planes; q++)
        all += votes[q];
    for (int q = 0; q < planes; q++)
        if (votes[q] * 300 > all) {
            low = q < low ? q : low;
            high = q;
        }
    if (high < 0) {
        low = 0;
        high = planes - 1;
    }
    range[0] = farthest + (low - 1.5) * step;
    range[1] = farthest + (high + 1.5) * step;
}

static relume_status find_range(double range[2], const struct slab_depth *d)
{
    enum { ROWS = 32 };
    const int view = middle_view(d), width = d->sweep.width;
    const struct plane_sweep_target target =
        plane_sweep_target(&d->sweep, view, PLANE_SWEEP_NEIGHBOURS);
    const double texel = 1.0 / plane_sweep_reach(&d->sweep, &target);
    int planes = relume_whole(ceil((nearest - farthest) / texel)) + 1;
    planes = planes > MOST_PLANES ? MOST_PLANES : planes < LEAST_PLANES ? LEAST_PLANES : planes;
    const double step = (nearest - farthest) / (planes - 1);
    size_t votes[MOST_PLANES] = {0};
    uint8_t *cost = mem_array((size_t)planes * (size_t)width, 1);
    struct plane_sweep_scratch scratch;
    relume_status status = plane_sweep_scratch_create(&scratch, width);
    if (!cost)
        status = RELUME_ENOMEM;
    for (int i = 0; i < ROWS && !status; i++) {
        const int row = (int)((i + 0.5) / ROWS * d->sweep.height);
        for (int q = 0; q < planes; q++)
            plane_sweep_row(cost + q * width, NULL, &d->sweep, &target, farthest + q * step, row,
                            &scratch);
        vote(votes, cost, width, planes);
    }
    voted_range(range, votes, planes, step);
    plane_sweep_scratch_free(&scratch);
    mem_free(cost);
    return status;
}

relume_status slab_depth_planes(struct slab_depth *d)
{
    const struct relume_geometry *g = &d->m->geometry;
    const double whole = fabs(g->uv_z - g->st_z);
    double range[2] = {whole / (d->p.range[1] > 0.0 ? d->p.range[1] : whole) - 1.0,
                       whole / (d->p.range[0] > 0.0 ? d->p.range[0] : whole) - 1.0};
    if (d->p.range[0] == 0.0 && d->p.range[1] == 0.0) {
        const relume_status status = find_range(range, d);
        if (status)
            return status;
    }
    range[0] = fmax(range[0], -0.98);
    const struct plane_sweep_target target =
        plane_sweep_target(&d->sweep, middle_view(d), PLANE_SWEEP_NEIGHBOURS);
    const double wanted =
        d->p.planes ? d->p.planes
                    : ceil((range[1] - range[0]) * plane_sweep_reach(&d->sweep, &target)) + 1.0;
    d->planes = (int)fmin(fmax(wanted, LEAST_PLANES), MOST_PLANES);
    d->first = range[0];
    d->step = (range[1] - range[0]) / (d->planes - 1);
    return RELUME_OK;
}

// ---------------------------------------------------------------- one view

struct volume {
    struct slab_depth *d;
    struct plane_sweep_target target;
    uint8_t *cost, *guide;
    uint16_t *sum;
    struct plane_sweep_scratch *scratch;  // [threads]
    uint8_t *row;                         // [threads][planes][width]
};

static void plane_sweep_one_row(void *context, size_t item, int worker)
{
    const struct volume *v = context;
    const struct slab_depth *d = v->d;
    const size_t width = (size_t)d->sweep.width, planes = (size_t)d->planes;
    uint8_t *row = v->row + (size_t)worker * planes * width;
    uint8_t *cost = v->cost + item * width * planes;
    for (size_t q = 0; q < planes; q++)
        plane_sweep_row(row + q * width, NULL, &d->sweep, &v->target,
                        d->first + (double)q * d->step, (int)item, &v->scratch[worker]);
    for (size_t x = 0; x < width; x++)
        for (size_t q = 0; q < planes; q++)
            cost[x * planes + q] = row[q * width + x];
}

static void choose_one_row(void *context, size_t item, int worker)
{
    const struct volume *v = context;
    const struct slab_depth *d = v->d;
    (void)worker;
    const size_t width = (size_t)d->sweep.width, planes = (size_t)d->planes;
    for (size_t x = item * width; x < (item + 1) * width; x++)
        d->plane[v->target.view][x] = semiglobal_best(v->sum + x * planes, d->planes);
}

static void make_guide(uint8_t *guide, const struct slab_depth *d, int view)
{
    const size_t n = (size_t)d->sweep.width * (size_t)d->sweep.height;
    const uint8_t *rgb = d->picture[view];
    for (size_t i = 0; i < n; i++)
        guide[i] = (uint8_t)((rgb[i] + 2 * rgb[n + i] + rgb[2 * n + i]) / 4);
}

static relume_status volume_create(struct volume *v, struct slab_depth *d, int view, int threads)
{
    const size_t n = (size_t)d->sweep.width * (size_t)d->sweep.height;
    const size_t planes = (size_t)d->planes;
    *v = (struct volume){
        .d = d,
        .target = plane_sweep_target(&d->sweep, view, PLANE_SWEEP_NEIGHBOURS),
        .cost = mem_array(n, planes),
        .guide = mem_array(n, 1),
        .sum = mem_zeroed(n, planes * sizeof *v->sum),
        .scratch = mem_zeroed((size_t)threads, sizeof *v->scratch),
        .row = mem_array((size_t)threads * planes, (size_t)d->sweep.width),
    };
    if (!v->cost || !v->guide || !v->sum || !v->scratch || !v->row)
        return RELUME_ENOMEM;
    relume_status status = RELUME_OK;
    for (int i = 0; i < threads && !status; i++)
        status = plane_sweep_scratch_create(&v->scratch[i], d->sweep.width);
    return status;
}

static void volume_destroy(struct volume *v, int threads)
{
    for (int i = 0; v->scratch && i < threads; i++)
        plane_sweep_scratch_free(&v->scratch[i]);
    mem_free(v->cost);
    mem_free(v->guide);
    mem_free(v->sum);
    mem_free(v->scratch);
    mem_free(v->row);
}

relume_status slab_depth_view(struct slab_depth *d, int view)
{
    struct volume v;
    const int threads = thread_count(d->p.threads);
    const size_t rows = (size_t)d->sweep.height;
    relume_status status = volume_create(&v, d, view, threads);
    if (!status) {
        make_guide(v.guide, d, view);
        thread_for(threads, rows, plane_sweep_one_row, &v);
        status = semiglobal_sum(&(struct semiglobal){.width = d->sweep.width,
                                                     .height = d->sweep.height,
                                                     .planes = d->planes,
                                                     .cost = v.cost,
                                                     .guide = v.guide,
                                                     .sum = v.sum,
                                                     .threads = threads});
    }
    if (!status)
        thread_for(threads, rows, choose_one_row, &v);
    volume_destroy(&v, threads);
    return status;
}
