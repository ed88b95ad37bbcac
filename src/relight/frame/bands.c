// bands.c - a whole view, of whose codes no more are in memory than a band
//
// Codes of many planes take several times the memory of the picture, and none of them is needed
// again where the renderer shows one picture. A band is whole blocks of the file, enough for every
// thread: rows, or tiles of lossy planes, each of which is decoded as a whole.
#include "core/base/log.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "format/coder/coding.h"
#include "format/pack/views.h"
#include "image/image/image.h"
#include "relight/frame/renderer.h"

#include <string.h>

// Bytes of codes that are worth a band, rows of a block, and blocks for each thread: one would
// leave most threads waiting for the last.
enum { BAND_BYTES = 1 << 24, BLOCK_ROWS = 32, BLOCKS_EACH = 2 };

static bool is_coded(const relume_renderer *r)
{
    return !strcmp(r->info->compression, "av1");
}

// Tiles that are lost are counted over the whole view.
bool frame_bands_suit(const relume_renderer *r)
{
    bool suits = r->params.once && r->shown == SHOWN_LIGHT && !r->info->has_shadow &&
                 r->params.pass == RELUME_PASS_COLOUR && !relume_pack_keeps_going(r->pack) &&
                 (r->info->tile || !is_coded(r));
    for (int i = 0; i < r->light_count; i++)  // an environment is summed once for each band
        suits &= r->lights[i].kind == RELUME_LIGHT_DIRECTIONAL;
    return suits;
}

// Width and height of a band, of whole blocks.
static void find_band(int size[2], const relume_renderer *r)
{
    const struct relume_pack_info *info = r->info;
    const bool coded = is_coded(r);
    const int threads = thread_count(r->params.threads);
    const int side = coded ? info->tile : larger_of(info->tile, BLOCK_ROWS);
    const int64_t pixel = info->books ? (int64_t)sizeof(uint16_t) * info->books
                                      : (int64_t)relume_storage_bytes(info->storage) * info->planes;
    const int64_t block = pixel * side * (coded ? side : info->width);
    const int64_t enough = coded ? threads : BLOCKS_EACH * threads;
    const int64_t blocks = BAND_BYTES / block > enough ? BAND_BYTES / block : enough;
    const int64_t across = coded ? (info->width + side - 1) / side : 1;
    const int64_t rows = blocks / across * side;
    size[0] = blocks < across ? (int)blocks * side : info->width;
    size[1] = rows < info->height ? larger_of((int)rows, side) : info->height;
}

static relume_status put_band(struct relume_image *out, relume_renderer *r, int view,
                              const struct relume_rect *at)
{
    const size_t row = 3 * (size_t)out->width, part = 3 * (size_t)at->width;
    float *to = out->data + row * (size_t)at->top + 3 * (size_t)at->left;
    struct relume_image band = {at->width, at->height, 3, .data = to};
    if (at->width == out->width)
        return frame_rows(&band, r, view, 0, at);
    band = (struct relume_image){0};
    const relume_status status = frame_rows(&band, r, view, 0, at);
    for (size_t y = 0; !status && y < (size_t)at->height; y++)
        memcpy(to + y * row, band.data + y * part, part * sizeof *to);
    relume_image_destroy(&band);
    return status;
}

relume_status frame_bands(struct relume_image *out, relume_renderer *r, int view)
{
    const int width = r->info->width, height = r->info->height;
    int size[2];
    find_band(size, r);
    relume_status status = relume_image_create(out, width, height, 3);
    for (int y = 0; !status && y < height; y += size[1]) {
        for (int x = 0; !status && x < width; x += size[0]) {
            const struct relume_rect at = {x, y, size[0] < width - x ? size[0] : width - x,
                                           size[1] < height - y ? size[1] : height - y};
            status = put_band(out, r, view, &at);
        }
        if (!status && !log_progress(r->params.log, "relighting", (double)y / height))
            status = RELUME_ECANCEL;
    }
    return status;
}
