// level.c - see level.h
//
// Lights that are not where they are thought to be turn and stretch all normals by one linear map
// (the ambiguity of photometric stereo: Belhumeur, Kriegman, Yuille 1999), and lamps that stand
// near bend them smoothly; exposures and lamps give colours a gain that changes smoothly. Both are
// fitted by least squares with Cauchy weights, in which quiet pixels count more than noisy ones.
#include "material/change/level.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "core/math/lsq.h"
#include "core/math/sort.h"
#include "core/math/vec.h"

#include <math.h>
#include <string.h>

enum { MOST = 60000, ROUNDS = 12, UNKNOWNS = 3 + LEVEL_TERMS };
static const double tuning = 2.385;      // as core/math/lambert.c
static const double darkest = 0.15;      // cube root: darker colours tell no gain
static const double proximal = 0.01;     // of a sample: how little the map leaves its last estimate
static const double least_scale = 1e-4;  // residuals are never thought to be smaller
static const double quiet = 0.3;         // of the median noise: pixels are never thought quieter
enum { NEAR = 2 };                       // pixels, around which noise is taken together

struct draw {
    const struct surface *a, *b;
    size_t count, *at;
    double *miss;  // [count], and a copy that is sorted
    double *sorted;
    double *worth[2];  // [count], of normals and of colours: 1 / variance, 1 at the median
};

static void terms_of(double t[LEVEL_TERMS], const struct surface *s, size_t at)
{
    const double x = 2.0 * ((double)(at % (size_t)s->width) + 0.5) / s->width - 1.0,
                 y = 2.0 * ((double)(at / (size_t)s->width) + 0.5) / s->height - 1.0;
    const double all[LEVEL_TERMS] = {1.0, x, y, x * x, x * y, y * y};
    memcpy(t, all, sizeof all);
}

static double sum_of(const double *a, const double *b, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

static double square3(const float *v)
{
    return (double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2];
}

static double noise_around(const struct relume_image *noise, size_t at)
{
    const int x = (int)(at % (size_t)noise->width), y = (int)(at / (size_t)noise->width);
    double sum = 0.0;
    for (int j = y - NEAR; j <= y + NEAR; j++)
        for (int i = x - NEAR; i <= x + NEAR; i++)
            sum += square3(noise->data +
                           3 * ((size_t)index_clamped(j, noise->height) * (size_t)noise->width +
                                (size_t)index_clamped(i, noise->width)));
    return sum;
}

static void find_worth(double *worth, const struct draw *d, const struct relume_image *a,
                       const struct relume_image *b)
{
    for (size_t i = 0; i < d->count; i++)
        d->sorted[i] = worth[i] = noise_around(a, d->at[i]) + noise_around(b, d->at[i]);
    sort_doubles(d->sorted, d->count);
    const double median = d->count ? fmax(d->sorted[d->count / 2], 1e-12) : 1.0;
    for (size_t i = 0; i < d->count; i++)
        worth[i] = 1.0 / (quiet * quiet + worth[i] / median);
}

static relume_status draw_sample(struct draw *d, const struct surface *a, const struct surface *b)
{
    const size_t n = (size_t)a->width * (size_t)a->height;
    size_t known = 0;
    *d = (struct draw){.a = a, .b = b};
    for (size_t i = 0; i < n; i++)
        known += surface_knows(a, i) && surface_knows(b, i);
    const size_t step = known / MOST + 1;
    d->at = mem_array(known / step + 1, sizeof *d->at);
    d->miss = mem_array(known / step + 1, sizeof *d->miss);
    d->sorted = mem_array(known / step + 1, sizeof *d->sorted);
    for (int k = 0; k < 2; k++)
        d->worth[k] = mem_array(known / step + 1, sizeof *d->worth[k]);
    if (!d->at || !d->miss || !d->sorted || !d->worth[0] || !d->worth[1])
        return RELUME_ENOMEM;
    for (size_t i = 0, k = 0; i < n; i++)
        if (surface_knows(a, i) && surface_knows(b, i) && k++ % step == 0)
            d->at[d->count++] = i;
    find_worth(d->worth[0], d, &a->normal_noise, &b->normal_noise);
    find_worth(d->worth[1], d, &a->colour_noise, &b->colour_noise);
    return RELUME_OK;
}

static void give_back(struct draw *d)
{
    mem_free(d->at);
    mem_free(d->miss);
    mem_free(d->sorted);
    mem_free(d->worth[0]);
    mem_free(d->worth[1]);
}

// The median of |miss|, as a deviation of a pixel of worth 1.
static double scale_of(struct draw *d, int which)
{
    for (size_t i = 0; i < d->count; i++)
        d->sorted[i] = fabs(d->miss[i]) * sqrt(d->worth[which][i]);
    sort_doubles(d->sorted, d->count);
    return fmax(1.4826 * d->sorted[d->count / 2], least_scale);
}

static double weight_of(double miss, double scale)
{
    const double r = miss / (tuning * scale);
    return 1.0 / (1.0 + r * r);
}

// ---------------------------------------------------------------- normals

static vec3 turned(const struct level *l, const float n[3])
{
    double v[3];
    for (int i = 0; i < 3; i++)
        v[i] = l->turn[i][0] * (double)n[0] + l->turn[i][1] * (double)n[1] +
               l->turn[i][2] * (double)n[2];
    return vec3_unit(vec3_of(v[0], v[1], v[2]));
}

static void miss_normals(struct draw *d, const struct level *l)
{
    for (size_t i = 0; i < d->count; i++) {
        const float *a = d->a->normal.data + 3 * d->at[i];
        const vec3 b = turned(l, d->b->normal.data + 3 * d->at[i]);
        double t[LEVEL_TERMS];
        terms_of(t, d->a, d->at[i]);
        d->miss[i] = hypot((double)a[0] - b.x - sum_of(l->bend[0], t, LEVEL_TERMS),
                           (double)a[1] - b.y - sum_of(l->bend[1], t, LEVEL_TERMS));
    }
}

// One row of the map and its bend; the map's constant and the bend's are told apart by `proximal`.
static bool solve_row(struct level *l, const struct draw *d, int row, int terms, double scale)
{
    const int n = 3 + (row < 2 ? terms : 0);
    double gram[UNKNOWNS * UNKNOWNS] = {0}, x[UNKNOWNS] = {0};
    double *const now[] = {l->turn[row], row < 2 ? l->bend[row] : NULL};
    for (size_t i = 0; i < d->count; i++) {
        const float *a = d->a->normal.data + 3 * d->at[i], *b = d->b->normal.data + 3 * d->at[i];
        const double w = d->worth[0][i] * weight_of(d->miss[i], scale / sqrt(d->worth[0][i]));
        double v[UNKNOWNS] = {(double)b[0], (double)b[1], (double)b[2]};
        terms_of(v + 3, d->a, d->at[i]);
        for (int j = 0; j < n; j++) {
            x[j] += w * v[j] * (double)a[row];
            for (int k = 0; k <= j; k++)
                gram[n * j + k] += w * v[j] * v[k];
        }
    }
    for (int j = 0; j < n; j++) {
        const double hold = proximal * (double)d->count;
        gram[(n + 1) * j] += hold;
        x[j] += hold * (j < 3 ? now[0][j] : now[1][j - 3]);
    }
    if (!lsq_solve(gram, n, x, 1))
        return false;
    memcpy(l->turn[row], x, 3 * sizeof *x);
    if (n > 3)
        memcpy(l->bend[row], x + 3, (size_t)terms * sizeof *x);
    return true;
}

static void level_normals(struct level *l, struct draw *d, bool keep_bend)
{
    const int terms = keep_bend ? 1 : LEVEL_TERMS;
    for (int round = 0; round < ROUNDS; round++) {
        miss_normals(d, l);
        const double scale = scale_of(d, 0);
        const struct level before = *l;
        for (int row = 0; row < 3; row++)
            if (!solve_row(l, d, row, terms, scale)) {
                *l = before;
                return;
            }
    }
}

static double largest_bend(const struct level *l, const struct surface *s)
{
    double most = 0.0;
    for (size_t i = 0; i < 81; i++) {
        const size_t at = (i / 9) * (size_t)(s->height - 1) / 8 * (size_t)s->width +
                          (i % 9) * (size_t)(s->width - 1) / 8;
        double t[LEVEL_TERMS];
        terms_of(t, s, at);
        most = fmax(most, hypot(sum_of(l->bend[0] + 1, t + 1, LEVEL_TERMS - 1),
                                sum_of(l->bend[1] + 1, t + 1, LEVEL_TERMS - 1)));
    }
    return most * 57.29577951308232;
}

// ---------------------------------------------------------------- colours

static void roots_of(double root[3], const float code[3])
{
    const double b = (double)code[0] - (double)code[2] * 2.0 / 3.0, mean = b + (double)code[2];
    root[0] = mean + 0.5 * (double)code[1], root[1] = mean - 0.5 * (double)code[1], root[2] = b;
}

static void code_of_roots(float code[3], const double root[3])
{
    code[0] = (float)((root[0] + root[1] + root[2]) / 3.0);
    code[1] = (float)(root[0] - root[1]);
    code[2] = (float)(0.5 * (root[0] + root[1]) - root[2]);
}

// The logarithm of a / b of one colour; false where either is too dark.
static bool log_ratio(double *out, const struct draw *d, size_t at, int c)
{
    double a[3], b[3];
    roots_of(a, d->a->colour.data + 3 * at);
    roots_of(b, d->b->colour.data + 3 * at);
    if (!(a[c] > darkest && b[c] > darkest))
        return false;
    *out = log(a[c] / b[c]);
    return true;
}

static void miss_colour(struct draw *d, const struct level *l, int c)
{
    for (size_t i = 0; i < d->count; i++) {
        double t[LEVEL_TERMS], ratio;
        terms_of(t, d->a, d->at[i]);
        d->miss[i] = log_ratio(&ratio, d, d->at[i], c) ? ratio - sum_of(l->gain[c], t, LEVEL_TERMS)
                                                       : (double)INFINITY;
    }
}

static void level_colour(struct level *l, struct draw *d, int c)
{
    for (int round = 0; round < ROUNDS; round++) {
        double gram[LEVEL_TERMS * LEVEL_TERMS] = {0}, x[LEVEL_TERMS] = {0};
        miss_colour(d, l, c);
        const double scale = round ? scale_of(d, 1) : 1.0;
        for (size_t i = 0; i < d->count; i++) {
            double t[LEVEL_TERMS], ratio;
            if (!log_ratio(&ratio, d, d->at[i], c))
                continue;
            const double w = d->worth[1][i] * weight_of(d->miss[i], scale / sqrt(d->worth[1][i]));
            terms_of(t, d->a, d->at[i]);
            for (int j = 0; j < LEVEL_TERMS; j++) {
                x[j] += w * t[j] * ratio;
                for (int k = 0; k <= j; k++)
                    gram[LEVEL_TERMS * j + k] += w * t[j] * t[k];
            }
        }
        for (int j = 0; j < LEVEL_TERMS; j++)
            gram[(LEVEL_TERMS + 1) * j] += 1e-6 * (double)d->count;
        if (lsq_solve(gram, LEVEL_TERMS, x, 1))
            memcpy(l->gain[c], x, sizeof x);
    }
}

// ---------------------------------------------------------------- both

// How the picture is turned in its plane, which turns normals the other way.
static void set_roll(double turn[3][3], const struct place *p, const struct surface *a)
{
    double o[2], x[2], y[2];
    place_of(o, p, 0.5 * a->width, 0.5 * a->height);
    place_of(x, p, 0.5 * a->width + 1.0, 0.5 * a->height);
    place_of(y, p, 0.5 * a->width, 0.5 * a->height + 1.0);
    const double roll = atan2((x[1] - o[1]) - (y[0] - o[0]), (x[0] - o[0]) + (y[1] - o[1]));
    const double c = cos(roll), s = sin(roll);
    const double m[3][3] = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
    memcpy(turn, m, sizeof m);
}

relume_status level_find(struct level *out, const struct surface *a, const struct surface *b,
                         const struct place *place, bool keep_bend, int threads)
{
    struct draw d;
    (void)threads;
    *out = (struct level){0};
    const relume_status status = draw_sample(&d, a, b);
    if (!status && d.count) {
        set_roll(out->turn, place, a);
        level_normals(out, &d, keep_bend);
        out->bend_deg = largest_bend(out, a);
        for (int c = 0; c < 3; c++)
            level_colour(out, &d, c);
    }
    give_back(&d);
    return status;
}

struct applying {
    const struct level *level;
    struct surface *b;
};

static void scale_noise(float code[3], const double factor[3])
{
    double root[3];
    roots_of(root, code);
    for (int c = 0; c < 3; c++)
        root[c] *= factor[c];
    code_of_roots(code, root);
}

static void apply_row(void *context, size_t y, int worker)
{
    (void)worker;
    const struct applying *a = context;
    const struct level *l = a->level;
    for (size_t x = 0; x < (size_t)a->b->width; x++) {
        const size_t i = y * (size_t)a->b->width + x;
        double t[LEVEL_TERMS], factor[3];
        if (!surface_knows(a->b, i))
            continue;
        terms_of(t, a->b, i);
        vec3 n = turned(l, a->b->normal.data + 3 * i);
        n.x += sum_of(l->bend[0], t, LEVEL_TERMS);
        n.y += sum_of(l->bend[1], t, LEVEL_TERMS);
        vec3_store(a->b->normal.data + 3 * i, vec3_unit(n));
        for (int c = 0; c < 3; c++)
            factor[c] = exp(sum_of(l->gain[c], t, LEVEL_TERMS));
        scale_noise(a->b->colour.data + 3 * i, factor);
        scale_noise(a->b->colour_noise.data + 3 * i, factor);
        const double light = pow((factor[0] + factor[1] + factor[2]) / 3.0, 3.0);
        if (a->b->gloss.data) {
            a->b->gloss.data[3 * i] *= (float)light;
            a->b->gloss_noise.data[3 * i] *= (float)light;
        }
    }
}

void level_apply(const struct level *level, struct surface *b, int threads)
{
    struct applying a = {level, b};
    thread_for(threads, (size_t)b->height, apply_row, &a);
}
