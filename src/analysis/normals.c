// normals.c - robust photometric stereo
//
// One band of rows at a time is relit under every captured direction, and each pixel is fitted
// (math/lambert.h).
#include <relume/normals.h>
#include <relume/relight.h>

#include "base/log.h"
#include "base/memory.h"
#include "base/params.h"
#include "base/thread.h"
#include "math/lambert.h"
#include "math/luminance.h"

#include <string.h>

static const size_t band_bytes = (size_t)64 << 20;  // of relit samples

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

// The rows of a band as codes of their own; `planes` and `indices` are room for their pointers.
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

static relume_status fit_bands(struct fit *f)
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
            thread_for(f->params.threads, (size_t)f->rows, fit_row, f);
        if (!status && !log_progress(f->params.log, "normals", (f->row + f->rows) / (double)height))
            status = RELUME_ECANCEL;
    }
    mem_free(planes);
    mem_free(indices);
    return status;
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
    mem_free(f.samples);
    mem_free(f.scratch);
    if (status)
        relume_normals_destroy(out);
    return status;
}
