// source.h - a view of a relume file as numbers that its sRGB-coded picture depends on linearly
//
//     picture_c(l) = constant_c(l) + sum_p weights_{c,p}(l) x_p
// with x_p the coefficients where they live in sRGB codes; where they do not, x are the coded
// pictures themselves under a set of directions, with an interpolation between them. A source that
// is whole takes other codings, linear light too, as they are.
#ifndef FOREIGN_SOURCE_H
#define FOREIGN_SOURCE_H

#include <relume/format/coder.h>

struct source {
    const struct relume_codes *codes;
    int width, height;
    int numbers;  // P
    int lights;   // directions that the file was made from, or that stand in for them
    struct relume_vec3 *light;
    struct relume_transfer coding;  // of the picture: sRGB, or what a whole source comes in
    relume_coder *between;          // interpolation between pictures; NULL: x are coefficients
    const struct relume_log *log;
};

// As what a file is taken.
enum source_kind {
    SOURCE_UPPER,  // sRGB and the hemisphere around z, which is all that other formats know
    SOURCE_WHOLE,  // its own coding; light from below the horizon and from every side counts too
    SOURCE_CODED,  // likewise, but in sRGB
};
relume_status source_open(struct source *s, const struct relume_codes *codes, enum source_kind kind,
                          const struct relume_log *log);
void source_close(struct source *s);

// In what a whole source comes: the file's coding, where it is a curve that everybody knows; else
// sRGB.
struct relume_transfer source_coding(enum relume_domain domain, struct relume_transfer display);

// x of `rows` rows from `row` on, out[P][rows][width]. Safe to call from several threads.
relume_status source_rows(const struct source *s, int row, int rows, float *out);
// weights[3][P + 1] at a unit direction; the last of each channel is its constant.
void source_weights(const struct source *s, struct relume_vec3 light, double *weights);

// Mean and covariance of x over the picture, [P] and [P][P]; large pictures are sampled evenly.
relume_status source_statistics(const struct source *s, int threads, double *mean,
                                double *covariance);

#endif
