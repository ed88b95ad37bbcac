// array.c - results that are one array of numbers
#include "format/team/array.h"

static void hand_in(const void *results, struct piece_writer *to)
{
    const struct team_array *a = results;
    piece_put(to, a->items, a->size);
}

static relume_status fetch(void *results, struct piece_reader *from)
{
    const struct team_array *a = results;
    return piece_get(from, a->items, a->size) ? RELUME_OK : RELUME_EDAMAGED;
}

const struct team_bytes team_array_bytes = {hand_in, fetch};
