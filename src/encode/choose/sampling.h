// sampling.h - pixels of a capture under all its lights, read by the members of a team
#ifndef CHOOSE_SAMPLING_H
#define CHOOSE_SAMPLING_H

#include "format/coder/coefficients.h"
#include "format/team/share.h"

struct sampling {
    const relume_capture *capture;
    struct relume_project_params p;
    struct relume_transfer display;
    size_t *pixel;  // [count]: which are looked at, by number over all views, ascending
    size_t count;
    // Rows of lights for `count` pixels; `pixels` are those of the shares before.
    struct relume_samples *out;

    // The share in progress: the chosen pixels `next` .. `end` are still to be read, and `shared`
    // have been, those that the mask holds.
    struct encode_share share;
    size_t next, end, shared;
};

// Target of the share's pixels in the row of a light, three floats each.
static inline float *sampling_row(const struct sampling *g, size_t light)
{
    return g->out->data + 3 * (light * g->count + g->out->pixels);
}

// The pixels of a share, as a piece (sampling_pieces.c).
extern const struct team_bytes sampling_bytes;  // of a struct sampling

#endif
