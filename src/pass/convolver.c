// convolver.c - pictures convolved through their spectra, tile by tile (overlap-save)
//
// A tile is `core` pixels and as much around it as the kernel reaches. A picture that fits into one
// tile and is black outside needs that margin once: what wraps around is black.
#include "pass/glare.h"

#include "base/memory.h"
#include "base/thread.h"
#include "math/fft2d.h"

#include <math.h>
#include <string.h>

enum { ONE_TILE = 1 << 24, TILE = 2048 };  // pixels of a transform; side of one of many

struct convolver {
    int width, height, reach, threads;
    enum relume_glare_border border;
    int margin;          // left of and above a tile
    int core_w, core_h;  // of a tile
    int tiles_x, tiles_y;
    int fft_w, fft_h;
    fft2d *fft;
    float *kernel;      // spectrum
    float *picture[3];  // spectra of the only tile; [0] serves all when there are many
    bool kept;          // picture[] are of the last picture
};

static void plan_one(convolver *c, int margin)
{
    c->core_w = c->width;
    c->core_h = c->height;
    c->margin = margin;
    // The margin is zero and serves both ends, or there is one on each side.
    c->fft_w = fft_good_size(c->width + c->reach + margin);
    c->fft_h = fft_good_size(c->height + c->reach + margin);
}

static void plan_many(convolver *c, int least)
{
    const int side = 4 * c->reach > least ? 4 * c->reach : least;
    c->margin = c->reach;
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
        good = (c->picture[k] = mem_array(fft2d_size(c->fft), sizeof(float))) != NULL;
    good = good && (c->kernel = mem_array(fft2d_size(c->fft), sizeof(float)));
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
        free((*c)->picture[k]);
    free((*c)->kernel);
    free(*c);
    *c = NULL;
}

bool convolver_fits(const convolver *c, int width, int height, int reach,
                    enum relume_glare_border border, int threads)
{
    return c && c->width == width && c->height == height && c->reach == reach &&
           c->border == border && c->threads == threads;
}

// ---------------------------------------------------------------- lines in and out

struct work {
    convolver *c;
    const float *in;
    float *out;
    const struct kernel *shape;
    int channel, x0, y0;  // the tile's core
    const float *other;   // spectrum to multiply by
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

static void fill_tile(void *context, int row, float *line)
{
    const struct work *w = context;
    const convolver *const c = w->c;
    const int used_w = c->core_w + c->margin + (c->margin ? c->reach : 0);
    const int y = border_index(w->y0 - c->margin + row, c->height, c->border);
    for (int x = 0; x < c->fft_w; x++) {
        const int at = x < used_w ? border_index(w->x0 - c->margin + x, c->width, c->border) : -1;
        line[x] = y < 0 || at < 0
                      ? 0.0f
                      : w->in[3 * ((size_t)y * (size_t)c->width + (size_t)at) + (size_t)w->channel];
    }
}

// The kernel around (0, 0), what lies left of it and above it wrapped.
static void fill_kernel(void *context, int row, float *line)
{
    const struct work *w = context;
    const convolver *const c = w->c;
    const int r = c->reach, side = 2 * r + 1;
    const int y = row <= r ? row : row - c->fft_h;
    memset(line, 0, (size_t)c->fft_w * sizeof *line);
    if (y < -r)
        return;
    const float *const from = w->shape->v[w->channel] + (size_t)(y + r) * (size_t)side;
    memcpy(line, from + r, ((size_t)r + 1) * sizeof *line);
    memcpy(line + c->fft_w - r, from, (size_t)r * sizeof *line);
}

static void take_row(void *context, int row, const float *line)
{
    const struct work *w = context;
    const convolver *const c = w->c;
    const float scale = 1.0f / ((float)c->fft_w * (float)c->fft_h);
    const int y = w->y0 + row - c->margin;
    const int count = c->width - w->x0 < c->core_w ? c->width - w->x0 : c->core_w;
    float *const to = w->out + 3 * ((size_t)y * (size_t)c->width + (size_t)w->x0);
    for (int x = 0; x < count; x++)
        to[3 * x + w->channel] = scale * line[x + c->margin];
}

// lines *= the same columns of the other spectrum.
static bool multiply(void *context, int column, int count, float *lines)
{
    const struct work *w = context;
    const size_t n = (size_t)w->c->fft_h, stride = fft2d_stride(w->c->fft);
    for (size_t y = 0; y < n; y++) {
        const float *const other = w->other + y * stride + 2 * (size_t)column;
        for (int k = 0; k < count; k++) {
            float *const z = lines + 2 * (n * (size_t)k + y);
            const float re = z[0], im = z[1], a = other[2 * k], b = other[2 * k + 1];
            z[0] = re * a - im * b;
            z[1] = re * b + im * a;
        }
    }
    return true;
}

// ---------------------------------------------------------------- tiles

static void transform_tile(const struct work *w, float *spectrum)
{
    const convolver *const c = w->c;
    const int rows = c->core_h + c->margin + (c->margin ? c->reach : 0);
    fft2d_rows(c->fft, spectrum, 0, rows, fill_tile, (void *)(uintptr_t)w);
    const struct fft2d_pass pass = {.to = rows, .end = fft2d_columns(c->fft)};
    fft2d_pass_columns(c->fft, spectrum, &pass);
}

static void back(const struct work *w, float *spectrum)
{
    const convolver *const c = w->c;
    const int rows = c->height - w->y0 < c->core_h ? c->height - w->y0 : c->core_h;
    fft2d_rows_back(c->fft, spectrum, c->margin, c->margin + rows, take_row, (void *)(uintptr_t)w);
}

static void transform_kernel_rows(const struct work *w)
{
    convolver *const c = w->c;
    fft2d_rows(c->fft, c->kernel, 0, c->fft_h, fill_kernel, (void *)(uintptr_t)w);
}

// The picture's spectrum is kept, the kernel's is made, multiplied and taken back at once.
static void run_one(struct work *w, bool same)
{
    convolver *const c = w->c;
    for (w->channel = 0; w->channel < 3; w->channel++) {
        if (!same || !c->kept)
            transform_tile(w, c->picture[w->channel]);
        transform_kernel_rows(w);
        w->other = c->picture[w->channel];
        const struct fft2d_pass pass = {.to = c->fft_h,
                                        .end = fft2d_columns(c->fft),
                                        .visit = multiply,
                                        .context = w,
                                        .back = true};
        fft2d_pass_columns(c->fft, c->kernel, &pass);
        back(w, c->kernel);
    }
    c->kept = true;
}

// The kernel's spectrum serves all tiles.
static void run_many(struct work *w)
{
    convolver *const c = w->c;
    const int rows = c->fft_h;
    for (w->channel = 0; w->channel < 3; w->channel++) {
        transform_kernel_rows(w);
        const struct fft2d_pass forward = {.to = rows, .end = fft2d_columns(c->fft)};
        fft2d_pass_columns(c->fft, c->kernel, &forward);
        w->other = c->kernel;
        for (int t = 0; t < c->tiles_x * c->tiles_y; t++) {
            w->x0 = t % c->tiles_x * c->core_w;
            w->y0 = t / c->tiles_x * c->core_h;
            fft2d_rows(c->fft, c->picture[0], 0, rows, fill_tile, w);
            const struct fft2d_pass pass = {.to = rows,
                                            .end = fft2d_columns(c->fft),
                                            .visit = multiply,
                                            .context = w,
                                            .back = true};
            fft2d_pass_columns(c->fft, c->picture[0], &pass);
            back(w, c->picture[0]);
        }
    }
}

relume_status convolver_run(convolver *c, float *out, const float *in, bool same,
                            const struct kernel *kernel)
{
    struct work w = {.c = c, .in = in, .out = out, .shape = kernel};
    if (c->tiles_x * c->tiles_y == 1)
        run_one(&w, same);
    else
        run_many(&w);
    return RELUME_OK;
}
