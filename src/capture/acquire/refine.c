// refine.c - lights and surface from the images, in turn
//
// The value of a matte pixel under a light is g.l with g = albedo x normal and l = brightness x
// direction: a bilinear system, solved for all g with l fixed (robustly, core/math/lambert.h) and
// for all l with g fixed, by turns. Its solutions are known up to g -> A^-T g, l -> A l. The A that
// is taken brings the l nearest to the directions given, over all lights: their common error stays,
// that of one against the others goes. Where it is asked for, integrability (integrable.h) then
// corrects part of the common error as well.
#include <relume/capture/acquire.h>

#include "capture/acquire/integrable.h"
#include "capture/acquire/refine.h"
#include "capture/manifest/near_view.h"
#include "capture/manifest/reflectance_table.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/lambert.h"
#include "core/math/lsq.h"
#include "core/math/luminance.h"
#include "core/math/sort.h"

#include <string.h>

enum { PIXELS = 6000, ROUNDS = 30, LEAST_LIGHTS = 6 };
// Brightness alone: in turn with robust surfaces it drifts, since what brightness explains looks
// like shadow at first; with plain ones it converges, and few robust rounds take shadows out.
enum { PLAIN_ROUNDS = 100, ROBUST_ROUNDS = 3 };
static const float DARK = 0.01f;       // median over lights below which a pixel says little
static const float CLIPPED = 0.995f;   // of white
static const double MOST_MOVED = 5.0;  // degrees, by integrability

enum { BINS = 32 };                       // of normals, along x and y
static const double RARE = 0.002;         // share of the pixels: rarer normals count no more
static const double MOST_CHANGED = 10.0;  // degrees, RMS: no one misses lamps by more
static const double AGREED = 0.25;        // degrees between halves that always do
static const double CLEAR = 2.0;          // moved by as many times what halves disagree

struct refiner {
    const relume_capture *capture;
    int lights, threads;
    bool brightness;  // alone: directions stay
    bool plain;       // surfaces are fitted to all samples, outliers too
    bool is_near;     // each pixel has its own directions; brightness alone
    struct near_view near;
    vec3 *point;  // [PIXELS] in the world, of near lights
    const vec3 *given;
    size_t pixels;
    int step, columns, rows;         // of the lattice of pixels
    int *slot;                       // [rows][columns]: which pixel; -1: none
    float *value;                    // [PIXELS][lights]; clipped ones are NaN
    vec3 *g;                         // [PIXELS]
    bool *known;                     // [PIXELS]
    double *weight;                  // [PIXELS], by how rare their normal is; mean 1
    vec3 *light;                     // [lights]
    double *bright;                  // [lights]
    struct lambert_sample *scratch;  // [workers][lights]
    vec3 *towards;                   // [workers][lights]
};

static bool is_useful(const float *value, int lights)
{
    int lit = 0;
    for (int i = 0; i < lights; i++)
        lit += value[i] > DARK;
    return lit >= 4 && 2 * lit >= lights;
}

// The unit direction from a point to a light; `*gain` as near_view_direction.
static vec3 direction_at(double *gain, const struct refiner *r, vec3 point, int light)
{
    *gain = 1.0;
    return r->is_near ? near_view_direction(gain, &r->near, light, point) : r->given[light];
}

static int take_pixel(struct refiner *r, const float *band, size_t stride, int x, int y,
                      float (*white)[3])
{
    float *to = r->value + r->pixels * (size_t)r->lights;
    vec3 *point = &r->point[r->pixels];
    *point = r->is_near ? near_view_pixel(&r->near, x, y) : vec3_of(0, 0, 0);
    for (int i = 0; i < r->lights; i++) {
        double gain;
        (void)direction_at(&gain, r, *point, i);
        const float *p = band + (size_t)i * stride + 3 * x, most = CLIPPED * (float)gain;
        const bool clips =
            p[0] >= most * white[i][0] || p[1] >= most * white[i][1] || p[2] >= most * white[i][2];
        to[i] = clips ? NAN : luminance_709f(p);
    }
    return r->pixels < PIXELS && is_useful(to, r->lights) ? (int)r->pixels++ : -1;
}

// A square lattice with about PIXELS crossings inside the mask.
static relume_status lay_lattice(struct refiner *r, const struct relume_image *mask)
{
    const int width = relume_capture_width(r->capture), height = relume_capture_height(r->capture);
    const size_t all = (size_t)width * (size_t)height;
    size_t inside = mask->data ? 0 : all;
    for (size_t i = 0; mask->data && i < all; i++)
        inside += mask->data[i] > 0.5f;
    r->step = (int)ceil(sqrt((double)inside / (0.95 * PIXELS)));
    r->step = r->step < 1 ? 1 : r->step;
    r->columns = (width + r->step - 1) / r->step;
    r->rows = (height + r->step - 1) / r->step;
    r->slot = mem_array((size_t)r->columns * (size_t)r->rows, sizeof *r->slot);
    return r->slot ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status read_rows(struct refiner *r, const struct relume_image *mask, float *band,
                               float (*white)[3], const struct relume_log *log)
{
    const size_t width = (size_t)relume_capture_width(r->capture), step = (size_t)r->step;
    const size_t height = (size_t)relume_capture_height(r->capture);
    relume_table *table;
    relume_status status = relume_table_open(
        &table, r->capture, 0,
        relume_table_params(.keep_near = true, .log = log, .threads = r->threads));
    for (size_t y = 0; !status && y < height; y++) {
        status = relume_table_read(table, 1, band);
        for (size_t x = 0; !status && y % step == 0 && x < width; x += step)
            r->slot[y / step * (size_t)r->columns + x / step] =
                mask->data && mask->data[y * width + x] <= 0.5f
                    ? -1
                    : take_pixel(r, band, 3 * width, (int)x, (int)y, white);
    }
    relume_table_destroy(&table);
    return status;
}

static relume_status read_pixels(struct refiner *r, const struct relume_log *log)
{
    struct relume_image mask;
    float *band =
        mem_array((size_t)r->lights * 3, (size_t)relume_capture_width(r->capture) * sizeof *band);
    float(*white)[3] = mem_array((size_t)r->lights, sizeof *white);
    relume_status status = relume_capture_mask(&mask, r->capture, 0, log);
    if (!status && r->is_near)
        status = near_view_open(&r->near, r->capture, 0, log);
    if (!status && !(band && white))
        status = RELUME_ENOMEM;
    if (!status)
        status = lay_lattice(r, &mask);
    for (int i = 0; !status && i < r->lights; i++)
        relume_capture_white(r->capture, i, white[i]);
    if (!status)
        status = read_rows(r, &mask, band, white, log);
    relume_image_destroy(&mask);
    mem_free(band);
    mem_free(white);
    return status;
}

// ---------------------------------------------------------------- in turn

// Where brightness alone is sought it is divided out, so that what is left looks like shadow or
// gloss only where it is.
static void fit_pixel(void *context, size_t item, int worker)
{
    struct refiner *r = context;
    const vec3 *light = r->brightness ? r->given : r->light;
    vec3 *towards = r->towards + (size_t)worker * (size_t)r->lights;
    double gain;
    for (int i = 0; i < r->lights; i++)
        towards[i] = r->is_near ? direction_at(&gain, r, r->point[item], i) : light[i];
    struct lambert_sample *s = r->scratch + (size_t)worker * (size_t)r->lights;
    const float *value = r->value + item * (size_t)r->lights;
    int n = 0;
    for (int i = 0; i < r->lights; i++)
        if (!isnan(value[i])) {
            const float bright = r->brightness ? (float)vec3_length(r->light[i]) : 1.0f;
            s[n++] = (struct lambert_sample){value[i] / bright, 1.0f, i};
        }
    r->known[item] = n >= 4 && lambert_fit(&r->g[item], towards, s, &n, r->plain) != NULL;
}

static int bin_of(double component)
{
    const int i = relume_whole(0.5 * (component + 1.0) * BINS);
    return i < 0 ? 0 : i >= BINS ? BINS - 1 : i;
}

static void weigh_pixels(struct refiner *r)
{
    size_t count[BINS][BINS] = {{0}}, known = 0;
    double sum = 0.0;
    for (size_t k = 0; k < r->pixels; k++) {
        const vec3 n = r->known[k] ? vec3_unit(r->g[k]) : vec3_of(0, 0, 1);
        count[bin_of(n.x)][bin_of(n.y)] += r->known[k];
        known += r->known[k];
    }
    for (size_t k = 0; k < r->pixels; k++) {
        const vec3 n = r->known[k] ? vec3_unit(r->g[k]) : vec3_of(0, 0, 1);
        const double alike = (double)count[bin_of(n.x)][bin_of(n.y)];
        r->weight[k] = r->known[k] ? 1.0 / fmax(alike, RARE * (double)known) : 0.0;
        sum += r->weight[k];
    }
    for (size_t k = 0; k < r->pixels; k++)
        r->weight[k] *= sum > 0.0 ? (double)known / sum : 0.0;
}

// Of the surface: what faces more along the axis than half of it does.
struct half {
    vec3 axis;  // of unit length; 0: all of it
    double least;
};

static bool is_in(const struct half *half, vec3 g)
{
    return vec3_dot(g, half->axis) >= half->least * vec3_length(g);
}

// Reweighted least squares of one light over the pixels that it lights.
static bool light_from(vec3 *out, const struct refiner *r, size_t item, const struct half *half)
{
    vec3 light = *out;
    double scale = 0.1;
    for (int round = 0; round < 6; round++) {
        double m[9] = {0.0}, b[3] = {0.0}, sum = 0.0, weight = 0.0;
        for (size_t k = 0; k < r->pixels; k++) {
            const double v = (double)r->value[k * (size_t)r->lights + item];
            const vec3 g = r->g[k];
            const double size = vec3_length(g), expected = vec3_dot(g, light);
            if (!r->known[k] || isnan(v) || expected < 0.15 * size * vec3_length(light) ||
                !is_in(half, g))
                continue;
            const double miss = (v - expected) / size;
            const double trust = r->weight[k] / (1.0 + miss * miss / (scale * scale));
            const double w = trust / (size * size);
            const double row[3] = {g.x, g.y, g.z};
            for (int j = 0; j < 9; j++)
                m[j] += w * row[j / 3] * row[j % 3];
            for (int j = 0; j < 3; j++)
                b[j] += w * row[j] * v;
            sum += trust * miss * miss;
            weight += trust;
        }
        if (weight < 20.0 || !lsq_solve(m, 3, b, 1))
            return false;
        light = vec3_of(b[0], b[1], b[2]);
        scale = fmax(2.0 * sqrt(sum / weight), 1e-3);
    }
    *out = light;
    return true;
}

// The brightness of one light likewise, by its directions from the pixels.
static bool brightness_from(double *out, const struct refiner *r, size_t item)
{
    double bright = *out, scale = 0.1;
    for (int round = 0; round < 6; round++) {
        double square = 0.0, along = 0.0, sum = 0.0, weight = 0.0, gain;
        for (size_t k = 0; k < r->pixels; k++) {
            const double v = (double)r->value[k * (size_t)r->lights + item];
            if (!r->known[k] || isnan(v))
                continue;
            const vec3 l = direction_at(&gain, r, r->point[k], (int)item);
            const double size = vec3_length(r->g[k]), shown = vec3_dot(r->g[k], l) / size;
            if (shown < 0.15)
                continue;
            const double miss = v / size - bright * shown;
            const double trust = r->weight[k] / (1.0 + miss * miss / (scale * scale));
            square += trust * shown * shown;
            along += trust * shown * v / size;
            sum += trust * miss * miss;
            weight += trust;
        }
        if (weight < 20.0 || !(along > 0.0))
            return false;
        bright = along / square;
        scale = fmax(2.0 * sqrt(sum / weight), 1e-3);
    }
    *out = bright;
    return true;
}

static void fit_light(void *context, size_t item, int worker)
{
    (void)worker;
    struct refiner *r = context;
    double bright = vec3_length(r->light[item]);
    if (!r->brightness)
        light_from(&r->light[item], r, item, &(struct half){{0, 0, 0}, 0.0});
    else if (brightness_from(&bright, r, item))
        r->light[item] = vec3_scale(r->given[item], bright);
}

// light <- A light with the A that brings the lights nearest to s_i given_i, s_i being free.
static bool fix_gauge(struct refiner *r, const vec3 *given)
{
    double *bright = r->bright;
    for (int i = 0; i < r->lights; i++)
        bright[i] = vec3_length(r->light[i]);
    bool good = true;
    for (int round = 0; good && round < 20; round++) {
        double m[9] = {0.0}, b[9] = {0.0};  // b: three right sides, the rows of A
        for (int i = 0; i < r->lights; i++) {
            const vec3 l = r->light[i], to = vec3_scale(given[i], bright[i]);
            const double row[3] = {l.x, l.y, l.z}, want[3] = {to.x, to.y, to.z};
            for (int j = 0; j < 9; j++) {
                m[j] += row[j / 3] * row[j % 3];
                b[j] += want[j / 3] * row[j % 3];
            }
        }
        good = lsq_solve(m, 3, b, 3);
        double mean = 0.0;
        for (int i = 0; good && i < r->lights; i++) {
            const vec3 l = r->light[i];
            r->light[i] =
                vec3_of(b[0] * l.x + b[1] * l.y + b[2] * l.z, b[3] * l.x + b[4] * l.y + b[5] * l.z,
                        b[6] * l.x + b[7] * l.y + b[8] * l.z);
            bright[i] = fmax(vec3_dot(r->light[i], given[i]), 1e-3);
            mean += vec3_length(r->light[i]) / r->lights;
        }
        for (int i = 0; good && i < r->lights; i++) {
            r->light[i] = vec3_scale(r->light[i], 1.0 / mean);
            bright[i] /= mean;
        }
    }
    return good;
}

// Where directions stay, what is free is the mean brightness.
static bool fix_mean(struct refiner *r)
{
    double mean = 0.0;
    for (int i = 0; i < r->lights; i++)
        mean += vec3_length(r->light[i]) / r->lights;
    for (int i = 0; i < r->lights; i++)
        r->light[i] = vec3_scale(r->light[i], 1.0 / mean);
    return isfinite(mean) && mean > 0.0;
}

// ---------------------------------------------------------------- whether to believe it

static double degrees_between(vec3 a, vec3 b)
{
    return vec3_angle(a, b) * 180.0 / M_PI;
}

// By how much lights from one half of the surface differ from those of both, RMS; `sorted`
// [pixels]. Infinite where one half alone gives more than a quarter of the lights.
static double disagreement(const struct refiner *r, vec3 axis, double *sorted)
{
    const vec3 back = vec3_scale(axis, -1.0);
    size_t n = 0;
    int counted = 0;
    double sum = 0.0;
    for (size_t k = 0; k < r->pixels; k++)
        if (r->known[k])
            sorted[n++] = vec3_dot(vec3_unit(r->g[k]), axis);
    if (!n)
        return INFINITY;
    sort_doubles(sorted, n);
    const struct half one = {axis, sorted[n / 2]}, other = {back, -sorted[n / 2]};
    for (int i = 0; i < r->lights; i++) {
        vec3 a = r->light[i], b = a;
        if (!light_from(&a, r, (size_t)i, &one) || !light_from(&b, r, (size_t)i, &other))
            continue;
        const double off = 0.5 * degrees_between(a, b);
        sum += off * off;
        counted++;
    }
    return 4 * counted < 3 * r->lights ? (double)INFINITY : sqrt(sum / counted);
}

static relume_status judge(bool *believed, const struct refiner *r, const vec3 *given,
                           const struct relume_log *log)
{
    double *sorted = mem_array(r->pixels, sizeof *sorted), sum = 0.0;
    if (!sorted)
        return RELUME_ENOMEM;
    const double off =
        fmax(disagreement(r, vec3_of(1, 0, 0), sorted), disagreement(r, vec3_of(0, 1, 0), sorted));
    mem_free(sorted);
    for (int i = 0; i < r->lights; i++)
        sum += pow(degrees_between(r->light[i], given[i]), 2.0);
    const double change = sqrt(sum / r->lights);
    *believed = change < MOST_CHANGED && off < fmax(AGREED, change / CLEAR);
    if (!*believed && isfinite(off))
        log_line(
            log, RELUME_WARNING,
            "lights not refined: the result would be unreliable, %.1f degrees from one half of "
            "the surface to the other; it is too flat or too glossy; originals kept",
            2.0 * off);
    else if (!*believed)
        log_line(log, RELUME_WARNING,
                 "lights not refined: the surface is too flat; originals kept");
    return RELUME_OK;
}

// A light as pixel `k` sees it: its direction times its brightness.
static vec3 light_at(const struct refiner *r, size_t k, int light)
{
    double gain;
    return r->is_near ? vec3_scale(direction_at(&gain, r, r->point[k], light),
                                   vec3_length(r->light[light]))
                      : r->light[light];
}

// The median |miss| / albedo of lit samples, with surfaces fitted to the lights as they are.
static relume_status find_residual(double *residual, struct refiner *r)
{
    double *miss = mem_array(r->pixels * (size_t)r->lights, sizeof *miss);
    size_t n = 0;
    thread_for(r->threads, r->pixels, fit_pixel, r);
    for (size_t k = 0; miss && k < r->pixels; k++)
        for (int i = 0; r->known[k] && i < r->lights; i++) {
            const double v = (double)r->value[k * (size_t)r->lights + (size_t)i];
            const double expected = vec3_dot(r->g[k], light_at(r, k, i));
            const double size = vec3_length(r->g[k]);
            if (!isnan(v) && expected > LAMBERT_GRAZING * size)
                miss[n++] = fabs(v - expected) / size;
        }
    if (n)
        sort_doubles(miss, n);
    *residual = n ? miss[n / 2] : (double)NAN;
    const relume_status status = miss ? RELUME_OK : RELUME_ENOMEM;
    mem_free(miss);
    return status;
}

// The lights by which the surface has no curl; brightness keeps its mean.
static relume_status integrate(struct refiner *r, double curl[2], const struct relume_log *log)
{
    const struct lattice lattice = {r->columns, r->rows, r->slot, r->g, r->known};
    double a[9], mean = 0.0, angle = 0.0;
    vec3 *moved = mem_array((size_t)r->lights, sizeof *moved);
    if (!moved)
        return RELUME_ENOMEM;
    if (!integrable_map(a, curl, &lattice)) {
        mem_free(moved);
        return log_fail(log, RELUME_EUNFIT,
                        "lights cannot be made to fit a surface of heights: too little of it is "
                        "connected");
    }
    for (int i = 0; i < r->lights; i++) {
        const vec3 l = r->light[i];
        moved[i] =
            vec3_of(a[0] * l.x + a[1] * l.y + a[2] * l.z, a[3] * l.x + a[4] * l.y + a[5] * l.z,
                    a[6] * l.x + a[7] * l.y + a[8] * l.z);
        mean += vec3_length(moved[i]) / r->lights;
        angle += degrees_between(moved[i], l) / r->lights;
    }
    if (angle > MOST_MOVED) {
        log_line(log, RELUME_WARNING,
                 "surface not made continuous: the lights would have to move by %.1f degrees, more "
                 "than %.0f; it is glossy, or --transfer is wrong; lights as without --integrable",
                 angle, MOST_MOVED);
        curl[1] = curl[0];
    } else {
        for (int i = 0; i < r->lights; i++)
            r->light[i] = vec3_scale(moved[i], 1.0 / mean);
    }
    mem_free(moved);
    return RELUME_OK;
}

// Back to where they came from.
static void give_back(struct refiner *r, const vec3 *given)
{
    for (int i = 0; i < r->lights; i++)
        r->light[i] = given[i];
}

static relume_status judge_brightness(bool *believed, struct refiner *r, const vec3 *given,
                                      double residual[2], const struct relume_log *log)
{
    const relume_status status = find_residual(&residual[1], r);
    *believed = !status && residual[1] < residual[0];
    if (!status && !*believed) {
        log_line(log, RELUME_WARNING,
                 "brightness not refined: the photographs fit lamps of equal brightness best");
        residual[1] = residual[0];
        give_back(r, given);
    }
    return status;
}

static relume_status solve(struct refiner *r, bool *believed, const vec3 *given, double residual[2],
                           const struct relume_log *log)
{
    relume_status status = find_residual(&residual[0], r);
    bool good = true;
    const int rounds = r->brightness ? PLAIN_ROUNDS + ROBUST_ROUNDS : ROUNDS;
    for (int round = 0; !status && good && round < rounds; round++) {
        r->plain = r->brightness && round < PLAIN_ROUNDS;
        weigh_pixels(r);
        thread_for(r->threads, (size_t)r->lights, fit_light, r);
        good = r->brightness ? fix_mean(r) : fix_gauge(r, given);
        thread_for(r->threads, r->pixels, fit_pixel, r);
        if (!log_progress(log, "refining", (round + 1.0) / rounds))
            return RELUME_ECANCEL;
    }
    if (!status)
        weigh_pixels(r);
    if (!status && r->brightness)
        return judge_brightness(believed, r, given, residual, log);
    if (!status)
        status = judge(believed, r, given, log);
    residual[1] = residual[0];
    if (!status && *believed)
        return find_residual(&residual[1], r);
    give_back(r, given);
    return status;
}

relume_status relume_acquire_refine(struct relume_vec3 *direction, double *intensity,
                                    double residual[2], const relume_capture *capture,
                                    const struct relume_acquire_refine_params *params)
{
    const struct relume_acquire_refine_params p = PARAMS_WORK(relume_acquire_refine_params, params);
    const struct relume_manifest *m = relume_capture_manifest(capture);
    double curl[2] = {0.0, 0.0};
    bool believed = false;
    struct refiner r = {
        .capture = capture,
        .lights = m->lights,
        .threads = thread_count(p.threads),
        .brightness = p.brightness,
        .is_near = near_view_applies(capture, 0),
        .given = m->directions,
    };
    if (m->lights < LEAST_LIGHTS || (m->positions && !p.brightness) ||
        !lambert_spans(m->directions, m->lights))
        return log_fail(p.log, RELUME_EUNFIT,
                        "lights cannot be refined: expected %d%s or more, in different planes; "
                        "found %d",
                        (int)LEAST_LIGHTS, p.brightness ? "" : " distant ones", m->lights);
    r.value = mem_array((size_t)(PIXELS + 1) * (size_t)r.lights, sizeof *r.value);
    r.g = mem_array(PIXELS, sizeof *r.g);
    r.point = mem_array(PIXELS + 1, sizeof *r.point);
    r.known = mem_array(PIXELS, sizeof *r.known);
    r.weight = mem_array(PIXELS, sizeof *r.weight);
    r.light = mem_copy(m->directions, (size_t)r.lights, sizeof *r.light);
    r.bright = mem_array((size_t)r.lights, sizeof *r.bright);
    r.scratch = mem_array((size_t)r.threads * (size_t)r.lights, sizeof *r.scratch);
    r.towards = mem_array((size_t)r.threads * (size_t)r.lights, sizeof *r.towards);
    relume_status status = r.value && r.g && r.point && r.known && r.weight && r.light &&
                                   r.bright && r.scratch && r.towards
                               ? RELUME_OK
                               : RELUME_ENOMEM;
    if (!status)
        status = read_pixels(&r, p.log);
    if (!status && r.pixels < 200)
        status =
            log_fail(p.log, RELUME_EUNFIT,
                     "lights cannot be refined: %zu pixels are lit by half of the lights; "
                     "expected some hundred; too dark, or linear photographs (--transfer linear)?",
                     r.pixels);
    if (!status)
        status = solve(&r, &believed, m->directions, residual, p.log);
    if (!status && believed && p.integrable)
        status = integrate(&r, p.curl ? p.curl : curl, p.log);
    for (int i = 0; !status && i < r.lights; i++) {
        intensity[i] = vec3_length(r.light[i]);
        direction[i] = vec3_unit(r.light[i]);
    }
    near_view_close(&r.near);
    mem_free(r.slot);
    mem_free(r.value);
    mem_free(r.point);
    mem_free(r.g);
    mem_free(r.known);
    mem_free(r.weight);
    mem_free(r.light);
    mem_free(r.bright);
    mem_free(r.scratch);
    mem_free(r.towards);
    return status;
}
