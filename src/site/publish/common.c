// common.c - one set of principal components for all views of a file, and what the light makes
// of it
#include "site/publish/common.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/vec.h"
#include "exchange/foreign/principal.h"
#include "site/publish/functions.h"
#include "site/publish/guide.h"

#include <math.h>
#include <string.h>

// Errors count by what they do to the picture, half of it under the captured lights, half under
// lights from everywhere.
enum { SPIRAL = 2048, MOST_VIEWS = 9 };

// What the numbers of the source are coefficients of.
static const struct relume_coder_info *coder_of(const struct source *s)
{
    return relume_coder_info(s->between ? s->between : s->codes->coder);
}

static struct relume_vec3 spiral(int i, const struct relume_coder_info *info)
{
    const double t = (i + 0.5) / SPIRAL, z = info->hemispherical ? t : 2.0 * t - 1.0;
    const double r = sqrt(1.0 - z * z), phi = i * (M_PI * (3.0 - sqrt(5.0)));
    return info->pole_y ? vec3_of(r * sin(phi), z, r * cos(phi))
                        : vec3_of(r * cos(phi), r * sin(phi), z);
}

// The lights by which errors count, and how much.
struct jury {
    int count;
    struct relume_vec3 *light;
    double *share;
};

static relume_status jury_make(struct jury *j, const struct source *s,
                               const struct relume_coder_info *info)
{
    const size_t n = (size_t)s->lights + SPIRAL;
    *j = (struct jury){(int)n, mem_array(n, sizeof *j->light), mem_array(n, sizeof *j->share)};
    for (size_t i = 0; j->light && j->share && i < n; i++) {
        const bool captured = i < (size_t)s->lights;
        j->light[i] = captured ? s->light[i] : spiral((int)i - s->lights, info);
        j->share[i] = 0.5 / (captured ? s->lights : SPIRAL);
    }
    return j->light && j->share ? RELUME_OK : RELUME_ENOMEM;
}

static void jury_free(struct jury *j)
{
    mem_free(j->light);
    mem_free(j->share);
}

// G = sum over directions and channels of w w^T, [P][P].
static double *metric_of(const struct source *s, const struct jury *jury)
{
    const size_t p = (size_t)s->numbers, directions = (size_t)jury->count;
    double *rows = mem_array(3 * directions * p, sizeof *rows);
    double *gram = mem_array(p * p, sizeof *gram), *w = mem_array(3 * (p + 1), sizeof *w);
    const bool good = rows && gram && w;
    for (size_t i = 0; good && i < directions; i++) {
        const double share = sqrt(jury->share[i]);
        source_weights(s, jury->light[i], w);
        for (size_t c = 0; c < 3; c++)
            for (size_t j = 0; j < p; j++)
                rows[(3 * i + c) * p + j] = share * w[c * (p + 1) + j];
    }
    if (good)
        lsq_product(true, false, s->numbers, s->numbers, (int)(3 * directions), rows, rows, gram);
    mem_free(rows);
    mem_free(w);
    if (good)
        return gram;
    mem_free(gram);
    return NULL;
}

// ---------------------------------------------------------------- statistics of all views

struct statistics {
    double *mean, *covariance;  // [P], [P][P]; while views are added, of the squares
};

static void add_view(struct statistics *all, const struct statistics *view, size_t p, double share)
{
    for (size_t i = 0; i < p; i++)
        all->mean[i] += share * view->mean[i];
    for (size_t i = 0; i < p * p; i++)
        all->covariance[i] += share * (view->covariance[i] + view->mean[i / p] * view->mean[i % p]);
}

static relume_status statistics_alloc(struct statistics *s, size_t p)
{
    s->mean = mem_zeroed(p, sizeof *s->mean);
    s->covariance = mem_zeroed(p * p, sizeof *s->covariance);
    return s->mean && s->covariance ? RELUME_OK : RELUME_ENOMEM;
}

static void statistics_free(struct statistics *s)
{
    mem_free(s->mean);
    mem_free(s->covariance);
}

// Views as far apart as there are; the middle one is first, whose source stays.
static relume_status look_at_views(struct common *c, struct statistics *all, relume_pack *pack,
                                   int threads, const struct relume_log *log)
{
    const int views = relume_pack_info(pack)->views;
    const int looked = views < MOST_VIEWS ? views : MOST_VIEWS;
    const size_t p = (size_t)c->source.numbers;
    struct statistics view = {0};
    relume_status status = statistics_alloc(&view, p);
    for (int i = 0; !status && i < looked; i++) {
        struct source s = {0};
        const struct relume_codes *codes;
        const int number = (int)(((long long)2 * i + 1) * views / (2 * looked));
        status = relume_pack_codes(&codes, pack, number);
        if (!status)
            status = source_open(&s, codes, c->kind, log);
        if (!status)
            status = source_statistics(&s, threads, view.mean, view.covariance);
        if (!status)
            add_view(all, &view, p, 1.0 / looked);
        source_close(&s);
        if (codes != c->source.codes)
            relume_pack_drop(pack, number);
        if (!status && !log_progress(log, "components", (i + 1.0) / (looked + 1)))
            status = RELUME_ECANCEL;
    }
    for (size_t i = 0; !status && i < p * p; i++)
        all->covariance[i] -= all->mean[i / p] * all->mean[i % p];
    statistics_free(&view);
    return status;
}

// ---------------------------------------------------------------- functions

// To 12 bits, which pack a fifth smaller in scene.json and move pictures by 0.02 of 255 at most.
static float rounded(double value)
{
    int exponent;
    const double mantissa = frexp(value, &exponent);
    return (float)ldexp(rint(mantissa * 4096.0), exponent - 12);
}

static relume_status make_functions(struct common *c, const struct principal *found,
                                    const double *mean)
{
    const struct relume_coder_info *info = coder_of(&c->source);
    const size_t f = (size_t)info->functions, k = (size_t)c->plan.planes;
    const size_t p = (size_t)c->source.numbers;
    double *sum = mem_array(f, sizeof *sum);
    c->functions = info->functions;
    c->transform = mem_array(3 * k * f, sizeof *c->transform);
    c->mean = mem_array(3 * f, sizeof *c->mean);
    const bool good = sum && c->transform && c->mean;
    for (size_t ch = 0; good && ch < 3; ch++)
        for (size_t row = 0; row <= k; row++) {
            const bool is_mean = row == k;
            memset(sum, 0, f * sizeof *sum);
            for (size_t i = 0; is_mean && info->mean && i < f; i++)
                sum[i] = (double)info->mean[ch * f + i];
            functions_add(sum, info, (int)ch, is_mean ? mean : found->back + row * p);
            for (size_t i = 0; i < f; i++)
                if (is_mean)
                    c->mean[ch * f + i] = (float)sum[i];
                else
                    c->transform[(ch * k + row) * f + i] = rounded(sum[i]);
        }
    mem_free(sum);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// C = forward (x - mean)
static relume_status make_plan(struct plan *p, const struct principal *found, const double *mean,
                               int numbers)
{
    const size_t k = (size_t)found->count, n = (size_t)numbers;
    *p = (struct plan){.form = FOREIGN_JOINT,
                       .terms = found->count,
                       .planes = found->count,
                       .numbers = numbers,
                       .lost = found->total,
                       .map = mem_copy(found->forward, k * n, sizeof *p->map),
                       .shift = mem_zeroed(k, sizeof *p->shift),
                       .weight = mem_array(k, sizeof *p->weight),
                       .energy = mem_array(k, sizeof *p->energy)};
    if (!p->map || !p->shift || !p->weight || !p->energy)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < k; i++) {
        p->weight[i] = 1.0;
        p->energy[i] = fmax(0.0, found->value[i]);
        p->lost -= p->energy[i];
        for (size_t j = 0; j < n; j++)
            p->shift[i] -= found->forward[i * n + j] * mean[j];
    }
    p->lost = fmax(p->lost, 0.0);
    return RELUME_OK;
}

static relume_status find(struct common *c, struct statistics *all, int planes)
{
    const int n = c->source.numbers;
    struct principal found = {0};
    struct jury jury;
    relume_status status = jury_make(&jury, &c->source, coder_of(&c->source));
    double *metric = status ? NULL : metric_of(&c->source, &jury);
    status = metric ? principal_find(&found, metric, all->covariance, n, planes < n ? planes : n)
                    : RELUME_ENOMEM;
    c->guided = c->source.coding.curve == RELUME_CURVE_LINEAR;
    if (!status && c->guided)
        status = guide_turn(&found, all->mean, &c->source, jury.light, jury.share, jury.count);
    if (!status)
        status = make_plan(&c->plan, &found, all->mean, n);
    if (!status)
        status = functions_coder(&c->raw, coder_of(&c->source), c->source.log);
    if (!status)
        status = make_functions(c, &found, all->mean);
    principal_free(&found);
    jury_free(&jury);
    mem_free(metric);
    return status;
}

relume_status common_find(struct common *c, relume_pack *pack, enum source_kind kind, int planes,
                          int threads, const struct relume_log *log)
{
    const struct relume_codes *codes;
    struct statistics all = {0};
    *c = (struct common){.kind = kind};
    relume_status status = relume_pack_codes(&codes, pack, relume_pack_info(pack)->views / 2);
    if (!status)
        status = source_open(&c->source, codes, kind, log);
    if (!status)
        status = statistics_alloc(&all, (size_t)c->source.numbers);
    if (!status)
        status = look_at_views(c, &all, pack, threads, log);
    if (!status)
        status = find(c, &all, planes);
    statistics_free(&all);
    if (status)
        common_free(c);
    return status;
}

void common_keep(struct common *c, int planes)
{
    const size_t f = (size_t)c->functions, k = (size_t)planes, had = (size_t)c->plan.planes;
    for (size_t ch = 1; ch < 3; ch++)
        memmove(c->transform + ch * k * f, c->transform + ch * had * f, k * f * sizeof(float));
    for (size_t i = k; i < had; i++)
        c->plan.lost += c->plan.energy[i];
    c->plan.planes = c->plan.terms = planes;
}

void common_weights(const struct common *c, struct relume_vec3 light, double *weights,
                    double constant[3])
{
    float values[3 * RELUME_MOST_COEFFICIENTS], none[3];
    const size_t f = (size_t)c->functions, k = (size_t)c->plan.planes;
    relume_coder_weights(c->raw, light, values, none);
    for (size_t ch = 0; ch < 3; ch++) {
        constant[ch] = 0.0;
        for (size_t i = 0; i < f; i++)
            constant[ch] += (double)values[i] * (double)c->mean[ch * f + i];
        for (size_t j = 0; j < k; j++) {
            const float *row = c->transform + (ch * k + j) * f;
            double sum = 0.0;
            for (size_t i = 0; i < f; i++)
                sum += (double)values[i] * (double)row[i];
            weights[ch * k + j] = sum;
        }
    }
}

void common_free(struct common *c)
{
    plan_free(&c->plan);
    relume_coder_destroy(&c->raw);
    source_close(&c->source);
    mem_free(c->transform);
    mem_free(c->mean);
    *c = (struct common){0};
}
