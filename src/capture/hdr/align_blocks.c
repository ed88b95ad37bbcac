// align_blocks.c - hierarchical macroblocks for brackets held by hand
//
// The scheme of a freehand HDR acquisition: one block of the whole picture is matched, split in
// four, each quarter starts from the displacements of its surroundings, down to blocks of 16
// pixels. Every level allows a shift of an eighth of the block's side, so that all levels together
// follow a roll of atan(2/8) = 14 degrees. Here a roll is undone before or afterwards, blocks above
// 64 pixels are matched on a pyramid where they have 64 x 64 samples, and the last level is refined
// below a pixel by a parabola.
#include <relume/capture/align.h>

#include "capture/hdr/align_guess.h"
#include "capture/hdr/blocks.h"
#include "capture/hdr/correlate.h"
#include "capture/hdr/pyramid.h"
#include "capture/hdr/tones.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"

#include <math.h>

enum { SAMPLES = 64, VISITED = 16, FILLED = 32 };
static const double least_part = 0.1;  // of its parent's score: below, a block stays
static const double good_match = 0.5;  // correlation of a block that its surroundings follow

struct search {
    const struct relume_image *anchor, *image;  // sharpened, at this pyramid level
    int scale;                                  // pixels of level 0 in one of theirs
    int radius;                                 // of the search, their pixels
    const struct grid *parent;                  // NULL for the root
    struct grid *grid;
    bool finest;
};

// ---------------------------------------------------------------- the score

struct block {
    struct rectangle r;  // inside of the anchor, pixels of the pyramid level
    struct moments anchor;
    double contrast;  // |cr| / N, what the correlation is multiplied by
};

// Blocks without detail score low.
static double score(const struct search *s, const struct block *b, int dx, int dy)
{
    return b->contrast * block_correlation(s->anchor, s->image, &b->r, b->anchor, dx, dy);
}

// ---------------------------------------------------------------- the search

struct guess {
    int x, y;
    double score;
};

// Scores by shift modulo the table's size: climbs from different starts come together.
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
        start_of(s, index_clamped(column + at % 3 - 1, s->grid->count),
                 index_clamped(row + at / 3 - 1, s->grid->count), d, &above);
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
    const int x = relume_whole(floor((g->origin[0] + (double)column * g->side) / s->scale));
    const int y = relume_whole(floor((g->origin[1] + (double)row * g->side) / s->scale));
    const int side = g->side / s->scale;
    start_of(s, column, row, node->d, &above);
    node->score = above;
    struct block b = {.r = rectangle_clip((struct rectangle){x, y, side, side}, 0, 0,
                                          s->anchor->width, s->anchor->height)};
    if (b.r.width < 4 || b.r.height < 4)
        return;
    b.anchor = block_moments(s->anchor, &b.r);
    // Its scale is that of level 0, whatever the pyramid level.
    const double n = 3.0 * b.r.width * b.r.height;
    const double variance = fmax(b.anchor.aa / n - b.anchor.a * b.anchor.a / (n * n), 0.0);
    b.contrast = sqrt(9.0 * variance / n) / s->scale;
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
        mem_free(parent.node);
        parent = *out;
    }
    return status || grid_median(out) ? status : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- roll

// Blocks move without turning. Where the picture is rolled, their insides are therefore compared
// smeared, the largest of them most, and what these miss the small ones do not find again. So the
// homography of small pictures is undone beforehand where it says that there is a roll; where it
// finds none, the affine map that the displacements amount to is undone afterwards and what
// remains is searched for again.

static const double clear_match = 0.3;    // correlation of a homography that is believed
static const double clear_roll = 0.01;    // pixels that two neighbours move apart: half a degree
static const double notable_roll = 0.05;  // the same, by displacements: 3 degrees

static double roll_of(const struct relume_homography *map)
{
    return sqrt(0.5) * hypot(map->m[0][1], map->m[1][0]);
}

static relume_status make_alike(struct pyramid *out, const struct relume_image *anchor,
                                const struct relume_image *image, int threads)
{
    struct relume_image alike;
    relume_status status = tones_match(&alike, anchor, image, threads);
    if (!status)
        status = sharpened(out, &alike, threads);
    relume_image_destroy(&alike);
    return status;
}

static relume_status match(struct grid *out, const struct pyramid *anchor,
                           const struct relume_image *image, int block, int threads)
{
    struct pyramid b = {0};
    relume_status status = sharpened(&b, image, threads);
    if (!status)
        status = match_all(out, anchor, &b, block, threads);
    pyramid_free(&b);
    return status;
}

// Displacements after `map` become those of both together.
static void compose(struct grid *grid, const struct relume_homography *map)
{
    for (int row = 0; row < grid->count; row++)
        for (int column = 0; column < grid->count; column++) {
            struct node *n = grid_node(grid, column, row);
            const double x = grid->origin[0] + (column + 0.5) * grid->side;
            const double y = grid->origin[1] + (row + 0.5) * grid->side;
            const double at[2] = {x + n->d[0], y + n->d[1]};
            const double z = map->m[2][0] * at[0] + map->m[2][1] * at[1] + 1.0;
            n->d[0] = (map->m[0][0] * at[0] + map->m[0][1] * at[1] + map->m[0][2]) / z - x;
            n->d[1] = (map->m[1][0] * at[0] + map->m[1][1] * at[1] + map->m[1][2]) / z - y;
        }
}

// The displacements that are found after `map` has been undone.
static relume_status match_upright(struct grid *out, const struct pyramid *anchor,
                                   const struct relume_image *image,
                                   const struct relume_homography *map, int block,
                                   const struct relume_align_params *p)
{
    struct relume_image upright;
    struct grid grid = {0};
    relume_status status = relume_warp_homography(&upright, NULL, image, map, p);
    if (!status)
        status = match(&grid, anchor, &upright, block, p->threads);
    relume_image_destroy(&upright);
    if (status) {
        mem_free(grid.node);
        return status;
    }
    compose(&grid, map);
    mem_free(out->node);
    *out = grid;
    return RELUME_OK;
}

static relume_status undo_roll(struct grid *grid, const struct pyramid *anchor,
                               const struct relume_image *image, int block,
                               const struct relume_align_params *p)
{
    struct relume_homography map = {.m = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    if (!grid_affine(map.m, grid) || roll_of(&map) < notable_roll)
        return RELUME_OK;
    return match_upright(grid, anchor, image, &map, block, p);
}

static relume_status match_rolled(struct grid *out, const struct pyramid *anchor_alike,
                                  const struct relume_image *anchor,
                                  const struct relume_image *image, int block,
                                  const struct relume_align_params *p)
{
    struct relume_homography map = {.correlation = 0.0};
    relume_status status = align_guess(&map, anchor, image, p->threads);
    if (status)
        return status;
    if (map.correlation > clear_match && roll_of(&map) > clear_roll)
        return match_upright(out, anchor_alike, image, &map, block, p);
    status = match(out, anchor_alike, image, block, p->threads);
    return status ? status : undo_roll(out, anchor_alike, image, block, p);
}

static relume_status hand_out(struct relume_displacements *out, const struct grid *grid, int width,
                              int height)
{
    const size_t nodes = (size_t)grid->count * (size_t)grid->count;
    out->d = mem_array(nodes, sizeof *out->d);
    if (!out->d)
        return RELUME_ENOMEM;
    out->width = width;
    out->height = height;
    out->columns = out->rows = grid->count;
    out->step = grid->side;
    for (int k = 0; k < 2; k++)
        out->origin[k] = grid->origin[k] + 0.5 * grid->side;
    for (size_t i = 0; i < nodes; i++)
        for (int k = 0; k < 2; k++)
            out->d[i][k] = (float)grid->node[i].d[k];
    return RELUME_OK;
}

relume_status relume_align_blocks(struct relume_displacements *out,
                                  const struct relume_image *anchor,
                                  const struct relume_image *image,
                                  const struct relume_align_params *params)
{
    const struct relume_align_params p = PARAMS_WORK(relume_align_params, params);
    const int block = p.block > 0 ? p.block : 16;
    *out = (struct relume_displacements){0};
    if (anchor->channels != 3 || image->channels != 3 || anchor->width != image->width ||
        anchor->height != image->height || block < 8 || block > SAMPLES || (block & (block - 1)))
        return log_fail(
            p.log, RELUME_EINVAL,
            "alignment: expected two pictures of 3 channels and equal sizes, and blocks "
            "of 8, 16, 32 or 64 pixels");
    struct pyramid a = {0};
    struct grid grid = {0};
    relume_status status = make_alike(&a, anchor, image, p.threads);
    if (!status)
        status = match_rolled(&grid, &a, anchor, image, block, &p);
    if (!status)
        status = hand_out(out, &grid, anchor->width, anchor->height);
    mem_free(grid.node);
    pyramid_free(&a);
    return status;
}

void relume_displacements_destroy(struct relume_displacements *displacements)
{
    mem_free(displacements->d);
    *displacements = (struct relume_displacements){0};
}

void relume_displacements_at(const struct relume_displacements *displacements, double x, double y,
                             double d[2])
{
    const struct relume_displacements *f = displacements;
    const double u = (x - f->origin[0]) / f->step, v = (y - f->origin[1]) / f->step;
    const struct bilinear b = bilinear_at(u, v, f->columns, f->rows, EDGE_CLAMPED);
    d[0] = d[1] = 0.0;
    for (int k = 0; k < 4; k++) {
        const float *n = f->d[b.at[k]];
        const double w = bilinear_share(&b, k, 1.0);
        d[0] += w * (double)n[0];
        d[1] += w * (double)n[1];
    }
}
