// enhance.c - passes over a relit view; shaders: viewer/shaders/enhance.frag.glsl
//
// Malzbender, Gelb, Wolters, "Polynomial Texture Maps", 2001. Diffuse gain multiplies the second
// derivatives of the reflectance by g and keeps where its maximum is and how large: there the
// gradient is zero, so that f'(L) = f(N) + g (f(L) - f(N)) for their polynomials, and f(N) is the
// albedo. Written so, it holds for every basis. Kept at the maximum alone it leaves little of a
// coin or a raking light but black: what is kept is chosen from the picture (enhance_range.c).
#include <relume/relight/enhance.h>

#include "core/base/memory.h"
#include "core/base/names.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/luminance.h"
#include "core/math/vec.h"
#include "relight/normals/enhance.h"

#include <string.h>

struct enhance {
    struct relume_image *image;
    enum relume_pass pass;
    const struct relume_normals *normals;
    struct relume_image detail;
    const struct relume_light *lights;
    int n;
    struct relume_pass_params params;
    struct relume_pass_range range;
};

static const char *const names[RELUME_PASSES] = {
    "colour",  "normals",   "specular",     "diffuse-gain",
    "unsharp", "luminance", "false-colour", "difference",
};

const char *relume_pass_name(enum relume_pass pass)
{
    return (unsigned)pass < RELUME_PASSES ? names[pass] : NULL;
}

relume_status relume_pass_parse(enum relume_pass *out, const char *name)
{
    const int i = name_find(name, names, RELUME_PASSES);
    *out = (enum relume_pass)(i < 0 ? 0 : i);
    return i < 0 ? RELUME_EINVAL : RELUME_OK;
}

bool relume_pass_needs_normals(enum relume_pass pass)
{
    return pass >= RELUME_PASS_NORMALS && pass <= RELUME_PASS_UNSHARP;
}

bool relume_pass_needs_range(enum relume_pass pass)
{
    return pass == RELUME_PASS_SPECULAR || pass == RELUME_PASS_DIFFUSE_GAIN ||
           pass == RELUME_PASS_FALSE_COLOUR;
}

// ---------------------------------------------------------------- pixels

static vec3 vector_at(const struct relume_image *image, size_t at)
{
    const float *v = image->data + at;
    return vec3_of((double)v[0], (double)v[1], (double)v[2]);
}

static bool shines(const struct relume_light *light)
{
    return light->kind == RELUME_LIGHT_DIRECTIONAL;
}

static void show_normals(const struct enhance *e, size_t at, float rgb[3])
{
    memcpy(rgb, e->normals->normal.data + at, 3 * sizeof *rgb);
}

// Blinn's highlight of each light's own colour, on top of the picture.
static void show_specular(const struct enhance *e, size_t at, float rgb[3])
{
    const vec3 normal = vector_at(&e->normals->normal, at);
    const vec3 towards =
        e->params.towards ? vector_at(e->params.towards, at) : vec3_of(0.0, 0.0, 1.0);
    for (int i = 0; i < e->n; i++) {
        if (!shines(&e->lights[i]))
            continue;
        const vec3 half = vec3_add(vec3_unit(e->lights[i].direction), towards);
        const double length = vec3_length(half);
        if (!(length > 1e-6))
            continue;
        const double cosine = vec3_dot(normal, half) / length;
        const double lobe = cosine > 0.0 ? (double)(e->range.scale * e->params.specular) *
                                               pow(cosine, (double)e->params.exponent)
                                         : 0.0;
        for (int c = 0; c < 3; c++)
            rgb[c] += (float)lobe * e->lights[i].rgb[c];
    }
}

static void show_diffuse_gain(const struct enhance *e, size_t at, float rgb[3])
{
    const float g = e->params.gain;
    for (int c = 0; c < 3; c++) {
        float light = 0.0f;
        for (int i = 0; i < e->n; i++)
            light += shines(&e->lights[i]) ? e->lights[i].rgb[c] : 0.0f;
        const float most = e->range.pivot * light * e->normals->albedo.data[at + (size_t)c];
        rgb[c] = fmaxf(e->range.scale * (most + g * (rgb[c] - most)), 0.0f);
    }
}

// The shading that the detail of the normals adds, times the gain.
static void show_unsharp(const struct enhance *e, size_t at, float rgb[3])
{
    const vec3 detail = vector_at(&e->detail, at);
    float change[3] = {0};
    for (int i = 0; i < e->n; i++) {
        if (!shines(&e->lights[i]))
            continue;
        const float more =
            e->params.gain * (float)vec3_dot(detail, vec3_unit(e->lights[i].direction));
        for (int c = 0; c < 3; c++)
            change[c] += more * e->lights[i].rgb[c];
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = fmaxf(rgb[c] + e->normals->albedo.data[at + (size_t)c] * change[c], 0.0f);
}

static void show_luminance(const struct enhance *e, size_t at, float rgb[3])
{
    (void)e, (void)at;
    rgb[0] = rgb[1] = rgb[2] = (float)luminance_709(rgb);
}

// Dark blue, violet, red, orange, yellow: lightness rises all the way. Black where nothing is:
// what a mask leaves out has codes of 0, whose sum may round to 2e-7.
static void show_false_colour(const struct enhance *e, size_t at, float rgb[3])
{
    static const float steps[5][3] = {
        {0.00f, 0.00f, 0.10f}, {0.15f, 0.00f, 0.35f}, {0.65f, 0.02f, 0.10f},
        {0.95f, 0.30f, 0.00f}, {1.00f, 0.95f, 0.30f},
    };
    (void)at;
    const double low = (double)e->range.low, high = (double)e->range.high;
    const double y = luminance_709(rgb), place = 4.0 * (y - low) / (high - low);
    const float shown = y > 1e-6 ? 1.0f : 0.0f;
    const double x = fmin(fmax(place, 0.0), 4.0);
    const int step = x < 3.0 ? (int)x : 3;
    const float part = (float)(x - step);
    for (int c = 0; c < 3; c++)
        rgb[c] = shown * (steps[step][c] + part * (steps[step + 1][c] - steps[step][c]));
}

static void show_difference(const struct enhance *e, size_t at, float rgb[3])
{
    const float *reference = e->params.reference->data + at;
    for (int c = 0; c < 3; c++)
        rgb[c] = fabsf(rgb[c] - reference[c]);
}

static void (*const shows[RELUME_PASSES])(const struct enhance *, size_t, float[3]) = {
    [RELUME_PASS_NORMALS] = show_normals,           [RELUME_PASS_SPECULAR] = show_specular,
    [RELUME_PASS_DIFFUSE_GAIN] = show_diffuse_gain, [RELUME_PASS_UNSHARP] = show_unsharp,
    [RELUME_PASS_LUMINANCE] = show_luminance,       [RELUME_PASS_FALSE_COLOUR] = show_false_colour,
    [RELUME_PASS_DIFFERENCE] = show_difference,
};

static void show_row(void *context, size_t item, int worker)
{
    const struct enhance *e = context;
    const size_t width = (size_t)e->image->width;
    (void)worker;
    for (size_t x = 0; x < width; x++) {
        const size_t at = 3 * (item * width + x);
        shows[e->pass](e, at, e->image->data + at);
    }
}

// ---------------------------------------------------------------- detail

struct blur {
    const struct relume_image *from;
    struct relume_image *to;
    int radius;
    bool down;  // along columns, not rows
};

// The mean along one line of pixels, its ends repeated, by a running sum.
static void blur_line(void *context, size_t item, int worker)
{
    const struct blur *b = context;
    const int n = b->down ? b->from->height : b->from->width;
    const size_t step = 3 * (b->down ? (size_t)b->from->width : 1);
    const size_t start = 3 * (b->down ? item : item * (size_t)b->from->width);
    (void)worker;
    for (size_t c = 0; c < 3; c++) {
        const float *from = b->from->data + start + c;
        float *to = b->to->data + start + c;
        double sum = 0.0;
        for (int i = -b->radius; i <= b->radius; i++)
            sum += (double)from[step * (size_t)(i < 0 ? 0 : i < n ? i : n - 1)];
        for (int i = 0; i < n; i++) {
            const int enters = i + b->radius + 1 < n ? i + b->radius + 1 : n - 1;
            const int leaves = i - b->radius > 0 ? i - b->radius : 0;
            to[step * (size_t)i] = (float)(sum / (2 * b->radius + 1));
            sum += (double)from[step * (size_t)enters] - (double)from[step * (size_t)leaves];
        }
    }
}

relume_status relume_normals_detail(struct relume_image *out, const struct relume_image *normal,
                                    int radius, int threads)
{
    struct relume_image across = {0};
    *out = (struct relume_image){0};
    relume_status status = relume_image_create(&across, normal->width, normal->height, 3);
    if (!status)
        status = relume_image_create(out, normal->width, normal->height, 3);
    if (!status) {
        struct blur rows = {normal, &across, radius, false};
        struct blur columns = {&across, out, radius, true};
        thread_for(threads, (size_t)normal->height, blur_line, &rows);
        thread_for(threads, (size_t)normal->width, blur_line, &columns);
        const size_t samples = 3 * (size_t)normal->width * (size_t)normal->height;
        for (size_t i = 0; i < samples; i++)
            out->data[i] = normal->data[i] - out->data[i];
    }
    relume_image_destroy(&across);
    return status;
}

// ---------------------------------------------------------------- interface

static bool fits(const struct relume_image *image, const struct relume_image *other)
{
    return other && other->data && other->channels == 3 && other->width == image->width &&
           other->height == image->height;
}

static relume_status find_range(struct enhance *e)
{
    const struct relume_pass_params *p = &e->params;
    relume_status status = RELUME_OK;
    e->range = (struct relume_pass_range){.high = 1.0f, .pivot = 1.0f, .scale = 1.0f};
    if (p->range)
        e->range = *p->range;
    else if (!p->fixed && relume_pass_needs_range(e->pass))
        status =
            relume_pass_measure(&e->range, e->image, e->pass,
                                e->normals ? &e->normals->albedo : NULL, e->lights, e->n, p->gain);
    if (p->top > p->low) {
        e->range.low = p->low;
        e->range.high = p->top;
    }
    return status;
}

relume_status relume_pass_apply(struct relume_image *image, enum relume_pass pass,
                                const struct relume_normals *normals,
                                const struct relume_light *lights, int n,
                                const struct relume_pass_params *params)
{
    struct enhance e = {
        .image = image,
        .pass = pass,
        .normals = normals,
        .lights = lights,
        .n = n,
        .params = PARAMS(relume_pass_params, params),
    };
    e.params.gain = e.params.gain != 0.0f ? e.params.gain : RELUME_PASS_GAIN;
    e.params.specular = e.params.specular != 0.0f ? e.params.specular : 0.6f;
    e.params.exponent = e.params.exponent > 0.0f ? e.params.exponent : 40.0f;
    e.params.radius = e.params.radius > 0 ? e.params.radius : 4;
    e.params.threads = thread_count(e.params.threads);
    if ((unsigned)pass >= RELUME_PASSES || image->channels != 3 ||
        (relume_pass_needs_normals(pass) &&
         (!normals || !fits(image, &normals->normal) || !fits(image, &normals->albedo))) ||
        (pass == RELUME_PASS_DIFFERENCE && !fits(image, e.params.reference)) ||
        (e.params.towards && !fits(image, e.params.towards)))
        return RELUME_EINVAL;
    if (!shows[pass])
        return RELUME_OK;
    relume_status status = find_range(&e);
    if (!status && pass == RELUME_PASS_UNSHARP)
        status =
            relume_normals_detail(&e.detail, &normals->normal, e.params.radius, e.params.threads);
    if (!status)
        thread_for(e.params.threads, (size_t)image->height, show_row, &e);
    relume_image_destroy(&e.detail);
    return status;
}
