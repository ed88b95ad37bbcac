// climb.c - the surface through boxes of a grid: adaptive skeleton climbing
//
// Two rounds over blocks, in layers: their boxes first, then, since neighbours know theirs, loops
// and triangles. Vertices are named by their edge until all are known, then numbered in order.
#include "shape/volume/climb.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "shape/volume/faces.h"

#include <string.h>

// What a block is.
enum { EMPTY = -1, ONE_BOX = -2 };  // else where its owners begin, in blocks

// The blocks of one layer, and what came of them.
struct layer {
    box_owner *owners;
    size_t owned;  // blocks that have them
    uint64_t (*triangle)[3];
    size_t triangles, capacity;
    size_t boxes, ambiguous;
    bool failed;
};

struct worker {
    struct block block;
    struct faces faces;
};

struct climb {
    const struct signs *g;
    int side;
    int blocks[3];
    int32_t *state;  // [blocks], x runs fastest
    struct layer *layer;
    struct worker *worker;
    uint64_t *used;  // as numbering has it
    bool share;
    size_t *first;  // triangle of each layer
    const struct numbering *vertices;
    uint32_t (*triangle)[3];
};

static size_t block_bytes(const struct climb *k)
{
    return (size_t)k->side * (size_t)k->side * (size_t)k->side;
}

static int32_t *state_at(const struct climb *k, int x, int y, int z)
{
    return k->state + ((size_t)z * (size_t)k->blocks[1] + (size_t)y) * (size_t)k->blocks[0] +
           (size_t)x;
}

// ---------------------------------------------------------------- first round: boxes

static bool keep_owners(struct climb *k, struct layer *l, const struct block *b)
{
    const size_t bytes = block_bytes(k);
    if (!(l->owned & (l->owned - 1))) {  // grows to the next power of two
        box_owner *more = mem_resize(l->owners, l->owned ? 2 * l->owned : 1, bytes);
        if (!more)
            return false;
        l->owners = more;
    }
    memcpy(l->owners + l->owned++ * bytes, b->owner, bytes);
    return true;
}

// Whether a bit is set, and whether one is not, in the samples of a row of blocks, at a word.
static void gather(const struct climb *k, int y, int z, int w, uint64_t *any, uint64_t *all)
{
    const struct signs *g = k->g;
    const int y1 = (y + 1) * k->side < g->size[1] ? (y + 1) * k->side : g->size[1] - 1;
    const int z1 = (z + 1) * k->side < g->size[2] ? (z + 1) * k->side : g->size[2] - 1;
    *any = 0;
    *all = ~(uint64_t)0;
    for (int j = z * k->side; j <= z1; j++)
        for (int i = y * k->side; i <= y1; i++) {
            const uint64_t bits = signs_row(g, i, j)[w];
            *any |= bits;
            *all &= bits;
        }
}

static void climb_block(struct climb *k, struct layer *l, struct block *b, const int at[3])
{
    int32_t *state = state_at(k, at[0], at[1], at[2]);
    block_load(b, k->g, k->side, at);
    if (block_climb(b)) {
        *state = ONE_BOX;
    } else {
        *state = (int32_t)l->owned;
        l->failed = l->failed || !keep_owners(k, l, b);
    }
}

static void climb_layer(void *context, size_t z, int worker)
{
    struct climb *k = context;
    struct layer *l = &k->layer[z];
    const int words = k->g->words, each = 64 / k->side;
    const uint64_t samples = ((uint64_t)2 << k->side) - 1;
    for (int y = 0; y < k->blocks[1]; y++) {
        uint64_t any, all, next_any, next_all;
        gather(k, y, (int)z, 0, &next_any, &next_all);
        for (int w = 0; w < words; w++) {
            any = next_any;
            all = next_all;
            if (w + 1 < words)
                gather(k, y, (int)z, w + 1, &next_any, &next_all);
            else
                next_any = any >> 63, next_all = all >> 63;
            if ((!any && !(next_any & 1)) || !(~all | (~next_all & 1)))
                continue;
            for (int i = 0; i < each && w * each + i < k->blocks[0]; i++) {
                const int shift = i * k->side;
                const bool last = i + 1 == each;
                const uint64_t a = (any >> shift | (last ? next_any << k->side : 0)) & samples;
                const uint64_t b = (all >> shift | (last ? next_all << k->side : 0)) & samples;
                if (a && b != samples)
                    climb_block(k, l, &k->worker[worker].block,
                                (const int[3]){w * each + i, y, (int)z});
            }
        }
    }
}

// ---------------------------------------------------------------- second round: triangles

static struct neighbours neighbours_of(const struct climb *k, const int at[3])
{
    struct neighbours n = {.owner = {NULL}};
    for (int f = 0; f < 6; f++) {
        int to[3] = {at[0], at[1], at[2]};
        to[f / 2] += f & 1 ? 1 : -1;
        if (to[f / 2] < 0 || to[f / 2] >= k->blocks[f / 2])
            continue;
        const int32_t state = *state_at(k, to[0], to[1], to[2]);
        n.alone[f] = state == ONE_BOX;
        if (state >= 0)
            n.owner[f] = k->layer[to[2]].owners + (size_t)state * block_bytes(k);
    }
    return n;
}

static bool grow_layer(struct layer *l, size_t more)
{
    if (l->triangles + more <= l->capacity)
        return true;
    const size_t capacity = 2 * l->capacity + more + 256;
    uint64_t(*grown)[3] = mem_resize(l->triangle, capacity, sizeof *grown);
    if (!grown)
        return false;
    l->triangle = grown;
    l->capacity = capacity;
    return true;
}

static void mark(struct climb *k, uint64_t key)
{
    uint64_t *word = k->used + (key >> 16) * (size_t)k->g->words + ((key & 0xffff) >> 6);
    const uint64_t bit = (uint64_t)1 << (key & 63);
    if (!(__atomic_load_n(word, __ATOMIC_RELAXED) & bit))
        __atomic_fetch_or(word, bit, __ATOMIC_RELAXED);
}

static void put_box(struct climb *k, struct layer *l, struct faces *f)
{
    l->boxes += f->touched > 0;
    while (faces_loop(f)) {
        const size_t more = (size_t)f->loop.count - 2;
        l->failed = l->failed || !grow_layer(l, more);
        for (int i = 0; i < f->loop.count; i++)
            mark(k, f->loop.key[i]);
        if (l->failed)
            continue;
        loop_cut(&f->loop, l->triangle + l->triangles);
        l->triangles += more;
    }
}

static bool begins(int at, uint8_t level)
{
    return !(at & ((1 << level) - 1));
}

static void put_block(struct climb *k, struct layer *l, struct worker *w, const int at[3])
{
    struct block *b = &w->block;
    const int32_t state = *state_at(k, at[0], at[1], at[2]);
    const struct neighbours beyond = neighbours_of(k, at);
    struct box box = {{0}, {0}};
    block_load(b, k->g, k->side, at);
    faces_begin_block(&w->faces, b, &beyond);
    if (state == ONE_BOX) {
        memset(box.level, b->levels, sizeof box.level);
        faces_draw(&w->faces, &box);
        put_box(k, l, &w->faces);
        return;
    }
    memcpy(b->owner, l->owners + (size_t)state * block_bytes(k), block_bytes(k));
    for (int z = 0; z < b->cells[2]; z++)
        for (int y = 0; y < b->cells[1]; y++)
            for (int x = 0; x < b->cells[0]; x += 1 << box.level[0]) {
                box = (struct box){{(uint8_t)x, (uint8_t)y, (uint8_t)z}, {0}};
                owner_levels(box.level, *block_owner(b->owner, b->side, x, y, z));
                if (!begins(y, box.level[1]) || !begins(z, box.level[2]))
                    continue;
                faces_draw(&w->faces, &box);
                put_box(k, l, &w->faces);
            }
}

static void put_layer(void *context, size_t z, int worker)
{
    struct climb *k = context;
    struct layer *l = &k->layer[z];
    struct worker *w = &k->worker[worker];
    const size_t before = w->faces.ambiguous;
    for (int y = 0; y < k->blocks[1]; y++)
        for (int x = 0; x < k->blocks[0]; x++)
            if (*state_at(k, x, y, (int)z) != EMPTY)
                put_block(k, l, w, (const int[3]){x, y, (int)z});
    l->ambiguous = w->faces.ambiguous - before;
}

// ---------------------------------------------------------------- vertices

static uint32_t vertex_of(const struct climb *k, uint64_t key)
{
    const size_t line = key >> 16;
    const int x = (int)(key & 0xffff);
    const uint64_t *word = k->used + line * (size_t)k->g->words;
    uint32_t number = k->vertices->first[line];
    for (int w = 0; w < x >> 6; w++)
        number += (uint32_t)signs_count(word[w]);
    return number + (uint32_t)signs_count(word[x >> 6] & (((uint64_t)1 << (x & 63)) - 1));
}

static void number_layer(void *context, size_t z, int worker)
{
    (void)worker;
    const struct climb *k = context;
    const struct layer *l = &k->layer[z];
    uint32_t(*out)[3] = k->triangle + k->first[z];
    for (size_t i = 0; i < 3 * l->triangles; i++)
        out[i / 3][i % 3] = vertex_of(k, l->triangle[i / 3][i % 3]);
}

static relume_status put(struct relume_mesh *out, struct climb *k, struct numbering *vertices,
                         size_t triangles)
{
    relume_status status = numbering_create(vertices, k->g, k->used);
    if (status)
        return status;
    out->position = mem_array(vertices->count, sizeof *out->position);
    out->normal = mem_array(vertices->count, sizeof *out->normal);
    out->triangle = k->triangle = mem_array(triangles, sizeof *out->triangle);
    if (!out->position || !out->normal || !out->triangle)
        return RELUME_ENOMEM;
    out->vertex_count = vertices->count;
    out->triangle_count = triangles;
    k->vertices = vertices;
    thread_for(k->g->threads, (size_t)k->blocks[2], number_layer, k);
    numbering_put(vertices, k->g, out);
    return RELUME_OK;
}

static relume_status finish(struct relume_mesh *out, struct relume_isosurface_report *report,
                            struct climb *k)
{
    struct numbering vertices = {.used = NULL};
    size_t triangles = 0;
    bool failed = false;
    for (int z = 0; z < k->blocks[2]; z++) {
        const struct layer *l = &k->layer[z];
        k->first[z] = triangles;
        triangles += l->triangles;
        report->boxes += l->boxes;
        report->ambiguous += l->ambiguous;
        failed |= l->failed;
    }
    relume_status status = failed                   ? RELUME_ENOMEM
                           : triangles > UINT32_MAX ? RELUME_ELIMIT
                                                    : put(out, k, &vertices, triangles);
    numbering_free(&vertices);
    return status;
}

static relume_status climb_volume(struct relume_mesh *out, struct relume_isosurface_report *report,
                                  struct climb *k)
{
    const struct signs *g = k->g;
    if (!signs_round(g, (size_t)k->blocks[2], climb_layer, k, 0.0, 0.6))
        return RELUME_ECANCEL;
    for (int z = 0; z < k->blocks[2]; z++)
        if (k->layer[z].failed)
            return RELUME_ENOMEM;
    for (int i = 0; i < g->threads; i++)
        faces_begin(&k->worker[i].faces, g, k->share);
    if (!signs_round(g, (size_t)k->blocks[2], put_layer, k, 0.6, 0.9))
        return RELUME_ECANCEL;
    return finish(out, report, k);
}

relume_status climb_mesh(struct relume_mesh *out, struct relume_isosurface_report *report,
                         const struct signs *g, int block, bool share)
{
    struct climb k = {.g = g, .side = block, .share = share};
    for (int c = 0; c < 3; c++)
        k.blocks[c] = (g->size[c] - 2) / block + 1;
    const size_t layers = (size_t)k.blocks[2];
    const size_t blocks = (size_t)k.blocks[0] * (size_t)k.blocks[1] * layers;
    k.state = mem_array(blocks, sizeof *k.state);
    k.layer = mem_zeroed(layers, sizeof *k.layer);
    k.worker = mem_array((size_t)g->threads, sizeof *k.worker);
    k.used = mem_zeroed(3 * g->rows, (size_t)g->words * sizeof *k.used);
    k.first = mem_array(layers, sizeof *k.first);
    if (k.state)
        memset(k.state, 0xff, blocks * sizeof *k.state);  // EMPTY
    const relume_status status = k.state && k.layer && k.worker && k.used && k.first
                                     ? climb_volume(out, report, &k)
                                     : RELUME_ENOMEM;
    for (size_t z = 0; k.layer && z < layers; z++) {
        mem_free(k.layer[z].owners);
        mem_free(k.layer[z].triangle);
    }
    mem_free(k.state);
    mem_free(k.layer);
    mem_free(k.worker);
    mem_free(k.used);
    mem_free(k.first);
    return status;
}
