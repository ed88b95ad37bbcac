// code_search.h - the nearest code of every vector, found by threads and by the members of a team
#ifndef CODEBOOK_CODE_SEARCH_H
#define CODEBOOK_CODE_SEARCH_H

#include "format/codebook/nearest.h"
#include "format/team/share.h"

#include <stdatomic.h>

struct code_search {
    const float *vectors, *codes;  // [n][dim], [codes][dim]
    size_t n;
    uint16_t *index;                 // [n]: the code of each vector, before and after
    double *distance;                // [n], squared
    float *apart;                    // [n]: at most the distance to any other code
    const double *drift, *furthest;  // of training (codebook.h); NULL: every vector is looked at
    const struct relume_team *team;  // or NULL
    bool any_changed;                // whether a vector has another code than before

    // Set by the search.
    const struct nearest *nearest;
    float *scratch;  // [workers][nearest_scratch]
    int threads;
    size_t first, end;    // the vectors of the share in progress
    atomic_bool changed;  // in that share
};

// Fills index, distance, apart and any_changed. RELUME_ENOMEM, and what sharing returns.
relume_status code_search_find(struct code_search *s, int codes, int dim, int threads,
                               unsigned cpu_off, const struct relume_log *log);

// Results of a share as a piece (code_search_pieces.c).
extern const struct team_bytes code_search_bytes;  // of a struct code_search

#endif
