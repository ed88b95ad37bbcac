// scale.c - a picture in another size: the mean of what a pixel covers, or between texels
//
// Both axes one after the other. Enlarged: bilinear, or Catmull and Rom's cubic (1974), held within
// the range of its four texels so that light does not become negative beside an edge.
#include <relume/image.h>

#include "core/base/memory.h"
#include "core/base/names.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "image/image/footprint.h"

#include <string.h>

// Pixels of one axis as sums of texels.
struct axis {
    int taps;   // a pixel
    bool held;  // within the range of its texels
    int *texel;
    float *weight;  // [pixels][taps]
};

struct side {
    int texels, pixels;
    int tiles;  // pictures side by side, that do not mix
    bool wrap;
    double first, span;  // what of the texels becomes the pixels
};

// In texels, where a pixel's place lies.
static double place_of(const struct side *s, double pixel)
{
    return s->first + pixel * s->span / s->pixels;
}

// A texel of the tile that pixel `i` is of.
static int texel_within(const struct side *s, int i, int texel)
{
    const int tile = (int)((i + 0.5) * s->tiles / s->pixels);
    const int first = (int)((int64_t)tile * s->texels / s->tiles);
    const int end = (int)((int64_t)(tile + 1) * s->texels / s->tiles);
    if (s->wrap)
        return ((texel % s->texels) + s->texels) % s->texels;
    return texel < first ? first : texel >= end ? end - 1 : texel;
}

static void add_tap(struct axis *a, const struct side *s, int i, int *n, int texel, double weight)
{
    const size_t at = (size_t)i * (size_t)a->taps + (size_t)(*n)++;
    a->texel[at] = texel_within(s, i, texel);
    a->weight[at] = (float)weight;
}

static void set_linear(struct axis *a, const struct side *s, int i, struct footprint f)
{
    int n = 0;
    for (int k = 0; k < f.count; k++) {
        const double at = place_of(s, i + 0.5 + footprint_place(f, k)) - 0.5;
        const double low = floor(at);
        add_tap(a, s, i, &n, (int)low, (1.0 - (at - low)) / f.count);
        add_tap(a, s, i, &n, (int)low + 1, (at - low) / f.count);
    }
}

static void set_cubic(struct axis *a, const struct side *s, int i)
{
    const double at = place_of(s, i + 0.5) - 0.5;
    const int low = (int)floor(at);
    double weight[4];
    int n = 0;
    footprint_cubic(weight, at - low);
    for (int k = 0; k < 4; k++)
        add_tap(a, s, i, &n, low - 1 + k, weight[k]);
}

static void set_nearest(struct axis *a, const struct side *s, int i)
{
    int n = 0;
    add_tap(a, s, i, &n, (int)place_of(s, i + 0.5), 1.0);
}

static bool create_axis(struct axis *a, const struct side *s, enum relume_filter filter)
{
    const double ratio = s->span / s->pixels;
    const struct footprint f = footprint_of(ratio, s->texels);
    const bool cubic = filter == RELUME_FILTER_CUBIC && ratio < 1.0;
    const bool nearest = filter == RELUME_FILTER_NEAREST;
    *a = (struct axis){.taps = nearest ? 1 : cubic ? 4 : 2 * f.count, .held = cubic};
    const size_t n = (size_t)s->pixels * (size_t)a->taps;
    a->texel = mem_array(n, sizeof *a->texel);
    a->weight = mem_array(n, sizeof *a->weight);
    for (int i = 0; a->texel && a->weight && i < s->pixels; i++)
        if (nearest)
            set_nearest(a, s, i);
        else if (cubic)
            set_cubic(a, s, i);
        else
            set_linear(a, s, i, f);
    return a->texel && a->weight;
}

// ---------------------------------------------------------------- one axis

struct axis_step {
    const struct relume_image *from;
    struct relume_image *to;
    struct axis axis;
    bool down;
};

// The samples of pixel `i`: a row of texels `step` apart.
static void add_up(float *to, const struct axis *a, int i, const float *from, size_t step,
                   int channels)
{
    const int *texel = &a->texel[(size_t)i * (size_t)a->taps];
    const float *weight = &a->weight[(size_t)i * (size_t)a->taps];
    for (int c = 0; c < channels; c++) {
        float sum = 0.0f, low = INFINITY, high = -INFINITY;
        for (int k = 0; k < a->taps; k++) {
            const float v = from[(size_t)texel[k] * step + (size_t)c];
            sum += weight[k] != 0.0f ? weight[k] * v : 0.0f;  // 0 x infinite is nothing
            low = fminf(low, v);
            high = fmaxf(high, v);
        }
        to[c] = a->held ? fminf(fmaxf(sum, low), high) : sum;
    }
}

// Cubics are held within the range of their texels.
static void scale_held(const struct axis_step *p, size_t row, float *to, size_t channels)
{
    const size_t stride = (size_t)p->from->width * channels;
    for (int x = 0; x < p->to->width; x++, to += channels)
        if (p->down)
            add_up(to, &p->axis, (int)row, p->from->data + (size_t)x * channels, stride,
                   p->to->channels);
        else
            add_up(to, &p->axis, x, p->from->data + row * stride, channels, p->to->channels);
}

// A row as the sum of whole rows; 0 x infinite is nothing.
static void scale_down(const struct axis_step *p, size_t row, float *to, size_t channels)
{
    const size_t n = (size_t)p->to->width * channels, first = row * (size_t)p->axis.taps;
    memset(to, 0, n * sizeof *to);
    for (size_t k = first; k < first + (size_t)p->axis.taps; k++) {
        const float weight = p->axis.weight[k];
        const float *from = p->from->data + (size_t)p->axis.texel[k] * n;
        for (size_t i = 0; weight != 0.0f && i < n; i++)
            to[i] += weight * from[i];
    }
}

// `channels` is a constant at each call.
static inline __attribute__((always_inline)) void scale_across(const struct axis *a,
                                                               const float *from, int width,
                                                               float *to, size_t channels)
{
    const int *texel = a->texel;
    const float *weight = a->weight;
    for (int x = 0; x < width; x++, to += channels, texel += a->taps, weight += a->taps) {
        float sum[4] = {0.0f};
        for (int k = 0; k < a->taps; k++)
            for (size_t c = 0; weight[k] != 0.0f && c < channels; c++)
                sum[c] += weight[k] * from[(size_t)texel[k] * channels + c];
        memcpy(to, sum, channels * sizeof *to);
    }
}

static void scale_row(void *context, size_t row, int worker)
{
    const struct axis_step *p = context;
    const size_t channels = (size_t)p->to->channels;
    const float *from = p->from->data + row * (size_t)p->from->width * channels;
    float *to = p->to->data + row * (size_t)p->to->width * channels;
    (void)worker;
    if (p->axis.held || channels > 4)
        scale_held(p, row, to, channels);
    else if (p->down)
        scale_down(p, row, to, channels);
    else if (channels == 3)
        scale_across(&p->axis, from, p->to->width, to, 3);
    else
        scale_across(&p->axis, from, p->to->width, to, channels);
}

static relume_status scale_axis(struct axis_step *p, const struct side *side, int threads,
                                enum relume_filter filter)
{
    const relume_status status = create_axis(&p->axis, side, filter) ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        thread_for(threads, (size_t)p->to->height, scale_row, p);
    mem_free(p->axis.texel);
    mem_free(p->axis.weight);
    return status;
}

relume_status relume_image_scale(struct relume_image *out, const struct relume_image *image,
                                 int width, int height, const struct relume_scale_params *params)
{
    const struct relume_scale_params p = PARAMS(relume_scale_params, params);
    const bool part = p.from[2] > 0.0 && p.from[3] > 0.0;
    const struct side across = {image->width,
                                width,
                                p.tiles > 1 ? p.tiles : 1,
                                p.wrap,
                                part ? p.from[0] : 0.0,
                                part ? p.from[2] : image->width};
    const struct side down = {
        image->height, height, 1, false, part ? p.from[1] : 0.0, part ? p.from[3] : image->height};
    struct relume_image wide = {0};
    *out = (struct relume_image){0};
    if (!image->data || (across.tiles > 1 && across.tiles > image->width))
        return RELUME_EINVAL;
    relume_status status = relume_image_create(&wide, width, image->height, image->channels);
    if (!status)
        status = relume_image_create(out, width, height, image->channels);
    struct axis_step step = {.from = image, .to = &wide};
    if (!status)
        status = scale_axis(&step, &across, p.threads, p.filter);
    step = (struct axis_step){.from = &wide, .to = out, .down = true};
    if (!status)
        status = scale_axis(&step, &down, p.threads, p.filter);
    relume_image_destroy(&wide);
    if (status)
        relume_image_destroy(out);
    return status;
}
