// align_blocks.c - hierarchical macroblocks for brackets held by hand
//
// The scheme of a freehand HDR acquisition: one block of the whole picture is matched, split in
// four, each quarter starts from the displacements of its surroundings, down to blocks of 16
// pixels. Every level allows a shift of an eighth of the block's side, so that all levels together
// follow a roll of atan(2/8) = 14 degrees. Here blocks above 64 pixels are matched on a pyramid
// where they have 64 x 64 samples, and the last level is refined below a pixel by a parabola.
#include <relume/align.h>

#include "base/log.h"
#include "base/memory.h"
#include "base/thread.h"
#include "capture/blocks.h"
#include "capture/pyramid.h"
#include "capture/tones.h"

#include <math.h>
#include <string.h>

enum { SAMPLES = 64, VISITED = 16, FILLED = 32 };
static const double least_part = 0.1;      // of its parent's score: below, a block stays
static const double good_match = 0.5;      // correlation of a block that its surroundings follow
static const double least_overlap = 0.25;  // of a block, with the other picture

struct search {
    const struct relume_image *anchor, *image;  // sharpened, at this pyramid level
    int scale;                                  // pixels of level 0 in one of theirs
    int radius;                                 // of the search, their pixels
    const struct grid *parent;                  // NULL for the root
    struct grid *grid;
    bool finest;
};

// ---------------------------------------------------------------- sharpening

static void sharpen_row(void *context, size_t y, int worker)
{
    struct relume_image *const *io = context;
    (void)worker;
    const struct relume_image *in = io[0];
    const size_t n = (size_t)in->channels, width = (size_t)in->width, stride = n * width;
    const float *row = in->data + y * stride;
    const float *up = y > 0 ? row - stride : row;
    const float *down = y + 1 < (size_t)in->height ? row + stride : row;
    float *out = io[1]->data + y * stride;
    for (size_t x = 0; x < width; x++)
        for (size_t c = 0; c < n; c++) {
            const size_t i = x * n + c, left = x > 0 ? i - n : i, right = x + 1 < width ? i + n : i;
            out[i] = 2.0f * row[i] - 0.25f * (row[left] + row[right] + up[i] + down[i]);
        }
}

// In place, with the kernel 0 -1/4 0, -1/4 2 -1/4, 0 -1/4 0.
static relume_status sharpen(struct relume_image *image, int threads)
{
    struct relume_image out;
    const relume_status status =
        relume_image_create(&out, image->width, image->height, image->channels);
    if (status)
        return status;
    struct relume_image *io[2] = {image, &out};
    thread_for(threads, (size_t)image->height, sharpen_row, io);
    relume_image_destroy(image);
    *image = out;
    return RELUME_OK;
}

// ---------------------------------------------------------------- the score

struct rectangle {
    int x, y, width, height;
};

static struct rectangle clipped(struct rectangle r, int x, int y, int width, int height)
{
    const int x1 = r.x + r.width < x + width ? r.x + r.width : x + width;
    const int y1 = r.y + r.height < y + height ? r.y + r.height : y + height;
    r.x = r.x > x ? r.x : x;
    r.y = r.y > y ? r.y : y;
    r.width = x1 > r.x ? x1 - r.x : 0;
    r.height = y1 > r.y ? y1 - r.y : 0;
    return r;
}

// Sums of a block's samples and products, four at a time (a vector type of GCC and Clang: from
// loops over arrays neither makes good code); a block has few enough samples for single precision.
typedef float four __attribute__((vector_size(16)));

struct sums {
    four b, bb, ab;
};

static four load(const float *from)
{
    four v;
    memcpy(&v, from, sizeof v);
    return v;
}

static void add_row(struct sums *s, const float *a, const float *b, int n)
{
    struct sums even = *s, odd = {{0}, {0}, {0}};
    int i = 0;
    for (; i + 8 <= n; i += 8) {
        const four a0 = load(a + i), a1 = load(a + i + 4), b0 = load(b + i), b1 = load(b + i + 4);
        even.b += b0;
        even.bb += b0 * b0;
        even.ab += a0 * b0;
        odd.b += b1;
        odd.bb += b1 * b1;
        odd.ab += a1 * b1;
    }
    for (; i < n; i++) {
        odd.b[0] += b[i];
        odd.bb[0] += b[i] * b[i];
        odd.ab[0] += a[i] * b[i];
    }
    *s = (struct sums){even.b + odd.b, even.bb + odd.bb, even.ab + odd.ab};
}

static double total(four v)
{
    return ((double)v[0] + (double)v[1]) + ((double)v[2] + (double)v[3]);
}

struct moments {
    double a, aa;  // sum of samples, and of squares
};

static struct moments moments_of(const struct relume_image *image, const struct rectangle *r)
{
    const size_t stride = 3 * (size_t)image->width;
    struct sums sum = {{0}, {0}, {0}};
    for (int y = r->y; y < r->y + r->height; y++) {
        const float *row = image->data + (size_t)y * stride + 3 * (size_t)r->x;
        add_row(&sum, row, row, 3 * r->width);
    }
    return (struct moments){total(sum.b), total(sum.bb)};
}

struct block {
    struct rectangle r;  // inside of the anchor, pixels of the pyramid level
    struct moments anchor;
    double contrast;  // |cr| / N, what the correlation is multiplied by
};

// The correlation of the block with the image at shift (dx, dy), times its contrast: blocks without
// detail score low. -INFINITY when hardly any of it lies inside of the image.
static double score(const struct search *s, const struct block *b, int dx, int dy)
{
    const struct rectangle r = clipped(b->r, -dx, -dy, s->image->width, s->image->height);
    if ((double)r.width * r.height < least_overlap * b->r.width * b->r.height)
        return (double)-INFINITY;
    const size_t stride = 3 * (size_t)s->anchor->width;
    const bool whole = r.width == b->r.width && r.height == b->r.height;
    const struct moments m = whole ? b->anchor : moments_of(s->anchor, &r);
    struct sums sum = {{0}, {0}, {0}};
    for (int y = r.y; y < r.y + r.height; y++)
        add_row(&sum, s->anchor->data + (size_t)y * stride + 3 * (size_t)r.x,
                s->image->data + (size_t)(y + dy) * stride + 3 * (size_t)(r.x + dx), 3 * r.width);
    const double n = 3.0 * r.width * r.height, b1 = total(sum.b);
    const double aa = m.aa - m.a * m.a / n, bb = total(sum.bb) - b1 * b1 / n;
    if (!(aa > 1e-6 * n) || !(bb > 1e-6 * n))  // a thousandth of full scale: noise of 8 bits
        return 0.0;
    return b->contrast * (total(sum.ab) - m.a * b1 / n) / sqrt(aa * bb);
}

// Its scale is that of level 0, whatever the pyramid level.
static double contrast_of(const struct search *s, const struct block *b)
{
    const double n = 3.0 * b->r.width * b->r.height;
    const double variance = fmax(b->anchor.aa / n - b->anchor.a * b->anchor.a / (n * n), 0.0);
    return sqrt(9.0 * variance / n) / s->scale;
}

// ---------------------------------------------------------------- the search

struct guess {
    int x, y;
    double score;
};

// Scores by shift modulo the table's size: climbs from different starts meet.
struct visited {
    struct guess at[VISITED][VISITED];
};

static double look_up(const struct search *s, const struct block *b, struct visited *v, int x,
                      int y)
{
    struct guess *g = &v->at[y & (VISITED - 1)][x & (VISITED - 1)];
    if (isnan(g->score) || g->x != x || g->y != y)
        *g = (struct guess){x, y, score(s, b, x, y)};
    return g->score;
}

// The next local maximum, at most `radius` steps away.
static struct guess climb(const struct search *s, const struct block *b, struct visited *v, int x,
                          int y)
{
    static const int way[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    struct guess best = {x, y, look_up(s, b, v, x, y)};
    for (int i = 0; i < s->radius; i++) {
        const struct guess from = best;
        for (int k = 0; k < 4; k++) {
            const int tx = from.x + way[k][0], ty = from.y + way[k][1];
            const double t = look_up(s, b, v, tx, ty);
            if (t > best.score)
                best = (struct guess){tx, ty, t};
        }
        if (best.x == from.x && best.y == from.y)
            break;
    }
    return best;
}

// The root has no better start than any other: all shifts are tried.
static struct guess search_root(const struct search *s, const struct block *b)
{
    struct guess best = {0, 0, score(s, b, 0, 0)};
    for (int y = -s->radius; y <= s->radius; y++)
        for (int x = -s->radius; x <= s->radius; x++) {
            const double t = score(s, b, x, y);
            if (t > best.score)
                best = (struct guess){x, y, t};
        }
    return best;
}

// Where a parabola through three scores has its top, in (-1/2, 1/2).
static double top(double left, double middle, double right)
{
    const double bend = left - 2.0 * middle + right;
    if (!isfinite(left) || !isfinite(right) || !(bend < 0.0))
        return 0.0;
    return fmin(fmax(0.5 * (left - right) / bend, -0.5), 0.5);
}

static void refine(const struct search *s, const struct block *b, const struct guess *g,
                   double d[2])
{
    d[0] += top(score(s, b, g->x - 1, g->y), g->score, score(s, b, g->x + 1, g->y));
    d[1] += top(score(s, b, g->x, g->y - 1), g->score, score(s, b, g->x, g->y + 1));
}

static int clamp(int i, int n)
{
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

static void start_of(const struct search *s, int column, int row, double d[2], double *above)
{
    d[0] = d[1] = *above = 0.0;
    if (s->parent)
        grid_interpolate(s->parent, s->grid->origin[0] + (column + 0.5) * s->grid->side,
                         s->grid->origin[1] + (row + 0.5) * s->grid->side, d, above);
}

// The best of the local maxima reached from the block's own start and its neighbours'; of equals
// the nearest to its own start.
static struct guess search_block(const struct search *s, const struct block *b, int column, int row,
                                 const double start[2])
{
    struct guess tried[9], best = {0, 0, (double)-INFINITY};
    double nearest = INFINITY;
    int tries = 0;
    struct visited v;
    for (int k = 0; k < VISITED * VISITED; k++)
        v.at[k / VISITED][k % VISITED].score = NAN;
    for (int k = 0; k < 9; k++) {
        double d[2], above;
        const int at = (k + 4) % 9;  // its own first
        start_of(s, clamp(column + at % 3 - 1, s->grid->count),
                 clamp(row + at / 3 - 1, s->grid->count), d, &above);
        const int x = (int)lround(d[0] / s->scale), y = (int)lround(d[1] / s->scale);
        int same = 0;
        while (same < tries && (tried[same].x != x || tried[same].y != y))
            same++;
        if (same < tries)
            continue;
        tried[tries++] = (struct guess){x, y, 0.0};
        const struct guess g = climb(s, b, &v, x, y);
        const double distance = hypot(g.x - start[0] / s->scale, g.y - start[1] / s->scale);
        if (g.score > best.score || (g.score == best.score && distance < nearest)) {
            best = g;
            nearest = distance;
        }
    }
    return best;
}

static void match_block(const struct search *s, int column, int row)
{
    const struct grid *g = s->grid;
    struct node *node = grid_node(g, column, row);
    double above;
    const int x = (int)floor((g->origin[0] + (double)column * g->side) / s->scale);
    const int y = (int)floor((g->origin[1] + (double)row * g->side) / s->scale);
    const int side = g->side / s->scale;
    start_of(s, column, row, node->d, &above);
    node->score = above;
    struct block b = {.r = clipped((struct rectangle){x, y, side, side}, 0, 0, s->anchor->width,
                                   s->anchor->height)};
    if (b.r.width < 4 || b.r.height < 4)
        return;
    b.anchor = moments_of(s->anchor, &b.r);
    b.contrast = contrast_of(s, &b);
    const struct guess best =
        s->parent ? search_block(s, &b, column, row, node->d) : search_root(s, &b);
    if (!isfinite(best.score))
        return;
    node->score = best.score;
    if (best.score <= 0.0 || best.score < least_part * above)
        return;
    node->trusted = best.score > good_match * b.contrast;
    node->d[0] = (double)best.x * s->scale;
    node->d[1] = (double)best.y * s->scale;
    if (s->finest)
        refine(s, &b, &best, node->d);
}

static void match_row(void *context, size_t row, int worker)
{
    const struct search *s = context;
    (void)worker;
    for (int column = 0; column < s->grid->count; column++)
        match_block(s, column, (int)row);
}

// ---------------------------------------------------------------- levels

static relume_status make_grid(struct grid *g, const struct relume_image *image, int root,
                               int count)
{
    *g = (struct grid){.count = count,
                       .side = root / count,
                       .origin = {0.5 * (image->width - root), 0.5 * (image->height - root)},
                       .node = mem_zeroed((size_t)count * (size_t)count, sizeof *g->node)};
    return g->node ? RELUME_OK : RELUME_ENOMEM;
}

static void match_level(struct grid *grid, const struct grid *parent, const struct pyramid *anchor,
                        const struct pyramid *image, bool finest, int threads)
{
    int level = 0;
    while (level < anchor->levels - 1 && grid->side >> level > SAMPLES)
        level++;
    const int side = grid->side >> level;
    const struct search s = {
        .anchor = &anchor->level[level],
        .image = &image->level[level],
        .scale = 1 << level,
        .radius = side / 8 > 2 ? side / 8 : 2,
        .parent = parent,
        .grid = grid,
        .finest = finest,
    };
    thread_for(threads, (size_t)grid->count, match_row, (void *)&s);
    if (parent && grid->count <= FILLED)
        grid_fill(grid, threads);
}

static relume_status sharpened(struct pyramid *out, const struct relume_image *image, int threads)
{
    relume_status status = pyramid_make(out, image, SAMPLES, threads);
    for (int i = 0; !status && i < out->levels; i++)
        status = sharpen(&out->level[i], threads);
    if (status)
        pyramid_free(out);
    return status;
}

static relume_status match_all(struct grid *out, const struct pyramid *anchor,
                               const struct pyramid *image, int block, int threads)
{
    const struct relume_image *whole = &anchor->level[0];
    const int longer = whole->width > whole->height ? whole->width : whole->height;
    int root = block;
    while (root < longer)
        root *= 2;
    struct grid parent = {0};
    relume_status status = RELUME_OK;
    for (int count = 1; !status && root / count >= block; count *= 2) {
        status = make_grid(out, whole, root, count);
        if (!status)
            match_level(out, count > 1 ? &parent : NULL, anchor, image, root / count == block,
                        threads);
        free(parent.node);
        parent = *out;
    }
    return status || grid_median(out) ? status : RELUME_ENOMEM;
}

relume_status relume_align_blocks(struct relume_displacements *out,
                                  const struct relume_image *anchor,
                                  const struct relume_image *image,
                                  const struct relume_align_params *params)
{
    const struct relume_align_params p = params ? *params : (struct relume_align_params){0};
    const int block = p.block > 0 ? p.block : 16;
    *out = (struct relume_displacements){0};
    if (anchor->channels != 3 || image->channels != 3 || anchor->width != image->width ||
        anchor->height != image->height || block < 8 || block > SAMPLES || (block & (block - 1)))
        return log_fail(
            p.log, RELUME_EINVAL,
            "alignment: expected two pictures of 3 channels and equal sizes, and blocks "
            "of 8, 16, 32 or 64 pixels");
    struct pyramid a = {0}, b = {0};
    struct grid grid = {0};
    struct relume_image alike;
    relume_status status = tones_match(&alike, anchor, image, p.threads);
    if (!status)
        status = sharpened(&a, &alike, p.threads);
    relume_image_destroy(&alike);
    if (!status)
        status = sharpened(&b, image, p.threads);
    if (!status)
        status = match_all(&grid, &a, &b, block, p.threads);
    const size_t nodes = (size_t)grid.count * (size_t)grid.count;
    if (!status && !(out->d = mem_array(nodes, sizeof *out->d)))
        status = RELUME_ENOMEM;
    if (!status) {
        out->width = anchor->width;
        out->height = anchor->height;
        out->columns = out->rows = grid.count;
        out->step = block;
        for (int k = 0; k < 2; k++)
            out->origin[k] = grid.origin[k] + 0.5 * block;
        for (size_t i = 0; i < nodes; i++)
            for (int k = 0; k < 2; k++)
                out->d[i][k] = (float)grid.node[i].d[k];
    }
    free(grid.node);
    pyramid_free(&a);
    pyramid_free(&b);
    return status;
}

void relume_displacements_destroy(struct relume_displacements *displacements)
{
    free(displacements->d);
    *displacements = (struct relume_displacements){0};
}

void relume_displacements_at(const struct relume_displacements *displacements, double x, double y,
                             double d[2])
{
    const struct relume_displacements *f = displacements;
    const double u = (x - f->origin[0]) / f->step, v = (y - f->origin[1]) / f->step;
    const int i = (int)floor(u), j = (int)floor(v);
    const double s = u - i, t = v - j;
    d[0] = d[1] = 0.0;
    for (int k = 0; k < 4; k++) {
        const int column = clamp(i + (k & 1), f->columns), row = clamp(j + k / 2, f->rows);
        const float *n = f->d[(size_t)row * (size_t)f->columns + (size_t)column];
        const double w = (k & 1 ? s : 1.0 - s) * (k / 2 ? t : 1.0 - t);
        d[0] += w * (double)n[0];
        d[1] += w * (double)n[1];
    }
}
