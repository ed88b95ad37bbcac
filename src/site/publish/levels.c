// levels.c - the planes of a view as a pyramid of tiles
#include "site/publish/levels.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
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

// A level on its way: planes as they lie in memory, and its tiles.
struct level {
    const struct levels *how;
    int width, height, columns, rows;
    const float *plane[PUBLISH_MOST_PLANES];
    const struct relume_log *log;
    bool kept;                // it goes into the site
    uint8_t **bytes, **avif;  // [tiles]
    size_t *size, *avif_size;
    relume_status *status;
    uint8_t *codes;
};

static void put_word(uint8_t *to, size_t v)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(v >> (8 * i));
}

// One sheet of a tile; its planes are copied into `room`.
static struct sheet cut(const struct level *l, const struct relume_rect *at, int first, float *room)
{
    struct sheet s = {.width = at->width,
                      .height = at->height,
                      .planes = smaller_of(l->how->planes - first, SHEET_PLANES),
                      .own = l->how->guided};
    const size_t width = (size_t)at->width, pixels = width * (size_t)at->height;
    for (int p = 0; p < s.planes; p++) {
        float *to = room + (size_t)p * pixels;
        for (int y = 0; y < at->height; y++)
            memcpy(to + (size_t)y * width,
                   l->plane[first + p] + (size_t)(at->top + y) * (size_t)l->width +
                       (size_t)at->left,
                   width * sizeof *to);
        s.plane[p] = to;
        s.minimum[p] = l->how->minimum[first + p];
        s.maximum[p] = l->how->maximum[first + p];
        s.weight[p] = 1.0;
    }
    return s;
}

static relume_status keep_codes(const struct level *l, const struct relume_rect *at, int first,
                                const struct sheet_result *sheet)
{
    struct jpeg_codes decoded = {0};
    const size_t pixels = (size_t)l->width * (size_t)l->height, width = (size_t)at->width;
    const relume_status status =
        jpeg_decode(&decoded, sheet->bytes, sheet->size, "tile", NULL, NULL);
    for (int p = 0; !status && p < smaller_of(l->how->planes - first, SHEET_PLANES); p++)
        for (int y = 0; y < at->height; y++)
            memcpy(l->codes + (size_t)(first + p) * pixels +
                       (size_t)(at->top + y) * (size_t)l->width + (size_t)at->left,
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
static relume_status find_gain(float *gain, const struct sheet *s, float *room, double step)
{
    const size_t n = (size_t)s->width * (size_t)s->height;
    struct sheet alone = *s;  // with the ranges of all three, which its codes depend on
    struct sheet_result coded;
    struct jpeg_codes decoded = {0};
    for (size_t i = 0; i < n; i++)
        room[i] = guide_root(room[i]);
    alone.plane[1] = alone.plane[2] = room;
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
static relume_status follow_guide(const struct sheet *s, float *room, float *gain, bool first,
                                  double step)
{
    const size_t n = (size_t)s->width * (size_t)s->height;
    const relume_status status = first ? find_gain(gain, s, room, step) : RELUME_OK;
    for (size_t i = first ? n : 0; !status && i < (size_t)s->planes * n; i++)
        room[i] /= gain[i % n];
    return status;
}

static bool has_avif(const struct level *l)
{
    return l->kept && l->how->layers != RELUME_PUBLISH_JPEG;
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
static relume_status encode_avif(const struct level *l, size_t item, const struct relume_rect *at,
                                 const struct sheet_result *jpeg, float *room)
{
    const int sheets = (l->how->planes + SHEET_PLANES - 1) / SHEET_PLANES;
    const size_t n = (size_t)at->width * (size_t)at->height;
    struct sheet_result *result = mem_zeroed((size_t)sheets, sizeof *result);
    uint8_t *codes = mem_array(SHEET_PLANES * n, 1);
    float *gain = room + SHEET_PLANES * n;
    int quantiser = FIRST_QUANTISER;
    relume_status status = result && codes ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < sheets; i++) {
        const struct sheet s = cut(l, at, SHEET_PLANES * i, room);
        if (l->how->guided)
            status = follow_guide(&s, room, gain, i == 0, l->how->step);
        if (!status)
            status = avif_encode(&result[i], codes, &s, &jpeg[i], &quantiser, l->log);
        const bool taken = !status && result[i].size < jpeg[i].size;
        for (size_t k = 0; taken && l->how->guided && i == 0 && k < n; k++)
            gain[k] = guide_gain((float)((codes[k] / 255.0 - jpeg->bias[0]) * jpeg->scale[0]));
        if (!status)
            status = keep_smaller(&result[i], &jpeg[i]);
    }
    if (!status)
        status = levels_join(result, sheets, &l->avif[item], &l->avif_size[item]);
    for (int i = 0; result && i < sheets; i++)
        mem_free(result[i].bytes);
    mem_free(result);
    mem_free(codes);
    return status;
}

static void encode_tile(void *context, size_t item, int worker)
{
    (void)worker;
    const struct level *l = context;
    const int x = (int)item % l->columns * LEVELS_TILE, y = (int)item / l->columns * LEVELS_TILE;
    const struct relume_rect at = {x, y, smaller_of(LEVELS_TILE, l->width - x),
                                   smaller_of(LEVELS_TILE, l->height - y)};
    const int sheets = (l->how->planes + SHEET_PLANES - 1) / SHEET_PLANES;
    struct sheet_result *result = mem_zeroed((size_t)sheets, sizeof *result);
    const size_t n = (size_t)at.width * (size_t)at.height;
    float *room = mem_array((SHEET_PLANES + 1) * n, sizeof *room);
    relume_status status = result && room ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < sheets; i++) {
        const struct sheet s = cut(l, &at, SHEET_PLANES * i, room);
        if (l->how->guided)
            status = follow_guide(&s, room, room + SHEET_PLANES * n, i == 0, l->how->step);
        if (!status)
            status = sheet_encode(&result[i], &s, l->how->step);
        if (!status && l->codes)
            status = keep_codes(l, &at, SHEET_PLANES * i, &result[i]);
        if (!status && !item)
            say_scales(l->how, SHEET_PLANES * i, &result[i]);
    }
    if (!status)
        status = levels_join(result, sheets, &l->bytes[item], &l->size[item]);
    if (!status && has_avif(l))
        status = encode_avif(l, item, &at, result, room);
    for (int i = 0; result && i < sheets; i++)
        mem_free(result[i].bytes);
    mem_free(result);
    mem_free(room);
    l->status[item] = status;
}

static relume_status save_tiles(const struct site *site, const char *folder, int number,
                                const struct level *l, const char *ending, bool avif,
                                uint64_t *bytes)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < l->columns * l->rows; i++) {
        const size_t size = avif ? l->avif_size[i] : l->size[i];
        *bytes += size;
        if (!site)
            continue;
        char *name =
            mem_format("%s/%d_%d_%d%s", folder, number, i % l->columns, i / l->columns, ending);
        status = name ? site_save_data(site, name, avif ? l->avif[i] : l->bytes[i], size)
                      : RELUME_ENOMEM;
        mem_free(name);
    }
    return status;
}

static relume_status write_level(const struct site *site, const char *folder, int number,
                                 struct level *l, uint64_t *bytes, uint64_t *avif)
{
    l->columns = (l->width + LEVELS_TILE - 1) / LEVELS_TILE;
    l->rows = (l->height + LEVELS_TILE - 1) / LEVELS_TILE;
    const size_t n = (size_t)l->columns * (size_t)l->rows;
    l->bytes = mem_zeroed(n, sizeof *l->bytes);
    l->avif = mem_zeroed(n, sizeof *l->avif);
    l->size = mem_zeroed(n, sizeof *l->size);
    l->avif_size = mem_zeroed(n, sizeof *l->avif_size);
    l->status = mem_zeroed(n, sizeof *l->status);
    relume_status status =
        l->bytes && l->avif && l->size && l->avif_size && l->status ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        thread_for(l->how->threads, n, encode_tile, l);
    for (size_t i = 0; !status && i < n; i++)
        status = l->status[i];
    if (!status && (!site || l->how->layers != RELUME_PUBLISH_AVIF))
        status = save_tiles(site, folder, number, l, ".bin", false, bytes);
    if (!status && has_avif(l))
        status = save_tiles(site, folder, number, l, ".avif.bin", true, avif);
    for (size_t i = 0; l->bytes && l->avif && i < n; i++) {
        mem_free(l->bytes[i]);
        mem_free(l->avif[i]);
    }
    mem_free(l->bytes);
    mem_free(l->avif);
    mem_free(l->size);
    mem_free(l->avif_size);
    mem_free(l->status);
    return status;
}

// The next level, in memory of its own, which takes the place of the last one's.
static relume_status go_up(struct level *l, float **own)
{
    for (int p = 0; p < l->how->planes; p++) {
        float *half = plane_halved(l->plane[p], l->width, l->height);
        if (!half)
            return RELUME_ENOMEM;
        mem_free(own[p]);
        l->plane[p] = own[p] = half;
    }
    l->width = (l->width + 1) / 2;
    l->height = (l->height + 1) / 2;
    return RELUME_OK;
}

relume_status levels_write(const struct site *site, const char *name, const struct planes *p,
                           const struct levels *how, uint64_t *bytes, uint64_t *avif,
                           uint8_t *codes)
{
    struct level l = {.how = how,
                      .width = p->width,
                      .height = p->height,
                      .kept = true,
                      .log = site->log,
                      .codes = codes};
    float **own = mem_zeroed((size_t)how->planes, sizeof *own);
    for (int i = 0; i < how->planes; i++)
        l.plane[i] = planes_at(p, i);
    relume_status status = own ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < how->count; i++) {
        status = write_level(site, name, i, &l, &bytes[i], &avif[i]);
        l.codes = NULL;
        if (!status && i + 1 < how->count)
            status = go_up(&l, own);
    }
    for (int i = 0; own && i < how->planes; i++)
        mem_free(own[i]);
    mem_free(own);
    return status;
}

relume_status levels_try(const struct planes *p, const struct levels *how, uint64_t *bytes,
                         uint8_t *codes)
{
    struct level l = {.how = how, .width = p->width, .height = p->height, .codes = codes};
    for (int i = 0; i < how->planes; i++)
        l.plane[i] = planes_at(p, i);
    return write_level(NULL, NULL, 0, &l, bytes, NULL);
}
