// write_header.c - the first part of a relume file: the preview, and what all of the file is
#include "core/base/half.h"
#include "core/base/memory.h"
#include "format/codebook/books.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"
#include "format/pack/format.h"
#include "format/pack/functions.h"
#include "format/pack/pack_write.h"
#include "format/pack/writer.h"
#include "image/image/exr_sums.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Where planes are coded with loss the preview is small, so that it is not most of the file: at
// most SMALL pixels a side, each the mean of MEAN x MEAN of the view or more unless it had fewer
// than LEAST a side then; to a 64th of itself.
enum { SMALL = 64, LEAST = 32, MEAN = 8, MOST_ROWS = 16, SMALL_LEFT_OUT = 5 };

// Of views that have reduced levels it is one of those, at most so many pixels a side.
enum { MOST_SHOWN = 1024 };

static size_t coarseness(const struct relume_coefficients_info *info)
{
    const int side = info->width > info->height ? info->width : info->height;
    const int least = (side + SMALL - 1) / SMALL, most = side < LEAST ? 1 : side / LEAST;
    return (size_t)(least > MEAN ? least : most < MEAN ? most : MEAN);
}

// Rows of the view join the sums of a row of the preview.
static void add_rows(float *sum, const float *rgb, size_t width, size_t rows, size_t coarse)
{
    for (size_t i = 0; i < rows * width; i++)
        for (size_t c = 0; c < 3; c++)
            sum[3 * (i % width / coarse) + c] += rgb[3 * i + c];
}

// The first of the views that are written.
static const struct relume_pack_view *first_view(const struct relume_pack_contents *c)
{
    return c->view + (c->share ? c->share->first : 0);
}

// B, G, R as halves, none of which is infinite, the lowest `left_out` of whose bits are 0.
static uint16_t *put_row(uint16_t *out, const float *rgb, size_t width, int left_out)
{
    const unsigned largest = 0x7bff, step = 1u << left_out;
    for (size_t channel = 3; channel-- > 0;)
        for (size_t x = 0; x < width; x++) {
            const unsigned half = half_from_float(fminf(rgb[3 * x + channel], 65504.0f));
            const unsigned rounded = (half & 0x7fff) + step / 2;
            const unsigned size = rounded < largest ? rounded : largest;
            *out++ = (uint16_t)((half & 0x8000) | (size & ~(step - 1)));
        }
    return out;
}

int relume_pack_shown(const struct relume_pack_view *view)
{
    const int levels = view->levels && !view->coded ? view->levels->levels : 0;
    for (int i = 0; i < levels; i++) {
        const struct relume_coefficients_info *info =
            relume_coefficients_info(view->levels->level[i]);
        if (info->width <= MOST_SHOWN && info->height <= MOST_SHOWN)
            return i + 1;
    }
    return levels;
}

const struct relume_coefficients_info *writer_shown(const struct relume_pack_view *view)
{
    const int level = relume_pack_shown(view);
    return relume_coefficients_info(level ? view->levels->level[level - 1] : view->coefficients);
}

static relume_status preview_rows(void *context, int row, int rows, void *samples)
{
    const struct relume_pack_contents *c = context;
    const size_t width = (size_t)writer_shown(first_view(c))->width;
    float *rgb = mem_zeroed((size_t)rows * width, 3 * sizeof *rgb);
    uint16_t *out = samples;
    if (!rgb)
        return RELUME_ENOMEM;
    const relume_status status =
        c->preview ? c->preview(c->preview_user, row, rows, rgb) : RELUME_OK;
    for (size_t y = 0; !status && y < (size_t)rows; y++)
        out = put_row(out, rgb + 3 * y * width, width, 0);
    mem_free(rgb);
    return status;
}

// One row of the small one, out of a few rows of the view at a time.
static relume_status small_row(float *sum, float *rgb, const struct relume_pack_contents *c,
                               size_t row)
{
    const struct relume_coefficients_info *info =
        relume_coefficients_info(first_view(c)->coefficients);
    const size_t coarse = coarseness(info), width = (size_t)info->width;
    const size_t first = row * coarse, height = (size_t)info->height;
    const size_t end = first + coarse < height ? first + coarse : height;
    relume_status status = RELUME_OK;
    for (size_t y = first, n; !status && c->preview && y < end; y += n) {
        n = end - y < MOST_ROWS ? end - y : MOST_ROWS;
        status = c->preview(c->preview_user, (int)y, (int)n, rgb);
        if (!status)
            add_rows(sum, rgb, width, n, coarse);
    }
    for (size_t x = 0; x * coarse < width; x++) {
        const size_t right = (x + 1) * coarse < width ? (x + 1) * coarse : width;
        for (size_t k = 0; k < 3; k++)
            sum[3 * x + k] /= (float)((end - first) * (right - x * coarse));
    }
    return status;
}

static relume_status small_rows(void *context, int row, int rows, void *samples)
{
    const struct relume_pack_contents *c = context;
    const struct relume_coefficients_info *info =
        relume_coefficients_info(first_view(c)->coefficients);
    const size_t width = (size_t)info->width,
                 small = (width + coarseness(info) - 1) / coarseness(info);
    float *rgb = mem_zeroed(MOST_ROWS * width, 3 * sizeof *rgb);
    float *sum = mem_array(small, 3 * sizeof *sum);
    uint16_t *out = samples;
    relume_status status = rgb && sum ? RELUME_OK : RELUME_ENOMEM;
    for (int y = row; !status && y < row + rows; y++) {
        memset(sum, 0, small * 3 * sizeof *sum);
        status = small_row(sum, rgb, c, (size_t)y);
        if (!status)
            out = put_row(out, sum, small, SMALL_LEFT_OUT);
    }
    mem_free(rgb);
    mem_free(sum);
    return status;
}

static void put_planes(float to[6], const struct relume_geometry *g)
{
    const double slab[] = {g->uv_z,      g->st_z,      g->st_min[0],
                           g->st_min[1], g->st_max[0], g->st_max[1]};
    for (int i = 0; i < 6; i++)
        to[i] = (float)slab[i];
}

static void put_pose(float to[12], const struct relume_pose *pose)
{
    const struct relume_vec3 v[] = {pose->origin, pose->axis[0], pose->axis[1], pose->axis[2]};
    for (int i = 0; i < 4; i++) {
        to[3 * i] = (float)v[i].x;
        to[3 * i + 1] = (float)v[i].y;
        to[3 * i + 2] = (float)v[i].z;
    }
}

static void describe_slabs(struct writer *w, struct exr_part *part)
{
    const struct relume_pack_contents *c = w->contents;
    const int slabs = c->slabs ? c->slabs : 1;
    float *planes = arena_array(&w->arena, 6 * (size_t)slabs, sizeof *planes);
    float *pose = c->slabs ? arena_array(&w->arena, 12 * (size_t)slabs, sizeof *pose) : NULL;
    float *uv = arena_array(&w->arena, 2 * (size_t)c->views, sizeof *uv);
    for (int i = 0; planes && i < slabs; i++)
        put_planes(planes + 6 * i, c->slabs ? &c->slab[i] : &c->geometry);
    for (int i = 0; pose && i < c->slabs; i++)
        put_pose(pose + 12 * i, &c->slab[i].pose);
    for (int i = 0; uv && i < 2 * c->views; i++)
        uv[i] = (float)c->view[i / 2].uv[i % 2];
    writer_floats(w, part, ATTR_SLAB, planes, 6 * slabs);
    if (c->slabs)
        writer_floats(w, part, ATTR_POSE, pose, 12 * slabs);
    writer_floats(w, part, ATTR_UV, uv, 2 * c->views);
}

static void describe_geometry(struct writer *w, struct exr_part *part)
{
    const struct relume_geometry *g = &w->contents->geometry;
    writer_text(part, ATTR_PROJECTION, relume_projection_name(g->projection));
    if (g->projection == RELUME_PLANAR) {
        const double window[] = {g->window_min[0], g->window_min[1], g->window_max[0],
                                 g->window_max[1], g->camera_z};
        writer_doubles(w, part, ATTR_WINDOW, window, 5);
        writer_text(part, ATTR_CAMERA, g->perspective ? "perspective" : "orthographic");
    } else if (g->projection == RELUME_SLAB) {
        describe_slabs(w, part);
    } else {
        const double panorama[] = {g->v_min,    g->v_max,    g->center.x,
                                   g->center.y, g->center.z, g->disc};
        writer_doubles(w, part, ATTR_PANORAMA, panorama, g->disc ? 6 : 5);
    }
}

// What rounding of functions may change where planes are coded: this part of what coding them does,
// which is no less than the other where the file is only weighed so far.
static const double OF_CODING = 0.5, LEAST_CODING = 1.0 / 1024.0;

static void describe_functions(struct writer *w, struct exr_part *part, bool coded)
{
    const struct relume_pack_contents *c = w->contents;
    const struct relume_coder_info *info = w->coder;
    const int rows = (info->basis->joint ? 3 : 1) * info->coefficients, each = info->functions;
    if (!coded || !info->basis->joint) {
        writer_floats(w, part, ATTR_TRANSFORM, info->transform, rows * each);
        return;
    }
    const double coding = c->report.store_rms > LEAST_CODING ? c->report.store_rms : LEAST_CODING;
    char *made = functions_text(info->transform, info->coefficients, each,
                                first_view(c)->coefficients->most, OF_CODING * coding);
    const char *text = made ? arena_format(&w->arena, "%s", made) : NULL;
    mem_free(made);
    w->failed |= !text;
    writer_text(part, ATTR_STEPPED, text);
}

static void describe_coder(struct writer *w, struct exr_part *part, bool coded)
{
    const struct relume_coder_info *info = w->coder;
    writer_text(part, ATTR_BASIS, info->basis->name);
    writer_int(part, ATTR_COEFFICIENTS, info->coefficients);
    writer_text(part, ATTR_POLE, info->pole_y ? "y" : "z");
    writer_int(part, ATTR_HEMISPHERICAL, info->hemispherical);
    writer_doubles(w, part, ATTR_RIDGE, &info->ridge, 1);
    writer_doubles(w, part, ATTR_LIGHTS, &info->directions->x, 3 * info->lights);
    if (info->transform)
        describe_functions(w, part, coded);
    if (info->mean)
        writer_floats(w, part, ATTR_MEAN, info->mean, 3 * info->functions);
    if (info->luminance)
        writer_text(part, ATTR_COLOUR, "luminance");
    if (info->interpolant) {
        writer_text(part, ATTR_INTERPOLANT, info->interpolant->name);
        writer_doubles(w, part, ATTR_PARAMETER, info->parameter, 4);
    }
}

// The picture of the first part is not of the views' size then.
static void describe_coding(struct writer *w, struct exr_part *part,
                            const struct relume_coefficients_info *info)
{
    const int coarse = (int)coarseness(info);
    part->codec = EXR_CODEC_ZIP;
    part->width = (info->width + coarse - 1) / coarse;
    part->height = (info->height + coarse - 1) / coarse;
    part->rows = small_rows;
    writer_text(part, ATTR_CODING, CODING_AV1);
    writer_floats(w, part, ATTR_SCALE, info->scale, info->planes);
    writer_floats(w, part, ATTR_OFFSET, info->offset, info->planes);
}

// What single precision does not hold: lights and parameters to the last digit, which what join
// measures depends on.
static const char *exact_text(struct writer *w)
{
    enum { EACH = 26 };
    const struct relume_coder_info *info = w->coder;
    const double *lights = &info->directions->x;
    const size_t numbers = 3 * (size_t)info->lights + 4;
    char *text = arena_array(&w->arena, numbers, EACH), *to = text;
    for (size_t i = 0; text && i < numbers; i++)
        to += snprintf(to, EACH, "%a ", i < 4 ? info->parameter[i] : lights[i - 4]);
    w->failed |= !text;
    return text;
}

static void describe_share(struct writer *w, struct exr_part *part)
{
    const struct relume_pack_share *s = w->contents->share;
    const double place[] = {s->part, s->parts, s->free_storage};
    writer_doubles(w, part, ATTR_PART, place, 3);
    writer_text(part, ATTR_CAPTURE, s->capture);
    writer_text(part, ATTR_OPTIONS, s->options);
    writer_int(part, ATTR_PART_STEP, (int)s->step);
    writer_int(part, ATTR_PYRAMID, (int)s->pyramid);
    writer_text(part, ATTR_EXACT, exact_text(w));
    if (s->coded)
        writer_text(part, ATTR_MEASURED, writer_measured(w, s->measured));
}

void writer_add_header(struct writer *w)
{
    static const char *const channels[] = {"B", "G", "R"};
    const struct relume_pack_contents *c = w->contents;
    const struct relume_pack_view *view = first_view(c);
    const struct relume_coefficients_info *info = relume_coefficients_info(view->coefficients);
    const double report[] = {c->report.fit_rms, c->report.store_rms};
    const struct relume_coefficients_info *shown = writer_shown(view);
    const bool coded = writer_is_coded(c);
    struct exr_part *part = writer_part(w, "preview", shown->width, shown->height);
    part->codec = w->codec;
    part->sample = EXR_SAMPLE_HALF;
    part->channels = 3;
    part->channel = channels;
    part->rows = preview_rows;
    part->context = (void *)(uintptr_t)c;
    relume_transfer_text(c->display, w->display, sizeof w->display);
    writer_text(part, ATTR_FORMAT, c->share ? FORMAT_PART : FORMAT_NAME);
    writer_int(part, ATTR_VERSION,
               coded || view->levels ? FORMAT_CODED
               : c->slabs            ? FORMAT_SLABS
               : c->geometry.disc    ? FORMAT_DISCS
                                     : FORMAT_PLAIN);
    writer_text(part, ATTR_CREATOR, "relume " RELUME_VERSION);
    writer_text(part, ATTR_SUMS, EXR_SUMS_CHANNEL);
    if (c->provenance)
        writer_text(part, ATTR_PROVENANCE, c->provenance);
    writer_text(part, ATTR_DOMAIN, c->domain == RELUME_DOMAIN_DISPLAY ? "display" : "linear");
    writer_text(part, ATTR_DISPLAY, w->display);
    writer_text(part, ATTR_STORAGE, relume_storage_name(info->storage));
    writer_int(part, ATTR_VIEWS, c->views);
    if (isfinite(report[0]) && isfinite(report[1]))
        writer_doubles(w, part, ATTR_REPORT, report, 2);
    if (coded || view->levels) {
        writer_int(part, ATTR_WIDTH, info->width);
        writer_int(part, ATTR_HEIGHT, info->height);
    }
    if (coded)
        describe_coding(w, part, info);
    if (view->books)
        writer_int(part, ATTR_BOOKS, relume_books_info(view->books)->books);
    describe_coder(w, part, coded);
    describe_geometry(w, part);
    if (c->share)
        describe_share(w, part);
}
