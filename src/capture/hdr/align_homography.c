// align_homography.c - one homography by enhanced correlation (Evangelidis, Psarakis 2008)
//
// The correlation of the anchor's structure with the warped image's is raised by Gauss-Newton steps
// (their Eq. 16 to 20), coarse to fine. Structures are normalised gradient magnitudes: they change
// little with exposure and light. The coarsest level tries rolls and shifts one by one.
//
// A homography of one level takes the anchor's pixels, from the middle and in units of half the
// longer side, to those of the image; so its entries mean the same on every level.
#include <relume/capture/align.h>

#include "capture/hdr/pyramid.h"
#include "capture/hdr/structure.h"
#include "capture/hdr/tones.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"

#include <math.h>
#include <string.h>

enum { COARSE = 80, FINE = 1400, ROUNDS = 15, BAND = 16, PARAMETERS = 8, SIMILARITY_SIZE = 256 };
static const double small_step = 1e-2;  // pixels in the corners: then a level is done
static const double per_move = 2.0;     // share of the correlation that half a picture costs
static const double most_shift = 0.12;  // of the longer side, tried on the coarsest level
static const double default_roll_deg = 12.0, roll_step_deg = 3.0;
static const double least_correlation = 0.02;

// What one band of rows adds to the normal equations.
struct sums {
    double n, a, b, aa, bb, ab;
    double gram[PARAMETERS * PARAMETERS];
    double ga[PARAMETERS], gb[PARAMETERS], g[PARAMETERS];
};

struct ecc {
    const struct relume_image *anchor, *image;  // structures
    double scale;                               // pixels in half the longer side
    double h[9];
    int parameters;  // 6: affine, 8
    struct sums *band;
};

// Bilinear value and gradient at pixel centres; false outside.
static inline bool look(const struct relume_image *image, double x, double y, double *v, double *gx,
                        double *gy)
{
    const double u = x - 0.5, w = y - 0.5;
    if (!(u >= 0.0 && w >= 0.0 && u < image->width - 1 && w < image->height - 1))
        return false;
    const int i = (int)u, j = (int)w;
    const double s = u - i, t = w - j;
    const float *p = image->data + (size_t)j * (size_t)image->width + (size_t)i;
    const double a = (double)p[0], b = (double)p[1];
    const double c = (double)p[image->width], d = (double)p[image->width + 1];
    *gx = (1.0 - t) * (b - a) + t * (d - c);
    *gy = (1.0 - s) * (c - a) + s * (d - b);
    *v = (1.0 - t) * (a + s * (b - a)) + t * (c + s * (d - c));
    return true;
}

static void add_pixel(struct sums *s, int parameters, double a, double b, const double *g)
{
    s->n += 1.0;
    s->a += a;
    s->b += b;
    s->aa += a * a;
    s->bb += b * b;
    s->ab += a * b;
    for (int i = 0; i < parameters; i++) {
        s->g[i] += g[i];
        s->ga[i] += g[i] * a;
        s->gb[i] += g[i] * b;
        for (int j = 0; j <= i; j++)
            s->gram[PARAMETERS * i + j] += g[i] * g[j];
    }
}

static void sum_band(void *context, size_t band, int worker)
{
    const struct ecc *e = context;
    struct sums *s = &e->band[band];
    (void)worker;
    *s = (struct sums){0};
    const int width = e->anchor->width, height = e->anchor->height;
    const int end = (int)(band + 1) * BAND < height ? (int)(band + 1) * BAND : height;
    const double *h = e->h;
    for (int row = (int)band * BAND; row < end; row++)
        for (int column = 0; column < width; column++) {
            const double x = (column + 0.5 - 0.5 * width) / e->scale;
            const double y = (row + 0.5 - 0.5 * height) / e->scale;
            const double z = 1.0 / (h[6] * x + h[7] * y + 1.0);
            const double u = (h[0] * x + h[1] * y + h[2]) * z;
            const double v = (h[3] * x + h[4] * y + h[5]) * z;
            double b, gx, gy;
            if (!look(e->image, u * e->scale + 0.5 * width, v * e->scale + 0.5 * height, &b, &gx,
                      &gy))
                continue;
            gx *= e->scale * z;
            gy *= e->scale * z;
            const double p = -(gx * u + gy * v);
            const double g[PARAMETERS] = {gx * x, gx * y, gx, gy * x, gy * y, gy, p * x, p * y};
            const float a = e->anchor->data[(size_t)row * (size_t)width + (size_t)column];
            add_pixel(s, e->parameters, (double)a, b, g);
        }
}

static struct sums sum_all(const struct ecc *e, int threads)
{
    struct sums all = {0};
    const size_t bands = ((size_t)e->anchor->height + BAND - 1) / BAND;
    thread_for(threads, bands, sum_band, (void *)e);
    double *to = (double *)&all;
    for (size_t i = 0; i < bands; i++)
        for (size_t k = 0; k < sizeof all / sizeof *to; k++)
            to[k] += ((const double *)&e->band[i])[k];
    return all;
}

static double correlation_of(const struct sums *s, const struct ecc *e)
{
    const double aa = s->aa - s->a * s->a / s->n, bb = s->bb - s->b * s->b / s->n;
    if (s->n < 0.25 * e->anchor->width * e->anchor->height || !(aa > 0.0) || !(bb > 0.0))
        return -1.0;
    return (s->ab - s->a * s->b / s->n) / sqrt(aa * bb);
}

// Gauss-Newton step of the enhanced correlation; false when the equations fail.
static bool step_of(struct sums *s, int parameters, double step[PARAMETERS])
{
    double gram[PARAMETERS * PARAMETERS], x[2][PARAMETERS], a[PARAMETERS], b[PARAMETERS];
    const double ab = s->ab - s->a * s->b / s->n, bb = s->bb - s->b * s->b / s->n;
    for (int i = 0; i < parameters; i++) {  // of values less their means
        a[i] = s->ga[i] - s->g[i] * s->a / s->n;
        b[i] = s->gb[i] - s->g[i] * s->b / s->n;
        x[0][i] = a[i];
        x[1][i] = b[i];
        for (int j = 0; j <= i; j++)
            gram[parameters * i + j] = s->gram[PARAMETERS * i + j];
        gram[(parameters + 1) * i] *= 1.0 + 1e-9;
    }
    double packed[2 * PARAMETERS];
    memcpy(packed, x[0], (size_t)parameters * sizeof *packed);
    memcpy(packed + parameters, x[1], (size_t)parameters * sizeof *packed);
    if (!lsq_solve(gram, parameters, packed, 2))
        return false;
    double above = bb, below = ab;
    for (int i = 0; i < parameters; i++) {
        above -= b[i] * packed[parameters + i];
        below -= a[i] * packed[parameters + i];
    }
    const double lambda = below > 0.0 ? above / below : ab > 0.0 ? bb / ab : 0.0;
    for (int i = 0; i < parameters; i++)
        step[i] = lambda * packed[i] - packed[parameters + i];
    return true;
}

// How far a step moves the corners, pixels.
static double reach(const struct ecc *e, const double *step)
{
    double sum = 0.0;
    for (int i = 0; i < e->parameters; i++)
        sum += fabs(step[i]);
    return sum * e->scale;
}

static double climb(struct ecc *e, int threads)
{
    double best = -1.0, at_best[9];
    memcpy(at_best, e->h, sizeof at_best);
    for (int round = 0; round < ROUNDS; round++) {
        double step[PARAMETERS] = {0.0};
        struct sums s = sum_all(e, threads);
        const double correlation = correlation_of(&s, e);
        if (correlation < best - 1e-3 || correlation <= -1.0)
            break;
        if (correlation > best) {
            best = correlation;
            memcpy(at_best, e->h, sizeof at_best);
        }
        if (!step_of(&s, e->parameters, step))
            break;
        for (int i = 0; i < e->parameters; i++)
            e->h[i] += step[i];
        if (reach(e, step) < small_step)
            break;
    }
    memcpy(e->h, at_best, sizeof at_best);
    return best;
}

// ---------------------------------------------------------------- levels

static void set_pose(double h[9], double roll_deg, double x, double y)
{
    const double a = roll_deg * 0.017453292519943295, c = cos(a), s = sin(a);
    const double pose[9] = {c, -s, x, s, c, y, 0.0, 0.0, 1.0};
    memcpy(h, pose, sizeof pose);
}

// What moves by less is believed where correlations are nearly equal: rows of tiles fit each other.
static double likely(double correlation, const double h[9])
{
    return correlation * (1.0 - per_move * fmin(hypot(h[2] / h[8], h[5] / h[8]), 1.0 / per_move));
}

// The best of all rolls and shifts, each climbed from the best shift of its roll.
static void start(struct ecc *e, double max_roll_deg, int threads)
{
    double best = -2.0, best_h[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const int rolls = (int)(max_roll_deg / roll_step_deg + 0.5);
    const int shifts = (int)(most_shift * 2.0 * e->scale / 2.0 + 0.5);
    for (int k = -rolls; k <= rolls; k++) {
        double peak = -2.0, pose[9];
        e->parameters = 0;
        for (int y = -shifts; y <= shifts; y++)
            for (int x = -shifts; x <= shifts; x++) {
                set_pose(e->h, k * roll_step_deg, 2.0 * x / e->scale, 2.0 * y / e->scale);
                const struct sums s = sum_all(e, 1);
                const double correlation = likely(correlation_of(&s, e), e->h);
                if (correlation > peak) {
                    peak = correlation;
                    memcpy(pose, e->h, sizeof pose);
                }
            }
        memcpy(e->h, pose, sizeof pose);
        e->parameters = 6;
        peak = likely(climb(e, threads), e->h);
        if (peak > best) {
            best = peak;
            memcpy(best_h, e->h, sizeof best_h);
        }
    }
    memcpy(e->h, best_h, sizeof best_h);
}

static relume_status prepare(struct ecc *e, struct relume_image structure[2],
                             const struct relume_image *anchor, const struct relume_image *image,
                             int threads)
{
    const size_t bands = ((size_t)anchor->height + BAND - 1) / BAND;
    relume_status status = structure_make(&structure[0], anchor, threads);
    if (!status)
        status = structure_make(&structure[1], image, threads);
    e->anchor = &structure[0];
    e->image = &structure[1];
    e->scale = 0.5 * (anchor->width > anchor->height ? anchor->width : anchor->height);
    e->band = mem_array(bands, sizeof *e->band);
    return status || e->band ? status : RELUME_ENOMEM;
}

static relume_status align_level(double h[9], double *correlation,
                                 const struct relume_image *anchor,
                                 const struct relume_image *image, bool coarsest,
                                 double max_roll_deg, int threads)
{
    struct relume_image structure[2] = {{0}, {0}};
    struct ecc e = {.parameters = PARAMETERS};
    memcpy(e.h, h, sizeof e.h);
    const relume_status status = prepare(&e, structure, anchor, image, threads);
    if (!status) {
        if (coarsest)
            start(&e, max_roll_deg, threads);
        e.parameters = coarsest ? 6 : PARAMETERS;
        *correlation = climb(&e, threads);
        memcpy(h, e.h, sizeof e.h);
    }
    mem_free(e.band);
    relume_image_destroy(&structure[0]);
    relume_image_destroy(&structure[1]);
    return status;
}

// m = (units -> pixels) h (pixels -> units).
static void to_pixels(struct relume_homography *out, const double h[9], int width, int height)
{
    const double s = 0.5 * (width > height ? width : height), x = 0.5 * width, y = 0.5 * height;
    const double in[9] = {1 / s, 0, -x / s, 0, 1 / s, -y / s, 0, 0, 1};
    const double back[9] = {s, 0, x, 0, s, y, 0, 0, 1};
    double a[9] = {0.0}, m[9] = {0.0};
    for (int i = 0; i < 9; i++)
        for (int k = 0; k < 3; k++)
            a[i] += h[3 * (i / 3) + k] * in[3 * k + i % 3];
    for (int i = 0; i < 9; i++)
        for (int k = 0; k < 3; k++)
            m[i] += back[3 * (i / 3) + k] * a[3 * k + i % 3];
    for (int i = 0; i < 9; i++)
        out->m[i / 3][i % 3] = m[i] / m[8];
}

static relume_status lumas(struct pyramid *out, const struct relume_image *image, int threads)
{
    struct relume_image luma;
    relume_status status = structure_luma(&luma, image, threads);
    if (!status)
        status = pyramid_make(out, &luma, COARSE, threads);
    relume_image_destroy(&luma);
    return status;
}

relume_status relume_align_homography(struct relume_homography *out,
                                      const struct relume_image *anchor,
                                      const struct relume_image *image,
                                      const struct relume_align_params *params)
{
    const struct relume_align_params p = PARAMS_WORK(relume_align_params, params);
    const double roll_deg = p.max_roll_deg > 0.0 ? p.max_roll_deg : default_roll_deg;
    double h[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    *out = (struct relume_homography){.m = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    if (anchor->channels != 3 || image->channels != 3 || anchor->width != image->width ||
        anchor->height != image->height || anchor->width < 16 || anchor->height < 16)
        return log_fail(p.log, RELUME_EINVAL,
                        "alignment: expected two pictures of 3 channels, equal sizes and 16 x 16 "
                        "pixels or more");
    struct pyramid a = {0}, b = {0};
    relume_status status = lumas(&a, anchor, p.threads);
    if (!status)
        status = lumas(&b, image, p.threads);
    for (int i = a.levels - 1; !status && i >= 0; i--)
        if (i == a.levels - 1 || pyramid_longer_side(&a.level[i]) <= FINE)
            status = align_level(h, &out->correlation, &a.level[i], &b.level[i], i == a.levels - 1,
                                 roll_deg, p.threads);
    pyramid_free(&a);
    pyramid_free(&b);
    if (!status && !(out->correlation > least_correlation))
        status = log_fail(p.log, RELUME_EUNFIT,
                          "alignment: the pictures have nothing in common (correlation %.2f)",
                          out->correlation);
    if (!status)
        to_pixels(out, h, anchor->width, anchor->height);
    return status;
}

static double mean(const struct relume_image *image)
{
    const size_t samples = (size_t)image->width * (size_t)image->height * 3;
    double sum = 0.0;
    for (size_t i = 0; i < samples; i++)
        sum += (double)image->data[i];
    return sum / (double)samples;
}

static double similarity_of(const struct relume_image *dark, const struct relume_image *bright)
{
    struct relume_image clipped = {0}, luma[2] = {{0}, {0}}, structure[2] = {{0}, {0}};
    struct ecc e = {.parameters = 0, .h = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    double similarity = -1.0;
    relume_status status = tones_match(&clipped, dark, bright, 1);
    if (!status)
        status = structure_luma(&luma[0], &clipped, 1);
    if (!status)
        status = structure_luma(&luma[1], bright, 1);
    if (!status)
        status = prepare(&e, structure, &luma[0], &luma[1], 1);
    if (!status) {
        const struct sums s = sum_all(&e, 1);
        similarity = correlation_of(&s, &e);
    }
    mem_free(e.band);
    relume_image_destroy(&clipped);
    for (int i = 0; i < 2; i++) {
        relume_image_destroy(&luma[i]);
        relume_image_destroy(&structure[i]);
    }
    return similarity > -1.0 ? similarity : (double)NAN;
}

// The darker one is given the tones of the brighter one: it saturates where that does.
double relume_edge_correlation(const struct relume_image *a, const struct relume_image *b)
{
    struct pyramid pa = {0}, pb = {0};
    double similarity = NAN;
    if (a->width != b->width || a->height != b->height || a->channels != 3 || b->channels != 3)
        return similarity;
    relume_status status = pyramid_make(&pa, a, SIMILARITY_SIZE, 1);
    if (!status)
        status = pyramid_make(&pb, b, SIMILARITY_SIZE, 1);
    if (!status) {
        const struct relume_image *x = &pa.level[pa.levels - 1], *y = &pb.level[pb.levels - 1];
        similarity = mean(x) < mean(y) ? similarity_of(x, y) : similarity_of(y, x);
    }
    pyramid_free(&pa);
    pyramid_free(&pb);
    return similarity;
}
