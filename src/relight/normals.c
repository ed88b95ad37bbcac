// normals.c - robust photometric stereo
//
// The value of a Lambertian pixel under a light of 1 from L is g.L with g = albedo x normal, as
// long as the light is in front. One band of rows at a time is relit under every captured
// direction; a pixel's samples are sorted by brightness, the ends are cut off, and g is found by
// iteratively reweighted least squares with the weights 1 / (1 + (r / c)^2).
#include <relume/normals.h>
#include <relume/relight.h>

#include "base/log.h"
#include "base/memory.h"
#include "base/thread.h"
#include "math/vec.h"

#include <string.h>

static const size_t band_bytes = (size_t)64 << 20;  // of relit samples
static const double dark_part = 0.25;               // of the samples: shadows
static const double bright_part = 0.10;             // highlights
static const int rounds = 10;
static const double tuning = 2.385;  // Cauchy: 95 % as good as least squares for normal errors
static const double grazing = 0.05;  // cosines below are no evidence
static const double black = 1e-3;    // albedo below which there is nothing but noise to fit

struct fit {
    const struct relume_codes *codes;
    struct relume_normals_params params;
    int lights;
    const vec3 *direction;
    int row, rows;   // of the band
    float *samples;  // [lights][rows][width][3]
    size_t stride;   // of a light in `samples`
    struct relume_normals *out;
    struct sample *scratch;  // [workers][lights]
};

struct sample {
    float value;  // luminance
    float weight;
    int light;
};

// ---------------------------------------------------------------- one pixel

static int by_value(const void *a, const void *b)
{
    const struct sample *p = a, *q = b;
    if (p->value != q->value)
        return p->value < q->value ? -1 : 1;
    return p->light - q->light;
}

// Solve the symmetric system m x = b by cofactors; false when it is nearly singular.
static bool solve3(vec3 *x, const double m[6], vec3 b)
{
    const double c00 = m[3] * m[5] - m[4] * m[4];
    const double c01 = m[2] * m[4] - m[1] * m[5];
    const double c02 = m[1] * m[4] - m[2] * m[3];
    const double determinant = m[0] * c00 + m[1] * c01 + m[2] * c02;
    const double size = m[0] + m[3] + m[5];
    if (!(determinant > 1e-9 * size * size * size))
        return false;
    const double c11 = m[0] * m[5] - m[2] * m[2];
    const double c12 = m[1] * m[2] - m[0] * m[4];
    const double c22 = m[0] * m[3] - m[1] * m[1];
    *x = vec3_of((c00 * b.x + c01 * b.y + c02 * b.z) / determinant,
                 (c01 * b.x + c11 * b.y + c12 * b.z) / determinant,
                 (c02 * b.x + c12 * b.y + c22 * b.z) / determinant);
    return true;
}

static bool least_squares(vec3 *g, const struct fit *f, const struct sample *s, int n)
{
    double m[6] = {0};
    vec3 b = {0, 0, 0};
    for (int i = 0; i < n; i++) {
        const vec3 l = f->direction[s[i].light];
        const double w = (double)s[i].weight;
        m[0] += w * l.x * l.x;
        m[1] += w * l.x * l.y;
        m[2] += w * l.x * l.z;
        m[3] += w * l.y * l.y;
        m[4] += w * l.y * l.z;
        m[5] += w * l.z * l.z;
        b = vec3_add(b, vec3_scale(l, w * (double)s[i].value));
    }
    return solve3(g, m, b);
}

static int by_weight(const void *a, const void *b)
{
    const struct sample *p = a, *q = b;
    if (p->weight != q->weight)
        return p->weight < q->weight ? -1 : 1;
    return p->light - q->light;
}

// 1.4826 x the median absolute residual; weights hold the residuals meanwhile.
static double find_scale(const struct fit *f, vec3 g, struct sample *s, int n)
{
    for (int i = 0; i < n; i++)
        s[i].weight = (float)fabs((double)s[i].value - vec3_dot(g, f->direction[s[i].light]));
    qsort(s, (size_t)n, sizeof *s, by_weight);
    return 1.4826 * (double)s[n / 2].weight;
}

static void weigh(const struct fit *f, vec3 g, struct sample *s, int n)
{
    const double size = vec3_length(g);
    const double scale = tuning * fmax(find_scale(f, g, s, n), 1e-4 * size);
    for (int i = 0; i < n; i++) {
        const double r = (double)s[i].weight / scale;
        const bool lit = vec3_dot(g, f->direction[s[i].light]) > grazing * size;
        s[i].weight = lit ? (float)(1.0 / (1.0 + r * r)) : 0.0f;
    }
}

// Cuts the ends off the `*n` samples.
static struct sample *trim(struct sample *s, int *n)
{
    const int dark = (int)(dark_part * *n);
    const int bright = (int)(bright_part * *n);
    if (*n - dark - bright < 4)
        return s;
    qsort(s, (size_t)*n, sizeof *s, by_value);
    *n -= dark + bright;
    return s + dark;
}

static bool fit_robustly(vec3 *g, const struct fit *f, struct sample *s, int n)
{
    vec3 better = *g;
    for (int i = 0; i < rounds; i++) {
        weigh(f, *g, s, n);
        if (!least_squares(&better, f, s, n))
            return i > 0;
        const double moved = vec3_length(vec3_sub(better, *g));
        *g = better;
        if (moved < 1e-5 * vec3_length(better))
            break;
    }
    return true;
}

static const float *sample_of(const struct fit *f, int light, size_t pixel)
{
    return f->samples + (size_t)light * f->stride + 3 * pixel;
}

// What the pixel reflects in each colour, given its normal and the weights of its samples.
static void find_albedo(float albedo[3], const struct fit *f, vec3 normal, size_t pixel,
                        const struct sample *s, int n)
{
    double sum[3] = {0}, norm = 0;
    for (int i = 0; i < n; i++) {
        const float *rgb = sample_of(f, s[i].light, pixel);
        const double cosine = vec3_dot(normal, f->direction[s[i].light]);
        if (cosine <= grazing)
            continue;
        const double w = (double)s[i].weight * cosine;
        norm += w * cosine;
        for (int c = 0; c < 3; c++)
            sum[c] += w * (double)rgb[c];
    }
    for (int c = 0; c < 3; c++)
        albedo[c] = norm > 0 ? (float)fmax(sum[c] / norm, 0.0) : 0.0f;
}

static void fit_pixel(const struct fit *f, struct sample *s, size_t pixel, float normal[3],
                      float albedo[3])
{
    int n = f->lights;
    vec3 g;
    for (int i = 0; i < n; i++) {
        const float *rgb = sample_of(f, i, pixel);
        s[i] = (struct sample){0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2], 1.0f, i};
    }
    if (!f->params.plain)
        s = trim(s, &n);
    if (!least_squares(&g, f, s, n) || !(vec3_length(g) > black))
        return;
    if (!f->params.plain && !fit_robustly(&g, f, s, n))
        return;
    if (!(vec3_length(g) > black))
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
    struct sample *scratch = f->scratch + (size_t)worker * (size_t)f->lights;
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
    const size_t bytes = band.storage == RELUME_STORE_8 ? 1 : 2;
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
                                    f->samples + (size_t)i * f->stride};
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
    free(planes);
    free(indices);
    return status;
}

static bool directions_span(const vec3 *direction, int n)
{
    double m[6] = {0};
    vec3 ignored;
    for (int i = 0; i < n; i++) {
        const vec3 l = direction[i];
        const double add[6] = {l.x * l.x, l.x * l.y, l.x * l.z, l.y * l.y, l.y * l.z, l.z * l.z};
        for (int k = 0; k < 6; k++)
            m[k] += add[k];
    }
    return solve3(&ignored, m, vec3_of(0, 0, 1));
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
        .params = params ? *params : (struct relume_normals_params){0},
        .lights = info->lights,
        .direction = info->directions,
        .out = out,
    };
    *out = (struct relume_normals){0};
    if (f.lights < 3 || !directions_span(f.direction, f.lights))
        return log_fail(f.params.log, RELUME_EDATA,
                        "normals need three lights in different planes; the %d captured directions "
                        "do not determine them",
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
    free(f.samples);
    free(f.scratch);
    if (status)
        relume_normals_destroy(out);
    return status;
}
