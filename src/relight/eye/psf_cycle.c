// psf_cycle.c - patterns that are computed once and shown in a loop (Ritschel 2009, 8.4.4)
//
// A loop must end as it begins, and an eye does not: the loop's first part fades over from what the
// eye shows after the loop's end. Patterns are light, and a mean of two of them is one.
#include <relume/relight/psf.h>

#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "relight/eye/pattern.h"
#include "relight/eye/psf.h"

#include <math.h>

// Halfs hold nine decades below this; a pattern falls by eight from its middle to its rim.
static const float largest_half = 60000.0f;
enum { MOST_PATTERNS = 3600 };

struct relume_psf_cycle {
    int field, count;
    double seconds;
    double *light;     // [count]
    double (*sum)[3];  // [count]: of the halfs of a channel
    uint16_t *shown;   // [count][3][field * field], each channel to a scale of its own
    double age, pigment;
};

static size_t texels(const relume_psf_cycle *c)
{
    return (size_t)c->field * (size_t)c->field;
}

static uint16_t *channel_of(const relume_psf_cycle *c, int k, int channel)
{
    return c->shown + (3 * (size_t)k + (size_t)channel) * texels(c);
}

// ---------------------------------------------------------------- showing

struct showing {
    const relume_psf_cycle *cycle;
    int from, to;
    float part;  // of `to`
    float *out[3];
};

static double sum_of(const uint16_t *v, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += (double)float_from_half(v[i]);
    return sum != 0.0 ? sum : 1.0;
}

// Each pattern sums to 1 before they are mixed, so that halfs change no light.
static void show_channel(void *context, size_t channel, int worker)
{
    (void)worker;
    const struct showing *s = context;
    const size_t n = texels(s->cycle);
    const uint16_t *a = channel_of(s->cycle, s->from, (int)channel);
    const uint16_t *b = channel_of(s->cycle, s->to, (int)channel);
    const float of_a = (float)((1.0 - (double)s->part) / s->cycle->sum[s->from][channel]);
    const float of_b = (float)((double)s->part / s->cycle->sum[s->to][channel]);
    for (size_t i = 0; i < n; i++)
        s->out[channel][i] = of_a * float_from_half(a[i]) + of_b * float_from_half(b[i]);
}

relume_status relume_psf_cycle_show(relume_psf *psf, const relume_psf_cycle *cycle, double time_s)
{
    if (relume_psf_shape(psf)->field != cycle->field || !isfinite(time_s))
        return RELUME_EINVAL;
    const double turn = time_s / cycle->seconds, at = (turn - floor(turn)) * cycle->count;
    const int from = (int)at % cycle->count;
    struct showing s = {.cycle = cycle,
                        .from = from,
                        .to = (from + 1) % cycle->count,
                        .part = (float)(at - floor(at))};
    for (int c = 0; c < 3; c++)
        s.out[c] = psf_channel_to_fill(psf, c);
    thread_for(psf_threads(psf), 3, show_channel, &s);
    psf_filled(psf,
               cycle->light[s.from] + (double)s.part * (cycle->light[s.to] - cycle->light[s.from]),
               cycle->age, cycle->pigment);
    return RELUME_OK;
}

// ---------------------------------------------------------------- making

static void keep(relume_psf_cycle *c, int k, const relume_psf *psf)
{
    c->light[k] = relume_psf_light(psf);
    for (int channel = 0; channel < 3; channel++) {
        const float *v = psf_channel(psf, channel);
        uint16_t *to = channel_of(c, k, channel);
        float most = 0.0f;
        for (size_t i = 0; i < texels(c); i++)
            most = fmaxf(most, fabsf(v[i]));
        const float scale = most > 0.0f ? largest_half / most : 0.0f;
        for (size_t i = 0; i < texels(c); i++)
            to[i] = half_from_float(scale * v[i]);
        c->sum[k][channel] = sum_of(to, texels(c));
    }
}

// The pattern of `psf` comes after the loop's end, as far as pattern k after its beginning.
static void fade_over(relume_psf_cycle *c, int k, double part, relume_psf *psf)
{
    const double light = relume_psf_light(psf);
    for (int channel = 0; channel < 3; channel++) {
        const uint16_t *before = channel_of(c, k, channel);
        float *v = psf_channel_to_fill(psf, channel);
        const double sum = c->sum[k][channel];
        for (size_t i = 0; i < texels(c); i++)
            v[i] = (float)(part / sum * (double)float_from_half(before[i]) +
                           (1.0 - part) * (double)v[i]);
    }
    psf_filled(psf, part * c->light[k] + (1.0 - part) * light, c->age, c->pigment);
    keep(c, k, psf);
}

static relume_status make_cycle(relume_psf_cycle *c, relume_psf *psf, relume_eye *eye,
                                const struct relume_psf_cycle_params *p)
{
    const double step = c->seconds / c->count;
    const int fading = (int)lrint(p->fade_s / step);
    relume_status status = RELUME_OK;
    for (int k = 0; k < c->count + fading && !status; k++) {
        if (p->log && p->log->progress &&
            !p->log->progress(p->log->user, "eye", (double)k / (c->count + fading)))
            return RELUME_ECANCEL;
        status = relume_psf_update(psf, eye);
        if (!status && k < c->count)
            keep(c, k, psf);
        else if (!status)
            fade_over(c, k - c->count, (double)(k - c->count) / fading, psf);
        if (!status)
            status = relume_eye_advance(eye, step, p->luminance);
    }
    return status;
}

relume_status relume_psf_cycle_create(relume_psf_cycle **out, relume_psf *psf, relume_eye *eye,
                                      const struct relume_psf_cycle_params *params)
{
    struct relume_psf_cycle_params p = PARAMS(relume_psf_cycle_params, params);
    p.seconds = p.seconds != 0.0 ? p.seconds : 4.0;
    p.fps = p.fps != 0.0 ? p.fps : 30.0;
    p.fade_s = p.fade_s != 0.0 ? p.fade_s : 0.25 * p.seconds;
    p.luminance = p.luminance != 0.0 ? p.luminance : relume_eye_state(eye)->luminance;
    *out = NULL;
    if (!(p.seconds > 0.0 && p.fps > 0.0 && p.seconds * p.fps >= 1.0 &&
          p.seconds * p.fps <= MOST_PATTERNS))
        return log_fail(p.log, RELUME_EINVAL,
                        "cycle; expected 1 to %d patterns; found %g seconds of %g", MOST_PATTERNS,
                        p.seconds, p.fps);
    if (!(p.fade_s >= 0.0 && p.fade_s <= p.seconds))
        return log_fail(p.log, RELUME_EINVAL,
                        "cycle; expected a fade of at most its %g s; found %g", p.seconds,
                        p.fade_s);
    relume_psf_cycle *c = mem_zeroed(1, sizeof *c);
    if (!c)
        return RELUME_ENOMEM;
    c->field = relume_psf_shape(psf)->field;
    c->count = (int)lrint(p.seconds * p.fps);
    c->seconds = p.seconds;
    c->age = relume_eye_subject(eye)->optics.age;
    c->pigment = relume_eye_subject(eye)->optics.pigment;
    c->light = mem_zeroed((size_t)c->count, sizeof *c->light);
    c->sum = mem_zeroed((size_t)c->count, sizeof *c->sum);
    c->shown = mem_array(3 * (size_t)c->count, texels(c) * sizeof *c->shown);
    const relume_status status =
        c->light && c->sum && c->shown ? make_cycle(c, psf, eye, &p) : RELUME_ENOMEM;
    if (status)
        relume_psf_cycle_destroy(&c);
    *out = c;
    return status;
}

void relume_psf_cycle_destroy(relume_psf_cycle **cycle)
{
    if (!*cycle)
        return;
    mem_free((*cycle)->light);
    mem_free((*cycle)->sum);
    mem_free((*cycle)->shown);
    mem_free(*cycle);
    *cycle = NULL;
}
