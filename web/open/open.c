// open.c - a relume file that is dropped onto a page: read by the library, and handed out as what a
// published folder holds
//
// It is compiled to WebAssembly (make web) and runs in a worker, one file each. A page calls it by
// numbers and addresses alone. Planes are the file's own numbers (functions.h), not components of
// them: nothing is fitted and little is lost, so that it opens at once.
#include "open.h"

#include "core/base/half.h"
#include "core/base/memory.h"
#include "core/math/scalar.h"
#include "format/coder/coding.h"
#include "format/pack/views.h"
#include "site/publish/functions.h"
#include "site/publish/published.h"

#include <relume/context.h>

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define EXPORT __attribute__((visibility("default"), used))

// Planes of a page (published.js); views whose codes are held, and what they may take.
enum { MOST_PLANES = 192, MOST_HELD = 16, HELD_BYTES = 256 << 20 };
// What one view may take of the two gigabytes that there are.
#define MOST_BYTES (UINT64_C(1) << 30)

struct opened {
    struct relume_log log;
    struct relume_limits limits;
    struct published file;
    char *json;
    bool bytes;                 // codes of 8 bits, as they are; else halves
    int held[MOST_HELD], next;  // views whose codes are in memory, -1: none; whose place is next
    void *out;                  // what was handed out last
    double range[2];            // of the last depth
    char why[2048];
};

EXPORT void *open_allocate(int bytes)
{
    return mem_array((size_t)bytes, 1);
}

static void keep_sentence(void *user, enum relume_level level, const char *text)
{
    struct opened *o = user;
    if (level == RELUME_ERROR)
        snprintf(o->why, sizeof o->why, "%s", text);
}

static bool read_page(void *user, void *bytes, size_t size, uint64_t offset)
{
    (void)user;
    const bool good = page_read(bytes, (double)offset, (int)size) != 0;
    if (!good)
        errno = EIO;
    return good;
}

EXPORT const char *open_why(const struct opened *o)
{
    return o->why;
}

// Without a sentence of its own a failure gets one.
static bool fine(struct opened *o, relume_status status)
{
    if (status && !*o->why)
        snprintf(o->why, sizeof o->why, "%s: %s", o->file.name,
                 status == RELUME_ENOMEM ? "there is not enough memory for it"
                                         : relume_status_text(status));
    return !status;
}

// ---------------------------------------------------------------- views

static uint64_t bytes_of_view(const struct opened *o)
{
    const struct relume_pack_info *info = relume_pack_info(o->file.pack);
    return (uint64_t)info->width * (uint64_t)info->height *
           (info->books ? 2 * (uint64_t)info->books
                        : (uint64_t)o->file.levels.planes * relume_storage_bytes(info->storage));
}

// Views that were asked for last stay, as many as there is memory for.
static relume_status open_codes(const struct relume_codes **out, struct opened *o, int view)
{
    const uint64_t bytes = bytes_of_view(o);
    const int most = (int)(bytes * MOST_HELD > HELD_BYTES ? HELD_BYTES / (bytes + 1) : MOST_HELD);
    for (int i = 0; i < MOST_HELD; i++)
        if (o->held[i] == view)
            return relume_pack_codes(out, o->file.pack, view);
    if (o->held[o->next] >= 0)
        relume_pack_drop(o->file.pack, o->held[o->next]);
    o->held[o->next] = view;
    o->next = (o->next + 1) % larger_of(most, 1);
    return relume_pack_codes(out, o->file.pack, view);
}

// ---------------------------------------------------------------- what it is

__attribute__((format(printf, 2, 3))) static bool refuse(struct opened *o, const char *format, ...)
{
    va_list list;
    const int n = snprintf(o->why, sizeof o->why, "%s: ", o->file.name);
    va_start(list, format);
    if (n < (int)sizeof o->why)
        vsnprintf(o->why + n, sizeof o->why - (size_t)n, format, list);
    va_end(list);
    return false;
}

static bool can_be_shown(struct opened *o)
{
    const struct relume_pack_info *info = relume_pack_info(o->file.pack);
    const uint64_t bytes = bytes_of_view(o);
    if (info->slabs)
        return refuse(o, "slabs around an object are not shown in pages; expected a planar file, "
                         "one slab or a panorama");
    if (info->domain == RELUME_DOMAIN_DISPLAY && info->display.curve == RELUME_CURVE_LOG)
        return refuse(o, "its coefficients are logarithms, which pages do not know; relume "
                         "publish makes a page of it");
    if (o->file.levels.planes > MOST_PLANES)
        return refuse(
            o, "%d planes are too many, expected at most %d; relume publish makes a page of it",
            o->file.levels.planes, MOST_PLANES);
    if (!info->levels && bytes > MOST_BYTES)
        return refuse(o,
                      "a view of %d x %d pixels takes %.1f GB here, expected at most %.1f; relume "
                      "publish makes a page of it",
                      info->width, info->height, (double)bytes / 1e9, (double)MOST_BYTES / 1e9);
    return true;
}

// One function of the light for each number of the file.
static relume_status make_functions(struct common *c, const struct relume_coder_info *info,
                                    int planes)
{
    const size_t f = (size_t)info->functions, k = (size_t)planes;
    double *x = mem_zeroed(k, sizeof *x), *sum = mem_array(f, sizeof *sum);
    c->functions = info->functions;
    c->transform = mem_array(3 * k * f, sizeof *c->transform);
    c->mean = mem_zeroed(3 * f, sizeof *c->mean);
    const bool good = x && sum && c->transform && c->mean;
    for (size_t i = 0; good && i < 3 * k; i++) {
        memset(sum, 0, f * sizeof *sum);
        x[i % k] = 1.0;
        functions_add(sum, info, (int)(i / k), x);
        x[i % k] = 0.0;
        for (size_t j = 0; j < f; j++)
            c->transform[i * f + j] = (float)sum[j];
    }
    if (good && info->mean)
        memcpy(c->mean, info->mean, 3 * f * sizeof *c->mean);
    mem_free(x);
    mem_free(sum);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// Codes of the only view stay what they are; several views have each their own scale, and halves
// hold the numbers of all.
static relume_status make_steps(struct opened *o)
{
    const struct relume_pack_info *info = relume_pack_info(o->file.pack);
    struct levels *l = &o->file.levels;
    const struct relume_codes *codes = NULL;
    l->scale = mem_array((size_t)l->planes, sizeof *l->scale);
    l->offset = mem_zeroed((size_t)l->planes, sizeof *l->offset);
    relume_status status = l->scale && l->offset ? RELUME_OK : RELUME_ENOMEM;
    o->bytes = info->storage == RELUME_STORE_8 && info->views == 1 && !info->books &&
               !relume_coder_info(info->coder)->luminance;
    if (!status && o->bytes)
        status = open_codes(&codes, o, 0);
    // a plane of the mask is 0 or 1, and something between at reduced size
    for (int p = 0; !status && p < l->planes; p++) {
        l->scale[p] = codes && p < info->planes ? codes->scale[p] : 1.0f / 255.0f;
        l->offset[p] = codes && p < info->planes ? codes->offset[p] : 0.0f;
    }
    return status;
}

static relume_status describe(struct opened *o)
{
    struct published *f = &o->file;
    const struct relume_pack_info *info = relume_pack_info(f->pack);
    const struct relume_coder_info *coder = relume_coder_info(info->coder);
    relume_status status = functions_coder(&f->common.raw, coder, &o->log);
    f->layers = mem_zeroed((size_t)info->views, sizeof *f->layers);
    f->moving = mem_zeroed((size_t)info->views, sizeof *f->moving);
    if (!status && !(f->layers && f->moving))
        status = RELUME_ENOMEM;
    for (int i = 0; !status && i < info->views; i++)
        f->layers[i] = (struct layers){.depth = info->has_depth, .mask = info->has_mask};
    f->common.source.coding = source_coding(info->domain, info->display);
    f->levels.count = levels_count(info->width, info->height, info->views);
    f->first_level = f->levels.count - 1;
    if (!status)
        status = make_functions(&f->common, coder, f->levels.planes);
    if (!status)
        status = make_steps(o);
    if (status)
        return status;
    struct jwriter w = {.style = JSON_MARKUP};
    published_put_json(&w, f);
    jend(&w);
    o->json = jtake(&w, NULL);
    return o->json ? RELUME_OK : RELUME_ENOMEM;
}

EXPORT struct opened *open_file(char *name, double size)
{
    struct opened *o = mem_zeroed(1, sizeof *o);
    if (!o)
        return NULL;
    o->log = (struct relume_log){.message = keep_sentence, .user = o};
    o->limits = (struct relume_limits){.max_memory = MOST_BYTES};
    o->file.name = o->file.details.title = relume_printable(name);
    for (int i = 0; i < MOST_HELD; i++)
        o->held[i] = -1;
    const struct relume_reader reader = {.read = read_page, .size = (uint64_t)size};
    relume_status status = relume_pack_open(
        &o->file.pack, name,
        relume_pack_params(.log = &o->log, .limits = &o->limits, .threads = 1, .reader = &reader));
    if (fine(o, status)) {
        const struct relume_coder_info *coder =
            relume_coder_info(relume_pack_info(o->file.pack)->coder);
        o->file.levels.planes =
            coder->basis->joint ? coder->coefficients : 3 * coder->coefficients;
        if (can_be_shown(o))
            (void)fine(o, describe(o));
    }
    return o;
}

EXPORT const char *open_json(const struct opened *o)
{
    return o->json;
}

EXPORT int open_is_bytes(const struct opened *o)
{
    return o->bytes;
}

EXPORT void open_close(struct opened *o)
{
    relume_pack_destroy(&o->file.pack);
    relume_coder_destroy(&o->file.common.raw);
    mem_free(o->file.common.transform);
    mem_free(o->file.common.mean);
    mem_free(o->file.levels.scale);
    mem_free(o->file.levels.offset);
    mem_free(o->file.layers);
    mem_free(o->file.moving);
    mem_free(o->json);
    mem_free(o->out);
    mem_free(o);
}

// ---------------------------------------------------------------- its codes

// Where pixels of a tile come from: the codes of a level that the file has, `step` x `step` of
// which are one.
struct origin {
    const struct relume_codes *codes;
    struct relume_codes_part part;  // owned
    int left, top, width, height;   // of them
    int step;
};

static int side_at(int side, int level)
{
    for (int i = 0; i < level; i++)
        side = (side + 1) / 2;
    return side;
}

static relume_status find_origin(struct origin *from, struct opened *o, int view, int level,
                                 const struct relume_rect *tile)
{
    const struct relume_pack_info *info = relume_pack_info(o->file.pack);
    const int own = smaller_of(level, info->levels), step = 1 << (level - own);
    const int width = side_at(info->width, own), height = side_at(info->height, own);
    const struct relume_rect r = {tile->left * step, tile->top * step,
                                  smaller_of(tile->width * step, width - tile->left * step),
                                  smaller_of(tile->height * step, height - tile->top * step)};
    *from = (struct origin){.width = r.width, .height = r.height, .step = step};
    if (info->levels) {
        const relume_status status =
            relume_pack_codes_level(&from->part, o->file.pack, view, own, &r);
        from->codes = &from->part.codes;
        return status;
    }
    from->left = r.left;
    from->top = r.top;
    return open_codes(&from->codes, o, view);
}

// Number `n` of the pixels of a row.
static void read_row(const struct origin *from, int n, int y, float *out, float *colour)
{
    const struct relume_coder_info *info = relume_coder_info(from->codes->coder);
    const size_t count = (size_t)from->width;
    const size_t first = (size_t)(from->top + y) * (size_t)from->codes->width + (size_t)from->left;
    relume_codes_plane(from->codes, info->luminance ? n / 3 : n, first, count, out);
    if (!info->luminance)
        return;
    relume_codes_plane(from->codes, info->coefficients + n % 3, first, count, colour);
    for (size_t x = 0; x < count; x++)
        out[x] *= colour[x];
}

// The mean of the pixels that each one of row `y` of the tile covers, in sum[width].
static void mean_row(const struct origin *from, int n, int y, int width, float *row, float *sum)
{
    const int step = from->step, rows = smaller_of(step, from->height - y * step);
    memset(sum, 0, (size_t)width * sizeof *sum);
    for (int i = 0; i < rows; i++) {
        read_row(from, n, y * step + i, row, row + from->width);
        for (int x = 0; x < from->width; x++)
            sum[x / step] += row[x];
    }
    for (int x = 0; x < width; x++)
        sum[x] /= (float)(rows * smaller_of(step, from->width - x * step));
}

static void put_row(const struct opened *o, int n, const float *row, int width, void *to)
{
    const float scale = o->file.levels.scale[n], offset = o->file.levels.offset[n];
    for (int x = 0; x < width; x++)
        if (o->bytes)
            ((uint8_t *)to)[4 * x] =
                (uint8_t)fminf(fmaxf(rintf((row[x] - offset) / scale), 0.0f), 255.0f);
        else
            ((uint16_t *)to)[4 * x] = half_from_float(fminf(fmaxf(row[x], -65504.0f), 65504.0f));
}

// A tile as the textures of a page are: layers of red, green and blue, and nothing as alpha.
static void *make_tile(const struct opened *o, const struct origin *from, int width, int height)
{
    const int planes = o->file.levels.planes;
    const size_t pixels = (size_t)width * (size_t)height, code = o->bytes ? 1 : 2;
    char *out = mem_zeroed((size_t)(planes + 2) / 3 * pixels, 4 * code);
    float *row = mem_array(2 * (size_t)from->width, sizeof *row);
    float *sum = mem_array((size_t)width, sizeof *sum);
    for (int n = 0; out && row && sum && n < planes; n++)
        for (int y = 0; y < height; y++) {
            const size_t at = (size_t)(n / 3) * pixels + (size_t)y * (size_t)width;
            mean_row(from, n, y, width, row, sum);
            put_row(o, n, sum, width, out + (4 * at + (size_t)(n % 3)) * code);
        }
    const bool good = out && row && sum;
    mem_free(row);
    mem_free(sum);
    if (!good)
        mem_free(out);
    return good ? out : NULL;
}

EXPORT const void *open_tile(struct opened *o, int view, int level, int x, int y)
{
    const struct relume_pack_info *info = relume_pack_info(o->file.pack);
    const int width = side_at(info->width, level), height = side_at(info->height, level);
    const struct relume_rect tile = {x * LEVELS_TILE, y * LEVELS_TILE,
                                     smaller_of(LEVELS_TILE, width - x * LEVELS_TILE),
                                     smaller_of(LEVELS_TILE, height - y * LEVELS_TILE)};
    struct origin from;
    relume_status status = find_origin(&from, o, view, level, &tile);
    mem_free(o->out);
    o->out = status ? NULL : make_tile(o, &from, tile.width, tile.height);
    relume_codes_part_destroy(&from.part);
    if (!status && !o->out)
        status = RELUME_ENOMEM;
    return fine(o, status) ? o->out : NULL;
}

// ---------------------------------------------------------------- depth and mask

EXPORT const double *open_range(const struct opened *o)
{
    return o->range;
}

EXPORT const void *open_picture(struct opened *o, int view, int mask)
{
    struct relume_image image = {0};
    struct layers l = {0};
    relume_status status = mask ? relume_pack_mask(&image, o->file.pack, view)
                                : relume_pack_depth(&image, o->file.pack, view);
    const size_t pixels = (size_t)image.width * (size_t)image.height;
    mem_free(o->out);
    uint8_t *out = o->out = status || !pixels ? NULL : mem_zeroed(pixels, 4);
    if (!mask && out)
        layers_find_steps(&l, &image);
    for (size_t i = 0; out && i < pixels; i++) {
        const int v = mask ? (image.data[i] > 0.5f ? 0xffff : 0) : layers_code(&l, image.data[i]);
        out[4 * i] = (uint8_t)(v >> 8);
        out[4 * i + 1] = (uint8_t)(v & 255);
        out[4 * i + 3] = 255;
    }
    o->range[0] = l.depth_min;
    o->range[1] = l.depth_step;
    if (!status && !out)
        status = pixels ? RELUME_ENOMEM : RELUME_EDAMAGED;
    relume_image_destroy(&image);
    return fine(o, status) ? out : NULL;
}

// ---------------------------------------------------------------- what moves

EXPORT const float *open_model(struct opened *o, int view)
{
    struct relume_image model;
    relume_status status = relume_pack_info(o->file.pack)->has_gloss
                               ? relume_pack_gloss(&model, o->file.pack, view)
                               : relume_pack_shadow(&model, o->file.pack, view);
    const size_t n = (size_t)model.width * (size_t)model.height * MOVING_NUMBERS;
    mem_free(o->out);
    o->out = status || !model.data ? NULL : mem_copy(model.data, n, sizeof *model.data);
    if (!status && !o->out)
        status = RELUME_ENOMEM;
    relume_image_destroy(&model);
    return fine(o, status) ? o->out : NULL;
}
