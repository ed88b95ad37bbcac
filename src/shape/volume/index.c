// index.c - the ranges of values in the bricks of a volume (span space: Livnat, Shen, Johnson 1996)
#include "shape/volume/volume.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

// A brick has the first samples of its upper neighbours, too, so that a surface that goes between
// them is in it.
static void range_of_brick(const relume_volume *v, int x0, int y0, int z0, float range[2])
{
    const int x1 = x0 + BRICK_X < v->size[0] ? x0 + BRICK_X : v->size[0] - 1;
    const int y1 = y0 + BRICK_Y < v->size[1] ? y0 + BRICK_Y : v->size[1] - 1;
    const int z1 = z0 + BRICK_Z < v->size[2] ? z0 + BRICK_Z : v->size[2] - 1;
    float least = volume_sample(v, volume_at(v, x0, y0, z0)), most = least;
    for (int z = z0; z <= z1; z++)
        for (int y = y0; y <= y1; y++) {
            const size_t row = volume_at(v, 0, y, z);
            for (int x = x0; x <= x1; x++) {
                const float value = volume_sample(v, row + (size_t)x);
                least = value < least ? value : least;
                most = value > most ? value : most;
            }
        }
    range[0] = least;
    range[1] = most;
}

static void index_layer(void *context, size_t z, int worker)
{
    (void)worker;
    const relume_volume *v = context;
    const struct volume_index *i = &v->index;
    float(*range)[2] = i->range + z * (size_t)i->bricks[0] * (size_t)i->bricks[1];
    for (int y = 0; y < i->bricks[1]; y++)
        for (int x = 0; x < i->bricks[0]; x++)
            range_of_brick(v, BRICK_X * x, BRICK_Y * y, BRICK_Z * (int)z, *range++);
}

relume_status relume_volume_index(relume_volume *v, int threads)
{
    const int side[3] = {BRICK_X, BRICK_Y, BRICK_Z};
    size_t bricks = 1;
    if (v->index.range)
        return RELUME_OK;
    for (int c = 0; c < 3; c++) {
        v->index.bricks[c] = (v->size[c] + side[c] - 1) / side[c];
        bricks *= (size_t)v->index.bricks[c];
    }
    v->index.range = mem_array(bricks, sizeof *v->index.range);
    if (!v->index.range)
        return RELUME_ENOMEM;
    thread_for(thread_count(threads), (size_t)v->index.bricks[2], index_layer, v);
    return RELUME_OK;
}
