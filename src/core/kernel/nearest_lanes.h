// nearest_lanes.h - the search for the nearest code for any set of WIDTH lanes; included by its
// file
//
// Three vectors of points against a tile of four codes are twelve running sums, which with three
// points and one code fill sixteen registers.
#include <math.h>

enum { SUMS = 3, STEP = SUMS * WIDTH };
_Static_assert(BLOCK % STEP == 0, "a block is whole steps in every set");

// The lowest scores of WIDTH points so far.
struct lowest {
    lanes best, second;
    whole tile;
};

static inline void take(struct lowest *l, const lanes s[TILE], whole tile)
{
    const lanes score = lanes_min(lanes_min(s[0], s[1]), lanes_min(s[2], s[3]));
    l->second = lanes_min(l->second, lanes_max(l->best, score));
    l->tile = whole_where_lower(score, l->best, tile, l->tile);
    l->best = lanes_min(l->best, score);
}

static inline void scan_tile(lanes sum[SUMS][TILE], const float *points, const float *codes,
                             const float *half, int dim)
{
    for (int r = 0; r < SUMS; r++)
        for (int l = 0; l < TILE; l++)
            sum[r][l] = lanes_all(half[l]);
    for (int i = 0; i < dim; i++, points += BLOCK, codes += TILE) {
        lanes x[SUMS];
        for (int r = 0; r < SUMS; r++)
            x[r] = lanes_load(points + r * WIDTH);
        for (int l = 0; l < TILE; l++) {
            const lanes code = lanes_all(codes[l]);
            for (int r = 0; r < SUMS; r++)
                sum[r][l] = lanes_minus(sum[r][l], x[r], code);
        }
    }
}

static void scan(const float *points, const float *codes, const float *half, int tiles, int dim,
                 float best[BLOCK], float second[BLOCK], int32_t tile[BLOCK])
{
    for (int first = 0; first < BLOCK; first += STEP) {
        struct lowest low[SUMS];
        for (int r = 0; r < SUMS; r++)
            low[r] = (struct lowest){lanes_all(INFINITY), lanes_all(INFINITY), whole_all(0)};
        for (int t = 0; t < tiles; t++) {
            lanes sum[SUMS][TILE];
            scan_tile(sum, points + first, codes + (ptrdiff_t)t * dim * TILE, half + t * TILE, dim);
            for (int r = 0; r < SUMS; r++)
                take(&low[r], sum[r], whole_all(t));
        }
        for (int r = 0; r < SUMS; r++) {
            lanes_store(best + first + r * WIDTH, low[r].best);
            lanes_store(second + first + r * WIDTH, low[r].second);
            whole_store(tile + first + r * WIDTH, low[r].tile);
        }
    }
}
