// merge.c - one radiance map from an exposure bracket
//
// Per channel ln E = sum_i w_i (ln f(c_i) - ln t_i) / sum_i w_i (Debevec, Malik 1997, Eq. 6), with
// weights that leave both ends of the code range with value and slope 0.
#include <relume/image/response.h>

#include "capture/hdr/agreement.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/names.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "image/image/merge_weight.h"

#include <math.h>
#include <string.h>

// Weights are tabled in quarters of an 8-bit code, log exposures in parts of 256.
static const float least_total = 0.01f;  // below, all codes lie within 4 % of an end
static const float unlike = 0.05f;       // codes that differ by more than noise
enum { BAND = 16, STEPS = 255 * 4, LOGS = 255 * 256 };

static float spline(float x)
{
    const float y = fminf(x, 1.0f - x);
    return y < 0.25f ? 8.0f * y * y : 1.0f - 8.0f * (0.5f - y) * (0.5f - y);
}

float relume_merge_weight(enum relume_merge_weights weights, float code, bool longest,
                          bool shortest)
{
    const float x = code > 0.0f ? fminf(code, 1.0f) : 0.0f;
    switch (weights) {
    case RELUME_MERGE_HAT: return 2.0f * fminf(x, 1.0f - x);
    case RELUME_MERGE_GAUSSIAN: return expf(-16.0f * (x - 0.5f) * (x - 0.5f));
    case RELUME_MERGE_SPLINE: break;
    }
    return (longest && x < 0.5f) || (shortest && x > 0.5f) ? 1.0f : spline(x);
}

// ---------------------------------------------------------------- merging

struct exposure {
    const float *codes, *mask;
    double time;
    float log_time;
    float weight[STEPS + 1];
    float inner[STEPS + 1];  // without the rule of the ends
};

struct merge {
    const struct relume_image *shape;
    const struct relume_response *response;
    struct exposure *exposure;
    int *by_time;  // indices, longest first
    int n;
    float *log_exposure[3];  // [LOGS + 1]
    float *out;
};

static float log_exposure(const struct merge *m, int c, float code)
{
    const float x = code > 0.0f ? fminf(code, 1.0f) : 0.0f;
    return m->log_exposure[c][(int)(x * LOGS + 0.5f)];
}

// Whether a shorter exposure is brighter, or a longer one darker: a mark in the picture, a hot
// pixel or something that moved. `code` belongs to `e`.
static bool is_impossible(const struct merge *m, const struct exposure *e, size_t sample,
                          float code)
{
    for (int i = 0; i < m->n; i++) {
        const struct exposure *other = &m->exposure[i];
        const float there = other->codes[sample];
        if ((other->time > e->time && there < fminf(code, 0.5f) - unlike) ||
            (other->time < e->time && there > fmaxf(code, 0.5f) + unlike))
            return true;
    }
    return false;
}

static float weight_of(const struct merge *m, const struct exposure *e, size_t pixel, int c,
                       float code)
{
    const float x = code > 0.0f ? fminf(code, 1.0f) : 0.0f;
    const int at = (int)(x * STEPS + 0.5f);
    float w = e->weight[at];
    if (w != e->inner[at] && is_impossible(m, e, 3 * pixel + (size_t)c, code))
        w = e->inner[at];
    return e->mask ? w * e->mask[pixel] : w;
}

// No exposure resolves it: the least wrong of those that are not masked.
static float unresolved(const struct merge *m, size_t pixel, int c)
{
    const struct exposure *best = &m->exposure[m->by_time[0]];
    bool found = false;
    for (int k = 0; k < m->n; k++) {
        const struct exposure *e = &m->exposure[m->by_time[k]];
        if (e->mask && !(e->mask[pixel] > 0.0f))
            continue;
        const bool bright = e->codes[3 * pixel + (size_t)c] > 0.5f;
        if (!found || bright)
            best = e;
        if (!bright)
            break;
        found = true;
    }
    return expf(log_exposure(m, c, best->codes[3 * pixel + (size_t)c]) - best->log_time);
}

static float merge_sample(const struct merge *m, size_t pixel, int c)
{
    float total = 0.0f, sum = 0.0f;
    for (int i = 0; i < m->n; i++) {
        const struct exposure *e = &m->exposure[i];
        const float code = e->codes[3 * pixel + (size_t)c];
        const float w = weight_of(m, e, pixel, c, code), l = log_exposure(m, c, code);
        if (w > 0.0f && !isinf(l)) {
            total += w;
            sum += w * (l - e->log_time);
        }
    }
    return total > least_total ? expf(sum / total) : unresolved(m, pixel, c);
}

static void merge_band(void *context, size_t band, int worker)
{
    const struct merge *m = context;
    (void)worker;
    const size_t width = (size_t)m->shape->width, height = (size_t)m->shape->height;
    const size_t end = (band + 1) * BAND < height ? (band + 1) * BAND : height;
    for (size_t i = band * BAND * width; i < end * width; i++)
        for (int c = 0; c < 3; c++)
            m->out[3 * i + (size_t)c] = merge_sample(m, i, c);
}

static void prepare(struct merge *m, const struct relume_image *codes, const double *exposures,
                    const struct relume_merge_params *p)
{
    for (int i = 0; i < m->n; i++) {
        int at = i;
        for (; at > 0 && exposures[m->by_time[at - 1]] < exposures[i]; at--)
            m->by_time[at] = m->by_time[at - 1];
        m->by_time[at] = i;
    }
    const double longest = exposures[m->by_time[0]], shortest = exposures[m->by_time[m->n - 1]];
    for (int i = 0; i < m->n; i++) {
        struct exposure *e = &m->exposure[i];
        e->codes = codes[i].data;
        e->mask = p->masks ? p->masks[i].data : NULL;
        e->time = exposures[i];
        e->log_time = (float)log(exposures[i]);
        for (int k = 0; k <= STEPS; k++)
            e->inner[k] = relume_merge_weight(p->weights, (float)k / STEPS, false, false);
        for (int k = 0; k <= STEPS; k++)
            e->weight[k] = relume_merge_weight(p->weights, (float)k / STEPS,
                                               exposures[i] == longest, exposures[i] == shortest);
    }
    for (int c = 0; c < 3; c++)
        for (int i = 0; i <= LOGS; i++)
            m->log_exposure[c][i] = logf(relume_response_decode(m->response, c, (float)i / LOGS));
}

static relume_status check(const struct relume_image *codes, const double *exposures, int n,
                           const struct relume_merge_params *p)
{
    bool good = n >= 1;
    for (int i = 0; good && i < n; i++) {
        const struct relume_image *mask = p->masks ? &p->masks[i] : NULL;
        good = codes[i].channels == 3 && codes[i].width == codes->width &&
               codes[i].height == codes->height && exposures[i] > 0.0 && isfinite(exposures[i]);
        if (good && mask && mask->data)
            good =
                mask->channels == 1 && mask->width == codes->width && mask->height == codes->height;
    }
    return good ? RELUME_OK
                : log_fail(p->log, RELUME_EINVAL,
                           "bracket: expected 3 channels, equal sizes, masks of that size, and "
                           "times above 0");
}

relume_status relume_merge(struct relume_image *out, struct relume_exposure_report *report,
                           const struct relume_image *codes, const double *exposures, int n,
                           const struct relume_response *response,
                           const struct relume_merge_params *params)
{
    const struct relume_merge_params p = PARAMS_WORK(relume_merge_params, params);
    *out = (struct relume_image){0};
    relume_status status = check(codes, exposures, n, &p);
    if (status)
        return status;
    struct merge m = {.shape = codes,
                      .response = response,
                      .exposure = mem_array((size_t)n, sizeof *m.exposure),
                      .by_time = mem_array((size_t)n, sizeof *m.by_time),
                      .n = n};
    float *logs = mem_array(3 * (LOGS + 1), sizeof *logs);
    for (int c = 0; logs && c < 3; c++)
        m.log_exposure[c] = logs + (size_t)c * (LOGS + 1);
    status = m.exposure && m.by_time && logs ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = agreement(report, codes, exposures, n, response, &p);
    if (!status)
        status = relume_image_create(out, codes->width, codes->height, 3);
    if (!status) {
        m.out = out->data;
        prepare(&m, codes, exposures, &p);
        thread_for(p.threads, ((size_t)codes->height + BAND - 1) / BAND, merge_band, &m);
    }
    mem_free(m.exposure);
    mem_free(m.by_time);
    mem_free(logs);
    return status;
}
