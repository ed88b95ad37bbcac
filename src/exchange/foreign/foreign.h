// foreign.h - a picture of another format: planes of 8-bit codes, and what they mean
//
// With f(l) the format's own functions of the light and C_p the coefficient planes,
//     channels   value_c(l) = sum_k C_{3k+c} T_k . f(l)
//     luminance  value_c(l) = C_{K+c} sum_k C_k T_k . f(l)
//     joint      value_c(l) = M_c . f(l) + sum_k C_k T_{c,k} . f(l)
//     ycc        Y(l) = sum_k C_k f_k(l), Cb = C_K, Cr = C_{K+1} for every light, then JPEG's RGB;
//                only for writing: what is read of it is joint
// T being `transform` and M `mean`.
#ifndef FOREIGN_FOREIGN_H
#define FOREIGN_FOREIGN_H

#include <relume/base.h>

#include "exchange/foreign/functions.h"

enum foreign_form { FOREIGN_CHANNELS, FOREIGN_LUMINANCE, FOREIGN_JOINT, FOREIGN_YCC };

enum { FOREIGN_MOST_PLANES = 1024 };

struct foreign {
    int width, height;
    bool linear;  // values are linear light; else sRGB codes
    enum foreign_form form;
    struct functions functions;
    int terms;              // K
    double *transform;      // [K][functions], joint: [3][K][functions]; NULL: the identity
    double *mean;           // joint: [3][functions]
    int planes;             // 3 K, K + 3 or K
    uint8_t *codes;         // [planes][height][width]
    float *scale, *offset;  // [planes]: C = code * scale + offset, 1 is white
    float knee;             // joint: not 0: C counts knee + |C_0| times
};

// Space for `planes` planes. RELUME_ELIMIT with a sentence when the size is over the limits.
relume_status foreign_create(struct foreign *f, const char *path, long width, long height,
                             int planes, const struct relume_limits *limits,
                             const struct relume_log *log);
void foreign_free(struct foreign *f);

// JPEG's YCbCr -> RGB.
extern const double foreign_rgb_of_ycc[3][3];

static inline size_t foreign_pixels(const struct foreign *f)
{
    return (size_t)f->width * (size_t)f->height;
}

// Row c of weights[3][K] and constant[c] at a unit direction: what the transform and the mean give.
// Forms without joint planes have three equal rows.
void foreign_weights(const struct foreign *f, struct relume_vec3 light, double *weights,
                     double constant[3]);

// The value of a coefficient plane at a pixel.
static inline double foreign_coefficient(const struct foreign *f, int plane, size_t pixel)
{
    return (double)f->codes[(size_t)plane * foreign_pixels(f) + pixel] * (double)f->scale[plane] +
           (double)f->offset[plane];
}

#endif
