// turn_all.c - many places at once: blocks that kernels turn, over several cores
#include "world/reflect/field.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/kernel/kernels.h"
#include "world/reflect/reflection.h"

#include <string.h>

enum { BLOCKS_AT_ONCE = 64 };  // a thread takes

struct turning {
    const relume_reflection *f;
    const struct relume_reflection_places *places;
    const struct turn_kernels *kernels;
    float (**constraint)[12];  // [sets]: as the kernel has them
};

// Of a block.
struct block {
    float place[3][TURN_BLOCK], r[3][TURN_BLOCK];
    float m[9][TURN_BLOCK], sum[9][TURN_BLOCK], a[TURN_BLOCK], total[TURN_BLOCK];
};

static void weigh(struct block *b, const relume_reflection *f, int set)
{
    for (int i = 0; i < TURN_BLOCK; i++)
        b->a[i] = 1.0f;
    for (int i = 0; f->edit.regions && i < TURN_BLOCK; i++) {
        const struct relume_reflection_place place = {
            .position =
                vec3_of((double)b->place[0][i], (double)b->place[1][i], (double)b->place[2][i])};
        b->a[i] = (float)relume_reflection_weight(f, set, &place);
    }
}

static void add_set(struct block *b, const struct turning *t, int set)
{
    const struct gathered *g = &t->f->gathered[set];
    weigh(b, t->f, set);
    if (g->members > 1) {
        t->kernels->sum(b->m, (const float(*)[TURN_BLOCK])b->place,
                        (const float(*)[12])t->constraint[set], g->members, (float)t->f->least);
        t->kernels->rotation(b->m);
    }
    for (int k = 0; g->members == 1 && k < 9; k++) {
        const vec3 row = g->only.row[k / 3];
        const float value = (float)(k % 3 == 0 ? row.x : k % 3 == 1 ? row.y : row.z);
        for (int i = 0; i < TURN_BLOCK; i++)
            b->m[k][i] = value;
    }
    for (int i = 0; i < TURN_BLOCK; i++)
        b->total[i] += b->a[i];
    for (int k = 0; k < 9; k++)
        for (int i = 0; i < TURN_BLOCK; i++)
            b->sum[k][i] += b->a[i] * b->m[k][i];
}

// Where one set counts whole, its rotation is there already.
static bool is_mixed(const struct block *b, int sets)
{
    bool mixed = sets > 1;
    for (int i = 0; i < TURN_BLOCK; i++)
        mixed |= b->total[i] > 0.0f && b->total[i] < 1.0f;
    return mixed;
}

static void turn_block(struct block *b, const struct turning *t)
{
    int sets = 0;
    memset(b->sum, 0, sizeof b->sum);
    memset(b->total, 0, sizeof b->total);
    for (int i = 0; i < gathered_count(t->f); i++)
        if (t->f->gathered[i].members) {
            add_set(b, t, i);
            sets++;
        }
    if (is_mixed(b, sets)) {
        for (int k = 0; k < 9; k++)
            for (int i = 0; i < TURN_BLOCK; i++)
                b->sum[k][i] += fmaxf(1.0f - b->total[i], 0.0f) * b->r[k / 3][i] * b->r[k % 3][i];
        t->kernels->rotation(b->sum);
    }
    for (int i = 0; i < TURN_BLOCK; i++) {
        const float x = b->r[0][i], y = b->r[1][i], z = b->r[2][i];
        for (int k = 0; k < 3; k++) {
            const float e =
                b->sum[3 * k][i] * x + b->sum[3 * k + 1][i] * y + b->sum[3 * k + 2][i] * z;
            b->r[k][i] = b->total[i] > 0.0f ? e : b->r[k][i];
        }
    }
}

static void turn_some(void *context, size_t item, int worker)
{
    (void)worker;
    const struct turning *t = context;
    const struct relume_reflection_places *p = t->places;
    const float *const place[3] = {p->x, p->y, p->z};
    float *const r[3] = {p->rx, p->ry, p->rz};
    const size_t first = item * BLOCKS_AT_ONCE * TURN_BLOCK;
    struct block b = {.a = {0.0f}};
    for (size_t at = first; at < first + BLOCKS_AT_ONCE * TURN_BLOCK && at < p->n;
         at += TURN_BLOCK) {
        const size_t n = p->n - at < TURN_BLOCK ? p->n - at : TURN_BLOCK;
        for (int k = 0; k < 3; k++) {
            memcpy(b.place[k], place[k] + at, n * sizeof(float));
            memcpy(b.r[k], r[k] + at, n * sizeof(float));
        }
        turn_block(&b, t);
        for (int k = 0; k < 3; k++)
            memcpy(r[k] + at, b.r[k], n * sizeof(float));
    }
}

static relume_status fill(float (**out)[12], const relume_reflection *f, const struct gathered *g)
{
    float(*to)[12] = mem_array((size_t)g->members, sizeof *to);
    *out = to;
    for (int i = 0; to && i < g->members; i++) {
        const struct relume_reflection_constraint *c = &f->constraint[g->member[i]];
        const double p[3] = {c->position.x, c->position.y, c->position.z};
        const double e[3] = {c->edited.x, c->edited.y, c->edited.z};
        const double r[3] = {c->original.x, c->original.y, c->original.z};
        for (int k = 0; k < 12; k++)
            to[i][k] = (float)(k < 3 ? p[k] : e[(k - 3) / 3] * r[(k - 3) % 3]);
    }
    return to ? RELUME_OK : RELUME_ENOMEM;
}

relume_status relume_reflection_turn_all(const relume_reflection *f,
                                         const struct relume_reflection_places *places,
                                         unsigned cpu_off, int threads)
{
    enum { AT_ONCE = BLOCKS_AT_ONCE * TURN_BLOCK };
    const int sets = gathered_count(f);
    struct turning t = {f, places, kernels_choose(cpu_off)->turn,
                        mem_zeroed((size_t)sets, sizeof *t.constraint)};
    relume_status status = t.constraint ? RELUME_OK : RELUME_ENOMEM;
    bool along = f->edit.geodesic;
    for (int i = 0; i < f->edit.regions; i++)
        along |= f->region[i].shape == RELUME_REFLECTION_GEODESIC;
    if (along && !status)
        status = RELUME_EUNFIT;
    for (int i = 0; i < sets && !status; i++)
        status = fill(&t.constraint[i], f, &f->gathered[i]);
    if (!status)
        thread_for(threads, (places->n + AT_ONCE - 1) / AT_ONCE, turn_some, &t);
    for (int i = 0; t.constraint && i < sets; i++)
        mem_free(t.constraint[i]);
    mem_free(t.constraint);
    return status;
}
