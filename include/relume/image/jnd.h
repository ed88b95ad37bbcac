// jnd.h - differences as eyes see them, in steps that are just noticeable (JND)
//
// Linear light becomes responses of the cones, each on a scale on which one step is one per cent in
// daylight and more in the dark, then white-black, red-green and blue-yellow (Guthe 2008, chapter
// 10, after Burbeck and Kelly 1980 and Mantiuk, Myszkowski, Seidel 2004). How fine a pattern is
// decides how well it is seen: a sinusoid of amplitude a on that scale is seen when
// a C(f) >= td, with the contrast sensitivity C (Tab. 10.1) and the threshold td, which is 1 and
// rises where another pattern of that fineness masks it (Daly 1993).
#ifndef RELUME_JND_H
#define RELUME_JND_H

#include <relume/base.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// How somebody looks at two pictures. Borrowed during the call.
struct relume_jnd_params {
    size_t struct_size;        // filled by the macro (base.h)
    int threads;               // default: all cores
    double pixels_per_degree;  // at the eye, (0, 1000]; default 40: a desktop screen at 60 cm
    double white;              // cd/m^2 of white, (0, 1e6]; default 200
    const struct relume_image *mask;  // one channel, counts where > 0.5; NULL: everywhere
    bool unmasked;                    // patterns do not hide others
};
#define relume_jnd_params(...)                                                                     \
    (&(const struct relume_jnd_params){RELUME_SIZED(relume_jnd_params), __VA_ARGS__})

// What is seen of a difference. Shares are of the pixels compared.
struct relume_jnd {
    double mean, max;  // JND
    double most;       // JND that 1 % of the pixels exceed
    double seen;       // share above 1 JND
    size_t pixels;     // compared
};
// The difference of two pictures in JND: that of the opponent channels in seven bands of fineness,
// each over its threshold, added up; of the channels the largest. `map` (or NULL) gets it for each
// pixel, one channel; it is empty on failure. Both images must have 3 channels and equal sizes,
// params their ranges, else RELUME_EINVAL. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_image_jnd(struct relume_jnd *out, struct relume_image *map,
                                             const struct relume_image *image,
                                             const struct relume_image *reference,
                                             const struct relume_jnd_params *params);

// How likely a difference is seen. Shares are of the pixels compared.
struct relume_vdp {
    double p75, p95;  // share of pixels where it is seen with more than 75 and 95 per cent
    double mean;      // probability
    size_t pixels;    // compared
};
// A visible differences predictor for high dynamic range in brief (Daly 1993; Mantiuk, Myszkowski,
// Seidel 2004): the white channel in seven bands of fineness by six of direction, each masked by
// itself; a difference of d thresholds is seen with the probability 1 - 2^-(d^3.5), and of all
// bands together. Without the optics of the eye, which C holds, and without uncertainty of phase.
// Otherwise as relume_image_jnd.
RELUME_RESULT relume_status relume_image_vdp(struct relume_vdp *out, struct relume_image *map,
                                             const struct relume_image *image,
                                             const struct relume_image *reference,
                                             const struct relume_jnd_params *params);

// The colours of a rendering beside a photograph: the 3 x 3 matrix that takes `image` nearest to
// `reference` (least squares in linear light, where `mask` > 0.5; NULL: everywhere).
// RELUME_EINVAL for wrong sizes, RELUME_EUNFIT where colours do not tell a matrix.
RELUME_RESULT relume_status relume_colours_fit(double matrix[3][3],
                                               const struct relume_image *image,
                                               const struct relume_image *reference,
                                               const struct relume_image *mask);
// Apply it to every pixel in place. RELUME_EINVAL unless there are 3 channels.
RELUME_RESULT relume_status relume_colours_apply(struct relume_image *image,
                                                 const double matrix[3][3]);

#ifdef __cplusplus
}
#endif
#endif
