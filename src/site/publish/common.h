// common.h - one set of principal components for all views of a file, and what the light makes
// of it
//
// With f(l) the raw functions of the file's own basis (or of an interpolation between pictures,
// source.h) a page shows, in the codes of the source,
//     value_c(l) = mean_c . f(l) + sum_k C_k transform_{c,k} . f(l)
// and nothing is approximated but the picture's numbers, by as many components as there are. Those
// of linear light are turned for a guide (guide.h).
#ifndef PUBLISH_COMMON_H
#define PUBLISH_COMMON_H

#include "exchange/foreign/plan.h"

#include <relume/pack.h>

struct common {
    enum source_kind kind;
    bool guided;           // linear light
    struct plan plan;      // joint, without functions of its own
    struct source source;  // of the first view that was looked at; its weights are those of all
    relume_coder *raw;     // whose weights are f, without any transform
    int functions;         // F
    float *transform;      // [3][planes][F]
    float *mean;           // [3][F]
};

// At most `planes`. Errors of reading; RELUME_ENOMEM, RELUME_ECANCEL.
relume_status common_find(struct common *c, relume_pack *pack, enum source_kind kind, int planes,
                          int threads, const struct relume_log *log);
// Keep the first `planes`, which is what transform then has.
void common_keep(struct common *c, int planes);
// Row c of weights[3][planes] and constant[c] at a unit direction.
void common_weights(const struct common *c, struct relume_vec3 light, double *weights,
                    double constant[3]);
void common_free(struct common *c);

#endif
