// write_view.c - the parts of one view: its coefficients, depth and mask
#include "core/base/half.h"
#include "core/base/memory.h"
#include "core/base/scratch.h"
#include "format/coder/codes.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"
#include "format/pack/format.h"
#include "format/pack/pack_write.h"
#include "format/pack/writer.h"
#include "image/image/image.h"

#include <stdio.h>
#include <string.h>

static relume_status code_rows(void *context, int row, int rows, void *samples)
{
    const relume_coefficients *coefficients = context;
    const struct relume_coefficients_info *info = relume_coefficients_info(coefficients);
    const struct relume_coder_info *coder = relume_coder_info(info->coder);
    const size_t width = (size_t)info->width, planes = (size_t)info->planes;
    const size_t code = width * relume_storage_bytes(info->storage);
    const size_t sample = width * exr_sample_bytes(codes_sample(info->storage));
    row += coefficients->some.row;
    char *codes = mem_array(planes, code), *to = samples;  // a row stays in the cache
    relume_status status = codes ? RELUME_OK : RELUME_ENOMEM;
    for (int y = row; !status && y < row + rows; y++, to += planes * sample) {
        status = relume_coefficients_read(coefficients, y, 1, codes);
        for (size_t p = 0; !status && p < planes; p++)
            codes_to_samples(to + (size_t)format_plane(coder, (int)p) * sample, info->storage,
                             codes + p * code, width);
    }
    mem_free(codes);
    return status;
}

static relume_status depth_rows(void *context, int row, int rows, void *samples)
{
    const struct relume_image *image = context;
    const size_t width = (size_t)image->width;
    memcpy(samples, image->data + (size_t)row * width, (size_t)rows * width * sizeof(float));
    image_forget(image, row, rows);
    return RELUME_OK;
}

static relume_status mask_rows(void *context, int row, int rows, void *samples)
{
    const struct relume_image *image = context;
    const size_t width = (size_t)image->width;
    const float *mask = image->data + (size_t)row * width;
    uint16_t *halves = samples;
    for (size_t i = 0; i < (size_t)rows * width; i++)
        halves[i] = half_from_float(mask[i] > 0.5f ? 1.0f : 0.0f);
    image_forget(image, row, rows);
    return RELUME_OK;
}

// Shares that are not 0 stay so.
static relume_status share_rows(void *context, int row, int rows, void *samples)
{
    const struct relume_image *image = context;
    const size_t width = (size_t)image->width;
    exr_from_floats(samples, EXR_SAMPLE_HALF, image->data + (size_t)row * width,
                    (size_t)rows * width);
    image_forget(image, row, rows);
    return RELUME_OK;
}

static void add_plane(struct writer *w, const char *name, int view,
                      const struct relume_image *image, const char *const *channel,
                      enum exr_sample sample, relume_status (*rows)(void *, int, int, void *))
{
    if (!image)
        return;
    struct exr_part *part = writer_part(w, arena_format(&w->arena, "view%04d.%s", view, name),
                                        image->width, image->height);
    part->codec = EXR_CODEC_ZIP;
    part->tile = w->contents->view[view].levels ? FORMAT_TILE : 0;
    part->sample = sample;
    part->channels = 1;
    part->channel = channel;
    part->rows = rows;
    part->context = (void *)(uintptr_t)image;
}

// What join adds up of rows whose steps are known.
static const char *stored_text(struct writer *w, const struct project_rows *s)
{
    enum { EACH = 80 };
    char *text = arena_array(&w->arena, (size_t)s->rows + 1, EACH), *to = text;
    w->failed |= !text;
    for (int y = s->row; text && y < s->row + s->rows; y++)
        to += snprintf(to, EACH, "%a %a %zu ", s->stored[y].square, s->stored[y].shown,
                       s->stored[y].count);
    return text;
}

static void add_steps(struct writer *w, struct exr_part *part,
                      const struct relume_coefficients_info *info)
{
    writer_floats(w, part, ATTR_SCALE, info->scale, info->planes);
    writer_floats(w, part, ATTR_OFFSET, info->offset, info->planes);
}

static void fill_with_planes(struct writer *w, struct exr_part *part,
                             const relume_coefficients *coefficients)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(coefficients);
    part->sample = codes_sample(info->storage);
    part->channels = info->planes;
    part->channel = w->channels;
    part->rows = code_rows;
    part->context = (void *)(uintptr_t)coefficients;
    add_steps(w, part, info);
}

const char *writer_measured(struct writer *w, const struct relume_fidelity *r)
{
    const struct relume_census *c = &r->census;
    const char *text = arena_format(&w->arena, FORMAT_MEASURED, r->fit_rms, r->store_rms,
                                    r->steps_rms, r->psnr_db, r->typical, c->pixels, c->black,
                                    c->clipped, c->always_clipped, c->repaired, c->black_images);
    w->failed |= !text;
    return text;
}

static relume_status waiting_rows(void *context, int row, int rows, void *samples)
{
    const relume_coefficients *c = context;
    const size_t bytes =
        (size_t)rows * (size_t)c->info.planes * (size_t)c->info.width * coefficients_waiting(c);
    return scratch_read(c->fd, samples, bytes, coefficients_offset(c, c->some.row + row))
               ? RELUME_OK
               : RELUME_EIO;
}

// "c0000" and so on: planes in their own order.
static const char **waiting_channels(struct writer *w, int planes)
{
    const char **names = arena_array(&w->arena, (size_t)planes, sizeof *names);
    for (int p = 0; names && p < planes; p++)
        if (!(names[p] = arena_format(&w->arena, "c%05d", p)))
            w->failed = true;
    w->failed |= !names;
    return names;
}

static const char *errors_text(struct writer *w, const relume_coefficients *c)
{
    enum { EACH = 26 };
    const struct project_rows *s = &c->some;
    const size_t lights = (size_t)w->coder->lights, rows = (size_t)s->rows;
    char *text = arena_array(&w->arena, rows + lights + 5, EACH), *to = text;
    if (!text) {
        w->failed = true;
        return NULL;
    }
    to += sprintf(to, "%a %zu %zu ", s->root_sum, s->error_count, s->lit_count);
    for (size_t i = 0; i < lights; i++)
        to += snprintf(to, EACH, "%a ", s->shown_error[i]);
    for (size_t y = 0; y < rows; y++)
        to += snprintf(to, EACH, "%a ", s->error[(size_t)s->row + y]);
    return text;
}

// A digit for each light.
static const char *lit_text(struct writer *w, const struct project_rows *s)
{
    const size_t lights = (size_t)w->coder->lights;
    char *text = arena_array(&w->arena, lights + 1, 1);
    w->failed |= !text;
    for (size_t i = 0; text && i < lights; i++)
        text[i] = s->lit && s->lit[i] ? '1' : '0';
    return text;
}

// Rows that wait for those of other parts, without which they have no steps.
static void fill_with_waiting(struct writer *w, struct exr_part *part,
                              const struct relume_pack_view *view)
{
    const relume_coefficients *c = view->coefficients;
    const int planes = c->info.planes, first = c->some.row / BAND_ROWS;
    const int bands = (c->some.rows + BAND_ROWS - 1) / BAND_ROWS;
    part->codec = EXR_CODEC_NONE;
    part->sample = c->info.storage == RELUME_STORE_FLOAT ? EXR_SAMPLE_FLOAT : EXR_SAMPLE_HALF;
    part->channels = planes;
    part->channel = waiting_channels(w, planes);
    part->rows = waiting_rows;
    part->context = (void *)(uintptr_t)c;
    writer_floats(w, part, ATTR_BANDS, &c->band[(size_t)first * (size_t)planes].min,
                  2 * bands * planes);
}

static void add_codes(struct writer *w, int index, bool shared)
{
    const struct relume_pack_view *view = &w->contents->view[index];
    const struct relume_coefficients_info *info = relume_coefficients_info(view->coefficients);
    const struct project_rows *some = &view->coefficients->some;
    struct exr_part *part =
        writer_part(w, arena_format(&w->arena, "view%04d", index), info->width, info->height);
    part->tile = view->levels ? FORMAT_TILE : 0;
    writer_int(part, ATTR_VIEW, index);
    if (w->contents->slabs)
        writer_int(part, ATTR_MEMBER, view->slab);
    if (w->contents->share)
        writer_text(
            part, ATTR_MEASURED,
            writer_measured(w, &w->contents->share->measured[index - w->contents->share->first]));
    if (view->books)
        writer_fill_indices(part, view);
    else if (some->rows && !some->stored)
        fill_with_waiting(w, part, view);
    else
        fill_with_planes(w, part, view->coefficients);
    if (some->rows) {
        part->height = some->rows;
        writer_text(part, ATTR_ERRORS, errors_text(w, view->coefficients));
        writer_text(part, ATTR_LIT, lit_text(w, some));
    }
    if (some->rows && some->stored)
        writer_text(part, ATTR_STORED, stored_text(w, some));
    if (view->books && !shared)
        writer_add_books(w, view->books, index);
}

void writer_add_levels(struct writer *w, int index)
{
    static const char *const channel[] = {"A"};
    const struct relume_pack_levels *levels = w->contents->view[index].levels;
    char name[32];
    for (int i = 0; levels && i < levels->levels; i++) {
        if (w->contents->view[index].coded && !levels->coded[i])
            continue;
        const struct relume_coefficients_info *info = relume_coefficients_info(levels->level[i]);
        struct exr_part *part =
            writer_part(w, arena_format(&w->arena, "view%04d.level%d", index, i + 1), info->width,
                        info->height);
        if (levels->coded[i]) {
            writer_fill_words(w, part, levels->coded[i], levels->coded_words[i]);
            add_steps(w, part, info);
        } else {
            part->tile = FORMAT_TILE;
            fill_with_planes(w, part, levels->level[i]);
        }
        snprintf(name, sizeof name, "level%d.mask", i + 1);
        add_plane(w, name, index, levels->share[i].data ? &levels->share[i] : NULL, channel,
                  EXR_SAMPLE_HALF, share_rows);
    }
}

void writer_add_view(struct writer *w, int index, bool shared)
{
    static const char *const depth_channel[] = {"Z"}, *const mask_channel[] = {"A"};
    const struct relume_pack_view *view = &w->contents->view[index];
    if (!view->coded)
        add_codes(w, index, shared);
    if (!view->coded || !(view->depth_step > 0.0f))
        add_plane(w, "depth", index, view->depth, depth_channel, EXR_SAMPLE_FLOAT, depth_rows);
    if (!view->coded)
        writer_add_levels(w, index);
    if (view->coded || !view->coefficients->some.row)
        add_plane(w, "mask", index, view->mask, mask_channel, EXR_SAMPLE_HALF, mask_rows);
}
