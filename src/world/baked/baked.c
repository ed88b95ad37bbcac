// baked.c - the life of a baked object
#include "world/baked/baked.h"

#include "core/base/log.h"
#include "core/base/memory.h"

#include <math.h>
#include <string.h>

// In memory, or as the file has it before it packs: halves in place of floats.
static uint64_t bytes_of(const relume_baked *b, bool stored)
{
    const uint64_t number = stored ? 2 : 4,
                   whole = (uint64_t)b->info.width * (uint64_t)b->info.height;
    const uint64_t texel = (uint64_t)b->blocks * (2 + number * (uint64_t)b->info.components) +
                           (stored && b->info.side == 1 ? 0 : 6 * number);
    return whole * texel +
           (uint64_t)b->vectors * (uint64_t)b->kept * (3 * number + (b->info.cube ? 2 : 0)) +
           (uint64_t)b->info.triangles * sizeof *b->triangle;
}

relume_status baked_make(relume_baked *b, const struct relume_limits *limits,
                         const struct relume_log *log)
{
    const size_t texels = (size_t)b->info.width * (size_t)b->info.height;
    const size_t n = texels * (size_t)b->blocks;
    const int views = b->info.side * b->info.side;
    b->vectors = (size_t)b->blocks * (size_t)b->info.clusters * (size_t)(1 + b->info.components) *
                 (size_t)(views / b->blocks);
    b->info.bytes = bytes_of(b, true);
    const relume_status status = limits_memory(limits, bytes_of(b, false), "the baked object", log);
    if (status)
        return status;
    b->cluster = mem_array(n, sizeof *b->cluster);
    b->weight = mem_zeroed(n * (size_t)b->info.components, sizeof *b->weight);
    b->frame = mem_zeroed(texels, sizeof *b->frame);
    b->value = mem_zeroed(b->vectors * (size_t)b->kept, 3 * sizeof *b->value);
    if (b->info.cube)
        b->place = mem_zeroed(b->vectors * (size_t)b->kept, sizeof *b->place);
    if (b->cluster)
        memset(b->cluster, 0xff, n * sizeof *b->cluster);
    return b->cluster && b->weight && b->frame && b->value && (!b->info.cube || b->place)
               ? RELUME_OK
               : RELUME_ENOMEM;
}

void relume_baked_destroy(relume_baked **baked)
{
    relume_baked *b = *baked;
    *baked = NULL;
    if (!b)
        return;
    basis_free(&b->basis);
    mem_free(b->triangle);
    mem_free(b->cluster);
    mem_free(b->weight);
    mem_free(b->frame);
    mem_free(b->place);
    mem_free(b->value);
    mem_free(b);
}

const struct relume_baked_info *relume_baked_info(const relume_baked *baked)
{
    return &baked->info;
}

void relume_baked_box(float box[2][3], const relume_baked *baked)
{
    for (int c = 0; c < 3; c++) {
        box[0][c] = INFINITY;
        box[1][c] = -INFINITY;
        for (size_t i = 0; i < 3 * baked->info.triangles; i++) {
            const float v = baked->triangle[i / 3][i % 3].position[c];
            box[0][c] = fminf(box[0][c], v);
            box[1][c] = fmaxf(box[1][c], v);
        }
    }
}
