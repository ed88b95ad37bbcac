// levels.c - the planes of a view as a pyramid of tiles
#include "site/publish/levels.h"

#include "core/base/memory.h"
#include "core/math/scalar.h"
#include "exchange/formats/tile_pyramid.h"
#include "image/image/jpeg.h"
#include "site/publish/avif.h"
#include "site/publish/guide.h"

#include <string.h>

// Where the search for that of AVIF begins.
enum { FIRST_QUANTISER = 12 };

int levels_count(int width, int height, int views)
{
    const int last = views > 1 ? 64 : 128;
    int n = 1;
    for (int side = larger_of(width, height); side > last; side = (side + 1) / 2)
        n++;
    return n;
}

// Files of a tile.
enum { FILE_JPEG, FILE_AVIF };

// A pyramid being written, or level 0 being tried.
struct levels_writer {
    const struct levels *how;
    const struct site *site;  // NULL: nothing is saved
    const char *folder;
    const struct relume_log *log;
    uint8_t *codes;          // of level 0, or NULL
    uint64_t *bytes, *avif;  // [levels]; avif is NULL without a site
};

static size_t pixels_of(const struct tile *tile)
{
    return (size_t)tile->at.width * (size_t)tile->at.height;
}

static int sheets_of(const struct levels_writer *w)
{
    return (w->how->planes + SHEET_PLANES - 1) / SHEET_PLANES;
}

static void put_word(uint8_t *to, size_t v)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(v >> (8 * i));
}

// One sheet of a tile; its planes are copied into `scratch`.
static struct sheet cut(const struct levels_writer *w, const struct tile *tile, int first,
                        float *scratch)
{
    struct sheet s = {.width = tile->at.width,
                      .height = tile->at.height,
                      .planes = smaller_of(w->how->planes - first, SHEET_PLANES),
                      .own = w->how->guided};
    for (int p = 0; p < s.planes; p++) {
        float *to = scratch + (size_t)p * pixels_of(tile);
        tile_copy(to, tile, first + p);
        s.plane[p] = to;
        s.minimum[p] = w->how->minimum[first + p];
        s.maximum[p] = w->how->maximum[first + p];
        s.weight[p] = 1.0;
    }
    return s;
}

static relume_status keep_codes(const struct levels_writer *w, const struct tile *tile, int first,
                                const struct sheet_result *sheet)
{
    struct jpeg_codes decoded = {0};
    const struct relume_rect *at = &tile->at;
    const size_t stride = (size_t)tile->level->width, width = (size_t)at->width;
    const size_t pixels = stride * (size_t)tile->level->height;
    const relume_status status =
        jpeg_decode(&decoded, sheet->bytes, sheet->size, "tile", NULL, NULL);
    for (int p = 0; !status && p < smaller_of(w->how->planes - first, SHEET_PLANES); p++)
        for (int y = 0; y < at->height; y++)
            memcpy(w->codes + (size_t)(first + p) * pixels + (size_t)(at->top + y) * stride +
                       (size_t)at->left,
                   decoded.data + ((size_t)p * (size_t)at->height + (size_t)y) * width, width);
    jpeg_codes_free(&decoded);
    return status;
}

relume_status levels_join(const struct sheet_result *sheet, int sheets, uint8_t **out, size_t *size)
{
    size_t at = 4 + 4 * (size_t)sheets;
    *size = at;
    for (int i = 0; i < sheets; i++)
        *size += sheet[i].size;
    *out = mem_array(*size, 1);
    if (!*out)
        return RELUME_ENOMEM;
    put_word(*out, (size_t)sheets);
    for (int i = 0; i < sheets; i++) {
        put_word(*out + 4 + 4 * i, sheet[i].size);
        memcpy(*out + at, sheet[i].bytes, sheet[i].size);
        at += sheet[i].size;
    }
    return RELUME_OK;
}

static void say_scales(const struct levels *how, int first, const struct sheet_result *sheet)
{
    for (int p = 0; p < smaller_of(how->planes - first, SHEET_PLANES); p++) {
        how->scale[first + p] = (float)(sheet->scale[p] / 255.0);
        how->offset[first + p] = (float)(-sheet->bias[p] * sheet->scale[p]);
    }
}

// The first plane of the first sheet becomes that of the guide; the gain of each pixel is what
// readers will make of it.
static relume_status find_gain(float *gain, const struct sheet *s, float *scratch, double step)
{
    const size_t n = (size_t)s->width * (size_t)s->height;
    struct sheet alone = *s;  // with the ranges of all three, which its codes depend on
    struct sheet_result coded;
    struct jpeg_codes decoded = {0};
    for (size_t i = 0; i < n; i++)
        scratch[i] = guide_root(scratch[i]);
    alone.plane[1] = alone.plane[2] = scratch;
    relume_status status = sheet_encode(&coded, &alone, step);
    if (!status)
        status = jpeg_decode(&decoded, coded.bytes, coded.size, "tile", NULL, NULL);
    for (size_t i = 0; !status && i < n; i++)
        gain[i] = guide_gain((float)((decoded.data[i] / 255.0 - coded.bias[0]) * coded.scale[0]));
    jpeg_codes_free(&decoded);
    mem_free(coded.bytes);
    return status;
}

// What is coded of the planes of a sheet that have a guide; `gain` is found from the first sheet.
static relume_status follow_guide(const struct sheet *s, float *scratch, float *gain, bool first,
                                  double step)
{
    const size_t n = (size_t)s->width * (size_t)s->height;
    const relume_status status = first ? find_gain(gain, s, scratch, step) : RELUME_OK;
    for (size_t i = first ? n : 0; !status && i < (size_t)s->planes * n; i++)
        scratch[i] /= gain[i % n];
    return status;
}

// JPEG stays where AVIF is larger.
static relume_status keep_smaller(struct sheet_result *avif, const struct sheet_result *jpeg)
{
    if (avif->size < jpeg->size)
        return RELUME_OK;
    mem_free(avif->bytes);
    avif->bytes = mem_copy(jpeg->bytes, jpeg->size, 1);
    avif->size = jpeg->size;
    return avif->bytes ? RELUME_OK : RELUME_ENOMEM;
}

// The sheets of a tile again, as AVIF. The guide of the later ones is what that makes of the first.
static relume_status encode_avif(struct tile_file *out, const struct levels_writer *w,
                                 const struct tile *tile, const struct sheet_result *jpeg,
                                 float *scratch)
{
    const int sheets = sheets_of(w);
    const size_t n = pixels_of(tile);
    struct sheet_result *result = mem_zeroed((size_t)sheets, sizeof *result);
    uint8_t *codes = mem_array(SHEET_PLANES * n, 1);
    float *gain = scratch + SHEET_PLANES * n;
    int quantiser = FIRST_QUANTISER;
    relume_status status = result && codes ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < sheets; i++) {
        const struct sheet s = cut(w, tile, SHEET_PLANES * i, scratch);
        if (w->how->guided)
            status = follow_guide(&s, scratch, gain, i == 0, w->how->step);
        if (!status)
            status = avif_encode(&result[i], codes, &s, &jpeg[i], &quantiser, w->log);
        const bool taken = !status && result[i].size < jpeg[i].size;
        for (size_t k = 0; taken && w->how->guided && i == 0 && k < n; k++)
            gain[k] = guide_gain((float)((codes[k] / 255.0 - jpeg->bias[0]) * jpeg->scale[0]));
        if (!status)
            status = keep_smaller(&result[i], &jpeg[i]);
    }
    if (!status)
        status = levels_join(result, sheets, &out->bytes, &out->size);
    for (int i = 0; result && i < sheets; i++)
        mem_free(result[i].bytes);
    mem_free(result);
    mem_free(codes);
    return status;
}

static relume_status encode_jpeg(struct sheet_result *result, const struct levels_writer *w,
                                 const struct tile *tile, float *scratch)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < sheets_of(w); i++) {
        const struct sheet s = cut(w, tile, SHEET_PLANES * i, scratch);
        if (w->how->guided)
            status = follow_guide(&s, scratch, scratch + SHEET_PLANES * pixels_of(tile), i == 0,
                                  w->how->step);
        if (!status)
            status = sheet_encode(&result[i], &s, w->how->step);
        if (!status && w->codes && !tile->level->number)
            status = keep_codes(w, tile, SHEET_PLANES * i, &result[i]);
        if (!status && !tile->column && !tile->row)
            say_scales(w->how, SHEET_PLANES * i, &result[i]);
    }
    return status;
}

static relume_status encode_tile(void *user, const struct tile *tile, struct tile_file *files)
{
    const struct levels_writer *w = user;
    const int sheets = sheets_of(w);
    struct sheet_result *result = mem_zeroed((size_t)sheets, sizeof *result);
    float *scratch = mem_array((SHEET_PLANES + 1) * pixels_of(tile), sizeof *scratch);
    const bool has_jpeg = !w->site || w->how->layers != RELUME_PUBLISH_AVIF;
    const bool has_avif = w->site && w->how->layers != RELUME_PUBLISH_JPEG;
    relume_status status =
        result && scratch ? encode_jpeg(result, w, tile, scratch) : RELUME_ENOMEM;
    if (!status && has_jpeg)
        status = levels_join(result, sheets, &files[FILE_JPEG].bytes, &files[FILE_JPEG].size);
    if (!status && has_avif)
        status = encode_avif(&files[FILE_AVIF], w, tile, result, scratch);
    for (int i = 0; result && i < sheets; i++)
        mem_free(result[i].bytes);
    mem_free(result);
    mem_free(scratch);
    return status;
}

static relume_status save_tile(void *user, const struct tile *tile, int number,
                               const struct tile_file *file)
{
    const struct levels_writer *w = user;
    const int level = tile->level->number;
    (number == FILE_AVIF ? w->avif : w->bytes)[level] += file->size;
    if (!w->site)
        return RELUME_OK;
    char *name = mem_format("%s/%d_%d_%d%s", w->folder, level, tile->column, tile->row,
                            number == FILE_AVIF ? ".avif.bin" : ".bin");
    const relume_status status =
        name ? site_save_data(w->site, name, file->bytes, file->size) : RELUME_ENOMEM;
    mem_free(name);
    return status;
}

static relume_status write_pyramid(struct levels_writer *w, const struct planes *p, int levels)
{
    const float *plane[PUBLISH_MOST_PLANES];
    for (int i = 0; i < w->how->planes; i++)
        plane[i] = planes_at(p, i);
    return tile_pyramid_write(&(struct tile_pyramid){
        .plane = plane,
        .planes = w->how->planes,
        .width = p->width,
        .height = p->height,
        .levels = levels,
        .side = LEVELS_TILE,
        .threads = w->how->threads,
        .user = w,
        .encode = encode_tile,
        .save = save_tile,
    });
}

relume_status levels_write(const struct site *site, const char *name, const struct planes *p,
                           const struct levels *how, uint64_t *bytes, uint64_t *avif,
                           uint8_t *codes)
{
    struct levels_writer w = {.how = how,
                              .site = site,
                              .folder = name,
                              .log = site->log,
                              .codes = codes,
                              .bytes = bytes,
                              .avif = avif};
    return write_pyramid(&w, p, how->count);
}

relume_status levels_try(const struct planes *p, const struct levels *how, uint64_t *bytes,
                         uint8_t *codes)
{
    struct levels_writer w = {.how = how, .bytes = bytes, .codes = codes};
    return write_pyramid(&w, p, 1);
}
