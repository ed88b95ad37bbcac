// views_order.c - which way the rows and columns of cameras run
//
// A point's parallax over columns and over rows is one number: with one of the two turned round the
// cameras agree on no depth. With both turned they agree on a world turned inside out, near for
// far; then what occludes gives it away: a pixel that some cameras do not see lies behind its
// surroundings, so its disparity must be the smaller one there. Where many depths fit equally well
// nothing is concluded.
#include "multiview/views_order.h"

#include "base/log.h"
#include "base/memory.h"
#include "multiview/sweep.h"
#include "multiview/sweep_picture.h"

#include <math.h>
#include <relume/photograph.h>
#include <string.h>

enum { MOST_WIDTH = 320, AROUND = 9, WINDOW = 2, NEAR = 5 };
static const double most_shift = 1.0 / 8.0;  // of the width, between the middle and the outermost

struct orders {
    struct sweep sweep;
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
    const int factor = sweep_factor(image.width, MOST_WIDTH);
    o->sweep.width = image.width / factor;
    o->sweep.height = image.height / factor;
    const size_t bytes = 3 * (size_t)o->sweep.width * (size_t)o->sweep.height;
    uint8_t *picture = mem_array(bytes + 1, 1);
    if (picture)
        sweep_picture(picture, &image, factor);
    o->picture[o->sweep.views++] = picture;
    relume_image_destroy(&image);
    return picture ? RELUME_OK : RELUME_ENOMEM;
}

// The middle camera comes first.
static relume_status load_around(struct orders *o, const struct photo_set *set,
                                 const struct camera_grid *g, const struct relume_ingest_params *p)
{
    int columns[3], rows[3];
    const int across = three_of(columns, g->columns), down = three_of(rows, g->rows);
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

static double disparity_of(const struct orders *o, int plane)
{
    return plane - (o->planes - 1) / 2;
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
static void sweep_plane(float *least, float *mean, uint8_t *raw, const struct orders *o,
                        const struct sweep_target *target, int plane,
                        const struct sweep_scratch *scratch)
{
    const int width = o->sweep.width, height = o->sweep.height;
    uint8_t *all = raw + (size_t)width * (size_t)height;
    for (int y = 0; y < height; y++)
        sweep_row(raw + y * width, all + y * width, &o->sweep, target, disparity_of(o, plane), y,
                  scratch);
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

static relume_status sweep_middle(struct findings *f, const struct orders *o)
{
    const size_t n = (size_t)o->sweep.width * (size_t)o->sweep.height;
    const struct sweep_target target = sweep_target(&o->sweep, 0, AROUND - 1);
    const size_t planes = (size_t)o->planes;
    uint8_t *raw = mem_array(n, 2);
    float *costs = mem_array(n * planes, 2 * sizeof *costs);
    struct sweep_scratch scratch;
    relume_status status = sweep_scratch_create(&scratch, o->sweep.width);
    if (!status && (!raw || !costs))
        status = RELUME_ENOMEM;
    for (size_t q = 0; !status && q < planes; q++)
        sweep_plane(costs + q * n, costs + (planes + q) * n, raw, o, &target, (int)q, &scratch);
    if (!status)
        choose_planes(f, costs, costs + planes * n, n, o->planes);
    sweep_scratch_free(&scratch);
    free(raw);
    free(costs);
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
    relume_status status = sweep_middle(&f[0], o);
    for (int i = 0; i < o->sweep.views; i++)
        o->at[i][1] = -o->at[i][1];
    if (!status && both_ways)
        status = sweep_middle(&f[1], o);
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
    relume_status status = load_around(&o, set, grid, p);
    float *room = NULL;
    const size_t n = (size_t)o.sweep.width * (size_t)o.sweep.height;
    if (!status && !(room = mem_array(4 * n, sizeof *room)))
        status = RELUME_ENOMEM;
    if (!status) {
        scale(&o);
        for (int i = 0; i < 2; i++) {
            f[i].plane = room + (size_t)(2 * i) * n;
            f[i].hidden = room + (size_t)(2 * i + 1) * n;
        }
        status = decide(out, &o, f, grid->rows > 1 && grid->columns > 1);
    }
    free(room);
    for (int i = 0; i < o.sweep.views; i++)
        free(o.picture[i]);
    return status;
}
