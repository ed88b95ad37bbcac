// planes.h - the planes of a plan as numbers for every pixel, in scratch space on disk
#ifndef FOREIGN_PLANES_H
#define FOREIGN_PLANES_H

#include "exchange/foreign/plan.h"

struct planes {
    int width, height, count;
    float *data;                // [count][height][width]
    double *minimum, *maximum;  // [count]
};

// Temporary data goes beside `near`. RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL.
relume_status planes_make(struct planes *out, const struct plan *plan, const struct source *s,
                          const char *near, int threads);
// Every `every`-th row of blocks of `p`, for quick trials; 1: all of it.
relume_status planes_sample(struct planes *out, const struct planes *p, int every, const char *near,
                            const struct relume_log *log);
void planes_free(struct planes *p);

// Half the size, rounded up: the mean of the one to four values that a pixel covers. The caller
// frees it; NULL when memory is short.
float *plane_halved(const float *from, int width, int height);

static inline const float *planes_at(const struct planes *p, int plane)
{
    return p->data + (size_t)plane * (size_t)p->width * (size_t)p->height;
}

#endif
