// convolve.c - products of spherical harmonics
#include "world/bake/convolve.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/sh.h"
#include "material/surface/texels.h"

#include <math.h>
#include <string.h>

enum { LIGHTS = 128 };  // of the hemisphere that a texel is asked for

struct convolution {
    struct convolved *c;
    const relume_btf_surface *surface;
    int side;
    vec3 light[LIGHTS];
    double harmonics[LIGHTS][CONVOLVE_COUNT];
};

static void ask_view(float *to, const struct convolution *w, int x, int y, vec3 view)
{
    float sum[CONVOLVE_COUNT][3] = {{0.0f}};
    const double share = 2.0 * M_PI / LIGHTS;
    for (int i = 0; i < LIGHTS; i++) {
        float rgb[3];
        relume_btf_surface_evaluate(w->surface, x + 0.5, y + 0.5, 0.0,
                                    &(struct relume_btf_ray){.view = view, .light = w->light[i]},
                                    rgb);
        for (int k = 0; k < CONVOLVE_COUNT; k++)
            for (int c = 0; c < 3; c++)
                sum[k][c] += (float)(share * w->harmonics[i][k]) * rgb[c];
    }
    memcpy(to, sum, sizeof sum);
}

static void ask_texel(void *context, size_t item, int worker)
{
    (void)worker;
    const struct convolution *w = context;
    const int width = w->c->width, views = w->c->views;
    float *to = w->c->value + item * (size_t)views * CONVOLVE_COUNT * 3;
    for (int v = 0; v < views; v++, to += 3 * CONVOLVE_COUNT)
        ask_view(to, w, (int)(item % (size_t)width), (int)(item / (size_t)width),
                 view_direction(w->side, v));
}

// A golden-angle spiral over the hemisphere (Swinbank and Purser 2006).
static void find_lights(struct convolution *w)
{
    const double golden = M_PI * (3.0 - sqrt(5.0));
    for (int i = 0; i < LIGHTS; i++) {
        const double z = (i + 0.5) / LIGHTS, r = sqrt(1.0 - z * z);
        w->light[i] = vec3_of(r * cos(golden * i), r * sin(golden * i), z);
        sh_evaluate(CONVOLVE_DEGREE, w->light[i], w->harmonics[i]);
    }
}

relume_status convolved_create(struct convolved **out, const relume_btf_surface *surface, int width,
                               int height, int side, uint64_t most, int threads)
{
    const size_t texels = (size_t)width * (size_t)height;
    const size_t numbers = (size_t)(side * side) * CONVOLVE_COUNT * 3;
    *out = NULL;
    if ((uint64_t)texels * numbers > most / sizeof(float))
        return RELUME_OK;
    struct convolved *c = *out = mem_zeroed(1, sizeof *c);
    struct convolution *w = mem_zeroed(1, sizeof *w);
    if (c) {
        c->width = width, c->height = height, c->views = side * side;
        c->value = mem_array(texels * numbers, sizeof *c->value);
    }
    if (!c || !w || !c->value) {
        convolved_destroy(out);
        mem_free(w);
        return RELUME_ENOMEM;
    }
    w->c = c, w->surface = surface, w->side = side;
    find_lights(w);
    thread_for(threads, texels, ask_texel, w);
    mem_free(w);
    return RELUME_OK;
}

void convolved_destroy(struct convolved **c)
{
    if (*c)
        mem_free((*c)->value);
    mem_free(*c);
    *c = NULL;
}

void convolved_add(float light[][3], vec3 direction, const float rgb[3])
{
    double y[CONVOLVE_COUNT];
    sh_evaluate(CONVOLVE_DEGREE, direction, y);
    for (int k = 0; k < CONVOLVE_COUNT; k++)
        for (int c = 0; c < 3; c++)
            light[k][c] += (float)y[k] * rgb[c];
}

static int repeated(double place, int n)
{
    const int at = (int)((place - floor(place)) * n);
    return at < n ? at : n - 1;
}

void convolved_show(float *out, const struct convolved *c, double s, double t, bool mirrored,
                    float light[][3])
{
    const size_t texel =
        (size_t)repeated(t, c->height) * (size_t)c->width + (size_t)repeated(s, c->width);
    const int side = (int)lround(sqrt(c->views));
    for (int v = 0; v < c->views; v++) {
        const int row = mirrored ? side - 1 - v / side : v / side;
        const float *value =
            c->value +
            3 * CONVOLVE_COUNT * (texel * (size_t)c->views + (size_t)(row * side + v % side));
        for (int k = 0; k < CONVOLVE_COUNT; k++)
            for (int i = 0; i < 3; i++)
                out[3 * v + i] += value[3 * k + i] * light[k][i];
    }
}
