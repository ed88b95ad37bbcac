// apply.c - the encoding map on the samples of pixels, and back at the captured lights
#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "format/coder/basis.h"

#include <string.h>

size_t coder_work(const relume_coder *coder)
{
    const size_t separated = 3 * (size_t)coder->info.lights * CODER_CHUNK;
    return separated + (coder->robust ? 2 * robust_work(coder->robust) : 0);
}

void coder_separate(float *to, const float *samples, size_t stride, int lights, size_t n)
{
    const size_t size = (size_t)lights * n;
    for (size_t i = 0; i < (size_t)lights; i++) {
        const float *from = samples + i * stride;
        float *row = to + i * n;
        for (size_t x = 0; x < n; x++) {
            row[x] = from[3 * x];
            row[size + x] = from[3 * x + 1];
            row[2 * size + x] = from[3 * x + 2];
        }
    }
}

// The colour of a pixel is its mean over the lights, each weighted by sin(2 elevation): high lights
// show highlights, low ones shadows. The luminance is (r + g + b) over that of the colour.
static void split_colour(const relume_coder *coder, float *work, size_t n, float *planes,
                         size_t plane_stride)
{
    const size_t lights = (size_t)coder->info.lights, size = lights * n;
    float *colour = planes + (size_t)coder->info.coefficients * plane_stride;
    double total = 0.0;
    for (size_t c = 0; c < 3; c++)
        memset(colour + c * plane_stride, 0, n * sizeof *colour);
    for (size_t i = 0; i < lights; i++) {
        const vec3 d = coder->frame[i];
        const double weight = 2.0 * fabs(d.z) * hypot(d.x, d.y) + 1e-3;
        total += weight;
        for (size_t c = 0; c < 3; c++)
            for (size_t x = 0; x < n; x++)
                colour[c * plane_stride + x] += (float)weight * work[c * size + i * n + x];
    }
    for (size_t x = 0; x < n; x++) {
        float sum = 0.0f;
        for (size_t c = 0; c < 3; c++) {
            colour[c * plane_stride + x] /= (float)total;
            sum += colour[c * plane_stride + x];
        }
        const float scale = sum > 1e-6f ? 1.0f / sum : 0.0f;
        for (size_t i = 0; i < lights; i++) {
            float *v = work + i * n + x;
            *v = (v[0] + v[size] + v[2 * size]) * scale;
        }
    }
}

void coder_part(const relume_coder *coder, float *parted, const float *samples, size_t stride,
                size_t n, float *planes, size_t plane_stride)
{
    coder_separate(parted, samples, stride, coder->info.lights, n);
    if (coder->info.luminance)
        split_colour(coder, parted, n, planes, plane_stride);
}

// `separated` as [channel][light][pixel].
static void multiply(const relume_coder *coder, float *separated, size_t n, float *planes,
                     size_t plane_stride)
{
    const struct relume_coder_info *info = &coder->info;
    const int k = info->coefficients, lights = info->lights, columns = (int)n;
    if (info->basis->joint) {
        lsq_multiply(k, columns, 3 * lights, coder->map, 3 * lights, separated, columns, planes,
                     (int)plane_stride);
        for (int i = 0; i < k; i++)
            for (size_t x = 0; x < n; x++)
                planes[(size_t)i * plane_stride + x] += coder->base[i];
        return;
    }
    const int sets = info->luminance ? 1 : 3;
    for (int c = 0; c < sets; c++)
        lsq_multiply(k, columns, lights, coder->map, lights, separated + (size_t)(c * lights) * n,
                     columns, planes + (size_t)c * plane_stride, sets * (int)plane_stride);
}

void coder_apply(const relume_coder *coder, const float *samples, size_t stride, size_t n,
                 float *planes, size_t plane_stride, float *work)
{
    coder_separate(work, samples, stride, coder->info.lights, n);
    coder_apply_separated(coder, n, planes, plane_stride, work);
}

void coder_apply_separated(const relume_coder *coder, size_t n, float *planes, size_t plane_stride,
                           float *work)
{
    const size_t lights = (size_t)coder->info.lights;
    if (coder->info.luminance)
        split_colour(coder, work, n, planes, plane_stride);
    multiply(coder, work, n, planes, plane_stride);
    if (coder->robust)
        robust_apply(coder->robust, coder, work, n, planes, plane_stride,
                     (double *)(void *)(work + 3 * lights * CODER_CHUNK));
}

relume_status relume_coder_apply(const relume_coder *coder, const float *samples, size_t stride,
                                 size_t n, float *planes, size_t plane_stride)
{
    if (!coder->map)
        return RELUME_EINVAL;
    float *work = mem_array(coder_work(coder), sizeof *work);
    if (!work)
        return RELUME_ENOMEM;
    for (size_t x = 0; x < n; x += CODER_CHUNK)
        coder_apply(coder, samples + 3 * x, stride, n - x < CODER_CHUNK ? n - x : CODER_CHUNK,
                    planes + x, plane_stride, work);
    mem_free(work);
    return RELUME_OK;
}

relume_status captured_create(struct captured *out, const relume_coder *coder,
                              const struct relume_vec3 *directions, int n)
{
    const size_t k = (size_t)coder->info.coefficients, lights = (size_t)n;
    float *weights = mem_array(3 * k, sizeof *weights);
    out->lights = n;
    out->basis = mem_array(3 * lights * k, sizeof *out->basis);
    out->constant = mem_array(3 * lights, sizeof *out->constant);
    const bool good = weights && out->basis && out->constant;
    for (size_t i = 0; good && i < lights; i++) {
        float constant[3];
        relume_coder_weights(coder, directions[i], weights, constant);
        for (size_t c = 0; c < 3; c++) {
            memcpy(out->basis + (c * lights + i) * k, weights + c * k, k * sizeof *weights);
            out->constant[c * lights + i] = constant[c];
        }
    }
    mem_free(weights);
    if (!good)
        captured_destroy(out);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

void captured_destroy(struct captured *c)
{
    mem_free(c->basis);
    mem_free(c->constant);
    *c = (struct captured){0, NULL, NULL};
}

void captured_predict(const struct captured *c, const relume_coder *coder, int channel,
                      const float *planes, size_t plane_stride, size_t n, float *out)
{
    const struct relume_coder_info *info = &coder->info;
    const int k = info->coefficients, lights = c->lights;
    const size_t first = info->joint ? 0 : (size_t)channel, step = info->joint ? 1 : 3;
    const float *colour = info->luminance ? planes + (size_t)(k + channel) * plane_stride : NULL;
    lsq_multiply(lights, (int)n, k, c->basis + (size_t)(channel * lights * k), k,
                 planes + first * plane_stride, (int)(step * plane_stride), out, (int)n);
    for (int i = 0; i < lights; i++)
        for (size_t x = 0; x < n; x++) {
            float *v = &out[(size_t)i * n + x];
            *v += c->constant[channel * lights + i];
            *v *= colour ? colour[x] : 1.0f;
        }
}
