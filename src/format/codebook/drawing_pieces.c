// drawing_pieces.c - what a member of a team has drawn: a zero, so that a piece is never empty, and
// the floats of its pixels
#include "format/codebook/drawing.h"

static void hand_in(const void *results, struct piece_writer *to)
{
    const struct drawing *d = results;
    const float first = 0.0f;
    piece_put(to, &first, sizeof first);
    piece_put(to, d->to + d->at, d->drawn * sizeof *d->to);
}

static relume_status fetch(void *results, struct piece_reader *from)
{
    struct drawing *d = results;
    float first;
    if (!piece_get(from, &first, sizeof first))
        return RELUME_EDAMAGED;
    d->drawn = piece_left(from) / sizeof *d->to;
    if (d->drawn > drawing_floats(d) - d->at)
        return RELUME_EDAMAGED;
    piece_get(from, d->to + d->at, d->drawn * sizeof *d->to);
    return RELUME_OK;
}

const struct team_bytes drawing_bytes = {hand_in, fetch};
