// join_rows.c - parts that hold rows of views: steps follow from the ranges of all rows of a view,
// so that quantising has waited until now. All else is as if the views had been encoded here
#include "encode/parts/join_rows.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/scratch.h"
#include "encode/levels/pyramid.h"
#include "format/coder/codes.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"
#include "format/pack/format.h"
#include "format/pack/pack_write.h"
#include "format/pack/reader.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <relume/encode/pack_encode.h>
#include <stdatomic.h>
#include <string.h>

struct rows_joining {
    const struct part_file *const *part;
    int count;
    relume_pack *header;  // of the first part: what all of the file is
    relume_coder *coder;  // the same as in the parts, to the last digit
    relume_coefficients **coefficients;
    struct relume_image *depth, *mask;
    struct relume_pack_view *view;
    struct relume_pack_levels *levels;
    struct relume_fidelity *report;  // [views]
    enum relume_step step;
    enum relume_pyramid pyramid;
    const char *path;
    const struct relume_pack_params *p;
};

static relume_status damaged(const struct rows_joining *j, const struct part_file *part)
{
    return log_fail(j->p->log, RELUME_EDAMAGED, "%s: damaged; run this part again", part->path);
}

// `count` numbers of a text, of which `*text` then holds what is left.
static bool read_numbers(const char **text, double *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        char *end;
        numbers[i] = strtod(*text, &end);
        if (end == *text || !isfinite(numbers[i]))
            return false;
        *text = end;
    }
    return true;
}

// ---------------------------------------------------------------- what all of it is

static relume_status read_header(struct rows_joining *j)
{
    relume_pack *h = j->header = mem_zeroed(1, sizeof *h);
    if (!h || !(h->path = mem_text(j->part[0]->path)))
        return RELUME_ENOMEM;
    h->file = j->part[0]->file;
    h->log = j->p->log;
    h->part = true;
    h->limits = limits_or_default(limits_of(j->p->limits, j->p->log));
    h->threads = j->p->threads;
    return reader_read_header(h);
}

static void forget_header(struct rows_joining *j)
{
    if (!j->header)
        return;
    relume_coder_destroy(&j->header->coder);
    arena_free(&j->header->arena);
    mem_free(j->header->path);
    mem_free(j->header);
}

// Directions that differ from the header's in single precision are not of this file.
static bool is_near(const struct relume_vec3 *a, const struct relume_vec3 *b, int n)
{
    for (int i = 0; i < n; i++)
        if (!(fabs(a[i].x - b[i].x) + fabs(a[i].y - b[i].y) + fabs(a[i].z - b[i].z) < 1e-3))
            return false;
    return true;
}

static relume_status make_coder(struct rows_joining *j)
{
    const struct relume_coder_info *info = relume_coder_info(j->header->coder);
    const size_t numbers = 3 * (size_t)info->lights + 4;
    const char *text = exr_get_text(j->part[0]->file, 0, ATTR_EXACT);
    double *exact = mem_array(numbers, sizeof *exact);
    struct relume_vec3 *lights = mem_array((size_t)info->lights, sizeof *lights);
    struct relume_coder_params params = {
        .log = j->p->log,
        .coefficients = info->coefficients,
        .decode = true,
        .force = true,
        .hemispherical = info->hemispherical,
        .pole_y = info->pole_y,
        .ridge = info->ridge,
        .luminance = info->luminance,
        .interpolant = info->interpolant,
        .transform = info->transform,
        .mean = info->mean,
    };
    relume_status status = exact && lights ? RELUME_OK : RELUME_ENOMEM;
    if (!status && (!text || !read_numbers(&text, exact, numbers)))
        status = damaged(j, j->part[0]);
    if (!status) {
        memcpy(params.parameter, exact, sizeof params.parameter);
        memcpy(lights, exact + 4, (size_t)info->lights * sizeof *lights);
        status = is_near(lights, info->directions, info->lights)
                     ? relume_coder_create(&j->coder, info->basis, lights, info->lights, &params)
                     : damaged(j, j->part[0]);
    }
    mem_free(exact);
    mem_free(lights);
    return status == RELUME_EINVAL ? damaged(j, j->part[0]) : status;
}

// ---------------------------------------------------------------- rows

struct sinking {
    const relume_coefficients *c;
    int first;
    atomic_int failed;
};

static void sink_rows(void *context, const struct relume_rect *at, const void *samples)
{
    struct sinking *s = context;
    const size_t bytes = (size_t)at->height * (size_t)s->c->info.planes * (size_t)s->c->info.width *
                         coefficients_waiting(s->c);
    if (!scratch_write(s->c->fd, samples, bytes, coefficients_offset(s->c, s->first + at->top)))
        atomic_store(&s->failed, errno);
}

static relume_status read_rows(const struct rows_joining *j, const struct part_file *part,
                               relume_coefficients *c)
{
    const struct exr_part_info info = exr_part_info(part->file, 1);
    const enum exr_sample sample =
        c->info.storage == RELUME_STORE_FLOAT ? EXR_SAMPLE_FLOAT : EXR_SAMPLE_HALF;
    struct sinking sinking = {.c = c, .first = part->info.row};
    if (info.width != c->info.width || info.height != part->info.rows || !info.uniform ||
        info.channels != c->info.planes || info.sample != sample || info.tile)
        return damaged(j, part);
    const relume_status status =
        exr_read(part->file, 1, NULL, j->p->threads, sink_rows, &sinking, NULL);
    if (status == RELUME_EDAMAGED)
        return damaged(j, part);
    if (!status && atomic_load(&sinking.failed))
        return log_fail(j->p->log, RELUME_EIO, "%s: no room for temporary data; %s", j->path,
                        strerror(atomic_load(&sinking.failed)));
    return status;
}

static bool read_bands(const struct part_file *part, relume_coefficients *c)
{
    const size_t planes = (size_t)c->info.planes;
    const size_t bands = (size_t)(part->info.rows + BAND_ROWS - 1) / BAND_ROWS;
    const float most = FLT_MAX / 4.0f;  // as encode.c allows
    struct range *to = c->band + (size_t)(part->info.row / BAND_ROWS) * planes;
    int count;
    const float *v = exr_get_floats(part->file, 1, ATTR_BANDS, &count);
    if (!v || (size_t)count != 2 * bands * planes)
        return false;
    for (size_t i = 0; i < bands * planes; i++) {
        to[i] = (struct range){v[2 * i], v[2 * i + 1]};
        if (!(to[i].min >= -most && to[i].min <= to[i].max && to[i].max <= most))
            return false;
    }
    return true;
}

bool rows_add_errors(struct project_rows *s, const struct part_file *part, int lights)
{
    const char *text = exr_get_text(part->file, 1, ATTR_ERRORS);
    double head[3], one;
    if (!text || !read_numbers(&text, head, 3) || !(head[1] >= 0.0 && head[1] < 0x1p53) ||
        !(head[2] >= 0.0 && head[2] < 0x1p53))
        return false;
    s->root_sum += head[0];
    s->error_count += (size_t)head[1];
    s->lit_count += (size_t)head[2];
    for (int i = 0; i < lights; i++) {
        if (!read_numbers(&text, &one, 1))
            return false;
        s->shown_error[i] += one;
    }
    return read_numbers(&text, s->error + part->info.row, (size_t)part->info.rows);
}

bool rows_add_census(struct relume_census *to, struct project_rows *s, const struct part_file *part,
                     int lights)
{
    const char *text = exr_get_text(part->file, 1, ATTR_LIT);
    struct relume_fidelity own;
    if (!text || strlen(text) != (size_t)lights || strspn(text, "01") != (size_t)lights ||
        !part_measured(&own, part, 1))
        return false;
    to->pixels += own.census.pixels;
    to->black += own.census.black;
    to->clipped += own.census.clipped;
    to->always_clipped += own.census.always_clipped;
    to->repaired += own.census.repaired;
    to->black_images = 0;
    for (int i = 0; i < lights; i++) {
        s->lit[i] |= text[i] == '1';
        to->black_images += !s->lit[i];
    }
    return true;
}

bool rows_add_stored(struct project_rows *s, const struct part_file *part)
{
    const char *text = exr_get_text(part->file, 1, ATTR_STORED);
    double numbers[3];
    for (int y = part->info.row; y < part->info.row + part->info.rows; y++) {
        if (!text || !read_numbers(&text, numbers, 3) ||
            !(numbers[2] >= 0.0 && numbers[2] < 0x1p53))
            return false;
        s->stored[y] =
            (struct encode_stored){numbers[0], numbers[1], (size_t)numbers[2], RELUME_OK};
    }
    return true;
}

// The part behind the rows that is called so; -1: none.
static int find_plane(const struct part_file *part, const char *ending)
{
    for (int k = 2; k < exr_part_count(part->file); k++)
        if (!strcmp(strchr(exr_part_info(part->file, k).name, '.'), ending))
            return k;
    return -1;
}

static relume_status read_plane(struct relume_image *out, const struct rows_joining *j,
                                const struct part_file *part, const char *ending,
                                enum exr_sample sample)
{
    const int k = find_plane(part, ending);
    relume_pack *h = j->header;
    if (k < 0)
        return RELUME_OK;
    const struct exr_part_info info = exr_part_info(part->file, k);
    if (info.width != h->info.width || info.height != h->info.height || info.channels != 1 ||
        !info.uniform || info.sample != sample)
        return damaged(j, part);
    exr_file *own = h->file;
    const struct relume_rect all = {0, 0, h->info.width, h->info.height};
    h->file = part->file;
    h->log = NULL;
    const relume_status status = reader_load_plane(out, h, k, &all);
    h->file = own;
    h->log = j->p->log;
    return status == RELUME_EDAMAGED ? damaged(j, part) : status;
}

// All parts of a view, the first of which is part *i; *i moves behind them.
static relume_status gather_view(struct rows_joining *j, int v, int *i)
{
    const struct relume_pack_info *info = &j->header->info;
    const int lights = relume_coder_info(j->coder)->lights, first = *i;
    const struct relume_project_params encode = {
        .log = j->p->log, .storage = info->storage, .scratch = j->p->writer ? NULL : j->path};
    relume_status status =
        coefficients_create(&j->coefficients[v], j->coder, info->width, info->height, &encode);
    relume_coefficients *c = j->coefficients[v];
    if (status)
        return status;
    c->some.error = mem_zeroed((size_t)info->height, sizeof *c->some.error);
    c->some.shown_error = mem_zeroed((size_t)lights, sizeof *c->some.shown_error);
    c->some.lit = mem_zeroed((size_t)lights, sizeof *c->some.lit);
    if (!c->some.error || !c->some.shown_error || !c->some.lit)
        return RELUME_ENOMEM;
    for (; !status && *i < j->count && j->part[*i]->info.first == v; ++*i) {
        status = read_bands(j->part[*i], c) && rows_add_errors(&c->some, j->part[*i], lights) &&
                         rows_add_census(&c->report.census, &c->some, j->part[*i], lights)
                     ? read_rows(j, j->part[*i], c)
                     : damaged(j, j->part[*i]);
    }
    if (!status)
        status = read_plane(&j->depth[v], j, j->part[first], ".depth", EXR_SAMPLE_FLOAT);
    if (!status)
        status = read_plane(&j->mask[v], j, j->part[first], ".mask", EXR_SAMPLE_HALF);
    return status;
}

static relume_status finish_view(struct rows_joining *j, int v)
{
    const struct relume_pack_info *info = &j->header->info;
    const struct relume_project_params encode = {
        .log = j->p->log, .domain = info->domain, .step = j->step};
    const relume_status status =
        project_finish_rows(j->coefficients[v], &j->mask[v], info->display, &encode);
    j->report[v] = relume_coefficients_report(j->coefficients[v]);
    j->view[v] = (struct relume_pack_view){
        .coefficients = j->coefficients[v],
        .uv = {info->uv[v][0], info->uv[v][1]},
        .depth = j->depth[v].data ? &j->depth[v] : NULL,
        .mask = j->mask[v].data ? &j->mask[v] : NULL,
    };
    return status;
}

static bool find_slab(struct rows_joining *j, const struct part_file *part, int v)
{
    int *slab = &j->view[v].slab;
    return !j->header->info.slabs || (exr_get_int(part->file, 1, ATTR_MEMBER, slab) && *slab >= 0 &&
                                      *slab < j->header->info.slabs);
}

static relume_status gather_views(struct rows_joining *j)
{
    relume_status status = RELUME_OK;
    for (int v = 0, i = 0; !status && v < j->header->info.views; v++) {
        const int first = i;
        status = gather_view(j, v, &i);
        if (!status)
            status = finish_view(j, v);
        if (!status && !find_slab(j, j->part[first], v))
            status = damaged(j, j->part[first]);
    }
    return status;
}

// ---------------------------------------------------------------- the file

static relume_status reduce_views(struct rows_joining *j,
                                  const struct relume_pack_contents *contents)
{
    relume_status status = RELUME_OK;
    for (int v = 0; !status && v < contents->views; v++) {
        status = relume_pack_reduce(
            &j->levels[v], contents, &j->view[v], j->pyramid,
            relume_project_params(.log = j->p->log, .step = j->step, .threads = j->p->threads,
                                  .scratch = j->p->writer ? NULL : j->path));
        j->view[v].levels = j->levels[v].levels ? &j->levels[v] : NULL;
    }
    return status;
}

static relume_status write_views(struct rows_joining *j, const struct relume_fidelity *report)
{
    const struct relume_pack_info *info = &j->header->info;
    struct relume_pack_contents contents = {
        .coder = j->coder,
        .domain = info->domain,
        .display = info->display,
        .geometry = info->geometry,
        .slabs = info->slabs,
        .slab = info->slab,
        .views = info->views,
        .view = j->view,
        .report = *report,
        .preview = relume_pack_preview,
        .preview_user = &contents,
        .provenance = info->provenance,
    };
    struct relume_pack_params p = *j->p;
    if (relume_compression_parse(&p.compression, exr_part_info(j->part[0]->file, 0).codec))
        return damaged(j, j->part[0]);
    const relume_status status = reduce_views(j, &contents);
    return status ? status : relume_pack_write(&contents, j->path, &p);
}

static bool create(struct rows_joining *j)
{
    const size_t n = (size_t)j->header->info.views;
    int step, pyramid;
    j->coefficients = mem_zeroed(n, sizeof *j->coefficients);
    j->depth = mem_zeroed(n, sizeof *j->depth);
    j->mask = mem_zeroed(n, sizeof *j->mask);
    j->view = mem_zeroed(n, sizeof *j->view);
    j->report = mem_zeroed(n, sizeof *j->report);
    j->levels = mem_zeroed(n, sizeof *j->levels);
    j->step = exr_get_int(j->part[0]->file, 0, ATTR_PART_STEP, &step) && step == RELUME_STEP_COMMON
                  ? RELUME_STEP_COMMON
                  : RELUME_STEP_DEFAULT;
    if (exr_get_int(j->part[0]->file, 0, ATTR_PYRAMID, &pyramid) && pyramid >= 0 &&
        pyramid <= RELUME_PYRAMID_NO)
        j->pyramid = (enum relume_pyramid)pyramid;
    return j->levels && j->coefficients && j->depth && j->mask && j->view && j->report;
}

static void destroy(struct rows_joining *j)
{
    const bool whole = j->coefficients && j->depth && j->mask;  // else there is nothing in them
    for (int v = 0; j->levels && v < j->header->info.views; v++)
        relume_pack_levels_destroy(&j->levels[v]);
    mem_free(j->levels);
    for (int v = 0; whole && v < j->header->info.views; v++) {
        relume_coefficients_destroy(&j->coefficients[v]);
        relume_image_destroy(&j->depth[v]);
        relume_image_destroy(&j->mask[v]);
    }
    mem_free(j->coefficients);
    mem_free(j->depth);
    mem_free(j->mask);
    mem_free(j->view);
    mem_free(j->report);
    relume_coder_destroy(&j->coder);
    forget_header(j);
}

relume_status join_rows(const struct part_file *const *parts, int count, const char *path,
                        struct relume_fidelity *report, const struct relume_pack_params *p)
{
    struct rows_joining j = {.part = parts, .count = count, .path = path, .p = p};
    relume_status status = read_header(&j);
    if (!status)
        status = make_coder(&j);
    if (!status && !create(&j))
        status = RELUME_ENOMEM;
    if (!status)
        status = gather_views(&j);
    if (!status) {
        *report = fidelity_mean(j.report, j.header->info.views);
        status = part_is_coarse(j.part[0], report, p->log);
    }
    if (!status)
        status = write_views(&j, report);
    destroy(&j);
    return status;
}
