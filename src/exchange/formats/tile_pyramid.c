// tile_pyramid.c - planes cut into tiles at full size, at half of it, at a quarter, ...
#include "exchange/formats/tile_pyramid.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "exchange/foreign/planes.h"

#include <string.h>

// A level being written.
struct level_writer {
    const struct tile_pyramid *pyramid;
    struct tile_level level;
    struct tile_file (*files)[TILE_FILES];  // [rows * columns]
    relume_status *status;                  // [rows * columns]
};

void tile_copy(float *to, const struct tile *tile, int plane)
{
    const size_t stride = (size_t)tile->level->width, width = (size_t)tile->at.width;
    const float *from =
        tile->level->plane[plane] + (size_t)tile->at.top * stride + (size_t)tile->at.left;
    for (size_t y = 0; y < (size_t)tile->at.height; y++)
        memcpy(to + y * width, from + y * stride, width * sizeof *to);
}

static struct tile tile_at(const struct level_writer *w, size_t index)
{
    const struct tile_level *l = &w->level;
    const int side = w->pyramid->side, overlap = w->pyramid->overlap;
    const int column = (int)index % l->columns, row = (int)index / l->columns;
    const int left = larger_of(column * side - overlap, 0),
              top = larger_of(row * side - overlap, 0);
    return (struct tile){
        .level = l,
        .column = column,
        .row = row,
        .at = {left, top, smaller_of((column + 1) * side + overlap, l->width) - left,
               smaller_of((row + 1) * side + overlap, l->height) - top},
    };
}

static void encode_tile(void *context, size_t index, int worker)
{
    (void)worker;
    const struct level_writer *w = context;
    const struct tile tile = tile_at(w, index);
    w->status[index] = w->pyramid->encode(w->pyramid->user, &tile, w->files[index]);
}

static relume_status save_tiles(const struct level_writer *w, size_t count)
{
    relume_status status = RELUME_OK;
    for (int number = 0; number < TILE_FILES; number++)
        for (size_t i = 0; !status && i < count; i++) {
            const struct tile tile = tile_at(w, i);
            if (w->files[i][number].bytes)
                status = w->pyramid->save(w->pyramid->user, &tile, number, &w->files[i][number]);
        }
    return status;
}

static relume_status write_level(struct level_writer *w)
{
    const int side = w->pyramid->side;
    w->level.columns = (w->level.width + side - 1) / side;
    w->level.rows = (w->level.height + side - 1) / side;
    const size_t count = (size_t)w->level.columns * (size_t)w->level.rows;
    w->files = mem_zeroed(count, sizeof *w->files);
    w->status = mem_zeroed(count, sizeof *w->status);
    relume_status status = w->files && w->status ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        thread_for(w->pyramid->threads, count, encode_tile, w);
    for (size_t i = 0; !status && i < count; i++)
        status = w->status[i];
    if (!status)
        status = save_tiles(w, count);
    for (size_t i = 0; w->files && i < TILE_FILES * count; i++)
        mem_free(w->files[i / TILE_FILES][i % TILE_FILES].bytes);
    mem_free(w->files);
    mem_free(w->status);
    return status;
}

// Replaces the planes by planes of half the size. `owned` has those that were made here.
static relume_status halve_level(struct tile_level *l, const float **plane, float **owned,
                                 int planes)
{
    for (int p = 0; p < planes; p++) {
        float *half = plane_halved(plane[p], l->width, l->height);
        if (!half)
            return RELUME_ENOMEM;
        mem_free(owned[p]);
        plane[p] = owned[p] = half;
    }
    l->number++;
    l->width = (l->width + 1) / 2;
    l->height = (l->height + 1) / 2;
    return RELUME_OK;
}

relume_status tile_pyramid_write(const struct tile_pyramid *pyramid)
{
    const size_t planes = (size_t)pyramid->planes;
    const float **plane = mem_copy(pyramid->plane, planes, sizeof *plane);
    float **owned = mem_zeroed(planes, sizeof *owned);
    struct level_writer w = {
        .pyramid = pyramid,
        .level = {.width = pyramid->width, .height = pyramid->height, .plane = plane},
    };
    relume_status status = plane && owned ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < pyramid->levels; i++) {
        status = i ? halve_level(&w.level, plane, owned, pyramid->planes) : RELUME_OK;
        if (!status)
            status = write_level(&w);
    }
    for (size_t p = 0; owned && p < planes; p++)
        mem_free(owned[p]);
    mem_free(owned);
    mem_free(plane);
    return status;
}
