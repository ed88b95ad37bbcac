// code_search_pieces.c - what a member of a team has found: whether any code has changed, and then
// the index, distance and margin of each vector of its share
#include "format/codebook/code_search.h"

static void hand_in(const void *results, struct piece_writer *to)
{
    const struct code_search *s = results;
    const size_t n = s->end - s->first;
    const unsigned char changed = atomic_load(&s->changed);
    piece_put(to, &changed, 1);
    piece_put(to, s->index + s->first, n * sizeof *s->index);
    piece_put(to, s->distance + s->first, n * sizeof *s->distance);
    piece_put(to, s->apart + s->first, n * sizeof *s->apart);
}

static relume_status fetch(void *results, struct piece_reader *from)
{
    struct code_search *s = results;
    const size_t n = s->end - s->first;
    unsigned char changed = 0;
    piece_get(from, &changed, 1);
    piece_get(from, s->index + s->first, n * sizeof *s->index);
    piece_get(from, s->distance + s->first, n * sizeof *s->distance);
    piece_get(from, s->apart + s->first, n * sizeof *s->apart);
    atomic_store(&s->changed, changed != 0);
    for (size_t i = s->first; !from->damaged && i < s->end; i++)
        if (s->index[i] >= s->nearest->codes)
            return RELUME_EDAMAGED;
    return RELUME_OK;
}

const struct team_bytes code_search_bytes = {hand_in, fetch};
