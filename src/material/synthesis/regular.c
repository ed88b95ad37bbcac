// regular.c - what repeats in a texture: the waves that stand out of their surroundings, and the
// base of which all are multiples (Meseth 2008, 4.1.3)
#include "material/synthesis/regular.h"
#include "material/synthesis/base.h"
#include "material/synthesis/texture.h"
#include "material/synthesis/waves.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/scalar.h"

#include <string.h>

// Of the least squares that move waves; texels for each wave, which has four unknowns.
enum { STEPS = 12, TEXELS_EACH = 24 };
// Noise has powers that follow an exponential distribution: the highest of a million bins is 14
// times the mean. Structure has LEAST_SHARE of the variance; a base explains LEAST_KEPT of what the
// waves did by themselves, and nearly as much (ENOUGH) as the best does.
static const double STANDS_OUT = 25.0, LEAST_SHARE = 0.03, LEAST_KEPT = 0.85, ENOUGH = 0.97,
                    LEAST_PERIODS = 1.5;

struct search {
    struct plane plane[REGULAR_CHANNELS];
    struct waves found[REGULAR_CHANNELS], kept[REGULAR_CHANNELS];
    double variance[REGULAR_CHANNELS], rest[REGULAR_CHANNELS], before[REGULAR_CHANNELS];
    int channels, threads;
    const struct relume_regular_params *params;
};

static bool load(struct search *s, const struct relume_texture *t)
{
    const size_t n = (size_t)t->width * (size_t)t->height;
    for (int c = 0; c < s->channels; c++) {
        double *to = mem_array(n, sizeof *to), sum = 0.0, squares = 0.0;
        s->plane[c] = (struct plane){t->width, t->height, to};
        if (!to)
            return false;
        for (size_t i = 0; i < n; i++) {
            to[i] = 255.0 * (double)t->value[i * (size_t)t->channels + (size_t)c];
            sum += to[i];
        }
        for (size_t i = 0; i < n; i++)
            squares += (to[i] - sum / (double)n) * (to[i] - sum / (double)n);
        s->variance[c] = squares / (double)n;
    }
    return true;
}

static relume_status analyse(struct search *s)
{
    const int texels = s->plane[0].width * s->plane[0].height,
              most = smaller_of(s->params->most, larger_of(texels / TEXELS_EACH, 4));
    relume_status status = RELUME_OK;
    for (int c = 0; c < s->channels && !status; c++) {
        status = waves_find(&s->found[c], &s->plane[c], s->params->threshold, most, s->threads);
        if (!status)
            status = waves_fit(&s->found[c], &s->plane[c], STEPS, &s->rest[c], &s->before[c]);
        for (int i = 0; i < s->found[c].count; i++)
            s->found[c].wave[i].channel = c;
        if (!status && !log_progress(s->params->log, "structure", (c + 1.0) / s->channels))
            status = RELUME_ECANCEL;
    }
    return status;
}

static bool stands_out(const struct relume_wave *w)
{
    return w->above > STANDS_OUT && fmax(w->x, fabs(w->y)) >= LEAST_PERIODS;
}

static double total(const double *list, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += list[i];
    return sum;
}

// The means and the waves that stand out, at the nearest multiples of the base, each place once;
// those far from all multiples are left out. `base` NULL: where they are.
static relume_status choose(struct search *s, const double base[2])
{
    relume_status status = RELUME_OK;
    for (int c = 0; c < s->channels && !status; c++) {
        struct waves *to = &s->kept[c];
        to->count = 0;
        for (int i = 0; i < s->found[c].count; i++) {
            struct relume_wave w = s->found[c].wave[i];
            bool good = i == 0 || stands_out(&w);
            if (base && i) {
                const double x = base[0] * base_multiple(w.x, base[0]),
                             y = base[1] * base_multiple(w.y, base[1]);
                good = good && fabs(x - w.x) < BASE_FAR && fabs(y - w.y) < BASE_FAR;
                w.x = x;
                w.y = y;
                for (int j = 0; j < to->count; j++)
                    good =
                        good && !(fabs(to->wave[j].x - x) < 1e-9 && fabs(to->wave[j].y - y) < 1e-9);
            }
            if (good)
                to->wave[to->count++] = w;
        }
        status = waves_fit(to, &s->plane[c], 0, &s->rest[c], NULL);
    }
    return status;
}

// All waves of all channels in one list, the means left out.
static int gather(struct relume_wave *out, const struct search *s)
{
    int n = 0;
    for (int c = 0; c < s->channels; c++)
        for (int i = 1; i < s->kept[c].count; i++)
            out[n++] = s->kept[c].wave[i];
    return n;
}

// Whether no wave that was kept changes along x (or y).
static bool stands_still(const struct search *s, bool along_x)
{
    for (int c = 0; c < s->channels; c++)
        for (int i = 1; i < s->kept[c].count; i++)
            if ((along_x ? s->kept[c].wave[i].x : s->kept[c].wave[i].y) != 0.0)
                return false;
    return true;
}

// The power of the waves that are multiples of a base.
static double power_at(const struct relume_wave *list, int count, double x, double y)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        const struct relume_wave *w = &list[i];
        if (fabs(x * base_multiple(w->x, x) - w->x) < BASE_FAR &&
            fabs(y * base_multiple(w->y, y) - w->y) < BASE_FAR)
            sum += w->re * w->re + w->im * w->im;
    }
    return sum;
}

// Of the pairs of candidates the one whose multiples have most power (what is left, Eq. 4.5, is
// least then); of those that have about as much, the one of the largest frequencies, which has the
// smallest tile.
static void find_base(double base[2], const struct relume_wave *list, int count)
{
    double x[BASE_MOST], y[BASE_MOST], most = 0.0;
    const int across = base_candidates(x, list, count, true),
              down = base_candidates(y, list, count, false);
    base[0] = base[1] = 0.0;
    for (int i = 0; i < across * down; i++)
        most = fmax(most, power_at(list, count, x[i % across], y[i / across]));
    for (int i = 0; i < across * down; i++) {
        const double a = x[i % across], b = y[i / across];
        if (power_at(list, count, a, b) >= ENOUGH * most &&
            fmax(a, 1.0) * fmax(b, 1.0) > fmax(base[0], 1.0) * fmax(base[1], 1.0)) {
            base[0] = a;
            base[1] = b;
        }
    }
}

static int by_size(const void *a, const void *b)
{
    const struct relume_wave *x = a, *y = b;
    const bool mean_x = x->x == 0.0 && x->y == 0.0, mean_y = y->x == 0.0 && y->y == 0.0;
    if (mean_x != mean_y)
        return mean_x ? -1 : 1;
    if (mean_x)
        return x->channel - y->channel;
    const double p = x->re * x->re + x->im * x->im, q = y->re * y->re + y->im * y->im;
    return p > q ? -1 : p < q;
}

static relume_status collect(struct relume_regular *r, const struct search *s,
                             const struct waves *list)
{
    int n = 0;
    for (int c = 0; c < s->channels; c++)
        n += list[c].count;
    r->wave = mem_array((size_t)n, sizeof *r->wave);
    if (!r->wave)
        return RELUME_ENOMEM;
    for (int c = 0; c < s->channels; c++) {
        memcpy(r->wave + r->info.count, list[c].wave, (size_t)list[c].count * sizeof *r->wave);
        r->info.count += list[c].count;
    }
    qsort(r->wave, (size_t)n, sizeof *r->wave, by_size);
    r->info.wave = r->wave;
    r->info.rms = sqrt(total(s->rest, s->channels) / s->channels);
    return RELUME_OK;
}

static double share_of(const struct search *s)
{
    const double all = total(s->variance, s->channels);
    return all > 0.0 ? fmax(1.0 - total(s->rest, s->channels) / all, 0.0) : 0.0;
}

// Structure of which nothing is known is none: the means remain.
static relume_status settle(struct relume_regular *r, struct search *s)
{
    struct relume_wave *list =
        mem_array((size_t)(REGULAR_CHANNELS * (s->params->most + 1)), sizeof *list);
    double base[2] = {0.0, 0.0};
    relume_status status = list ? choose(s, NULL) : RELUME_ENOMEM;
    const double share = share_of(s);
    const int count = status ? 0 : gather(list, s);
    r->info.regular = count > 0 && share >= LEAST_SHARE;
    if (r->info.regular) {
        find_base(base, list, count);
        status = base[0] + base[1] > 0.0 ? choose(s, base) : RELUME_OK;
        r->info.common = base[0] + base[1] > 0.0 && share_of(s) >= LEAST_KEPT * share;
        if (!status && !r->info.common)
            status = choose(s, NULL);
    } else if (!status) {
        for (int c = 0; c < s->channels; c++) {
            s->kept[c].count = 1;
            s->rest[c] = s->variance[c];
        }
    }
    for (int i = 0; r->info.common && i < 2; i++)
        r->info.base[i] = stands_still(s, i == 0) ? 0.0 : base[i];
    r->info.share = r->info.regular ? share_of(s) : 0.0;
    mem_free(list);
    return status ? status : collect(r, s, s->kept);
}

static relume_status check(struct relume_regular_params *p)
{
    p->threshold = p->threshold != 0.0 ? p->threshold : 1.0;
    p->most = p->most ? p->most : 64;
    if (!(p->threshold >= 0.1 && p->threshold <= 255.0))
        return log_fail(p->log, RELUME_EINVAL, "threshold: expected 0.1 to 255; found %g",
                        p->threshold);
    if (p->most < 1 || p->most > 256)
        return log_fail(p->log, RELUME_EINVAL, "waves: expected 1 to 256; found %d", p->most);
    return RELUME_OK;
}

static relume_status find(struct relume_regular *r, struct search *s,
                          const struct relume_texture *t)
{
    relume_status status = load(s, t) ? analyse(s) : RELUME_ENOMEM;
    for (int c = 0; c < s->channels && !status; c++) {
        s->kept[c].wave = mem_array((size_t)s->found[c].count, sizeof *s->kept[c].wave);
        r->info.found += s->found[c].count - 1;
        if (!s->kept[c].wave)
            status = RELUME_ENOMEM;
    }
    r->info.rms_found = sqrt(total(s->before, s->channels) / s->channels);
    r->info.rms_fitted = sqrt(total(s->rest, s->channels) / s->channels);
    if (!status && s->params->all) {
        r->info.share = share_of(s);
        r->info.regular = r->info.found > 0;
        return collect(r, s, s->found);
    }
    return status ? status : settle(r, s);
}

relume_status relume_regular_find(relume_regular **out, const struct relume_texture *texture,
                                  const struct relume_regular_params *params)
{
    struct relume_regular_params p = PARAMS_WORK(relume_regular_params, params);
    struct search s = {.params = &p, .threads = p.threads};
    *out = NULL;
    relume_status status = check(&p);
    if (!status)
        status = texture_check(texture, p.log);
    if (status)
        return status;
    struct relume_regular *r = mem_zeroed(1, sizeof *r);
    if (!r)
        return RELUME_ENOMEM;
    s.channels = texture->channels < REGULAR_CHANNELS ? 1 : REGULAR_CHANNELS;
    r->width = texture->width;
    r->height = texture->height;
    r->channels = s.channels;
    status = find(r, &s, texture);
    for (int c = 0; c < s.channels; c++) {
        mem_free(s.plane[c].value);
        mem_free(s.found[c].wave);
        mem_free(s.kept[c].wave);
    }
    *out = r;
    if (status)
        relume_regular_destroy(out);
    return status;
}

void relume_regular_destroy(relume_regular **regular)
{
    if (*regular)
        mem_free((*regular)->wave);
    mem_free(*regular);
    *regular = NULL;
}

const struct relume_regular_info *relume_regular_info(const relume_regular *regular)
{
    return &regular->info;
}
