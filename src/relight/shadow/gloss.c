// gloss.c - highlights that wander, added to a relit picture
#include "relight/shadow/gloss.h"

#include "core/base/thread.h"
#include "format/pack/views.h"

#include <math.h>

static const float LEAST_ROUGHNESS = 0.05f;  // as src/material/maps/ggx.h

void gloss_shown(float rgb[3], const float *pixel, vec3 light)
{
    const float x = pixel[RELUME_GLOSS_NORMAL], y = pixel[RELUME_GLOSS_NORMAL + 1];
    const float z = sqrtf(fmaxf(1.0f - x * x - y * y, 1e-6f));
    const float lx = (float)light.x, ly = (float)light.y, lz = (float)light.z;
    const float cosine = x * lx + y * ly + z * lz;
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (!(cosine > 0.0f))
        return;
    const float half = fmaxf((cosine + z) / sqrtf(fmaxf(2.0f + 2.0f * lz, 1e-6f)), 0.0f);
    const float r = fmaxf(pixel[RELUME_GLOSS_ROUGHNESS], LEAST_ROUGHNESS), a2 = r * r * r * r;
    const float d = half * half * (a2 - 1.0f) + 1.0f;
    const float lobe = a2 * cosine /
                       (d * d * (cosine + sqrtf(a2 + (1.0f - a2) * cosine * cosine)) *
                        (z + sqrtf(a2 + (1.0f - a2) * z * z)));
    const float shine = pixel[RELUME_GLOSS_SHINE];
    for (int c = 0; c < 3; c++) {
        const float colour = pixel[RELUME_GLOSS_COLOUR + c];
        rgb[c] = fminf(shine < 0.0f ? colour * lobe : colour * cosine + shine * lobe, 1.0f);
    }
}

void gloss_wanders(float rgb[3], const float *pixel, const struct gloss_light *l)
{
    float between[3] = {0.0f, 0.0f, 0.0f}, known[3];
    for (int i = 0; i < l->captured; i++) {
        gloss_shown(known, pixel, l->from[i]);
        for (int c = 0; c < 3; c++)
            between[c] += l->weight[i] *
                          (l->display ? relume_transfer_encode(*l->display, known[c]) : known[c]);
    }
    gloss_shown(rgb, pixel, l->light);
    for (int c = 0; c < 3; c++)
        rgb[c] -= l->display ? relume_transfer_decode(*l->display, between[c]) : between[c];
}

struct adding {
    struct relume_image *more;
    int left, top;
    const struct relume_image *model;
    const struct gloss_light *light;
    const float *rgb;
};

static void add_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct adding *a = context;
    const size_t width = (size_t)a->more->width;
    const float *pixel =
        a->model->data + RELUME_GLOSS_CHANNELS *
                             (((size_t)a->top + row) * (size_t)a->model->width + (size_t)a->left);
    float *out = a->more->data + 3 * row * width;
    for (size_t x = 0; x < width; x++, out += 3, pixel += RELUME_GLOSS_CHANNELS) {
        const float share = pixel[RELUME_GLOSS_SHARE];
        float more[3];
        if (!(share > 0.0f))
            continue;
        gloss_wanders(more, pixel, a->light);
        for (int c = 0; c < 3; c++)
            out[c] += a->rgb[c] * share * more[c];
    }
}

void gloss_add(struct relume_image *more, int left, int top, const struct relume_image *model,
               const struct gloss_light *light, const float rgb[3], int threads)
{
    struct adding a = {
        .more = more, .left = left, .top = top, .model = model, .light = light, .rgb = rgb};
    thread_for(threads, (size_t)more->height, add_row, &a);
}
