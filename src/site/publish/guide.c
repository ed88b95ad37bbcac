// guide.c - planes of linear light in steps that grow with the brightness of a pixel
#include "site/publish/guide.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <float.h>

// A highlight of few pixels, which is beyond white, would make the steps of all coarse: so many
// of the darkest and of the brightest may end before.
#define BEYOND 2e-5
enum { BINS = 4096 };

// Means over the lights and channels: of what a component adds to the picture, and of what lacks
// for black. Components are orthonormal over these lights.
static void look(const struct principal *c, const double *mean, const double *w, int numbers,
                 double share, double *bright, double *black)
{
    const size_t n = (size_t)numbers;
    for (size_t ch = 0; ch < 3; ch++) {
        const double *row = w + ch * (n + 1);
        double shown = row[n];
        for (size_t j = 0; j < n; j++)
            shown += mean[j] * row[j];
        for (size_t k = 0; k < (size_t)c->count; k++) {
            double v = 0.0;
            for (size_t j = 0; j < n; j++)
                v += c->back[k * n + j] * row[j];
            bright[k] += share * v;
            black[k] -= share * v * shown;
        }
    }
}

// rows - 2 v v' rows / v'v
static void reflect(double *rows, const double *v, double square, int count, int numbers)
{
    for (int j = 0; j < numbers; j++) {
        double along = 0.0;
        for (int k = 0; k < count; k++)
            along += v[k] * rows[k * numbers + j];
        for (int k = 0; k < count; k++)
            rows[k * numbers + j] -= 2.0 * v[k] * along / square;
    }
}

// Householder's reflection that makes `bright` the first component.
static relume_status turn(struct principal *c, const double *bright, int numbers)
{
    double length = 0.0, square = 0.0;
    double *v = mem_copy(bright, (size_t)c->count, sizeof *v);
    double *value = mem_zeroed((size_t)c->count, sizeof *value);
    const bool good = v && value;
    for (int k = 0; good && k < c->count; k++)
        length += bright[k] * bright[k];
    for (int k = 0; good && k < c->count; k++) {
        v[k] = bright[k] / fmax(sqrt(length), 1e-30) - (k == 0);
        square += v[k] * v[k];
    }
    if (good && square > 1e-12) {
        for (int k = 0; k < c->count; k++)
            for (int j = 0; j < c->count; j++) {
                const double share = (k == j) - 2.0 * v[k] * v[j] / square;
                value[k] += share * share * c->value[j];
            }
        reflect(c->forward, v, square, c->count, numbers);
        reflect(c->back, v, square, c->count, numbers);
        for (int k = 0; k < c->count; k++)
            c->value[k] = value[k];
    }
    mem_free(v);
    mem_free(value);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

relume_status guide_turn(struct principal *components, double *mean, const struct source *s,
                         const struct relume_vec3 *lights, const double *shares, int count)
{
    const int n = s->numbers;
    double *w = mem_array(3 * ((size_t)n + 1), sizeof *w);
    double *bright = mem_zeroed((size_t)components->count, sizeof *bright);
    double *black = mem_zeroed((size_t)components->count, sizeof *black);
    relume_status status = w && bright && black ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < count; i++) {
        source_weights(s, lights[i], w);
        look(components, mean, w, n, shares[i], bright, black);
    }
    for (int k = 0; !status && k < components->count; k++)
        for (int j = 0; j < n; j++)
            mean[j] += black[k] * components->back[k * n + j];
    if (!status)
        status = turn(components, bright, n);
    mem_free(w);
    mem_free(bright);
    mem_free(black);
    return status;
}

static float *plane(struct planes *p, int k)
{
    return p->data + (size_t)k * (size_t)p->width * (size_t)p->height;
}

void guide_divide(struct planes *p)
{
    const size_t n = (size_t)p->width * (size_t)p->height;
    float *guide = plane(p, 0);
    for (size_t i = 0; i < n; i++)
        guide[i] = guide_root(guide[i]);
    for (int k = 1; k < p->count; k++) {
        float *v = plane(p, k);
        for (size_t i = 0; i < n; i++)
            v[i] /= guide_gain(guide[i]);
    }
}

static float coded_at(const struct planes *p, int k, size_t i)
{
    const float u = guide_root(p->data[i]);
    return k ? planes_at(p, k)[i] / guide_gain(u) : u;
}

// Between which values all pixels but few lie.
static void find_range(void *context, size_t k, int worker)
{
    (void)worker;
    struct planes *p = context;
    const size_t n = (size_t)p->width * (size_t)p->height, few = (size_t)(BEYOND * (double)n);
    size_t count[BINS] = {0}, below = 0, above = 0;
    float min = FLT_MAX, max = -FLT_MAX;
    for (size_t i = 0; i < n; i++) {
        const float u = coded_at(p, (int)k, i);
        min = fminf(min, u);
        max = fmaxf(max, u);
    }
    const float bin = fmaxf((max - min) / (BINS - 1), 1e-12f);
    for (size_t i = 0; i < n; i++) {
        const float at = (coded_at(p, (int)k, i) - min) / bin;
        if (at >= 0.0f && at < (float)BINS)
            count[(int)at]++;
    }
    int low = 0, high = BINS - 1;
    while (low < high && (below += count[low]) <= few)
        low++;
    while (high > low && (above += count[high]) <= few)
        high--;
    p->minimum[k] = (double)(min + (float)low * bin);
    p->maximum[k] = (double)(min + (float)(high + 1) * bin);
}

void guide_find_ranges(struct planes *p, int threads)
{
    thread_for(threads, (size_t)p->count, find_range, p);
}
