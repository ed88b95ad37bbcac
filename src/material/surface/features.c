// features.c - the principal components of a texel's values in some pictures of the sample. All
// pictures would say little more (thesis, 4.2.1: 150 of 6561 do); square roots approximate display
// coding, so that a step counts as it is seen.
#include "material/surface/features.h"

#include <relume/material/surface.h>

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"
#include "material/btf/values.h"

#include <string.h>

enum { SIDE = 8, PICTURES = SIDE * SIDE, VALUES = 3 * PICTURES, CHUNK = 64 };

struct feature_pictures {
    const relume_btf_fitted *m;
    struct model_blend at[PICTURES];
    float *values;  // [texels][VALUES], over sqrt(VALUES)
};

static void load_chunk(void *context, size_t item, int worker)
{
    (void)worker;
    struct feature_pictures *w = context;
    const size_t from = item * CHUNK, end = from + CHUNK;
    for (size_t i = from; i < (end < w->m->texels ? end : w->m->texels); i++)
        for (int p = 0; p < PICTURES; p++) {
            float *to = w->values + i * VALUES + 3 * p;
            model_blend(w->m, i, &w->at[p], to);
            for (int c = 0; c < 3; c++)
                to[c] = sqrtf(fmaxf(to[c], 0.0f) / (float)VALUES);
        }
}

// Views and lights spread over those of the model, in an order that pairs every view with every
// light.
static void choose_pictures(struct feature_pictures *w)
{
    for (int i = 0; i < PICTURES; i++) {
        const vec3 v = w->m->view[i / SIDE * w->m->views / SIDE];
        const vec3 l = w->m->light[i % SIDE * w->m->lights / SIDE];
        w->at[i] = (struct model_blend){.view = relume_direction_mesh_at(w->m->view_mesh, v),
                                        .light = relume_direction_mesh_at(w->m->light_mesh, l),
                                        .v = v,
                                        .l = l};
    }
}

static bool find_components(const struct feature_pictures *w, double *vectors)
{
    double values[FEATURES];
    double *gram = mem_zeroed((size_t)VALUES * VALUES, sizeof *gram);
    double *rows = mem_array((size_t)CHUNK * VALUES, sizeof *rows);
    bool good = gram && rows;
    for (size_t first = 0; good && first < w->m->texels; first += CHUNK) {
        const size_t left = w->m->texels - first, n = left < CHUNK ? left : CHUNK;
        for (size_t i = 0; i < n * VALUES; i++)
            rows[i] = (double)w->values[first * VALUES + i];
        lsq_add_gram(gram, VALUES, rows, (int)n);
    }
    good = good && lsq_eigenvectors(gram, VALUES, FEATURES, values, vectors);
    mem_free(gram);
    mem_free(rows);
    return good;
}

static void project(const struct feature_pictures *w, const double *vectors, struct features *out)
{
    for (size_t i = 0; i < w->m->texels; i++)
        for (int k = 0; k < FEATURES; k++) {
            double sum = 0.0;
            for (int j = 0; j < VALUES; j++)
                sum += vectors[k * VALUES + j] * (double)w->values[i * VALUES + (size_t)j];
            out->texel[i][k] = (float)sum;
        }
}

relume_status features_make(struct features *out, const relume_btf_fitted *sample, int threads)
{
    struct feature_pictures w = {.m = sample};
    double *vectors = mem_array((size_t)FEATURES * VALUES, sizeof *vectors);
    *out = (struct features){.width = sample->width, .height = sample->height};
    out->texel = mem_array(sample->texels, sizeof *out->texel);
    w.values = mem_array(sample->texels * VALUES, sizeof *w.values);
    bool good = vectors && out->texel && w.values;
    choose_pictures(&w);
    if (good) {
        thread_for(threads, (sample->texels + CHUNK - 1) / CHUNK, load_chunk, &w);
        good = find_components(&w, vectors);
    }
    if (good)
        project(&w, vectors, out);
    mem_free(vectors);
    mem_free(w.values);
    if (!good)
        features_free(out);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

void features_free(struct features *f)
{
    mem_free(f->texel);
    f->texel = NULL;
}

relume_status relume_btf_texture(struct relume_texture *out, const relume_btf_fitted *sample,
                                 int threads)
{
    struct features f;
    const relume_status status = features_make(&f, sample, threads);
    *out = (struct relume_texture){.width = f.width, .height = f.height, .channels = FEATURES};
    out->value = status ? NULL : *f.texel;
    return status;
}
