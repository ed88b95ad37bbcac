// judge.c - see judge.h
//
// Differences are means over about three pixels across, as narrow as a scratch is. The statistic of
// a pixel is the square of its difference over its variance, of two components of the normal, and
// of three of the colour. Its variance is that of both captures (means of the halves' differences
// around it), what a shift by a fraction of a pixel makes where the surface changes fast, and a
// floor. The statistic's scale is set by its median; its p-value is that of chi squared.
#include "material/change/judge.h"

#include "core/base/memory.h"
#include "core/math/bilinear.h"
#include "core/math/scalar.h"
#include "core/math/sort.h"
#include "core/math/vec.h"
#include "image/compare/ciede2000.h"
#include "material/change/smooth.h"

#include <math.h>
#include <string.h>

static const double sharp = 1.0;       // pixels: differences are means of this deviation
static const double around = 3.0;      // ... and the noise of them
static const double wide = 16.0;       // ... that of neighbourhoods, at most,
static const double wide_part = 20.0;  // or this part of the picture's side
static const double smooth_part = 0.75, smooth_chi = 1.323;  // quantile of smooth differences
static const double freedom = 20.0;                          // degrees of freedom of a variance
static const double floor_normal = 4e-3;                     // a quarter of a degree
static const double floor_colour = 2e-3;                     // cube root
static const double floor_gloss = 5e-3;                      // of white
static const double least_scale = 0.06;  // of the statistic, of what is expected
static const double steep_part = 0.9;    // of the pixels are less steep than those that tell shifts
static const double most_shift = 1.0, least_shift = 0.05;           // pixels
static const double median_chi[4] = {0.0, 0.4549, 1.3863, 2.3660};  // of 1, 2, 3 components

struct judged {
    const struct surface *a, *b;
    size_t n;
    int threads;
    struct relume_image known;
    struct relume_image difference;  // three channels
    struct relume_image variance;    // three
    struct relume_image slope;       // three: squares of the change per pixel
    struct relume_image statistic;   // one
    double scale;                    // of the variances, by the bulk of the picture
};

static relume_status known_of(struct judged *j)
{
    const relume_status status = relume_image_create(&j->known, j->a->width, j->a->height, 1);
    for (size_t i = 0; !status && i < j->n; i++)
        j->known.data[i] = surface_knows(j->a, i) && surface_knows(j->b, i) ? 1.0f : 0.0f;
    return status;
}

static relume_status difference_of(struct judged *j, const struct relume_image *a,
                                   const struct relume_image *b)
{
    const relume_status status = relume_image_create(&j->difference, a->width, a->height, 3);
    if (status)
        return status;
    for (size_t i = 0; i < 3 * j->n; i++)
        j->difference.data[i] = a->data[i] - b->data[i];
    return smooth_known(&j->difference, &j->known, sharp, j->threads);
}

// A smoothed copy.
static relume_status copy_known(struct relume_image *out, const struct judged *j,
                                const struct relume_image *image)
{
    relume_status status = relume_image_create(out, image->width, image->height, 3);
    if (!status)
        memcpy(out->data, image->data, 3 * j->n * sizeof *image->data);
    return status ? status : smooth_known(out, &j->known, sharp, j->threads);
}

static double wide_of(const struct judged *j)
{
    return fmin(wide, fmax(j->a->width, j->a->height) / wide_part);
}

// Adds the mean square of smoothed noise, of what is close or of all around.
static relume_status add_noise(struct judged *j, const struct relume_image *noise)
{
    struct relume_image own = {0}, far = {0};
    relume_status status = copy_known(&own, j, noise);
    for (size_t i = 0; !status && i < 3 * j->n; i++)
        own.data[i] *= own.data[i];
    if (!status)
        status = smooth_known(&own, &j->known, around, j->threads);
    if (!status)
        status = relume_image_create(&far, own.width, own.height, 3);
    if (!status) {
        memcpy(far.data, own.data, 3 * j->n * sizeof *own.data);
        status = smooth_known(&far, &j->known, wide_of(j), j->threads);
    }
    for (size_t i = 0; !status && i < 3 * j->n; i++)
        j->variance.data[i] += fmaxf(own.data[i], far.data[i]);
    relume_image_destroy(&own);
    relume_image_destroy(&far);
    return status;
}

// Adds, everywhere, the usual square of differences that are smooth.
static relume_status add_smooth(struct judged *j)
{
    struct relume_image far;
    double *some = mem_array(j->n, sizeof *some);
    relume_status status = relume_image_create(&far, j->a->width, j->a->height, 3);
    if (!status && !some)
        status = RELUME_ENOMEM;
    if (!status) {
        memcpy(far.data, j->difference.data, 3 * j->n * sizeof *far.data);
        status = smooth_known(&far, &j->known, wide_of(j), j->threads);
    }
    for (size_t c = 0; !status && c < 3; c++) {
        size_t count = 0;
        for (size_t i = 0; i < j->n; i++)
            if (j->known.data[i] > 0.5f)
                some[count++] = (double)far.data[3 * i + c] * (double)far.data[3 * i + c];
        sort_doubles(some, count);
        const double usual =
            count ? some[(size_t)(smooth_part * (double)(count - 1))] / smooth_chi : 0.0;
        for (size_t i = 0; i < j->n; i++)
            j->variance.data[3 * i + c] += (float)usual;
    }
    relume_image_destroy(&far);
    mem_free(some);
    return status;
}

static relume_status variance_of(struct judged *j, const struct relume_image *a,
                                 const struct relume_image *b)
{
    relume_status status = relume_image_create(&j->variance, a->width, a->height, 3);
    if (!status)
        status = add_smooth(j);
    if (!status)
        status = add_noise(j, a);
    if (!status)
        status = add_noise(j, b);
    return status;
}

// Squares of the changes from pixel to pixel.
static relume_status slope_in(struct relume_image *out, const struct judged *j,
                              const struct relume_image *of)
{
    struct relume_image soft;
    relume_status status = copy_known(&soft, j, of);
    if (!status)
        status = relume_image_create(out, of->width, of->height, 3);
    const size_t width = (size_t)of->width;
    for (size_t i = 0; !status && i < 3 * j->n; i++) {
        const size_t at = i / 3, c = i % 3, x = at % width, y = at / width;
        const size_t left = at - (x > 0), right = at + (x + 1 < width),
                     above = at - (y > 0 ? width : 0),
                     below = at + (y + 1 < (size_t)of->height ? width : 0);
        const float across = 0.5f * (soft.data[3 * right + c] - soft.data[3 * left + c]),
                    down = 0.5f * (soft.data[3 * below + c] - soft.data[3 * above + c]);
        out->data[i] = across * across + down * down;
    }
    relume_image_destroy(&soft);
    return status ? status : smooth_known(out, &j->known, 1.5 * sharp, j->threads);
}

// The lesser of both captures: a new scratch does not excuse itself by being steep.
static relume_status slope_of(struct judged *j, const struct relume_image *a,
                              const struct relume_image *b)
{
    struct relume_image other = {0};
    relume_status status = slope_in(&j->slope, j, a);
    if (!status)
        status = slope_in(&other, j, b);
    for (size_t i = 0; !status && i < 3 * j->n; i++)
        j->slope.data[i] = fminf(j->slope.data[i], other.data[i]);
    relume_image_destroy(&other);
    return status;
}

static double sum3(const float *v)
{
    return (double)v[0] + (double)v[1] + (double)v[2];
}

static double square3(const float *v)
{
    return (double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2];
}

// How far places are off, pixels: what the steepest pixels differ in beyond their noise, half of
// each pixel's slope lying along the shift.
static relume_status shift_of(double *shift, const struct judged *j)
{
    double *steep = mem_array(j->n, sizeof *steep), *excess = mem_array(j->n, sizeof *excess);
    size_t count = 0, some = 0;
    *shift = least_shift;
    if (!steep || !excess) {
        mem_free(steep);
        mem_free(excess);
        return RELUME_ENOMEM;
    }
    for (size_t i = 0; i < j->n; i++)
        if (j->known.data[i] > 0.5f)
            steep[count++] = sum3(j->slope.data + 3 * i);
    sort_doubles(steep, count);
    const double least = steep[(size_t)(steep_part * (double)(count - 1))];
    for (size_t i = 0; i < j->n; i++) {
        const double slope = sum3(j->slope.data + 3 * i);
        if (j->known.data[i] > 0.5f && slope > least)
            excess[some++] =
                (square3(j->difference.data + 3 * i) / 0.4549 - sum3(j->variance.data + 3 * i)) /
                (0.5 * slope);
    }
    sort_doubles(excess, some);
    if (some && excess[some / 2] > 0.0)
        *shift = fmin(fmax(sqrt(excess[some / 2]), least_shift), most_shift);
    mem_free(steep);
    mem_free(excess);
    return RELUME_OK;
}

// ---------------------------------------------------------------- probabilities

// -log10 of the probability that F is at least the mean of the components' squares: that of two of
// them, whose tail is a power; of three it is less.
static double improbable(double sum, int components)
{
    return fmin(0.5 * freedom * log10(1.0 + 2.0 * sum / components / freedom), 300.0);
}

// The statistic of every known pixel, its scale set by the median.
static relume_status statistics(struct judged *j, const double floor, double shift, int components)
{
    double *some = mem_array(j->n, sizeof *some);
    size_t count = 0;
    if (!some)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < j->n; i++) {
        const float *d = j->difference.data + 3 * i, *v = j->variance.data + 3 * i,
                    *s = j->slope.data + 3 * i;
        double sum = 0.0;
        if (j->known.data[i] < 0.5f)
            continue;
        if (components == 2) {  // three numbers, of which a unit vector has two
            const double all = sum3(v) + 0.5 * shift * shift * sum3(s) + 2.0 * floor * floor;
            sum = 2.0 * square3(d) / all;
        } else {
            for (int c = 0; c < 3; c++)
                sum += (double)d[c] * (double)d[c] /
                       ((double)v[c] + 0.5 * shift * shift * (double)s[c] + floor * floor);
        }
        j->statistic.data[i] = (float)sum;
        some[count++] = sum;
    }
    sort_doubles(some, count);
    j->scale = fmax(count ? some[count / 2] / median_chi[components] : 1.0, least_scale);
    for (size_t i = 0; i < j->n; i++)
        j->statistic.data[i] /= (float)j->scale;
    mem_free(some);
    return RELUME_OK;
}

// The -log10 of the probability from which on pixels are marked: of n probabilities in order the
// k-th may be at most share k / n (Benjamini, Hochberg 1995). INFINITY where none is.
static double mark_from(double *improbables, size_t n, double share)
{
    sort_doubles(improbables, n);
    for (size_t i = 0; i < n; i++)  // ascending: n - i pixels are as improbable, or more so
        if (improbables[i] >= -log10(share * (double)(n - i) / (double)n))
            return improbables[i];
    return INFINITY;
}

static relume_status mark(struct relume_change *out, struct judged *j, size_t channel,
                          int components, double share, const struct relume_image *size,
                          double least)
{
    double *some = mem_array(j->n, sizeof *some);
    size_t count = 0;
    if (!some)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < j->n; i++)
        if (j->known.data[i] > 0.5f) {
            // the tail of one component is below that of two with half of its square each
            some[count] = improbable((double)j->statistic.data[i], larger_of(components, 2));
            out->significance.data[3 * i + channel] = (float)some[count++];
        }
    const double from = mark_from(some, count, share);
    for (size_t i = 0; i < j->n; i++) {
        const bool marked = j->known.data[i] > 0.5f &&
                            (double)out->significance.data[3 * i + channel] >= from * 0.999999 &&
                            (double)size->data[i] >= least;
        out->changed.data[3 * i + channel] = marked ? 1.0f : 0.0f;
    }
    mem_free(some);
    return RELUME_OK;
}

static void clear(struct judged *j)
{
    relume_image_destroy(&j->difference);
    relume_image_destroy(&j->variance);
    relume_image_destroy(&j->slope);
}

static relume_status median_noise(double *out, const struct judged *j)
{
    double *some = mem_array(j->n, sizeof *some);
    size_t count = 0;
    if (!some)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < j->n; i++)
        if (j->known.data[i] > 0.5f)
            some[count++] = sum3(j->variance.data + 3 * i);
    sort_doubles(some, count);
    *out = count ? sqrt(j->scale * some[count / 2]) : 0.0;
    mem_free(some);
    return RELUME_OK;
}

// ---------------------------------------------------------------- shape

static relume_status judge_shape(struct relume_change *out, struct judged *j,
                                 const struct relume_change_params *p)
{
    relume_status status = difference_of(j, &j->a->normal, &j->b->normal);
    if (!status)
        status = variance_of(j, &j->a->normal_noise, &j->b->normal_noise);
    if (!status)
        status = slope_of(j, &j->a->normal, &j->b->normal);
    if (!status)
        status = shift_of(&out->misplaced, j);
    for (size_t i = 0; !status && i < j->n; i++)  // a chord between unit vectors
        out->degrees.data[i] =
            (float)(114.59155902616465 *
                    asin(fmin(0.5 * sqrt(square3(j->difference.data + 3 * i)), 1.0)));
    if (!status)
        status = statistics(j, floor_normal, out->misplaced, 2);
    if (!status)
        status = mark(out, j, 0, 2, p->false_share, &out->degrees, p->least_deg);
    if (!status)
        status = median_noise(&out->noise_deg, j);
    out->noise_deg *= 57.29577951308232;
    clear(j);
    return status;
}

// ---------------------------------------------------------------- colour

static void find_delta_e(struct relume_change *out, const struct relume_image *a,
                         const struct relume_image *b, size_t n)
{
    const struct ciede_tables *tables = ciede_tables();
    for (size_t first = 0; first < n; first += CIEDE_BLOCK) {
        const size_t count = n - first < CIEDE_BLOCK ? n - first : CIEDE_BLOCK;
        float rgb[2][3 * CIEDE_BLOCK], delta[CIEDE_BLOCK];
        struct lab_block lab[2] = {0};
        const struct relume_image *of[] = {a, b};
        for (int k = 0; k < 2; k++) {
            for (size_t i = 0; i < count; i++) {
                colour_linear(rgb[k] + 3 * i, of[k]->data + 3 * (first + i));
                for (size_t c = 0; c < 3; c++)
                    rgb[k][3 * i + c] = fminf(rgb[k][3 * i + c], 1.0f);
            }
            lab_from_linear(tables, &lab[k], rgb[k], (int)count);
        }
        ciede2000_block(tables, &lab[0], &lab[1], delta);
        memcpy(out->delta_e.data + first, delta, count * sizeof *delta);
    }
}

static relume_status measure_colour(struct relume_change *out, struct judged *j)
{
    struct relume_image soft[2] = {{0}, {0}};
    const struct relume_image *of[] = {&j->a->colour, &j->b->colour};
    relume_status status = RELUME_OK;
    for (int k = 0; !status && k < 2; k++)
        status = copy_known(&soft[k], j, of[k]);
    if (!status)
        find_delta_e(out, &soft[0], &soft[1], j->n);
    relume_image_destroy(&soft[0]);
    relume_image_destroy(&soft[1]);
    return status;
}

static relume_status judge_colour(struct relume_change *out, struct judged *j,
                                  const struct relume_change_params *p)
{
    double shift = 0.0;
    relume_status status = measure_colour(out, j);
    if (!status)
        status = difference_of(j, &j->a->colour, &j->b->colour);
    if (!status)
        status = variance_of(j, &j->a->colour_noise, &j->b->colour_noise);
    if (!status)
        status = slope_of(j, &j->a->colour, &j->b->colour);
    if (!status)
        status = shift_of(&shift, j);
    if (!status) {
        out->misplaced = fmax(out->misplaced, shift);
        status = statistics(j, floor_colour, shift, 3);
    }
    if (!status)
        status = mark(out, j, 1, 3, p->false_share, &out->delta_e, p->least_de);
    if (!status)
        status = median_noise(&out->noise_de, j);
    out->noise_de *= 100.0;  // 0.01 as a cube root is about one step of L*
    clear(j);
    return status;
}

// ---------------------------------------------------------------- gloss

static relume_status judge_gloss(struct relume_change *out, struct judged *j,
                                 const struct relume_change_params *p)
{
    struct relume_image size = {0};
    for (size_t i = 0; i < j->n; i++) {
        if (!surface_knows_gloss(j->a, i) || !surface_knows_gloss(j->b, i))
            j->known.data[i] = 0.0f;
        out->gloss_known += j->known.data[i] > 0.5f;
    }
    if (!out->gloss_known || out->gloss_known < (size_t)p->least_area)
        return RELUME_OK;
    relume_status status = difference_of(j, &j->a->gloss, &j->b->gloss);
    if (!status)
        status = variance_of(j, &j->a->gloss_noise, &j->b->gloss_noise);
    if (!status)
        status = slope_of(j, &j->a->gloss, &j->b->gloss);
    if (!status)
        status = relume_image_create(&size, out->width, out->height, 1);
    for (size_t i = 0; !status && i < j->n; i++) {
        out->gloss.data[i] = j->known.data[i] > 0.5f ? -j->difference.data[3 * i] : 0.0f;
        size.data[i] = fabsf(out->gloss.data[i]);
    }
    if (!status)
        status = statistics(j, floor_gloss, out->misplaced, 1);
    if (!status)
        status = mark(out, j, 2, 1, p->false_share, &size, p->least_gloss);
    if (!status)
        status = median_noise(&out->noise_gloss, j);
    relume_image_destroy(&size);
    clear(j);
    return status;
}

relume_status judge(struct relume_change *out, const struct surface *a, const struct surface *b,
                    const struct relume_change_params *params)
{
    struct judged j = {.a = a, .b = b, .threads = params->threads};
    j.n = (size_t)a->width * (size_t)a->height;
    relume_status status = known_of(&j);
    if (!status)
        status = relume_image_create(&j.statistic, a->width, a->height, 1);
    if (!status)
        status = judge_shape(out, &j, params);
    if (!status)
        status = judge_colour(out, &j, params);
    for (size_t i = 0; !status && i < j.n; i++)
        out->known += j.known.data[i] > 0.5f;
    if (!status)
        status = judge_gloss(out, &j, params);
    for (size_t i = 0; !status && i < j.n; i++) {
        float *c = out->changed.data + 3 * i;
        c[2] = c[0] > 0.5f || c[1] > 0.5f || c[2] > 0.5f ? 1.0f : 0.0f;
    }
    relume_image_destroy(&j.known);
    relume_image_destroy(&j.statistic);
    return status;
}
