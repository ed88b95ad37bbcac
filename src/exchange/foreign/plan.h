// plan.h - which planes another format gets: C = map x + shift, and how its viewers read them
#ifndef FOREIGN_PLAN_H
#define FOREIGN_PLAN_H

#include "exchange/foreign/foreign.h"
#include "exchange/foreign/source.h"

struct plan {
    enum foreign_form form;
    struct functions functions;  // lights borrowed from the source
    int terms, planes;
    int chroma;     // joint: planes of each chroma, planes 3 t + k, t < chroma, for component k of
                    // (Y, a, b), the rest for Y; 0: of R, G and B
    int numbers;    // P of the source
    double *map;    // [planes][P]
    double *shift;  // [planes]
    double *transform;  // joint: [3][K][functions], of R, G, B or Y, a, b
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
// (gauss or grid). RELUME_ENOMEM, and what source_statistics returns.
relume_status plan_components(struct plan *p, const struct source *s,
                              const struct functions *functions, int planes, int threads);

// The same with planes for luminance and chroma apart, [Y, C, C] of them, at least 3; C is at most
// `most_chroma`.
relume_status plan_yab(struct plan *p, const struct source *s, const struct functions *functions,
                       int planes, int most_chroma, int threads);

// Least squares on the picture's values with the functions ptm, hsh or sh. `form`: channels;
// luminance, one set for all channels, times a colour (the rows of `map` for the terms then give
// the sum of the channels, those of the colour the base colour; divide the terms by its
// sum); or ycc.
relume_status plan_fit(struct plan *p, const struct source *s, const struct functions *functions,
                       enum foreign_form form, int threads);
void plan_free(struct plan *p);

#endif
