// sampling_pieces.c - what a member of a team has sampled: the number of pixels, and then their
// values, light by light
#include "encode/choose/sampling.h"

static void hand_in(const void *results, struct piece_writer *to)
{
    const struct sampling *g = results;
    const uint64_t pixels = g->shared;
    piece_put(to, &pixels, sizeof pixels);
    for (size_t i = 0; i < (size_t)g->out->lights; i++)
        piece_put(to, sampling_row(g, i), g->shared * 3 * sizeof(float));
}

static relume_status fetch(void *results, struct piece_reader *from)
{
    struct sampling *g = results;
    uint64_t pixels = 0;
    if (!piece_get(from, &pixels, sizeof pixels) || pixels > g->count - g->out->pixels)
        return RELUME_EDAMAGED;
    g->shared = (size_t)pixels;
    for (size_t i = 0; i < (size_t)g->out->lights; i++)
        piece_get(from, sampling_row(g, i), g->shared * 3 * sizeof(float));
    return RELUME_OK;
}

const struct team_bytes sampling_bytes = {hand_in, fetch};
