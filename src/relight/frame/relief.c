// relief.c - the captured lights that show relief
//
// Every s-th pixel of one view is relit under each captured light. Their number suffices for shares
// to one percent, however large the view is.
#include <relume/relight/relief.h>
#include <relume/relight/relight.h>

#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/scalar.h"
#include "core/math/sort.h"
#include "core/math/vec.h"
#include "format/pack/views.h"

#include <string.h>

enum { MOST_SAMPLES = 1 << 14, LEAST_SAMPLES = 1 << 11, LEVEL_PIXELS = 1 << 18 };
static const double most_products = 1e9;   // of numbers and weights, at all samples
static const double white_part = 0.99;     // as relume_tone_meter_bright
static const double nearly = 0.9;          // of what the best light shows
static const double overhead = 0.1;        // of the side's length, in the plane
static const double facing = 0.5;          // the cosine of 60 degrees
static const double as_low = M_PI / 90.0;  // radians
static const double tie = 1e-6;            // of cosines, as scene.json rounds directions

struct survey {
    const struct relume_coder_info *coder;
    int threads;
    struct relume_codes_part part;  // the samples, as one row
    size_t n;
    float *brightest;           // [n]: under any light
    bool *is_object;            // [n]
    float *value;               // [n]: under one light
    struct relume_image relit;  // likewise
    double *share;              // [lights]: bright share of the object
    double *top;                // [lights]: 99th percentile of the object
};

static void close_survey(struct survey *s)
{
    relume_codes_part_destroy(&s->part);
    relume_image_destroy(&s->relit);
    mem_free(s->brightest);
    mem_free(s->is_object);
    mem_free(s->value);
    mem_free(s->share);
    mem_free(s->top);
}

// ---------------------------------------------------------------- samples

static size_t common_divisor(size_t a, size_t b)
{
    while (b) {
        const size_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

// Samples run through all columns.
static size_t find_step(int width, int height, const struct relume_coder_info *coder)
{
    const size_t pixels = (size_t)width * (size_t)height;
    const double each = (double)coder->lights * coder->planes;
    const size_t most = (size_t)fmax(fmin(most_products / each, MOST_SAMPLES), LEAST_SAMPLES);
    size_t step = pixels / most;
    step += step == 0;
    while (step > 1 && common_divisor(step, (size_t)width) > 1)
        step++;
    return step;
}

// The coarsest level that is fine enough; the first level of coded planes is made of the view.
static int find_level(const relume_pack *pack)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    int level = info->levels, width, height;
    for (; level > 0; level--) {
        relume_pack_level_size(&width, &height, pack, level);
        if ((size_t)width * (size_t)height >= LEVEL_PIXELS)
            break;
    }
    return level == 1 && !strcmp(info->compression, "av1") ? 0 : level;
}

static relume_status take_samples(struct survey *s, relume_pack *pack, int view, int level,
                                  size_t *step)
{
    struct relume_codes_part reduced = {.memory = NULL};
    const struct relume_codes *codes = &reduced.codes;
    int width, height;
    relume_pack_level_size(&width, &height, pack, level);
    relume_status status = level
                               ? relume_pack_codes_level(&reduced, pack, view, level,
                                                         &(struct relume_rect){0, 0, width, height})
                               : relume_pack_codes(&codes, pack, view);
    *step = find_step(width, height, s->coder);
    s->n = (size_t)width * (size_t)height / *step;
    if (!status)
        status = relume_codes_pick(&s->part, codes, 0, *step, s->n);
    relume_codes_part_destroy(&reduced);
    return status;
}

// Samples lie in the middle of pixels of the level.
static relume_status take_mask(bool *masked, struct survey *s, relume_pack *pack, int view,
                               int level, size_t step)
{
    struct relume_image mask = {0};
    int width, height;
    relume_pack_level_size(&width, &height, pack, level);
    const relume_status status =
        relume_pack_info(pack)->has_mask ? relume_pack_mask(&mask, pack, view) : RELUME_OK;
    *masked = mask.data != NULL;
    for (size_t i = 0; *masked && i < s->n; i++) {
        const int half = level ? 1 << (level - 1) : 0;
        const int x = (int)(i * step % (size_t)width) << level;
        const int y = (int)(i * step / (size_t)width) << level;
        const size_t column = (size_t)smaller_of(x + half, mask.width - 1);
        const size_t row = (size_t)smaller_of(y + half, mask.height - 1);
        s->is_object[i] = mask.data[row * (size_t)mask.width + column] > 0.5f;
    }
    relume_image_destroy(&mask);
    return status;
}

static relume_status open_survey(struct survey *s, relume_pack *pack)
{
    const int view = relume_pack_info(pack)->views / 2, level = find_level(pack);
    size_t step;
    bool masked = false;
    relume_status status = take_samples(s, pack, view, level, &step);
    if (status)
        return status;
    s->brightest = mem_zeroed(s->n, sizeof *s->brightest);
    s->is_object = mem_zeroed(s->n, sizeof *s->is_object);
    s->value = mem_array(s->n, sizeof *s->value);
    s->share = mem_zeroed((size_t)s->coder->lights, sizeof *s->share);
    s->top = mem_zeroed((size_t)s->coder->lights, sizeof *s->top);
    if (!s->brightest || !s->is_object || !s->value || !s->share || !s->top)
        return RELUME_ENOMEM;
    status = take_mask(&masked, s, pack, view, level, step);
    for (size_t i = 0; !masked && i < s->n; i++)
        s->is_object[i] = true;
    return status;
}

// ---------------------------------------------------------------- lights

static relume_status relight_samples(struct survey *s, int light)
{
    const struct relume_light lamp = {.direction = s->coder->directions[light], .rgb = {1, 1, 1}};
    return relume_relight(&s->relit, &s->part.codes, &lamp, 1,
                          relume_relight_params(.threads = s->threads));
}

static float largest_channel(const float *rgb)
{
    return fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
}

// The 99th percentile of `n` values, which are sorted.
static float bright_value(float *value, size_t n)
{
    sort_floats(value, n);
    return value[(size_t)(white_part * (double)(n - 1) + 0.5)];
}

// Pixels that no light shows are no object.
static void drop_dark(struct survey *s)
{
    size_t n = 0;
    for (size_t i = 0; i < s->n; i++)
        if (s->is_object[i])
            s->value[n++] = s->brightest[i];
    if (n == 0)
        return;
    const float least = (float)RELUME_RELIEF_LEVEL * bright_value(s->value, n);
    for (size_t i = 0; i < s->n; i++)
        s->is_object[i] &= s->brightest[i] > least;
}

static void judge_light(struct survey *s, int light)
{
    size_t n = 0, bright = 0;
    for (size_t i = 0; i < s->n; i++)
        if (s->is_object[i])
            s->value[n++] = largest_channel(s->relit.data + 3 * i);
    if (n == 0)
        return;
    const float top = bright_value(s->value, n);
    for (size_t i = 0; i < n; i++)
        bright += s->value[i] > 0.0f && s->value[i] > (float)RELUME_RELIEF_LEVEL * top;
    s->share[light] = (double)bright / (double)n;
    s->top[light] = (double)fmaxf(top, 0.0f);
}

static relume_status find_shares(struct survey *s)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < s->coder->lights; i++) {
        status = relight_samples(s, i);
        for (size_t k = 0; !status && k < s->n; k++)
            s->brightest[k] = fmaxf(s->brightest[k], largest_channel(s->relit.data + 3 * k));
    }
    drop_dark(s);
    for (int i = 0; !status && i < s->coder->lights; i++) {
        status = relight_samples(s, i);
        if (!status && s->coder->directions[i].z > 0.0)
            judge_light(s, i);
    }
    return status;
}

static relume_status find_median(double *median, const struct survey *s)
{
    const size_t lights = (size_t)s->coder->lights;
    double *sorted = mem_copy(s->top, lights, sizeof *sorted);
    if (!sorted)
        return RELUME_ENOMEM;
    sort_doubles(sorted, lights);
    *median = sorted[lights / 2];
    mem_free(sorted);
    return RELUME_OK;
}

static relume_status keep_lights(struct relume_relief *out, const struct survey *s)
{
    const size_t lights = (size_t)s->coder->lights;
    double median, best = 0.0;
    const relume_status status = find_median(&median, s);
    out->light = mem_array(lights, sizeof *out->light);
    out->direction = mem_array(lights, sizeof *out->direction);
    if (status || !out->light || !out->direction)
        return RELUME_ENOMEM;
    const double dim = RELUME_RELIEF_DIM * median;
    for (size_t i = 0; i < lights; i++)
        if (s->top[i] >= dim)
            best = fmax(best, s->share[i]);
    const double least = fmin(RELUME_RELIEF_SHARE, nearly * best);
    for (size_t i = 0; i < lights; i++)
        if (s->share[i] > 0.0 && s->share[i] >= least && s->top[i] >= dim) {
            out->light[out->count] = (int)i;
            out->direction[out->count++] = s->coder->directions[i];
        }
    return RELUME_OK;
}

void relume_relief_destroy(struct relume_relief *relief)
{
    mem_free(relief->light);
    mem_free(relief->direction);
    *relief = (struct relume_relief){0};
}

relume_status relume_relief_find(struct relume_relief *out, relume_pack *pack,
                                 const struct relume_relief_params *params)
{
    const struct relume_relief_params p = PARAMS_WORK(relume_relief_params, params);
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct survey s = {.coder = relume_coder_info(info->coder), .threads = p.threads};
    *out = (struct relume_relief){0};
    if (info->geometry.projection > RELUME_SLAB || info->slabs || !s.coder->hemispherical)
        return RELUME_OK;
    relume_status status = open_survey(&s, pack);
    if (!status)
        status = find_shares(&s);
    if (!status)
        status = keep_lights(out, &s);
    close_survey(&s);
    if (status)
        relume_relief_destroy(out);
    return status;
}

// ---------------------------------------------------------------- a side

// The cosine of the angle between the azimuths of a light and of a unit vector of the plane.
static double azimuth_cosine(vec3 direction, vec3 side)
{
    const double wide = hypot(direction.x, direction.y);
    return (direction.x * side.x + direction.y * side.y) / fmax(wide, 1e-12);
}

static double height_of(vec3 direction)
{
    return atan2(direction.z, hypot(direction.x, direction.y));
}

int relume_relief_lowest(const struct relume_relief *relief, struct relume_vec3 side, int except)
{
    const double wide = hypot(side.x, side.y);
    const vec3 towards = wide > overhead * vec3_length(side)
                             ? vec3_of(side.x / wide, side.y / wide, 0.0)
                             : vec3_of(-M_SQRT1_2, M_SQRT1_2, 0.0);
    double nearest = -1.0, lowest = M_PI, most = -2.0;
    int found = -1;
    for (int i = 0; i < relief->count; i++)
        if (i != except)
            nearest = fmax(nearest, azimuth_cosine(relief->direction[i], towards));
    const double least = fmin(facing, nearest) - tie;
    for (int i = 0; i < relief->count; i++)
        if (i != except && azimuth_cosine(relief->direction[i], towards) >= least)
            lowest = fmin(lowest, height_of(relief->direction[i]));
    for (int i = 0; i < relief->count; i++) {
        const double cosine = azimuth_cosine(relief->direction[i], towards);
        if (i == except || cosine < least || height_of(relief->direction[i]) > lowest + as_low ||
            cosine <= most + tie)
            continue;
        most = cosine;
        found = i;
    }
    return found;
}
