// convolver.c - pictures convolved through their spectra, tile by tile (overlap-save)
//
// A tile is `core` pixels and as much around it as the kernel reaches. A picture that fits into one
// tile and is black outside needs that margin once: what wraps around is black. The kernel lies
// in the first rows and columns, so that the others cost nothing; the result lies as much
// farther right and below.
#include "relight/eye/glare.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/fft2d.h"
#include "core/math/scalar.h"

#include <math.h>
#include <string.h>

enum { ONE_TILE = 1 << 24, TILE = 2048 };  // pixels of a transform; side of one of many

struct convolver {
    int width, height, reach, threads;
    enum relume_glare_border border;
    int reach_x, reach_y;  // of the kernel within the picture
    int margin;            // left of and above a tile
    int core_w, core_h;    // of a tile
    int tiles_x, tiles_y;
    int fft_w, fft_h;
    fft2d *fft;
    float *spectrum;  // in the making
    float *kept[3];   // column after column: of the only tile, or, in [0], of the kernel
    bool known;       // kept[] are of the last picture
};

static void plan_one(convolver *c, int margin)
{
    c->core_w = c->width;
    c->core_h = c->height;
    c->margin = margin;
    // Without a margin no light comes from farther than the picture is wide.
    c->reach_x = margin || c->reach < c->width ? c->reach : c->width - 1;
    c->reach_y = margin || c->reach < c->height ? c->reach : c->height - 1;
    // The margin is zero and serves both ends, or there is one on each side.
    c->fft_w = fft_good_size(c->width + c->reach_x + margin);
    c->fft_h = fft_good_size(c->height + c->reach_y + margin);
}

static void plan_many(convolver *c, int least)
{
    const int side = 4 * c->reach > least ? 4 * c->reach : least;
    c->margin = c->reach_x = c->reach_y = c->reach;
    c->fft_w = fft_good_size(side < c->width + 2 * c->reach ? side : c->width + 2 * c->reach);
    c->fft_h = fft_good_size(side < c->height + 2 * c->reach ? side : c->height + 2 * c->reach);
    c->core_w = c->fft_w - 2 * c->reach;
    c->core_h = c->fft_h - 2 * c->reach;
}

static relume_status create(convolver **out, convolver plan)
{
    convolver *const c = mem_zeroed(1, sizeof *c);
    *out = c;
    if (!c)
        return RELUME_ENOMEM;
    *c = plan;
    c->tiles_x = (c->width + c->core_w - 1) / c->core_w;
    c->tiles_y = (c->height + c->core_h - 1) / c->core_h;
    const int kept = c->tiles_x * c->tiles_y == 1 ? 3 : 1;
    bool good = !fft2d_create(&c->fft, c->fft_w, c->fft_h, true, c->threads);
    for (int k = 0; good && k < kept; k++)
        good = (c->kept[k] = mem_array(fft2d_size(c->fft), sizeof(float))) != NULL;
    good = good && (c->spectrum = mem_array(fft2d_size(c->fft), sizeof(float)));
    if (!good)
        convolver_destroy(out);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

relume_status convolver_create(convolver **out, int width, int height, int reach,
                               enum relume_glare_border border, int threads)
{
    convolver c = {
        .width = width, .height = height, .reach = reach, .threads = threads, .border = border};
    plan_one(&c, border == RELUME_GLARE_ZERO ? 0 : reach);
    if ((int64_t)c.fft_w * c.fft_h > ONE_TILE)
        plan_many(&c, TILE);
    return create(out, c);
}

relume_status convolver_create_tiled(convolver **out, int width, int height, int reach,
                                     enum relume_glare_border border, int threads, int side)
{
    convolver c = {
        .width = width, .height = height, .reach = reach, .threads = threads, .border = border};
    plan_many(&c, side);
    return create(out, c);
}

void convolver_destroy(convolver **c)
{
    if (!*c)
        return;
    fft2d_destroy(&(*c)->fft);
    for (int k = 0; k < 3; k++)
        mem_free((*c)->kept[k]);
    mem_free((*c)->spectrum);
    mem_free(*c);
    *c = NULL;
}

bool convolver_fits(const convolver *c, int width, int height, int reach,
                    enum relume_glare_border border, int threads)
{
    return c && c->width == width && c->height == height && c->reach == reach &&
           c->border == border && c->threads == threads;
}

// ---------------------------------------------------------------- lines in and out

struct tile_lines {
    convolver *c;
    const float *in;
    float *out;
    const struct kernel *shape;
    int channel, x0, y0;  // the tile's core
    float *kept;          // to be filled, or to multiply by
};

// The pixel that stands at `i` beside or in a row of n; -1: black.
static int border_index(int i, int n, enum relume_glare_border border)
{
    if (i >= 0 && i < n)
        return i;
    switch (border) {
    case RELUME_GLARE_CLAMP: return i < 0 ? 0 : n - 1;
    case RELUME_GLARE_PERIODIC: return (i % n + n) % n;
    case RELUME_GLARE_ZERO: break;
    }
    return -1;
}

static float pixel_at(const struct tile_lines *w, int x, int y)
{
    const int at = border_index(x, w->c->width, w->c->border);
    return at < 0 ? 0.0f
                  : w->in[3 * ((size_t)y * (size_t)w->c->width + (size_t)at) + (size_t)w->channel];
}

static void fill_tile(void *context, int row, float *line)
{
    const struct tile_lines *w = context;
    const convolver *const c = w->c;
    const int used_w = c->core_w + c->margin + (c->margin ? c->reach : 0);
    const int y = border_index(w->y0 - c->margin + row, c->height, c->border);
    const int left = w->x0 - c->margin;  // of the line's first pixel
    memset(line, 0, (size_t)c->fft_w * sizeof *line);
    if (y < 0)
        return;
    const int from = left < 0 ? smaller_of(-left, used_w) : 0,
              to = smaller_of(c->width - left, used_w);
    const float *const in = w->in + 3 * (ptrdiff_t)y * c->width + w->channel;
    for (int x = 0; x < from; x++)
        line[x] = pixel_at(w, left + x, y);
    for (int x = from; x < to; x++)
        line[x] = in[3 * (ptrdiff_t)(left + x)];
    for (int x = to > from ? to : from; x < used_w; x++)
        line[x] = pixel_at(w, left + x, y);
}

static void fill_kernel(void *context, int row, float *line)
{
    const struct tile_lines *w = context;
    const convolver *const c = w->c;
    const size_t side = 2 * (size_t)c->reach + 1, used = 2 * (size_t)c->reach_x + 1;
    const size_t y = (size_t)(row + c->reach - c->reach_y);
    memcpy(line, w->shape->v[w->channel] + y * side + (c->reach - c->reach_x), used * sizeof *line);
    memset(line + used, 0, ((size_t)c->fft_w - used) * sizeof *line);
}

static void take_row(void *context, int row, const float *line)
{
    const struct tile_lines *w = context;
    const convolver *const c = w->c;
    const float scale = 1.0f / ((float)c->fft_w * (float)c->fft_h);
    const int y = w->y0 + row - c->margin - c->reach_y;
    const int count = smaller_of(c->width - w->x0, c->core_w);
    float *const to =
        w->out + 3 * ((size_t)y * (size_t)c->width + (size_t)w->x0) + (size_t)w->channel;
    for (int x = 0; x < count; x++)
        to[3 * x] = scale * line[x + c->margin + c->reach_x];
}

static float *kept_columns(const struct tile_lines *w, int column)
{
    return w->kept + 2 * (size_t)column * (size_t)w->c->fft_h;
}

static bool keep(void *context, int column, int count, float *lines)
{
    const struct tile_lines *w = context;
    memcpy(kept_columns(w, column), lines, 2 * (size_t)count * (size_t)w->c->fft_h * sizeof *lines);
    return false;
}

static bool multiply(void *context, int column, int count, float *lines)
{
    const struct tile_lines *w = context;
    const float *const other = kept_columns(w, column);
    const size_t n = 2 * (size_t)count * (size_t)w->c->fft_h;
    for (size_t i = 0; i < n; i += 2) {
        const float re = lines[i], im = lines[i + 1];
        lines[i] = re * other[i] - im * other[i + 1];
        lines[i + 1] = re * other[i + 1] + im * other[i];
    }
    return true;
}

// ---------------------------------------------------------------- tiles

// What `fill` makes of the first rows, as a spectrum: kept, or times what is kept and back again.
static void transform(struct tile_lines *w, int rows, void (*fill)(void *, int, float *), bool back)
{
    convolver *const c = w->c;
    const struct fft2d_step step = {.to = rows,
                                    .end = fft2d_columns(c->fft),
                                    .visit = back ? multiply : keep,
                                    .context = w,
                                    .back = back};
    fft2d_rows(c->fft, c->spectrum, 0, rows, fill, w);
    fft2d_step_columns(c->fft, c->spectrum, &step);
    const int first = c->margin + c->reach_y;
    if (back)
        fft2d_rows_back(c->fft, c->spectrum, first,
                        first + smaller_of(c->height - w->y0, c->core_h), take_row, w);
}

static void transform_tile(struct tile_lines *w, bool back)
{
    const convolver *const c = w->c;
    transform(w, c->core_h + c->margin + (c->margin ? c->reach : 0), fill_tile, back);
}

static void transform_kernel(struct tile_lines *w, bool back)
{
    transform(w, 2 * w->c->reach_y + 1, fill_kernel, back);
}

// The picture's spectrum is kept, the kernel's is made, multiplied and taken back at once.
static void run_one(struct tile_lines *w, bool same)
{
    convolver *const c = w->c;
    for (w->channel = 0; w->channel < 3; w->channel++) {
        w->kept = c->kept[w->channel];
        if (!same || !c->known)
            transform_tile(w, false);
        transform_kernel(w, true);
    }
    c->known = true;
}

// The kernel's spectrum serves all tiles.
static void run_many(struct tile_lines *w)
{
    const convolver *const c = w->c;
    w->kept = c->kept[0];
    for (w->channel = 0; w->channel < 3; w->channel++) {
        transform_kernel(w, false);
        for (int t = 0; t < c->tiles_x * c->tiles_y; t++) {
            w->x0 = t % c->tiles_x * c->core_w;
            w->y0 = t / c->tiles_x * c->core_h;
            transform_tile(w, true);
        }
        w->x0 = w->y0 = 0;
    }
}

relume_status convolver_run(convolver *c, float *out, const float *in, bool same,
                            const struct kernel *kernel)
{
    struct tile_lines w = {.c = c, .in = in, .out = out, .shape = kernel};
    if (c->tiles_x * c->tiles_y == 1)
        run_one(&w, same);
    else
        run_many(&w);
    return RELUME_OK;
}
