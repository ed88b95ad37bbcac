// views_order.c - which way the rows and columns of cameras run, and how far apart they stand
//
// A point's parallax over columns and over rows is one number: with one of the two turned round the
// cameras agree on no depth. With both turned they agree on a world turned inside out, near for
// far; then what occludes gives it away: a pixel that some cameras do not see lies behind its
// surroundings, so its disparity must be the smaller one there. Where many depths fit equally well
// nothing is concluded.
//
// How far a point moves from row to row is to how far it moves from column to column as the rows'
// spacing is to the columns': the ratio on which most pixels of the middle picture agree.
#include "capture/multiview/views_order.h"

#include "capture/multiview/plane_sweep.h"
#include "capture/multiview/plane_sweep_picture.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <math.h>
#include <relume/image/photograph.h>
#include <string.h>

enum { MOST_WIDTH = 320, AROUND = 9, WINDOW = 2, NEAR = 5 };
static const double most_shift = 1.0 / 8.0;  // of the width, between the middle and the outermost

struct orders {
    struct plane_sweep sweep;
    uint8_t *picture[AROUND];
    double at[AROUND][2];
    int planes;
    double step;
};

// What the sweep finds at every pixel.
struct findings {
    float *plane, *hidden;  // best plane (negative: many are), cost that only occlusion explains
    double cost;            // mean of the least costs
};
static const float as_good = 4.0f;  // of costs
static const int few_planes = 6;

// First, middle and last of n, without repetition.
static int three_of(int out[3], int n)
{
    int count = 0;
    out[count++] = n / 2;
    if (n > 1)
        out[count++] = 0;
    if (n > 2)
        out[count++] = n - 1;
    return count;
}

static relume_status load(struct orders *o, const char *path, const struct relume_ingest_params *p)
{
    struct relume_image image;
    const relume_status status = relume_photograph_load(
        &image, NULL, path,
        relume_photograph_params(.log = p->log, .limits = p->limits, .transfer = p->transfer));
    if (status)
        return status;
    const int factor = plane_sweep_factor(image.width, MOST_WIDTH);
    o->sweep.width = image.width / factor;
    o->sweep.height = image.height / factor;
    const size_t bytes = 3 * (size_t)o->sweep.width * (size_t)o->sweep.height;
    uint8_t *picture = mem_array(bytes + 1, 1);
    if (picture)
        plane_sweep_picture(picture, &image, factor);
    o->picture[o->sweep.views++] = picture;
    relume_image_destroy(&image);
    return picture ? RELUME_OK : RELUME_ENOMEM;
}

// The middle camera comes first; `across` and `down`: of how many columns and rows.
static relume_status load_around(struct orders *o, const struct photo_set *set,
                                 const struct camera_grid *g, int across, int down,
                                 const struct relume_ingest_params *p)
{
    int columns[3], rows[3];
    across = across < three_of(columns, g->columns) ? across : three_of(columns, g->columns);
    down = down < three_of(rows, g->rows) ? down : three_of(rows, g->rows);
    relume_status status = RELUME_OK;
    for (int j = 0; j < down; j++)
        for (int i = 0; i < across && !status; i++) {
            o->at[o->sweep.views][0] = g->u[columns[i]] - g->u[columns[0]];
            o->at[o->sweep.views][1] = g->v[rows[0]] - g->v[rows[j]];
            const int camera = g->camera[rows[j] * g->columns + columns[i]];
            status = load(o, set->camera[camera].images[0], p);
        }
    return status;
}

// Disparities in steps of a texel of the outermost camera.
static void scale(struct orders *o)
{
    double most = 0.0;
    for (int i = 0; i < o->sweep.views; i++)
        most = fmax(most, fmax(fabs(o->at[i][0]), fabs(o->at[i][1])));
    for (int i = 0; i < o->sweep.views; i++)
        for (int k = 0; k < 2; k++)
            o->at[i][k] /= most;
    o->planes = 2 * (int)lround(most_shift * o->sweep.width) + 1;
    o->sweep.picture = o->picture;
    o->sweep.at = (const double(*)[2])o->at;
    o->sweep.channels = 3;
}

// Mean over a window of 2 WINDOW + 1 pixels square.
static void smooth(float *out, const uint8_t *in, int width, int height)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            int sum = 0, n = 0;
            for (int j = y - WINDOW; j <= y + WINDOW; j++)
                for (int i = x - WINDOW; i <= x + WINDOW; i++)
                    if (i >= 0 && j >= 0 && i < width && j < height) {
                        sum += in[j * width + i];
                        n++;
                    }
            out[y * width + x] = (float)sum / (float)n;
        }
}

// Sums over a window of all costs of one plane: cost[planes][n], and the mean over all cameras.
static void plane_sweep_plane(float *least, float *mean, uint8_t *raw, const struct orders *o,
                              const struct plane_sweep_target *target, int plane,
                              const struct plane_sweep_scratch *scratch)
{
    const int width = o->sweep.width, height = o->sweep.height;
    uint8_t *all = raw + (size_t)width * (size_t)height;
    for (int y = 0; y < height; y++)
        plane_sweep_row(raw + y * width, all + y * width, &o->sweep, target,
                        plane - (o->planes - 1) / 2, y, scratch);
    smooth(least, raw, width, height);
    smooth(mean, all, width, height);
}

static void choose_planes(struct findings *f, const float *least, const float *mean, size_t n,
                          int planes)
{
    f->cost = 0.0;
    for (size_t i = 0; i < n; i++) {
        int best = 0, good = 0;
        for (int q = 1; q < planes; q++)
            if (least[(size_t)q * n + i] < least[(size_t)best * n + i])
                best = q;
        const float lowest = least[(size_t)best * n + i];
        for (int q = 0; q < planes; q++)
            good += least[(size_t)q * n + i] <= lowest + as_good;
        f->plane[i] = good <= few_planes ? (float)best : -1.0f;
        f->hidden[i] = mean[(size_t)best * n + i] - lowest;
        f->cost += (double)lowest / (double)n;
    }
}

static relume_status plane_sweep_middle(struct findings *f, const struct orders *o)
{
    const size_t n = (size_t)o->sweep.width * (size_t)o->sweep.height;
    const struct plane_sweep_target target = plane_sweep_target(&o->sweep, 0, AROUND - 1);
    const size_t planes = (size_t)o->planes;
    uint8_t *raw = mem_array(n, 2);
    float *costs = mem_array(n * planes, 2 * sizeof *costs);
    struct plane_sweep_scratch scratch;
    relume_status status = plane_sweep_scratch_create(&scratch, o->sweep.width);
    if (!status && (!raw || !costs))
        status = RELUME_ENOMEM;
    for (size_t q = 0; !status && q < planes; q++)
        plane_sweep_plane(costs + q * n, costs + (planes + q) * n, raw, o, &target, (int)q,
                          &scratch);
    if (!status)
        choose_planes(f, costs, costs + planes * n, n, o->planes);
    plane_sweep_scratch_free(&scratch);
    mem_free(raw);
    mem_free(costs);
    return status;
}

// The least and greatest plane around a pixel.
static void planes_around(float range[2], const struct findings *f, const struct orders *o, int x,
                          int y)
{
    range[0] = range[1] = f->plane[y * o->sweep.width + x];
    for (int j = y - NEAR; j <= y + NEAR; j++)
        for (int i = x - NEAR; i <= x + NEAR; i++) {
            const float q = f->plane[j * o->sweep.width + i];
            if (q < 0.0f)
                continue;
            range[0] = fminf(range[0], q);
            range[1] = fmaxf(range[1], q);
        }
}

static double occlusion(const struct findings *f, const struct orders *o)
{
    double sum = 0.0, most = 1e-9;
    const int rim = NEAR + o->planes / 2;
    for (int y = rim; y < o->sweep.height - rim; y++)
        for (int x = rim; x < o->sweep.width - rim; x++) {
            float range[2];
            const size_t i = (size_t)y * (size_t)o->sweep.width + (size_t)x;
            if (f->plane[i] < 0.0f)
                continue;
            planes_around(range, f, o, x, y);
            sum += (double)(f->hidden[i] * (range[1] + range[0] - 2.0f * f->plane[i]));
            most += (double)(f->hidden[i] * (range[1] - range[0]));
        }
    return sum / most;
}

static relume_status decide(struct grid_order *out, struct orders *o, struct findings f[2],
                            bool both_ways)
{
    relume_status status = plane_sweep_middle(&f[0], o);
    for (int i = 0; i < o->sweep.views; i++)
        o->at[i][1] = -o->at[i][1];
    if (!status && both_ways)
        status = plane_sweep_middle(&f[1], o);
    if (status)
        return status;
    out->mixed = both_ways && f[1].cost < f[0].cost;
    const double cost[2] = {f[out->mixed].cost, both_ways ? f[!out->mixed].cost : f[0].cost};
    out->agreement = cost[1] > 0.0 ? 1.0 - cost[0] / cost[1] : 0.0;
    out->occlusion = occlusion(&f[out->mixed], o);
    return RELUME_OK;
}

relume_status grid_order(struct grid_order *out, const struct photo_set *set,
                         const struct camera_grid *grid, const struct relume_ingest_params *p)
{
    struct orders o = {.planes = 0};
    struct findings f[2] = {{NULL, NULL, 0.0}, {NULL, NULL, 0.0}};
    relume_status status = load_around(&o, set, grid, 3, 3, p);
    float *scratch = NULL;
    const size_t n = (size_t)o.sweep.width * (size_t)o.sweep.height;
    if (!status && !(scratch = mem_array(4 * n, sizeof *scratch)))
        status = RELUME_ENOMEM;
    if (!status) {
        scale(&o);
        for (int i = 0; i < 2; i++) {
            f[i].plane = scratch + (size_t)(2 * i) * n;
            f[i].hidden = scratch + (size_t)(2 * i + 1) * n;
        }
        status = decide(out, &o, f, grid->rows > 1 && grid->columns > 1);
    }
    mem_free(scratch);
    for (int i = 0; i < o.sweep.views; i++)
        mem_free(o.picture[i]);
    return status;
}

// ---------------------------------------------------------------- spacing

enum { PARTS = 4, RATIOS = 277 };  // the picture in PARTS x PARTS, ratios from 1/4 to 4 by 1 %
static const double least_ratio = 0.25;
static const double least_move = 2.0;  // texels that a point moves by
static const size_t few_pixels = 150;
static const double least_share = 0.4, most_error = 0.1;

// The disparities of the middle camera by the others in its row or in its column, in texels of the
// outermost of them, which is `way` units from the middle.
struct moves {
    float *plane;
    double middle, way;
    int width, height;
};

static relume_status find_moves(struct moves *m, const struct photo_set *set,
                                const struct camera_grid *grid, bool rows,
                                const struct relume_ingest_params *p)
{
    struct orders o = {.planes = 0};
    struct findings f = {.cost = 0.0};
    relume_status status = load_around(&o, set, grid, rows ? 1 : 3, rows ? 3 : 1, p);
    const size_t n = (size_t)o.sweep.width * (size_t)o.sweep.height;
    for (int i = 0; i < o.sweep.views; i++)
        m->way = fmax(m->way, fabs(o.at[i][rows]));
    if (!status && !(f.plane = mem_array(2 * n, sizeof *f.plane)))
        status = RELUME_ENOMEM;
    if (!status) {
        f.hidden = f.plane + n;
        scale(&o);
        status = plane_sweep_middle(&f, &o);
    }
    m->plane = f.plane;
    m->middle = (o.planes - 1) / 2;
    m->width = o.sweep.width;
    m->height = o.sweep.height;
    for (int i = 0; i < o.sweep.views; i++)
        mem_free(o.picture[i]);
    return status;
}

// By how much a point moves over columns and over rows.
struct moved {
    float across, down;
    int part;
};

static size_t collect(struct moved *moved, const struct moves m[2])
{
    size_t n = 0;
    const int width = m[0].width, height = m[0].height;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const float *a = &m[0].plane[y * width + x], *b = &m[1].plane[y * width + x];
            const double across = (double)*a - m[0].middle, down = (double)*b - m[1].middle;
            if (*a >= 0.0f && *b >= 0.0f && hypot(across, down) >= least_move)
                moved[n++] = (struct moved){(float)across, (float)down,
                                            y * PARTS / height * PARTS + x * PARTS / width};
        }
    return n;
}

static double ratio_of(int i)
{
    return least_ratio * pow(1.0 / (least_ratio * least_ratio), i / (RATIOS - 1.0));
}

// How many of a part's pixels (-1: of all) move down by `ratio` times as much as across, either
// way, to a texel.
static double agree(const struct moved *moved, size_t n, int part, double ratio)
{
    double sum[2] = {0.0, 0.0};
    const double scale = 1.0 / hypot(1.0, ratio);
    for (size_t i = 0; i < n; i++)
        for (int way = 0; way < 2 && (part < 0 || moved[i].part == part); way++) {
            const double expected = (way ? -ratio : ratio) * (double)moved[i].across;
            const double off = scale * ((double)moved[i].down - expected);
            sum[way] += fmax(1.0 - off * off, 0.0);
        }
    return fmax(sum[0], sum[1]);
}

static double best_ratio(const struct moved *moved, size_t n, int part)
{
    double most = -1.0, best = 0.0;
    for (int i = 0; i < RATIOS; i++) {
        const double sum = agree(moved, n, part, ratio_of(i));
        best = sum > most ? ratio_of(i) : best;
        most = fmax(most, sum);
    }
    return best;
}

// The error of the mean of what parts of the picture show by themselves.
static double disagreement(const struct moved *moved, size_t n, double ratio)
{
    double square = 0.0;
    int parts = 0;
    for (int part = 0; part < PARTS * PARTS; part++) {
        size_t own = 0;
        for (size_t i = 0; i < n; i++)
            own += moved[i].part == part;
        if (own < few_pixels / 4)
            continue;
        square += pow(log(best_ratio(moved, n, part) / ratio), 2.0);
        parts++;
    }
    return parts > 1 ? sqrt(square / (parts - 1) / parts) : 1.0;
}

static void judge(struct grid_spacing *out, const struct moved *moved, size_t n,
                  const struct moves m[2])
{
    if (n < few_pixels)
        return;
    const double ratio = best_ratio(moved, n, -1);
    out->share = agree(moved, n, -1, ratio) / (double)n;
    out->error = disagreement(moved, n, ratio);
    const bool inside = ratio > ratio_of(1) && ratio < ratio_of(RATIOS - 2);
    if (inside && out->share >= least_share && out->error <= most_error)
        out->ratio = ratio * m[0].way / m[1].way;
}

relume_status grid_spacing(struct grid_spacing *out, const struct photo_set *set,
                           const struct camera_grid *grid, const struct relume_ingest_params *p)
{
    struct moves m[2] = {{.way = 0.0}, {.way = 0.0}};
    *out = (struct grid_spacing){.ratio = 0.0};
    relume_status status = find_moves(&m[0], set, grid, false, p);
    if (!status)
        status = find_moves(&m[1], set, grid, true, p);
    struct moved *moved = NULL;
    if (!status && !(moved = mem_array((size_t)m[0].width * (size_t)m[0].height, sizeof *moved)))
        status = RELUME_ENOMEM;
    if (!status)
        judge(out, moved, collect(moved, m), m);
    mem_free(moved);
    mem_free(m[0].plane);
    mem_free(m[1].plane);
    return status;
}
