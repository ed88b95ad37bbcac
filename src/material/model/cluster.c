// cluster.c - k-means of reduced texels (Lloyd 1982), started by spread-out texels (Arthur and
// Vassilvitskii 2007)
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/random.h"
#include "material/model/reduce.h"

#include <string.h>

enum { ROUNDS = 50, CHUNK = 256 };

struct means {
    const struct reduced *r;
    int clusters;
    float *center;    // [clusters][count]
    int *which;       // [texels]
    double *squared;  // [texels]: distance to the nearest center
    int newest;       // while starting: only this center is new
};

static double distance(const float *a, const float *b, int n)
{
    float sum = 0.0f;
    for (int i = 0; i < n; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return (double)sum;
}

static void nearest(const struct means *m, size_t texel)
{
    const int n = m->r->count;
    const float *x = m->r->score + texel * (size_t)n;
    int best = 0;
    double least = INFINITY;
    for (int c = 0; c < m->clusters; c++) {
        const double d = distance(x, m->center + (size_t)c * (size_t)n, n);
        if (d < least) {
            least = d;
            best = c;
        }
    }
    m->which[texel] = best;
    m->squared[texel] = least;
}

static void with_newest(const struct means *m, size_t texel)
{
    const size_t n = (size_t)m->r->count;
    const double d = distance(m->r->score + texel * n, m->center + (size_t)m->newest * n, (int)n);
    if (d < m->squared[texel])
        m->squared[texel] = d;
}

static void assign_chunk(void *context, size_t item, int worker)
{
    (void)worker;
    const struct means *m = context;
    const size_t from = item * CHUNK, end = from + CHUNK;
    for (size_t i = from; i < (end < m->r->texels ? end : m->r->texels); i++)
        if (m->newest < 0)
            nearest(m, i);
        else
            with_newest(m, i);
}

static void assign(struct means *m, int threads)
{
    thread_for(threads, (m->r->texels + CHUNK - 1) / CHUNK, assign_chunk, m);
}

static double total(const struct means *m)
{
    double sum = 0.0;
    for (size_t i = 0; i < m->r->texels; i++)
        sum += m->squared[i];
    return sum;
}

static void set_center(struct means *m, int c, size_t texel)
{
    const size_t n = (size_t)m->r->count;
    memcpy(m->center + (size_t)c * n, m->r->score + texel * n, n * sizeof(float));
}

// Each next center is a texel drawn by its squared distance from those before.
static void start(struct means *m, const struct fitting *f)
{
    struct random random = random_stream(f->seed, m->r->texels, (uint64_t)m->clusters);
    size_t texel = (size_t)(random_next(&random) * (double)m->r->texels);
    for (size_t i = 0; i < m->r->texels; i++)
        m->squared[i] = INFINITY;
    for (int c = 0; c < m->clusters; c++) {
        set_center(m, c, texel);
        m->newest = c;
        assign(m, f->threads);
        double left = random_next(&random) * total(m);
        for (texel = 0; texel + 1 < m->r->texels && left >= m->squared[texel]; texel++)
            left -= m->squared[texel];
    }
    m->newest = -1;
}

// Centers move to the means of their texels; one without texels moves to the farthest texel.
static bool move(struct means *m)
{
    const size_t n = (size_t)m->r->count;
    double *sum = mem_zeroed((size_t)m->clusters * n, sizeof *sum);
    size_t *count = mem_zeroed((size_t)m->clusters, sizeof *count);
    for (size_t i = 0; sum && count && i < m->r->texels; i++) {
        double *to = sum + (size_t)m->which[i] * n;
        for (size_t k = 0; k < n; k++)
            to[k] += (double)m->r->score[i * n + k];
        count[m->which[i]]++;
    }
    for (int c = 0; sum && count && c < m->clusters; c++) {
        size_t far = 0;
        for (size_t i = 1; !count[c] && i < m->r->texels; i++)
            far = m->squared[i] > m->squared[far] ? i : far;
        if (!count[c]) {
            set_center(m, c, far);
            m->squared[far] = 0.0;
        }
        for (size_t k = 0; count[c] && k < n; k++)
            m->center[(size_t)c * n + k] = (float)(sum[(size_t)c * n + k] / (double)count[c]);
    }
    const bool good = sum && count;
    mem_free(sum);
    mem_free(count);
    return good;
}

relume_status reduce_cluster(const struct reduced *r, const struct fitting *f, int clusters,
                             int *which)
{
    struct means m = {
        .r = r,
        .clusters = clusters,
        .center = mem_array((size_t)clusters * (size_t)r->count, sizeof *m.center),
        .which = which,
        .squared = mem_array(r->texels, sizeof *m.squared),
    };
    bool good = m.center && m.squared;
    if (good)
        start(&m, f);
    double before = INFINITY;
    for (int round = 0; round < ROUNDS && good; round++) {
        assign(&m, f->threads);
        const double now = total(&m);
        if (before - now <= 1e-4 * before)
            break;
        before = now;
        good = move(&m);
    }
    mem_free(m.center);
    mem_free(m.squared);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

relume_status members_make(struct members *out, const int *which, size_t texels, int clusters)
{
    out->texel = mem_array(texels, sizeof *out->texel);
    out->first = mem_zeroed((size_t)clusters + 1, sizeof *out->first);
    if (!out->texel || !out->first) {
        members_free(out);
        return RELUME_ENOMEM;
    }
    for (size_t i = 0; i < texels; i++)
        out->first[which[i] + 1]++;
    for (int c = 0; c < clusters; c++)
        out->first[c + 1] += out->first[c];
    for (size_t i = 0; i < texels; i++)
        out->texel[out->first[which[i]]++] = i;
    for (int c = clusters; c > 0; c--)
        out->first[c] = out->first[c - 1];
    out->first[0] = 0;
    return RELUME_OK;
}

void members_free(struct members *m)
{
    mem_free(m->texel);
    mem_free(m->first);
    m->texel = m->first = NULL;
}
