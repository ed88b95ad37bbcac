// signs.c - which samples of a volume are inside, and where its crossed edges have their vertices
#include "shape/volume/signs.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <float.h>
#include <math.h>
#include <string.h>

// Vertices keep this distance from samples, so that no two are at one place.
#define LEAST_STEP 1e-3f

#define SAMPLE   uint8_t
#define OF(name) name##_u8
#include "shape/volume/signs_typed.h"
#define SAMPLE   uint16_t
#define OF(name) name##_u16
#include "shape/volume/signs_typed.h"
#define SAMPLE   int16_t
#define OF(name) name##_i16
#include "shape/volume/signs_typed.h"
#define SAMPLE   float
#define OF(name) name##_f32
#include "shape/volume/signs_typed.h"

static const struct typed {
    void (*sign_row)(uint64_t *out, const relume_volume *v, size_t row, double limit);
    void (*sign_bricks)(uint64_t *out, const relume_volume *v, size_t row, double limit,
                        const float (*range)[2]);
    struct place (*place)(const struct signs *g, int axis, int x, int y, int z);
    size_t (*put_word)(const struct signs *g, int axis, int x, int y, int z, uint64_t word,
                       float (*position)[3], float (*normal)[3]);
    double least, most;  // limits of the type: what is beyond them is beyond every sample
    bool whole;
} typed[VOLUME_TYPES] = {
    [VOLUME_U8] = {sign_row_u8, sign_bricks_u8, place_of_u8, put_word_u8, 0, UINT8_MAX, true},
    [VOLUME_U16] = {sign_row_u16, sign_bricks_u16, place_of_u16, put_word_u16, 0, UINT16_MAX, true},
    [VOLUME_I16] = {sign_row_i16, sign_bricks_i16, place_of_i16, put_word_i16, INT16_MIN, INT16_MAX,
                    true},
    [VOLUME_F32] = {sign_row_f32, sign_bricks_f32, place_of_f32, put_word_f32, (double)-FLT_MAX,
                    (double)FLT_MAX, false},
};

// ---------------------------------------------------------------- bits

struct signing {
    struct signs *g;
    const struct typed *typed;
    double limit;
};

// One layer of samples.
static void sign_layer(void *context, size_t z, int worker)
{
    (void)worker;
    const struct signing *s = context;
    const relume_volume *v = s->g->volume;
    const struct volume_index *index = &v->index;
    const size_t height = (size_t)s->g->size[1], words = (size_t)s->g->words;
    for (size_t y = 0; y < height; y++) {
        const size_t row = z * height + y;
        const size_t bricks = z / BRICK_Z * (size_t)index->bricks[1] + y / BRICK_Y;
        if (index->range)
            s->typed->sign_bricks(s->g->bits + row * words, v, row, s->limit,
                                  (const float(*)[2])index->range +
                                      bricks * (size_t)index->bricks[0]);
        else
            s->typed->sign_row(s->g->bits + row * words, v, row, s->limit);
    }
}

relume_status signs_create(struct signs *g, const relume_volume *volume, float threshold,
                           int threads)
{
    *g = (struct signs){.volume = volume,
                        .size = {volume->size[0], volume->size[1], volume->size[2]},
                        .words = (volume->size[0] + 63) / 64,
                        .rows = (size_t)volume->size[1] * (size_t)volume->size[2],
                        .threshold = threshold,
                        .threads = threads};
    const struct typed *t = &typed[volume->type];
    const double limit = t->whole ? ceil((double)threshold) : (double)threshold;
    g->bits = mem_array(g->rows, (size_t)g->words * sizeof *g->bits);
    if (!g->bits)
        return RELUME_ENOMEM;
    if (limit <= t->least || limit > t->most) {
        memset(g->bits, limit > t->most ? 0 : 0xff, g->rows * (size_t)g->words * sizeof *g->bits);
        return RELUME_OK;
    }
    struct signing s = {g, t, limit};
    thread_for(threads, (size_t)g->size[2], sign_layer, &s);
    return RELUME_OK;
}

bool signs_round(const struct signs *g, size_t layers,
                 void (*body)(void *context, size_t item, int worker), void *context, double from,
                 double to)
{
    struct thread_told told = g->told;
    const double all = told.to - told.from;
    told.to = told.from + to * all;
    told.from += from * all;
    return thread_for_told(g->threads, layers, body, context, &told);
}

void signs_free(struct signs *g)
{
    mem_free(g->bits);
    *g = (struct signs){.bits = NULL};
}

struct place signs_place(const struct signs *g, int axis, int x, int y, int z)
{
    return typed[g->volume->type].place(g, axis, x, y, z);
}

// ---------------------------------------------------------------- vertices

struct filling {
    const struct numbering *n;
    const struct signs *g;
    struct relume_mesh *out;
};

static void count_layer(void *context, size_t z, int worker)
{
    (void)worker;
    const struct filling *f = context;
    for (int y = 0; y < f->g->size[1]; y++) {
        uint32_t *first = f->n->first + 3 * (z * (size_t)f->g->size[1] + (size_t)y);
        for (int axis = 0; axis < 3; axis++) {
            int count = 0;
            for (int w = 0; w < f->g->words; w++) {
                const uint64_t word = numbering_word(f->n, f->g, axis, y, (int)z, w);
                if (word)
                    count += signs_count(word);
            }
            first[axis] = (uint32_t)count;
        }
    }
}

relume_status numbering_create(struct numbering *n, const struct signs *g, const uint64_t *used)
{
    *n = (struct numbering){.used = used, .first = mem_array(3 * g->rows, sizeof *n->first)};
    if (!n->first)
        return RELUME_ENOMEM;
    struct filling f = {n, g, NULL};
    thread_for(g->threads, (size_t)g->size[2], count_layer, &f);
    for (size_t i = 0; i < 3 * g->rows; i++) {
        const uint32_t count = n->first[i];
        n->first[i] = (uint32_t)n->count;
        n->count += count;
        if (n->count > UINT32_MAX)
            return RELUME_ELIMIT;
    }
    return RELUME_OK;
}

void numbering_free(struct numbering *n)
{
    mem_free(n->first);
    *n = (struct numbering){.used = NULL};
}

// In units of the spacing.
static void stretch(float position[3], float normal[3], const double spacing[3])
{
    float square = 0.0f;
    for (int c = 0; c < 3; c++) {
        position[c] *= (float)spacing[c];
        normal[c] /= (float)spacing[c];
        square += normal[c] * normal[c];
    }
    for (int c = 0; c < 3; c++)
        normal[c] /= sqrtf(square);
}

static void put_layer(void *context, size_t z, int worker)
{
    (void)worker;
    const struct filling *f = context;
    const struct signs *g = f->g;
    const double *spacing = g->volume->spacing;
    const struct typed *t = &typed[g->volume->type];
    const size_t first = f->n->first[3 * z * (size_t)g->size[1]];
    size_t at = first;
    for (int y = 0; y < g->size[1]; y++)
        for (int axis = 0; axis < 3; axis++)
            for (int w = 0; w < g->words; w++) {
                const uint64_t word = numbering_word(f->n, g, axis, y, (int)z, w);
                if (word)
                    at += t->put_word(g, axis, 64 * w, y, (int)z, word, f->out->position + at,
                                      f->out->normal + at);
            }
    if (spacing[0] == 1.0 && spacing[1] == 1.0 && spacing[2] == 1.0)
        return;
    for (size_t i = first; i < at; i++)
        stretch(f->out->position[i], f->out->normal[i], spacing);
}

void numbering_put(const struct numbering *n, const struct signs *g, struct relume_mesh *out)
{
    struct filling f = {n, g, out};
    thread_for(g->threads, (size_t)g->size[2], put_layer, &f);
}
