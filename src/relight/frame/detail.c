// detail.c - a rectangle of a view in another size, of which no more is read and relit at once than
// a band of rows: of the view itself, or of the reduced level that is fine enough
#include "core/base/log.h"
#include "format/pack/views.h"
#include "relight/frame/renderer.h"

#include <math.h>
#include <string.h>

// Rows that are there at once.
enum { BAND = 256 };

struct detail {
    relume_renderer *r;
    int view, level;
    double from[4];           // left, top, width, height of the wanted in pixels of the level
    struct relume_rect rect;  // whole pixels that it takes
    struct relume_scale_params scale;
};

// Whether `side` pixels at a level show `pixels` well. Between the level's pixels there is only
// what a mean of them says: from 1.4 a pixel on that is closer than 42 dB to the mean of the view's
// own, and where the two grids are the same but for an eighth of a pixel it is that mean.
static bool is_fine(int first, int side, int level, int pixels)
{
    const double each = ldexp((double)side / pixels, -level), at = ldexp(first, -level);
    const bool same = fabs(at - round(at)) + (each - 1.0) * pixels <= 0.125;
    return each >= 1.4 || (each >= 1.0 && same);
}

static bool is_coded(const relume_renderer *r)
{
    return !strcmp(r->info->compression, "av1");
}

// The coarsest level that is fine enough for the picture. The first one of coded planes is made of
// the view, and not as well.
static int find_level(const relume_renderer *r, const struct relume_rect *rect, int width,
                      int height)
{
    int level = 0;
    while (level < r->info->levels && is_fine(rect->left, rect->width, level + 1, width) &&
           is_fine(rect->top, rect->height, level + 1, height))
        level++;
    return level == 1 && is_coded(r) ? 0 : level;
}

bool frame_detail_suits(const relume_renderer *r, const struct relume_rect *rect, int width,
                        int height)
{
    bool barred = false;
    for (int i = 0; i < r->light_count; i++)
        barred |= relume_light_is_near(r->lights[i].kind);
    return (r->params.once || find_level(r, rect, width, height) > 0) && r->shown == SHOWN_LIGHT &&
           !barred && renderer_goes_by_texels(r) && width < rect->width;
}

// With what a mean at the border reaches.
static void find_rect(struct detail *d, const struct relume_rect *rect, int width, int height)
{
    const double scale = ldexp(1.0, -d->level);
    const int whole[] = {rect->left, rect->top, rect->width, rect->height};
    int size[2], begin[2], end[2];
    relume_pack_level_size(&size[0], &size[1], d->r->pack, d->level);
    for (int i = 0; i < 4; i++)
        d->from[i] = whole[i] * scale;
    const double reach[] = {d->from[2] / width + 2.0, d->from[3] / height + 2.0};
    for (int i = 0; i < 2; i++) {
        begin[i] = (int)fmax(floor(d->from[i] - reach[i]), 0.0);
        begin[i] -= d->r->info->tile ? begin[i] % d->r->info->tile : 0;  // bands of whole tiles
        end[i] = (int)fmin(ceil(d->from[i] + d->from[i + 2] + reach[i]), size[i]);
        d->from[i] -= begin[i];
    }
    d->rect = (struct relume_rect){begin[0], begin[1], end[0] - begin[0], end[1] - begin[1]};
}

static relume_status narrow_band(struct relume_image *tall, const struct detail *d, int row,
                                 int rows)
{
    const struct relume_rect band = {d->rect.left, d->rect.top + row, d->rect.width, rows};
    const size_t line = 3 * (size_t)tall->width;
    struct relume_scale_params across = d->scale;
    struct relume_image relit = {0}, narrow = {0};
    across.from[1] = 0.0;
    across.from[3] = rows;
    relume_status status = frame_rows(&relit, d->r, d->view, d->level, &band);
    if (!status)
        status = relume_image_scale(&narrow, &relit, tall->width, rows, &across);
    if (!status)
        memcpy(tall->data + line * (size_t)row, narrow.data,
               line * (size_t)rows * sizeof *tall->data);
    relume_image_destroy(&relit);
    relume_image_destroy(&narrow);
    return status;
}

// Both axes are scaled one after the other, so bands make the same picture bit by bit.
relume_status frame_detail(struct relume_image *out, relume_renderer *r, int view,
                           const struct relume_rect *rect, int width, int height)
{
    struct detail d = {.r = r,
                       .view = view,
                       .level = find_level(r, rect, width, height),
                       .scale = frame_scaling(r)};
    struct relume_image tall;
    find_rect(&d, rect, width, height);
    const int band = r->info->tile > BAND ? r->info->tile : BAND;
    const bool all = rect->width == r->info->width && rect->height == r->info->height;
    const bool round = d.scale.wrap || d.scale.tiles > 1;
    if (!all) {
        d.scale.wrap = false;
        d.scale.tiles = 1;
    }
    if (!all || !round)
        memcpy(d.scale.from, d.from, sizeof d.from);
    relume_status status = relume_image_create(&tall, width, d.rect.height, 3);
    for (int y = 0; !status && y < d.rect.height; y += band) {
        const int left = d.rect.height - y;
        status = narrow_band(&tall, &d, y, left < band ? left : band);
        if (!status && !log_progress(r->params.log, "relighting", (double)y / d.rect.height))
            status = RELUME_ECANCEL;
    }
    d.scale.from[0] = 0.0;
    d.scale.from[2] = width;
    if (!status)
        status = relume_image_scale(out, &tall, width, height, &d.scale);
    relume_image_destroy(&tall);
    return status;
}
