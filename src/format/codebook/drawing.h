// drawing.h - the pixels of all views that codebooks learn from, drawn by the members of a team
#ifndef CODEBOOK_DRAWING_H
#define CODEBOOK_DRAWING_H

#include "format/coder/coding.h"
#include "format/coder/coefficients.h"
#include "format/team/share.h"

// Members of a team that learn books together: each has the coefficients of its own views, and
// `encode` makes those of another view.
struct books_team {
    const struct relume_team *team;
    relume_status (*encode)(void *user, int view, relume_coefficients **out);
    void *user;
};

struct drawing {
    const relume_coefficients *const *views;  // [count]; NULL: `by` encodes it
    int count;
    size_t pixels, wanted;  // in all views; to be drawn
    uint64_t seed;
    const struct books_team *by;  // or NULL
    const struct relume_coefficients_info *info;
    const struct relume_log *log;
    float *to;                  // [wanted][planes]
    size_t at;                  // floats of the shares before
    struct encode_share share;  // in progress
    size_t drawn;               // its floats, behind `at`
};

static inline size_t drawing_floats(const struct drawing *d)
{
    return d->wanted * (size_t)d->info->planes;
}

// The floats of a share, as a piece (drawing_pieces.c).
extern const struct team_bytes drawing_bytes;  // of a struct drawing

#endif
