// normals.c - robust photometric stereo
//
// One band of rows at a time is relit under every captured direction, and each pixel is fitted as a
// matte surface (core/math/lambert.h). Where it is known from where the surface is seen its
// material is learned (capture/stereo/field.h), and the normals of a lattice of pixels are found
// with it, under some of the lights: 32 of 96 do as well as all. What that changes between two
// pixels of the lattice changes evenly: it depends on the material and on where the surface faces.
#include <relume/relight/normals.h>
#include <relume/relight/relight.h>

#include "capture/stereo/field.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/lambert.h"
#include "core/math/luminance.h"
#include "core/math/sort.h"

#include <string.h>

static const size_t band_bytes = (size_t)64 << 20;  // of relit samples
enum { MOST_LIGHTS = 32 };                          // that a material is found by
static const double most_solved = 16384.0;          // pixels of the lattice: some 2 s of one core

struct fit {
    const struct relume_codes *codes;
    struct relume_normals_params params;
    int lights;
    const vec3 *direction;
    int row, rows;   // of the band
    float *samples;  // [lights][rows][width][3]
    size_t stride;   // of a light in `samples`
    struct relume_normals *out;
    struct lambert_sample *scratch;  // [workers][lights]
    bool is_matte;
    struct stereo_field field;
    int used;  // of its lights
    int light[MOST_LIGHTS];
    size_t step, columns, lines;  // the lattice
    struct relume_image change;   // of its normals; the fourth channel: 1 where there is one
};

static const float *sample_of(const struct fit *f, int light, size_t pixel)
{
    return f->samples + (size_t)light * f->stride + 3 * pixel;
}

// What the pixel reflects in each colour, given its normal and the weights of its samples.
static void find_albedo(float albedo[3], const struct fit *f, vec3 normal, size_t pixel,
                        const struct lambert_sample *s, int n)
{
    double sum[3] = {0}, norm = 0;
    for (int i = 0; i < n; i++) {
        const float *rgb = sample_of(f, s[i].light, pixel);
        const double cosine = vec3_dot(normal, f->direction[s[i].light]);
        if (cosine <= LAMBERT_GRAZING)
            continue;
        const double w = (double)s[i].weight * cosine;
        norm += w * cosine;
        for (int c = 0; c < 3; c++)
            sum[c] += w * (double)rgb[c];
    }
    for (int c = 0; c < 3; c++)
        albedo[c] = norm > 0 ? (float)fmax(sum[c] / norm, 0.0) : 0.0f;
}

static void fit_pixel(const struct fit *f, struct lambert_sample *s, size_t pixel, float normal[3],
                      float albedo[3])
{
    int n = f->lights;
    vec3 g;
    for (int i = 0; i < n; i++) {
        const float *rgb = sample_of(f, i, pixel);
        s[i] = (struct lambert_sample){luminance_709f(rgb), 1.0f, i};
    }
    s = lambert_fit(&g, f->direction, s, &n, f->params.plain);
    if (!s)
        return;
    g = vec3_unit(g);
    normal[0] = (float)g.x;
    normal[1] = (float)g.y;
    normal[2] = (float)g.z;
    find_albedo(albedo, f, g, pixel, s, n);
}

// ---------------------------------------------------------------- more than matte

static void set_values(const struct fit *f, size_t pixel, float *value)
{
    for (int i = 0; i < f->used; i++)
        value[i] = fmaxf(luminance_709f(sample_of(f, f->light[i], pixel)), 0.0f);
}

static bool normal_at(vec3 *out, const struct fit *f, size_t at)
{
    const float *const n = f->out->normal.data + 3 * at;
    *out = vec3_of((double)n[0], (double)n[1], (double)n[2]);
    return vec3_length(*out) > 0.0;
}

static relume_status show_band(struct fit *f)
{
    const size_t pixels = (size_t)f->rows * (size_t)f->codes->width;
    const size_t before = (size_t)f->row * (size_t)f->codes->width;
    vec3 normal;
    for (size_t i = 0; i < pixels; i++)
        if (stereo_field_next(&f->field) && normal_at(&normal, f, before + i))
            set_values(f, i, stereo_field_add(&f->field, normal, NULL, f->params.eye));
    return RELUME_OK;
}

// The lines of the lattice that lie in the band.
static size_t first_line(const struct fit *f)
{
    return ((size_t)f->row + f->step - 1) / f->step;
}

static void solve_line(void *context, size_t item, int worker)
{
    struct fit *const f = context;
    const size_t line = first_line(f) + item, y = line * f->step, w = (size_t)f->codes->width;
    for (size_t i = 0; i < f->columns; i++) {
        const size_t x = i * f->step;
        float *const to = f->change.data + 4 * (line * f->columns + i);
        vec3 matte, normal;
        if (!normal_at(&matte, f, y * w + x))
            continue;
        normal = matte;
        set_values(f, (y - (size_t)f->row) * w + x, stereo_field_values(&f->field, worker));
        stereo_field_solve(&f->field, worker, NULL, f->params.eye, &normal);
        to[0] = (float)(normal.x - matte.x);
        to[1] = (float)(normal.y - matte.y);
        to[2] = (float)(normal.z - matte.z);
        to[3] = 1.0f;
    }
}

static float median(float *value, int n)
{
    sort_floats(value, (size_t)n);
    return value[n / 2];
}

// The changes of the pixels of the lattice around one.
static int changes_around(float around[3][8], const struct fit *f, size_t i, size_t j)
{
    int n = 0;
    for (size_t k = 0; k < 9; k++) {
        const size_t column = i + k % 3 - 1, line = j + k / 3 - 1;  // before the first: the largest
        if (k == 4 || column >= f->columns || line >= f->lines)
            continue;
        const float *const from = f->change.data + 4 * (line * f->columns + column);
        for (int c = 0; c < 3 && from[3] > 0.0f; c++)
            around[c][n] = from[c];
        n += from[3] > 0.0f;
    }
    return n;
}

// A change that differs from all around it was found wrongly: bent by a shadow or by noise it would
// be a dent as wide as two steps of the lattice. The median of those around it stands in its place.
// Some stand side by side: those that are mended count for the next ones.
static void mend_changes(struct fit *f)
{
    enum { LEAST = 4, ROUNDS = 3 };  // that say what is usual
    static const double most = 2;    // times what those around differ by
    static const double always = 0.04;
    const size_t pixels = f->columns * f->lines;
    for (size_t i = 0; i < ROUNDS * pixels; i++) {
        const size_t at = i % pixels;
        float around[3][8], usual[3];
        float *const own = f->change.data + 4 * at;
        const int n = changes_around(around, f, at % f->columns, at / f->columns);
        if (own[3] == 0.0f || n < LEAST)
            continue;
        double off = 0.0, spread = 0.0;
        for (int c = 0; c < 3; c++) {
            usual[c] = median(around[c], n);
            for (int k = 0; k < n; k++)
                around[c][k] = fabsf(around[c][k] - usual[c]);
            off = fmax(off, (double)fabsf(own[c] - usual[c]));
            spread = fmax(spread, (double)median(around[c], n));
        }
        if (off > fmax(most * spread, always))
            memcpy(own, usual, sizeof usual);
    }
}

static relume_status solve_band(struct fit *f)
{
    const size_t end = ((size_t)(f->row + f->rows) + f->step - 1) / f->step;
    thread_for(f->params.threads, end - first_line(f), solve_line, f);
    return log_progress(f->params.log, "material", (f->row + f->rows) / (double)f->codes->height)
               ? RELUME_OK
               : RELUME_ECANCEL;
}

// Bilinear between those of the lattice's pixels that have one.
static vec3 change_at(const struct fit *f, size_t x, size_t y)
{
    const size_t i = x / f->step, j = y / f->step;
    const float u = (float)(x % f->step) / (float)f->step;
    const float v = (float)(y % f->step) / (float)f->step;
    float sum[4] = {0.0f};
    for (size_t k = 0; k < 4; k++) {
        const size_t column = i + (k & 1), line = j + (k >> 1);
        if (column >= f->columns || line >= f->lines)
            continue;
        const float *const from = f->change.data + 4 * (line * f->columns + column);
        const float weight = (k & 1 ? u : 1.0f - u) * (k >> 1 ? v : 1.0f - v) * from[3];
        for (int c = 0; c < 3; c++)
            sum[c] += weight * from[c];
        sum[3] += weight;
    }
    const double share = sum[3] > 0.0f ? 1.0 / (double)sum[3] : 0.0;
    return vec3_scale(vec3_of((double)sum[0], (double)sum[1], (double)sum[2]), share);
}

static void change_row(void *context, size_t y, int worker)
{
    (void)worker;
    const struct fit *const f = context;
    const size_t w = (size_t)f->codes->width;
    for (size_t x = 0; x < w; x++) {
        vec3 normal;
        if (!normal_at(&normal, f, y * w + x))
            continue;
        normal = vec3_unit(vec3_add(normal, change_at(f, x, y)));
        float *const to = f->out->normal.data + 3 * (y * w + x);
        to[0] = (float)normal.x;
        to[1] = (float)normal.y;
        to[2] = (float)normal.z;
    }
}

// Lights are spread over their order in the capture, which mostly follows the dome.
static relume_status create_field(struct fit *f)
{
    vec3 direction[MOST_LIGHTS];
    const size_t w = (size_t)f->codes->width, h = (size_t)f->codes->height;
    f->used = f->lights < MOST_LIGHTS ? f->lights : MOST_LIGHTS;
    for (int i = 0; i < f->used; i++) {
        f->light[i] = (int)((i + 0.5) * f->lights / f->used);
        direction[i] = f->direction[f->light[i]];
    }
    f->step = (size_t)ceil(sqrt((double)w * (double)h / most_solved));
    f->columns = (w + f->step - 1) / f->step;
    f->lines = (h + f->step - 1) / f->step;
    const relume_status status = relume_image_create(&f->change, (int)f->columns, (int)f->lines, 4);
    return status ? status
                  : stereo_field_create(&f->field, f->used, f->params.threads, direction,
                                        f->params.eye, 1);
}

// ---------------------------------------------------------------- bands

static void fit_row(void *context, size_t item, int worker)
{
    struct fit *f = context;
    const size_t width = (size_t)f->codes->width;
    struct lambert_sample *scratch = f->scratch + (size_t)worker * (size_t)f->lights;
    for (size_t x = 0; x < width; x++) {
        const size_t at = 3 * (((size_t)f->row + item) * width + x);
        fit_pixel(f, scratch, item * width + x, f->out->normal.data + at, f->out->albedo.data + at);
    }
}

// The rows of a band as codes of their own; `planes` and `indices` hold their pointers.
static struct relume_codes cut_band(const struct fit *f, const void **planes,
                                    const uint16_t **indices)
{
    struct relume_codes band = *f->codes;
    const size_t before = (size_t)f->row * (size_t)band.width;
    const size_t bytes = relume_storage_bytes(band.storage);
    for (int i = 0; !band.books && i < band.planes; i++)
        planes[i] = (const char *)band.plane[i] + before * bytes;
    for (int b = 0; b < band.books; b++)
        indices[b] = band.index[b] + before;
    band.height = f->rows;
    band.plane = planes;
    band.index = indices;
    return band;
}

static relume_status relight_band(const struct fit *f, const struct relume_codes *band)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < f->lights; i++) {
        const struct relume_light light = {.direction = f->direction[i], .rgb = {1, 1, 1}};
        struct relume_image into = {band->width, band->height, 3,
                                    .data = f->samples + (size_t)i * f->stride};
        status = relume_relight(
            &into, band, &light, 1,
            relume_relight_params(.threads = f->params.threads, .cpu_off = f->params.cpu_off));
    }
    return status;
}

static relume_status for_bands(struct fit *f, relume_status (*use)(struct fit *))
{
    const int height = f->codes->height, rows = f->rows;
    const void **planes = mem_array((size_t)f->codes->planes, sizeof *planes);
    const uint16_t **indices = mem_array((size_t)f->codes->books, sizeof *indices);
    relume_status status = planes && indices ? RELUME_OK : RELUME_ENOMEM;
    for (f->row = 0; !status && f->row < height; f->row += rows) {
        f->rows = height - f->row < rows ? height - f->row : rows;
        const struct relume_codes band = cut_band(f, planes, indices);
        status = relight_band(f, &band);
        if (!status)
            status = use(f);
    }
    f->row = 0;
    f->rows = rows;
    mem_free(planes);
    mem_free(indices);
    return status;
}

static relume_status fit_band(struct fit *f)
{
    thread_for(f->params.threads, (size_t)f->rows, fit_row, f);
    if (!log_progress(f->params.log, "normals", (f->row + f->rows) / (double)f->codes->height))
        return RELUME_ECANCEL;
    return f->is_matte ? RELUME_OK : show_band(f);
}

static relume_status fit_bands(struct fit *f)
{
    relume_status status = f->is_matte ? RELUME_OK : create_field(f);
    if (!status)
        status = for_bands(f, fit_band);
    if (status || f->is_matte)
        return status;
    status = stereo_field_learn(&f->field);
    if (status || f->field.is_matte)
        return status;
    // of one band alone the samples are still there
    status = f->rows == f->codes->height ? solve_band(f) : for_bands(f, solve_band);
    if (status)
        return status;
    mend_changes(f);
    thread_for(f->params.threads, (size_t)f->codes->height, change_row, f);
    return RELUME_OK;
}

void relume_normals_destroy(struct relume_normals *normals)
{
    relume_image_destroy(&normals->normal);
    relume_image_destroy(&normals->albedo);
}

relume_status relume_normals_fit(struct relume_normals *out, const struct relume_codes *codes,
                                 const struct relume_normals_params *params)
{
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    struct fit f = {
        .codes = codes,
        .params = PARAMS_WORK(relume_normals_params, params),
        .lights = info->lights,
        .direction = info->directions,
        .out = out,
    };
    *out = (struct relume_normals){0};
    if (f.lights < 3 || !lambert_spans(f.direction, f.lights))
        return log_fail(f.params.log, RELUME_EUNFIT,
                        "normals cannot be computed; expected three lights or more that do not lie "
                        "in one plane; found %d",
                        f.lights);
    f.params.threads = thread_count(f.params.threads);
    f.is_matte =
        f.params.plain || f.lights < STEREO_LEAST_LIGHTS || vec3_length(f.params.eye) == 0.0;
    if (!f.is_matte)
        f.params.eye = vec3_unit(f.params.eye);
    const size_t row_bytes = (size_t)codes->width * (size_t)f.lights * 3 * sizeof(float);
    const size_t fitting = band_bytes / row_bytes;
    f.rows = fitting < 1 ? 1 : fitting < (size_t)codes->height ? (int)fitting : codes->height;
    f.stride = 3 * (size_t)codes->width * (size_t)f.rows;
    f.samples = mem_array((size_t)f.lights * f.stride, sizeof *f.samples);
    f.scratch = mem_array((size_t)f.params.threads * (size_t)f.lights, sizeof *f.scratch);
    relume_status status = f.samples && f.scratch ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = relume_image_create(&out->normal, codes->width, codes->height, 3);
    if (!status)
        status = relume_image_create(&out->albedo, codes->width, codes->height, 3);
    if (!status)
        status = fit_bands(&f);
    stereo_field_destroy(&f.field);
    relume_image_destroy(&f.change);
    mem_free(f.samples);
    mem_free(f.scratch);
    if (status)
        relume_normals_destroy(out);
    return status;
}
