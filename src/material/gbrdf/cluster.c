// cluster.c - k-means of distributions that are turned onto each other (Menzel 2011, section 6.3.3)
//
// The thesis finds the turn by FFT; with 32 directions around, all of them are tried at no more
// cost. The number of materials is that of the least separation index,
//     SI = RMS of distances to the own centre / least distance between two centres,
// and one where no number separates. Borders are cleaned by relaxation labelling (Rosenfeld,
// Hummel, Zucker 1976): P' = P Q / sum P Q, Q the neighbours' mean, from P that falls with
// distance.
#include "material/gbrdf/cluster.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "core/math/random.h"

#include <string.h>

// Centres are learned from no more texels than this.
enum { LEARN = 1024, ROUNDS = 12, STARTS = 3, RELAXATIONS = 4, MOST_CLUSTERS = 64 };
// Of the pole; further out, half vectors are rare.
static const double WIDEST = 60.0 * M_PI / 180.0;
// What a turn must gain of the unit correlation: those of round distributions mean nothing.
static const double TURN_GAIN = 0.02;
// Centres that separate no better than this are of one material.
static const double DISTINCT = 1.0;

// ---------------------------------------------------------------- distributions

// A share of each value to its neighbours: cells are told by few samples.
static void soften(float polar[POLAR_VALUES])
{
    float from[POLAR_VALUES];
    memcpy(from, polar, sizeof from);
    for (int r = 0; r < POLAR_RINGS; r++)
        for (int i = 0; i < POLAR_AROUND; i++) {
            float sum = 0.0f;
            for (int k = 0; k < 9; k++) {
                const int ring = index_clamped(r + k / 3 - 1, POLAR_RINGS),
                          at = index_wrapped(i + k % 3 - 1, POLAR_AROUND);
                sum += (k / 3 == 1 ? 0.5f : 0.25f) * (k % 3 == 1 ? 0.5f : 0.25f) *
                       from[ring * POLAR_AROUND + at];
            }
            polar[r * POLAR_AROUND + i] = sum;
        }
}

void polar_from(float polar[POLAR_VALUES], const float *q, int side)
{
    double sum = 0.0;
    for (int r = 0; r < POLAR_RINGS; r++)
        for (int i = 0; i < POLAR_AROUND; i++) {
            const double theta = WIDEST * (r + 0.5) / POLAR_RINGS,
                         phi = 2.0 * M_PI * i / POLAR_AROUND;
            double at[2];
            ndf_place(vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)), side, at);
            const struct bilinear b =
                bilinear_at(at[0] - 0.5, at[1] - 0.5, side, side, EDGE_CLAMPED);
            const double share = sin(theta) * fmax(bilinear_value(&b, q, 1, 0), 0.0);
            polar[r * POLAR_AROUND + i] = (float)share;
        }
    soften(polar);
    for (int i = 0; i < POLAR_VALUES; i++) {
        sum += (double)polar[i];
        polar[i] = sqrtf(polar[i]);
    }
    for (int i = 0; i < POLAR_VALUES; i++)
        polar[i] = sum > 1e-20 ? polar[i] / (float)sqrt(sum) : 1.0f / sqrtf(POLAR_VALUES);
}

// c[shift] for all shifts, of products with `a` shifted forwards; none waits for another.
static void correlate(float c[POLAR_AROUND], const float *a, const float *b)
{
    float sum[POLAR_AROUND] = {0.0f};
    for (int r = 0; r < POLAR_RINGS; r++, a += POLAR_AROUND, b += POLAR_AROUND) {
        float twice[2 * POLAR_AROUND];
        memcpy(twice, a, POLAR_AROUND * sizeof *a);
        memcpy(twice + POLAR_AROUND, a, POLAR_AROUND * sizeof *a);
        for (int i = 0; i < POLAR_AROUND; i++)
            for (int s = 0; s < POLAR_AROUND; s++)
                sum[s] += twice[i + s] * b[i];
    }
    memcpy(c, sum, sizeof sum);
}

double polar_align(const float *polar, const float *centre, double *shift)
{
    float c[POLAR_AROUND];
    int best = 0;
    correlate(c, polar, centre);
    for (int s = 1; s < POLAR_AROUND; s++)
        best = c[s] > c[best] ? s : best;
    if ((double)c[best] < (double)c[0] + TURN_GAIN)
        best = 0;
    const double left = (double)c[(best + POLAR_AROUND - 1) % POLAR_AROUND],
                 right = (double)c[(best + 1) % POLAR_AROUND];
    const double bend = left + right - 2.0 * (double)c[best];
    // between two shifts lies the top of a parabola
    *shift = best ? best + (bend < -1e-9 ? 0.5 * (left - right) / bend : 0.0) : 0.0;
    return sqrt(fmax(2.0 - 2.0 * (double)c[best], 0.0));
}

// Shifted by whole steps onto the frame of its centre.
static void add_turned(double *sum, const float *polar, double shift)
{
    const int s = ((int)lround(shift) + POLAR_AROUND) % POLAR_AROUND;
    for (int r = 0; r < POLAR_RINGS; r++)
        for (int i = 0; i < POLAR_AROUND; i++)
            sum[r * POLAR_AROUND + i] += (double)polar[r * POLAR_AROUND + (i + s) % POLAR_AROUND];
}

// ---------------------------------------------------------------- k-means

struct learning {
    const float *polar;  // of all texels
    size_t texels;
    int count, threads;
    float centre[MOST_CLUSTERS][POLAR_VALUES];
    double *distance, *shift;  // [texel][row], of those that are looked at
    size_t row;
    size_t stride, looked;  // every so manieth texel
    int known;              // centres that have not moved since the last look
};

static const float *texel_of(const struct learning *w, size_t item)
{
    return w->polar + item * w->stride * POLAR_VALUES;
}

static void compare(void *context, size_t item, int worker)
{
    (void)worker;
    const struct learning *w = context;
    for (int k = w->known; k < w->count; k++) {
        const size_t at = item * w->row + (size_t)k;
        w->distance[at] = polar_align(texel_of(w, item), w->centre[k], &w->shift[at]);
    }
}

static void look(struct learning *w, size_t stride, int known)
{
    w->known = known;
    w->stride = stride;
    w->looked = (w->texels + stride - 1) / stride;
    thread_for(w->threads, w->looked, compare, w);
}

static int nearest(const struct learning *w, size_t item)
{
    const double *d = w->distance + item * w->row;
    int best = 0;
    for (int k = 1; k < w->count; k++)
        best = d[k] < d[best] ? k : best;
    return best;
}

// The mean of those nearest to each; a centre of none stays. False when none moves.
static bool move_centres(struct learning *w)
{
    bool moves = false;
    for (int k = 0; k < w->count; k++) {
        double sum[POLAR_VALUES] = {0.0}, length = 0.0;
        for (size_t i = 0; i < w->looked; i++)
            if (nearest(w, i) == k)
                add_turned(sum, texel_of(w, i), w->shift[i * w->row + (size_t)k]);
        for (int i = 0; i < POLAR_VALUES; i++)
            length += sum[i] * sum[i];
        for (int i = 0; i < POLAR_VALUES && length > 0.0; i++) {
            const float to = (float)(sum[i] / sqrt(length));
            moves |= to != w->centre[k][i];
            w->centre[k][i] = to;
        }
    }
    return moves;
}

// k-means++ (Arthur, Vassilvitskii 2007): far ones are likely to be the next centre.
static void seed_centres(struct learning *w, int count, size_t stride, struct random *chance)
{
    w->count = 0;
    w->looked = (w->texels + stride - 1) / stride;
    size_t chosen = (size_t)(random_next(chance) * (double)w->looked);
    for (int next = 0; next < count; next++) {
        w->stride = stride;
        memcpy(w->centre[next], texel_of(w, chosen), sizeof w->centre[next]);
        w->count = next + 1;
        look(w, stride, next);
        double sum = 0.0;
        for (int step = 0; step < 2; step++) {
            const double target = step ? random_next(chance) * sum : INFINITY;
            sum = 0.0;
            chosen = w->looked - 1;
            for (size_t i = 0; i < w->looked && sum <= target; i++) {
                const double d = w->distance[i * w->row + (size_t)nearest(w, i)];
                sum += d * d;
                if (step && sum > target)
                    chosen = i;
            }
        }
    }
}

// The sum of squared distances to the own centre.
static double spread(const struct learning *w)
{
    double sum = 0.0;
    for (size_t i = 0; i < w->looked; i++) {
        const double d = w->distance[i * w->row + (size_t)nearest(w, i)];
        sum += d * d;
    }
    return sum;
}

static double separation(const struct learning *w)
{
    double least = INFINITY, ignored;
    for (int i = 0; i < w->count; i++)
        for (int j = i + 1; j < w->count; j++)
            least = fmin(least, polar_align(w->centre[i], w->centre[j], &ignored));
    return least > 1e-9 ? sqrt(spread(w) / (double)w->looked) / least : INFINITY;
}

// The best of some starts with `count` centres; `best` is theirs.
static double learn(struct learning *w, int count, size_t stride, uint64_t seed,
                    float best[MOST_CLUSTERS][POLAR_VALUES])
{
    double least = INFINITY, index = INFINITY;
    for (int start = 0; start < STARTS; start++) {
        struct random chance = random_stream(seed, (uint64_t)count, (uint64_t)start);
        seed_centres(w, count, stride, &chance);
        bool moves = true;
        for (int round = 0; round < ROUNDS && moves; round++) {
            look(w, stride, 0);
            moves = move_centres(w);
        }
        look(w, stride, 0);
        const double now = spread(w);
        if (now < least) {
            least = now;
            index = separation(w);
            memcpy(best, w->centre, sizeof w->centre);
        }
    }
    return index;
}

// ---------------------------------------------------------------- labels

// P of every texel and cluster, by the distances in `w`, made less by neighbours that disagree.
static bool relax(const struct learning *w, float *p, int width, int height)
{
    const size_t n = (size_t)w->count;
    float *next = mem_array(w->texels * n, sizeof *next);
    for (size_t i = 0; i < w->texels; i++) {
        float sum = 0.0f;
        for (size_t k = 0; k < n; k++)
            sum += p[i * n + k] = (float)(1.0 / (pow(w->distance[i * w->row + k], 2) + 1e-6));
        for (size_t k = 0; k < n; k++)
            p[i * n + k] /= sum;
    }
    for (int round = 0; next && round < RELAXATIONS; round++) {
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                const size_t at = ((size_t)y * (size_t)width + (size_t)x) * n;
                float sum = 0.0f;
                for (size_t k = 0; k < n; k++) {
                    float q = 0.0f;
                    for (int j = 0; j < 9; j++)
                        q += j == 4
                                 ? 0.0f
                                 : p[((size_t)index_wrapped(y + j / 3 - 1, height) * (size_t)width +
                                      (size_t)index_wrapped(x + j % 3 - 1, width)) *
                                         n +
                                     k];
                    sum += next[at + k] = p[at + k] * (q + 1e-6f);
                }
                for (size_t k = 0; k < n; k++)
                    next[at + k] /= sum;
            }
        memcpy(p, next, w->texels * n * sizeof *p);
    }
    mem_free(next);
    return next != NULL;
}

static relume_status label(struct clusters *out, struct learning *w, int width, int height)
{
    const size_t n = (size_t)w->count;
    float *p = mem_array(w->texels * n, sizeof *p);
    look(w, 1, 0);
    if (!p || !relax(w, p, width, height)) {
        mem_free(p);
        return RELUME_ENOMEM;
    }
    for (size_t i = 0; i < w->texels; i++) {
        size_t best = 0;
        for (size_t k = 1; k < n; k++)
            best = p[i * n + k] > p[i * n + best] ? k : best;
        out->label[i] = (uint8_t)best;
        out->rotation[i] = (float)(2.0 * M_PI / POLAR_AROUND * w->shift[i * w->row + best]);
    }
    mem_free(p);
    return RELUME_OK;
}

// A centre between others may lose all its texels where borders are settled.
static void drop_empty(struct clusters *out, size_t texels)
{
    bool used[MOST_CLUSTERS] = {false};
    uint8_t number[MOST_CLUSTERS] = {0};
    int count = 0;
    for (size_t i = 0; i < texels; i++)
        used[out->label[i]] = true;
    for (int k = 0; k < out->count; k++) {
        number[k] = (uint8_t)count;
        count += used[k];
    }
    for (size_t i = 0; i < texels; i++)
        out->label[i] = number[out->label[i]];
    out->count = count;
}

relume_status clusters_find(struct clusters *out, const float *polar, int width, int height,
                            int most, bool exact, uint64_t seed, int threads)
{
    const size_t texels = (size_t)width * (size_t)height;
    const size_t stride = (texels + LEARN - 1) / LEARN;
    static const int FEWEST = 1;
    most = most < MOST_CLUSTERS ? most : MOST_CLUSTERS;
    *out = (struct clusters){.label = mem_zeroed(texels, 1),
                             .rotation = mem_zeroed(texels, sizeof(float))};
    struct learning *w = mem_zeroed(1, sizeof *w);
    float(*tried)[POLAR_VALUES] = mem_array(2 * MOST_CLUSTERS, sizeof *tried);
    float(*best)[POLAR_VALUES] = tried ? tried + MOST_CLUSTERS : NULL;
    relume_status status = RELUME_ENOMEM;
    if (w) {
        w->distance = mem_array(texels * (size_t)most, sizeof(double));
        w->shift = mem_array(texels * (size_t)most, sizeof(double));
    }
    if (out->label && out->rotation && w && tried && w->distance && w->shift) {
        w->polar = polar, w->texels = texels, w->threads = threads, w->row = (size_t)most;
        out->separation = INFINITY;
        for (int n = exact ? most : FEWEST; n <= most; n++) {
            const double index = learn(w, n, stride, seed, tried);
            if (n == FEWEST || exact || (index < DISTINCT && index < out->separation)) {
                out->count = n;
                out->separation = n == FEWEST ? INFINITY : index;
                memcpy(best, tried, MOST_CLUSTERS * sizeof *best);
            }
        }
        w->count = out->count;
        memcpy(w->centre, best, sizeof w->centre);
        status = label(out, w, width, height);
        if (!status)
            drop_empty(out, texels);
    }
    if (w) {
        mem_free(w->distance);
        mem_free(w->shift);
    }
    mem_free(w);
    mem_free(tried);
    return status;
}

void clusters_free(struct clusters *c)
{
    mem_free(c->label);
    mem_free(c->rotation);
}
