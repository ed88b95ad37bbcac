// near.c - point, spot, slide, area and ies lights: every pixel sees them from a direction of its
// own (Wong 1998, 7.5.5)
//
// In the linear domain a pixel's lights meet in one weight vector as distant ones do, and its
// coefficients are read once; in the display domain each light is decoded and made linear.
#include "relight/near.h"

#include "base/memory.h"
#include "image/half.h"
#include "math/vec.h"

#include <string.h>

enum { MOST_WEIGHTS = 3 * 4096, MOST_TOGETHER = 64 };

// ---------------------------------------------------------------- emitters

static int facet_side(const struct near *near, const struct relume_light *area)
{
    return relume_light_facet_side(area, relume_area_distance(area, near->surface));
}

static void cut(struct emitter *to, const struct relume_light *area, int side)
{
    struct relume_facet facets[RELUME_FACETS_MOST * RELUME_FACETS_MOST];
    relume_light_facets(facets, area, side);
    for (int i = 0; i < side * side; i++)
        to[i].facet = facets[i];
}

relume_status near_create(struct near *near, const struct relume_light *lights, int n)
{
    int *side = mem_zeroed((size_t)n, sizeof *side);
    size_t count = 0;
    for (int i = 0; side && i < n; i++) {
        if (lights[i].kind == RELUME_LIGHT_AREA)
            side[i] = facet_side(near, &lights[i]);
        else
            side[i] = relume_light_is_near(lights[i].kind);
        count += (size_t)side[i] * (size_t)side[i];
    }
    near->emitter = side && count <= INT32_MAX ? mem_zeroed(count, sizeof *near->emitter) : NULL;
    for (int i = 0; near->emitter && i < n; i++) {
        struct emitter *to = &near->emitter[near->count];
        if (lights[i].kind == RELUME_LIGHT_AREA)
            cut(to, &lights[i], side[i]);
        else if (side[i])
            to->light = &lights[i];
        near->count += side[i] * side[i];
    }
    free(side);
    return near->emitter ? RELUME_OK : RELUME_ENOMEM;
}

void near_destroy(struct near *near)
{
    free(near->emitter);
    *near = (struct near){0};
}

static bool is_captured(const struct near *near, vec3 towards)
{
    const struct relume_coder_info *info = relume_coder_info(near->codes->coder);
    return !info->hemispherical || pole_from_world(towards, info->pole_y).z >= 0.0;
}

// Areas are integrals: from below the horizon of a hemispherical capture they add nothing. Others
// are taken at the horizon there, as directional lights are.
static bool arrives(vec3 *towards, float rgb[3], const struct near *near, const struct emitter *e,
                    vec3 point)
{
    if (e->light)
        return relume_light_at(towards, rgb, e->light, point);
    return relume_facet_at(towards, rgb, &e->facet, point) && is_captured(near, *towards);
}

// ---------------------------------------------------------------- coefficients

static float code_value(const struct relume_codes *codes, int plane, size_t pixel)
{
    if (codes->storage == RELUME_STORE_8)
        return ((const uint8_t *)codes->plane[plane])[pixel];
    const uint16_t word = ((const uint16_t *)codes->plane[plane])[pixel];
    return codes->storage == RELUME_STORE_HALF ? float_from_half(word) : word;
}

static void read_planes(float *out, const struct relume_codes *codes, size_t first, size_t n)
{
    for (int p = 0; p < codes->planes; p++)
        for (size_t i = 0; i < n; i++)
            out[i * (size_t)codes->planes + (size_t)p] =
                code_value(codes, p, first + i) * codes->scale[p] + codes->offset[p];
}

static void read_vectors(float *out, const struct relume_codes *codes, size_t first, size_t n)
{
    const size_t planes = (size_t)codes->planes;
    memset(out, 0, n * planes * sizeof *out);
    for (int b = 0; b < codes->books; b++)
        for (size_t i = 0; i < n; i++) {
            const float *v = codes->vectors[b] + (size_t)codes->index[b][first + i] * planes;
            for (size_t p = 0; p < planes; p++)
                out[i * planes + p] += v[p];
        }
}

// out[n][planes]: pixels side by side, so that a pixel's sums run through memory.
static void read_coefficients(float *out, const struct relume_codes *codes, size_t first, size_t n)
{
    (codes->books ? read_vectors : read_planes)(out, codes, first, n);
}

// ---------------------------------------------------------------- pixels

static float dot(const float *weights, const float *coefficient, int k, int stride)
{
    float sum = 0.0f;
    for (int i = 0; i < k; i++)
        sum += weights[i] * coefficient[i * stride];
    return sum;
}

static void decode(float value[3], const struct near *near, const float *weights,
                   const float constant[3], const float *coefficient)
{
    const struct relume_coder_info *info = relume_coder_info(near->codes->coder);
    const int k = info->coefficients;
    for (int c = 0; c < 3; c++) {
        const float *from = info->joint ? coefficient : coefficient + c;
        value[c] = constant[c] + dot(weights + c * k, from, k, info->joint ? 1 : 3);
        if (info->luminance)
            value[c] *= coefficient[k + c];
    }
}

struct scratch {
    float weights[MOST_WEIGHTS];
    float constant[3];
};

static void clear(struct scratch *s, const struct near *near)
{
    const size_t k = (size_t)relume_coder_info(near->codes->coder)->coefficients;
    memset(s->weights, 0, 3 * k * sizeof *s->weights);
    memset(s->constant, 0, sizeof s->constant);
}

static void add_linear(const struct near *near, vec3 point, const float *coefficient,
                       struct scratch *s, float out[3])
{
    float value[3], rgb[3];
    vec3 towards;
    clear(s, near);
    for (int i = 0; i < near->count; i++)
        if (arrives(&towards, rgb, near, &near->emitter[i], point))
            relume_weight_grid_add(s->weights, s->constant, near->grid, towards, rgb);
    decode(value, near, s->weights, s->constant, coefficient);
    for (int c = 0; c < 3; c++)
        out[c] += value[c];
}

static void add_displayed(const struct near *near, vec3 point, const float *coefficient,
                          struct scratch *s, float out[3])
{
    static const float one[3] = {1.0f, 1.0f, 1.0f};
    float value[3], rgb[3];
    vec3 towards;
    for (int i = 0; i < near->count; i++) {
        if (!arrives(&towards, rgb, near, &near->emitter[i], point))
            continue;
        clear(s, near);
        relume_weight_grid_add(s->weights, s->constant, near->grid, towards, one);
        decode(value, near, s->weights, s->constant, coefficient);
        for (int c = 0; c < 3; c++)
            out[c] += rgb[c] * curve_decode(near->display, value[c]);
    }
}

static void add_some(const struct near *near, size_t first, size_t n, struct scratch *s, float *out)
{
    const size_t planes = (size_t)near->codes->planes;
    float coefficients[MOST_WEIGHTS];
    read_coefficients(coefficients, near->codes, first, n);
    for (size_t i = 0; i < n; i++) {
        const float *p = near->surface->data + 3 * (first + i);
        const vec3 point = vec3_of((double)p[0], (double)p[1], (double)p[2]);
        if (isfinite(point.x) && isfinite(point.y) && isfinite(point.z))
            (near->display ? add_displayed : add_linear)(near, point, coefficients + i * planes, s,
                                                         out + 3 * i);
    }
}

void near_add(const struct near *near, size_t first, size_t n, float *out)
{
    struct scratch scratch;
    const size_t fit = (size_t)MOST_WEIGHTS / (size_t)near->codes->planes;
    const size_t step = fit < 1 ? 1 : fit < MOST_TOGETHER ? fit : MOST_TOGETHER;
    for (size_t done = 0; done < n; done += step) {
        const size_t some = n - done < step ? n - done : step;
        add_some(near, first + done, some, &scratch, out + 3 * done);
    }
}
