// tiles.c - tiles that fit in any order, from one sample (thesis, 4.2.2; one border for all tiles:
// Somol and Haindl 2005), patches joined along minimum cuts (Kwatra et al. 2003)
//
// The first tile is quilted on a torus, so that it fits itself on all sides. Every other tile
// starts as a copy of it, whose middle is replaced by other parts of the sample while its border
// stays. What is computed with is numbers of texels of the sample: the result serves every model.
#include "material/surface/patch.h"
#include "material/surface/surface.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/random.h"

#include <string.h>

enum { MULTIPLE = 8, LEAST_SAMPLE = 16 };

// ---------------------------------------------------------------- tiles

// Patches in rows over the whole torus, `across` in each.
static relume_status cover(struct canvas *c, struct random *random, int across, int size, int core)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < across * across && !status; i++) {
        struct patch p = {.x = i % across * c->side / across,
                          .y = i / across * c->side / across,
                          .size = size,
                          .core = core};
        status = patch_paste(c, &p, (uint64_t)(random_next(random) * 0x1p53));
    }
    return status;
}

// The largest patch that leaves some choice in the sample.
static int most_size(const struct canvas *c)
{
    const int side = c->f->width < c->f->height ? c->f->width : c->f->height;
    return side * 3 / 4;
}

// The tile that repeats: patches overlap by half of what they are apart.
static relume_status make_first(struct canvas *c, struct random *random)
{
    int across = 2;
    while (3 * c->side / (2 * across) + 2 > most_size(c))
        across++;
    for (int i = 0; i < c->side * c->side; i++)
        c->texel[i] = PATCH_EMPTY;
    return cover(c, random, across, 3 * c->side / (2 * across) + 2, 0);
}

static relume_status make_other(struct canvas *c, const uint32_t *first, struct random *random)
{
    memcpy(c->texel, first, (size_t)c->side * (size_t)c->side * sizeof *first);
    const int size = c->side <= most_size(c) ? c->side : most_size(c);
    const int across = size == c->side ? 1 : (4 * c->side + 3 * size - 1) / (3 * size);
    return cover(c, random, across, size, size / 8);
}

static relume_status make_tiles(relume_btf_map *map, struct canvas *c,
                                const struct relume_btf_tiles_params *p)
{
    const size_t each = (size_t)c->side * (size_t)c->side;
    relume_status status = RELUME_OK;
    for (int i = 0; i < map->info.tiles && !status; i++) {
        struct random random = random_stream(p->seed, 1, (uint64_t)i);
        c->texel = map->texel + (size_t)i * each;
        status = i ? make_other(c, map->texel, &random) : make_first(c, &random);
        if (!status && !log_progress(p->log, "tiles", (i + 1.0) / map->info.tiles))
            status = RELUME_ECANCEL;
    }
    return status;
}

// ---------------------------------------------------------------- the matrix

static bool is_near(const relume_btf_map *m, int column, int row, int tile)
{
    const struct relume_btf_map_info *s = &m->info;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            const int x = map_wrap(column + dx, s->columns), y = map_wrap(row + dy, s->rows);
            // those that come later are not chosen yet
            if ((y < row || (y == row && x < column)) &&
                m->matrix[(size_t)y * (size_t)s->columns + (size_t)x] == tile)
                return true;
        }
    return false;
}

static void fill_matrix(relume_btf_map *m, uint64_t seed)
{
    enum { TRIALS = 64 };
    const struct relume_btf_map_info *s = &m->info;
    struct random random = random_stream(seed, 2, 0);
    for (int y = 0; y < s->rows; y++)
        for (int x = 0; x < s->columns; x++) {
            int tile = 0;
            for (int i = 0; i < TRIALS; i++) {
                tile = (int)(random_next(&random) * s->tiles);
                if (!is_near(m, x, y, tile))
                    break;
            }
            m->matrix[(size_t)y * (size_t)s->columns + (size_t)x] = (uint16_t)tile;
        }
}

// ---------------------------------------------------------------- parameters

// What neighbours in the sample differ by.
static float mean_step(const struct features *f)
{
    double sum = 0.0;
    for (int y = 0; y + 1 < f->height; y++)
        for (int x = 0; x + 1 < f->width; x++) {
            const size_t i = (size_t)y * (size_t)f->width + (size_t)x;
            sum += (double)features_apart(f, i, i + 1) +
                   (double)features_apart(f, i, i + (size_t)f->width);
        }
    return (float)(sum / (2.0 * (f->width - 1.0) * (f->height - 1.0)));
}

static relume_status check(struct relume_btf_tiles_params *p, const relume_btf_fitted *sample)
{
    const int side = sample->width < sample->height ? sample->width : sample->height;
    if (side < LEAST_SAMPLE)
        return log_fail(p->log, RELUME_EUNFIT,
                        "tiles: expected a sample of at least %d x %d texels; found %d x %d",
                        LEAST_SAMPLE, LEAST_SAMPLE, sample->width, sample->height);
    p->tiles = p->tiles ? p->tiles : 10;
    p->columns = p->columns ? p->columns : 16;
    p->rows = p->rows ? p->rows : 16;
    p->side = p->side                   ? p->side
              : side < 2 * LEAST_SAMPLE ? LEAST_SAMPLE
                                        : side / 2 / MULTIPLE * MULTIPLE;
    if (p->tiles < 1 || p->tiles > 256)
        return log_fail(p->log, RELUME_EINVAL, "tiles: expected 1 to 256; found %d", p->tiles);
    if (p->side < 16 || p->side > 4096 || p->side % MULTIPLE)
        return log_fail(p->log, RELUME_EINVAL,
                        "side of tiles: expected a multiple of %d from 16 to 4096; found %d",
                        MULTIPLE, p->side);
    if (p->columns < 1 || p->columns > 4096 || p->rows < 1 || p->rows > 4096)
        return log_fail(p->log, RELUME_EINVAL, "matrix: expected 1 to 4096 a side; found %d x %d",
                        p->columns, p->rows);
    return RELUME_OK;
}

relume_status relume_btf_map_tiles(relume_btf_map **out, const relume_btf_fitted *sample,
                                   const struct relume_btf_tiles_params *params)
{
    struct relume_btf_tiles_params p = PARAMS_WORK(relume_btf_tiles_params, params);
    struct features f = {.texel = NULL};
    *out = NULL;
    relume_status status = check(&p, sample);
    const struct relume_btf_map_info sizes = {.sample_width = sample->width,
                                              .sample_height = sample->height,
                                              .tiles = p.tiles,
                                              .width = p.side,
                                              .height = p.side,
                                              .columns = p.columns,
                                              .rows = p.rows};
    if (!status)
        status = map_start(out, &sizes, p.log);
    if (!status)
        status = features_make(&f, sample, p.threads);
    if (!status) {
        struct canvas c = {
            .f = &f, .side = p.side, .threads = p.threads, .unit = fmaxf(mean_step(&f), 1e-12f)};
        status = make_tiles(*out, &c, &p);
        mem_free(c.used);
    }
    if (!status)
        fill_matrix(*out, p.seed);
    features_free(&f);
    if (status)
        relume_btf_map_destroy(out);
    return status;
}
