// plan.h - which planes another format gets: C = map x + shift, and how its viewers read them
#ifndef EXCHANGE_PLAN_H
#define EXCHANGE_PLAN_H

#include "exchange/foreign.h"
#include "exchange/source.h"

struct plan {
    enum foreign_form form;
    struct functions functions;  // lights borrowed from the source
    int terms, planes;
    int numbers;        // P of the source
    double *map;        // [planes][P]
    double *shift;      // [planes]
    double *transform;  // joint: [3][K][functions]
    double *mean;       // joint: [3][functions]
    // Root of the squared error, summed over the channels and averaged over the lights, that an
    // error of 1 in the plane makes.
    double *weight;
    // The same squared error of the picture itself: what the functions cannot follow, and what each
    // plane would add if it were left out.
    double lost;
    double *energy;
};

// Principal components of the pictures as a viewer shows them that interpolates by `functions`
// (gauss or grid). RELUME_EDATA when the source has no variance at all, RELUME_ENOMEM.
relume_status plan_components(struct plan *p, const struct source *s,
                              const struct functions *functions, int planes, int threads);

// Least squares on the picture's values with the functions ptm, hsh or sh. `form`: channels;
// luminance, one set for all channels, times a colour (the rows of `map` for the terms then give
// the sum of the channels, those of the colour the base colour; the terms are to be divided by its
// sum); or ycc.
relume_status plan_fit(struct plan *p, const struct source *s, const struct functions *functions,
                       enum foreign_form form, int threads);
void plan_free(struct plan *p);

#endif
