// compress.c - texel by texel: bounces, what components are learned from, and what of them each is
//
// A texel's numbers are many (views times lights), so they are never all kept: some texels are
// baked to learn from, then every texel is baked, written as components and forgotten.
#include "world/bake/compress.h"

#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "world/baked/components.h"

#include <math.h>
#include <string.h>

enum { CHUNK = 16, AT_ONCE = 16, TAUGHT = 32768 };
static const size_t TAUGHT_BYTES = (size_t)512 << 20;

// ---------------------------------------------------------------- over texels

// Work on texels [0, count), some at a time, each worker with its scratch.
struct sweep {
    const struct baking *b;
    relume_status (*body)(const struct sweep *s, size_t i, struct texel_scratch *scratch);
    void *context;
    size_t count, first;
    relume_status *status;  // [items at once]
};

static void sweep_chunk(void *context, size_t item, int worker)
{
    (void)worker;
    const struct sweep *s = context;
    struct texel_scratch scratch;
    const size_t from = s->first + item * CHUNK, left = s->count - from;
    relume_status status = scratch_make(&scratch, s->b);
    for (size_t i = from; i < from + (left < CHUNK ? left : CHUNK) && !status; i++)
        status = s->body(s, i, &scratch);
    scratch_free(&scratch);
    s->status[item] = status;
}

static relume_status sweep_run(struct sweep *s, const char *what)
{
    const size_t at_once = (size_t)thread_count(s->b->threads) * AT_ONCE;
    relume_status status = RELUME_OK;
    s->status = mem_array(at_once, sizeof *s->status);
    if (!s->status)
        return RELUME_ENOMEM;
    for (s->first = 0; s->first < s->count && !status; s->first += at_once * CHUNK) {
        const size_t left = (s->count - s->first + CHUNK - 1) / CHUNK;
        const size_t items = left < at_once ? left : at_once;
        thread_for(s->b->threads, items, sweep_chunk, s);
        for (size_t i = 0; i < items && !status; i++)
            status = s->status[i];
        if (!status && !log_progress(s->b->log, what, (double)s->first / (double)s->count))
            status = RELUME_ECANCEL;
    }
    mem_free(s->status);
    return status;
}

// ---------------------------------------------------------------- bounces

static relume_status send_straight(const struct sweep *s, size_t i, struct texel_scratch *scratch)
{
    const struct baking *b = s->b;
    struct surface_point p;
    texel_point(&p, b, b->used[i]);
    const relume_status status = texel_direct(scratch->vector, b, &p, scratch);
    if (!status)
        texel_mean((float *)s->context + i * 3 * (size_t)b->count, b, scratch->vector);
    return status;
}

struct bounce {
    const float *from;
    float *to;
};

static relume_status send_on(const struct sweep *s, size_t i, struct texel_scratch *scratch)
{
    const struct baking *b = s->b;
    const struct bounce *bounce = s->context;
    struct surface_point p;
    texel_point(&p, b, b->used[i]);
    memset(scratch->vector, 0, baking_length(b) * sizeof *scratch->vector);
    texel_gather(scratch->vector, b, &p, b->used[i], bounce->from);
    texel_mean(bounce->to + i * 3 * (size_t)b->count, b, scratch->vector);
    return RELUME_OK;
}

relume_status bake_bounces(struct baking *b)
{
    const size_t n = b->atlas.used * 3 * (size_t)b->count;
    if (!b->bounces)
        return RELUME_OK;
    relume_status status =
        limits_memory(NULL, 3 * (uint64_t)n * sizeof(float), "light between surfaces", b->log);
    if (status)
        return status;
    float *next = mem_array(n, sizeof *next);
    b->sent = mem_array(n, sizeof *b->sent);
    b->bounced = mem_array(n, sizeof *b->bounced);
    status = next && b->sent && b->bounced ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = sweep_run(
            &(struct sweep){
                .b = b, .body = send_straight, .context = b->sent, .count = b->atlas.used},
            "straight light");
    if (!status)
        memcpy(b->bounced, b->sent, n * sizeof *b->sent);
    for (int i = 1; i < b->bounces && !status; i++) {
        struct bounce bounce = {b->bounced, next};
        status = sweep_run(
            &(struct sweep){.b = b, .body = send_on, .context = &bounce, .count = b->atlas.used},
            "light from surfaces");
        for (size_t k = 0; k < n && !status; k++)
            b->sent[k] += next[k];
        float *swap = b->bounced;
        b->bounced = next;
        next = swap;
    }
    mem_free(next);
    return status;
}

// ---------------------------------------------------------------- learning

static relume_status whole(float *out, const struct baking *b, uint32_t texel,
                           struct surface_point *p, struct texel_scratch *scratch)
{
    texel_point(p, b, texel);
    const relume_status status = texel_direct(out, b, p, scratch);
    if (!status && b->sent)
        texel_gather(out, b, p, texel, b->sent);
    return status;
}

struct taught {
    float *rows;
    size_t count;
};

static relume_status teach(const struct sweep *s, size_t i, struct texel_scratch *scratch)
{
    const struct taught *t = s->context;
    struct surface_point p;
    const size_t from = i * s->b->atlas.used / t->count;
    return whole(t->rows + i * baking_length(s->b), s->b, s->b->used[from], &p, scratch);
}

// Vectors that are far smaller than what halves hold never matter; larger ones cannot be kept.
static relume_status round_to_halves(float *value, size_t n, const struct relume_log *log)
{
    for (size_t i = 0; i < n; i++) {
        value[i] = float_from_half(half_from_float(value[i]));
        if (!isfinite(value[i]))
            return log_fail(log, RELUME_EUNFIT,
                            "baking: the light is brighter than half floats can hold; expected "
                            "weaker lamps, and --gain or --exposure afterwards");
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- wavelets

struct ranked {
    float energy;
    uint16_t place;
};

static int by_energy(const void *a, const void *b)
{
    const struct ranked *x = a, *y = b;
    return x->energy != y->energy ? (x->energy < y->energy) - (x->energy > y->energy)
                                  : (x->place > y->place) - (x->place < y->place);
}

// The largest of each face stay, by the sum over the colours; the others become 0.
static void keep_largest(relume_baked *out, size_t number, float *dense)
{
    const size_t face = (size_t)(out->info.cube * out->info.cube), kept = (size_t)out->info.kept;
    struct ranked rank[RELUME_BAKED_MOST_CUBE * RELUME_BAKED_MOST_CUBE] = {{0}};
    uint16_t *place = out->place + number * (size_t)out->kept;
    float *value = out->value + 3 * number * (size_t)out->kept;
    for (size_t f = 0; f < 6; f++) {
        for (size_t i = 0; i < face; i++) {
            const float *v = dense + 3 * (f * face + i);
            rank[i] =
                (struct ranked){v[0] * v[0] + v[1] * v[1] + v[2] * v[2], (uint16_t)(f * face + i)};
        }
        qsort(rank, face, sizeof *rank, by_energy);
        for (size_t i = 0; i < kept; i++, value += 3) {
            *place++ = rank[i].place;
            memcpy(value, dense + 3 * (size_t)rank[i].place, 3 * sizeof *value);
        }
        for (size_t i = kept; i < face; i++)
            memset(dense + 3 * (size_t)rank[i].place, 0, 3 * sizeof *dense);
    }
}

// ---------------------------------------------------------------- one block

struct block {
    relume_baked *out;
    const struct local_components *components;
    int number;
    size_t offset;  // of its numbers in a texel's
};

static relume_status learn_block(const struct block *bl, const struct baking *b,
                                 const struct taught *t)
{
    const struct local_components *c = bl->components;
    relume_baked *out = bl->out;
    const size_t vectors = (size_t)c->clusters * (size_t)(1 + c->components) * (size_t)out->views;
    const size_t first = (size_t)bl->number * vectors, length = 3 * (size_t)b->count;
    relume_status status =
        components_learn(c, t->rows + bl->offset, t->count, baking_length(b), b->threads);
    if (!status)
        status = round_to_halves(c->vector, vectors * length, b->log);
    if (status)
        return status;
    for (size_t i = 0; i < vectors && out->info.cube; i++)
        keep_largest(out, first + i, c->vector + i * length);
    if (!out->info.cube)
        memcpy(out->value + first * length, c->vector, vectors * length * sizeof *out->value);
    return RELUME_OK;
}

// ---------------------------------------------------------------- all texels

struct writing {
    relume_baked *out;
    const struct local_components *components;  // [blocks]
    double (*square)[2];                        // [used]: of what is left, of all
};

static relume_status write_block(const struct writing *w, int number, size_t texel, const float *y,
                                 float *left, double square[2], const struct relume_log *log)
{
    relume_baked *out = w->out;
    const struct local_components *c = &w->components[number];
    const size_t own = (size_t)number * (size_t)out->info.width * (size_t)out->info.height + texel;
    float *weight = out->weight + own * (size_t)c->components;
    double rest;
    out->cluster[own] = (uint16_t)components_best(weight, &rest, c, y, left);
    square[0] += rest;
    for (size_t j = 0; j < c->length; j++)
        square[1] += (double)y[j] * (double)y[j];
    return round_to_halves(weight, (size_t)c->components, log);
}

static relume_status write_frame(float frame[6], const struct surface_point *p)
{
    const vec3 v[2] = {p->normal, p->tangent};
    for (int i = 0; i < 2; i++) {
        frame[3 * i] = (float)v[i].x;
        frame[3 * i + 1] = (float)v[i].y;
        frame[3 * i + 2] = (float)v[i].z;
    }
    return round_to_halves(frame, 6, NULL);
}

static relume_status write_texel(const struct sweep *s, size_t i, struct texel_scratch *scratch)
{
    const struct writing *w = s->context;
    const struct baking *b = s->b;
    struct surface_point p;
    float *left = mem_array(baking_length(b), sizeof *left);
    relume_status status =
        left ? whole(scratch->vector, b, b->used[i], &p, scratch) : RELUME_ENOMEM;
    w->square[i][0] = w->square[i][1] = 0.0;
    for (int k = 0; k < w->out->blocks && !status; k++)
        status =
            write_block(w, k, b->used[i], scratch->vector + (size_t)k * w->components[k].length,
                        left, w->square[i], b->log);
    if (!status)
        status = write_frame(w->out->frame[b->used[i]], &p);
    mem_free(left);
    return status;
}

static relume_status write_all(struct writing *w, const struct baking *b)
{
    double left = 0.0, all = 0.0;
    w->square = mem_array(b->atlas.used, sizeof *w->square);
    relume_status status = w->square ? sweep_run(&(struct sweep){.b = b,
                                                                 .body = write_texel,
                                                                 .context = w,
                                                                 .count = b->atlas.used},
                                                 "texels")
                                     : RELUME_ENOMEM;
    for (size_t i = 0; i < b->atlas.used && !status; i++) {
        left += w->square[i][0];
        all += w->square[i][1];
    }
    w->out->info.error = all > 0.0 ? sqrt(left / all) : 0.0;
    mem_free(w->square);
    return status;
}

size_t bake_count_taught(relume_baked *out, const struct baking *b)
{
    size_t n = TAUGHT_BYTES / (baking_length(b) * sizeof(float));
    n = n < 1 ? 1 : n > TAUGHT ? TAUGHT : n;
    n = n < b->atlas.used ? n : b->atlas.used;
    const size_t most = n / (size_t)(1 + out->info.components);
    if (most < (size_t)out->info.clusters)
        out->info.clusters = most ? (int)most : 1;
    return n;
}

relume_status bake_compress(relume_baked *out, const struct baking *b)
{
    struct taught t = {.count = b->taught};
    relume_status status = baked_make(out, NULL, b->log);
    const size_t blocks = (size_t)out->blocks;
    struct local_components *c = mem_zeroed(blocks, sizeof *c);
    if (!status && !c)
        status = RELUME_ENOMEM;
    if (!status)
        t.rows = mem_array(t.count * baking_length(b), sizeof *t.rows);
    if (!status && !t.rows)
        status = RELUME_ENOMEM;
    if (!status)
        status = sweep_run(&(struct sweep){.b = b, .body = teach, .context = &t, .count = t.count},
                           "samples");
    for (size_t k = 0; k < blocks && !status; k++) {
        c[k] = (struct local_components){
            .clusters = out->info.clusters,
            .components = out->info.components,
            .length = baking_length(b) / blocks,
        };
        c[k].vector = mem_array((size_t)c[k].clusters * (size_t)(1 + c[k].components),
                                c[k].length * sizeof *c[k].vector);
        const struct block block = {out, &c[k], (int)k, k * c[k].length};
        status = c[k].vector ? learn_block(&block, b, &t) : RELUME_ENOMEM;
    }
    mem_free(t.rows);
    if (!status)
        status = write_all(&(struct writing){.out = out, .components = c}, b);
    for (size_t k = 0; c && k < blocks; k++)
        mem_free(c[k].vector);
    mem_free(c);
    return status;
}
