// change.c - from two captures to what has changed between them
#include <relume/material/change.h>

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/sort.h"
#include "material/change/flow.h"
#include "material/change/judge.h"
#include "material/maps/from_pack.h"

#include <math.h>
#include <string.h>

static const double bright_part = 0.98, bright = 0.8;  // of the pixels are darker than this
static const double other_lamps = 15.0;                // degrees
enum { LEAST_SIDE = 32, LEAST_KNOWN = 400 };

void relume_change_destroy(struct relume_change *c)
{
    struct relume_image *const of[] = {&c->normal[0],    &c->normal[1], &c->albedo[0],
                                       &c->albedo[1],    &c->degrees,   &c->delta_e,
                                       &c->significance, &c->changed,   &c->gloss};
    for (size_t i = 0; i < sizeof of / sizeof *of; i++)
        relume_image_destroy(of[i]);
    mem_free(c->place);
    *c = (struct relume_change){0};
}

// Colours so that bright parts are at 0.8 of white, however the capture was exposed.
static relume_status expose(struct surface *s, double *exposure)
{
    const size_t n = (size_t)s->width * (size_t)s->height;
    double *some = mem_array(n, sizeof *some);
    size_t count = 0;
    if (!some)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++)
        if (surface_knows(s, i))
            some[count++] = (double)s->colour.data[3 * i];
    sort_doubles(some, count);
    const double at = count ? some[(size_t)(bright_part * (double)(count - 1))] : 0.0;
    const float gain = at > 0.0 ? (float)(cbrt(bright) / at) : 1.0f;
    for (size_t i = 0; i < 3 * n; i++) {
        s->colour.data[i] *= gain;
        s->colour_noise.data[i] *= gain;
    }
    for (size_t i = 0; i < n; i++) {
        s->gloss.data[3 * i] *= gain * gain * gain;
        s->gloss_noise.data[3 * i] *= gain * gain * gain;
    }
    *exposure = (double)gain * (double)gain * (double)gain;
    mem_free(some);
    return RELUME_OK;
}

// A capture as it is compared.
struct side {
    struct surface surface;
    double exposure;   // that its colours were multiplied by
    double elevation;  // mean of the lights, degrees
};

static double elevation_of(const struct relume_manifest *m)
{
    double sum = 0.0;
    for (int i = 0; i < m->lights; i++)
        sum += asin(fmin(fmax(m->directions[i].z, -1.0), 1.0)) * 57.29577951308232;
    return sum / m->lights;
}

static relume_status fit_capture(struct side *out, const relume_capture *capture, int view,
                                 const char *name, int threads, const struct relume_log *log)
{
    const enum relume_projection projection = relume_capture_manifest(capture)->geometry.projection;
    const int width = relume_capture_width(capture), height = relume_capture_height(capture);
    if (projection != RELUME_PLANAR && projection != RELUME_SLAB)
        return log_fail(log, RELUME_EUNSUPPORTED,
                        "the %s capture is %s; expected a planar one, or a view of a slab", name,
                        relume_projection_name(projection));
    if (width < LEAST_SIDE || height < LEAST_SIDE)
        return log_fail(log, RELUME_EUNFIT,
                        "the %s capture has %d x %d pixels; expected %d x %d or more", name, width,
                        height, LEAST_SIDE, LEAST_SIDE);
    struct log_place place;
    relume_status status = surface_fit(&out->surface, capture, view, threads,
                                       log_at(&place, log, "the %s capture: ", name));
    out->elevation = elevation_of(relume_capture_manifest(capture));
    return status ? status : expose(&out->surface, &out->exposure);
}

static relume_status open_side(struct side *out, const struct relume_change_input *in,
                               const char *name, const struct relume_change_params *p)
{
    struct relit relit;
    if (!in->capture == !in->pack)
        return log_fail(p->log, RELUME_EINVAL, "change: expected a capture or a file");
    if (in->capture)
        return fit_capture(out, in->capture, in->view, name, p->threads, p->log);
    relume_status status = relit_open(&relit, in->pack, in->view, p->threads, p->log);
    if (!status)
        status = fit_capture(out, relit.capture, 0, name, p->threads, p->log);
    relit_close(&relit);
    return status;
}

static size_t common(const struct surface *a, const struct surface *b)
{
    size_t known = 0;
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height; i++)
        known += surface_knows(a, i) && surface_knows(b, i);
    return known;
}

// `laid` is the second at the places of the first, and made as it.
static relume_status lay(struct surface *laid, struct relume_change *out, const struct surface *a,
                         const struct surface *b, const struct relume_change_params *p)
{
    struct place place = {0};
    struct level level;
    relume_status status = place_register(&place, &out->registered.correlation, a, b,
                                          p->max_roll_deg, p->threads, p->log);
    for (int round = 0; !status && round < 2; round++) {
        status = place_sample(laid, b, &place, a->width, a->height, p->threads);
        if (!status && common(a, laid) < LEAST_KNOWN)
            status = log_fail(p->log, RELUME_EUNFIT,
                              "the two captures have %zu pixels in common; expected %d or more",
                              common(a, laid), LEAST_KNOWN);
        if (!status)
            status = level_find(&level, a, laid, &place, p->keep_bend, p->threads);
        if (!status && round)
            break;
        surface_free(laid);
        if (!status)
            status = flow_find(&place, &out->flow, a, b, &level, p->threads);
    }
    if (!status) {
        level_apply(&level, laid, p->threads);
        memcpy(out->registered.m, place.m, sizeof place.m);
        out->bend_deg = level.bend_deg;
        for (int c = 0; c < 3; c++)
            out->gain[c] = exp(3.0 * level.gain[c][0]);
    }
    place_free(&place);
    return status;
}

static relume_status create(struct relume_change *out, const struct surface *a)
{
    struct {
        struct relume_image *image;
        int channels;
    } const of[] = {{&out->normal[0], 3},    {&out->normal[1], 3}, {&out->albedo[0], 3},
                    {&out->albedo[1], 3},    {&out->degrees, 1},   {&out->delta_e, 1},
                    {&out->significance, 3}, {&out->changed, 3},   {&out->gloss, 1}};
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && i < sizeof of / sizeof *of; i++)
        status = relume_image_create(of[i].image, a->width, a->height, of[i].channels);
    out->width = a->width;
    out->height = a->height;
    return status;
}

static void fill(struct relume_change *out, const struct surface *a, const struct surface *b)
{
    const struct surface *of[] = {a, b};
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height; i++)
        for (int k = 0; k < 2; k++)
            if (surface_knows(a, i) && surface_knows(b, i)) {
                memcpy(out->normal[k].data + 3 * i, of[k]->normal.data + 3 * i, 3 * sizeof(float));
                colour_linear(out->albedo[k].data + 3 * i, of[k]->colour.data + 3 * i);
            }
}

static relume_status check(const struct relume_change_params *p)
{
    if (!(p->least_deg >= 0.0 && p->least_deg <= 90.0) ||
        !(p->least_de >= 0.0 && p->least_de <= 100.0) ||
        !(p->least_gloss >= 0.0 && p->least_gloss <= 1.0) ||
        !(p->false_share > 0.0 && p->false_share <= 0.5) || p->least_area < 1 ||
        !(p->max_roll_deg > 0.0 && p->max_roll_deg <= 180.0))
        return log_fail(p->log, RELUME_EINVAL,
                        "change: expected degrees of 0 to 90, deltaE of 0 to 100, gloss of 0 to 1, "
                        "a false share "
                        "above 0 and at most 0.5, an area of 1 or more, a roll of at most 180");
    return RELUME_OK;
}

relume_status relume_change_find(struct relume_change *out,
                                 const struct relume_change_input *before,
                                 const struct relume_change_input *after,
                                 const struct relume_change_params *params)
{
    struct relume_change_params p = PARAMS_WORK(relume_change_params, params);
    struct side a = {0}, b = {0};
    struct surface laid = {0};
    p.threads = thread_count(p.threads);
    p.least_deg = p.least_deg != 0.0 ? p.least_deg : 2.0;
    p.least_de = p.least_de != 0.0 ? p.least_de : 2.0;
    p.least_gloss = p.least_gloss != 0.0 ? p.least_gloss : 0.03;
    p.false_share = p.false_share != 0.0 ? p.false_share : 0.01;
    p.least_area = p.least_area ? p.least_area : 16;
    p.max_roll_deg = p.max_roll_deg != 0.0 ? p.max_roll_deg : 12.0;
    *out = (struct relume_change){0};
    relume_status status = check(&p);
    if (!status)
        status = open_side(&a, before, "first", &p);
    if (!status)
        status = open_side(&b, after, "second", &p);
    if (!status)
        status = lay(&laid, out, &a.surface, &b.surface, &p);
    surface_free(&b.surface);
    if (!status)
        status = create(out, &a.surface);
    if (!status) {
        for (int c = 0; c < 3; c++)
            out->gain[c] *= b.exposure / a.exposure;
        fill(out, &a.surface, &laid);
        status = judge(out, &a.surface, &laid, &p);
    }
    if (!status)
        status = places_find(out, p.least_area);
    surface_free(&a.surface);
    surface_free(&laid);
    if (!status && fabs(a.elevation - b.elevation) > other_lamps)
        log_line(
            p.log, RELUME_WARNING,
            "the lamps of the two captures stand at different heights (%.0f and %.0f degrees on "
            "average): in deep grooves shadows can look like change",
            a.elevation, b.elevation);
    if (status)
        relume_change_destroy(out);
    return status;
}
