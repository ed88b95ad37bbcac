// response.h - from exposure brackets to radiance: the camera's response, and the merge
//
// Brackets are `n` images of equal size, three channels of code values with 1 as full scale
// (relume_photograph_load with `codes`), aligned, and their exposures in seconds or any common
// unit.
#ifndef RELUME_RESPONSE_H
#define RELUME_RESPONSE_H

#include <relume/base.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { RELUME_CODES = 256 };

// Code value -> exposure (radiance x time), per channel, never falling. Entry i belongs to code
// i / 255; between them it is linear. Thread-safety: plain data.
struct relume_response {
    float exposure[3][RELUME_CODES];  // [channel][code]: the exposure of a code
};

// `code` in [0, 1]; others are clamped.
RELUME_API float relume_response_decode(const struct relume_response *response, int channel,
                                        float code);
// A known curve as a response.
RELUME_API void relume_response_of(struct relume_response *out, struct relume_transfer transfer);

// A text file: the line "relume-response 1", then 256 lines "code red green blue". Lines that begin
// with # are skipped. Returns an input status (not such a file, negative, falling, not finite) and
// RELUME_EIO.
RELUME_RESULT relume_status relume_response_load(struct relume_response *out, const char *path,
                                                 const struct relume_log *log);
// Write it as relume_response_load reads it. RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_response_save(const struct relume_response *response,
                                                 const char *path, const struct relume_log *log);

// How a response is recovered. Borrowed during the call.
struct relume_recover_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int samples;        // places that are looked at; default 400
    double smoothness;  // weight of the second differences; default 20
    // [n], one channel: places where one is 0 (outside of a warped picture, a ghost) are not looked
    // at; empty image: all are; or NULL
    const struct relume_image *masks;
};
#define relume_recover_params(...)                                                                 \
    (&(const struct relume_recover_params){RELUME_SIZED(relume_recover_params), __VA_ARGS__})

// The response from a bracket (Debevec, Malik 1997, Eq. 3: least squares of
// g(z_ij) - ln E_i - ln t_j with a smooth g), made monotone by pooling. Samples lie where the
// picture is locally even, spread over all code values. Scaled so that the green of full code is 1.
// RELUME_EINVAL for wrong sizes; RELUME_EUNFIT when fewer than two different exposures are given,
// all is saturated or black, or a channel shows too few code values.
RELUME_RESULT relume_status relume_response_recover(struct relume_response *out,
                                                    const struct relume_image *codes,
                                                    const double *exposures, int n,
                                                    const struct relume_recover_params *params);

// How much a code counts in a merge.
enum relume_merge_weights {
    RELUME_MERGE_SPLINE = 0,  // two parabolas that leave 0 and 1 with slope 0; in the longest
                              // exposure 1 below half, in the shortest 1 above half
    RELUME_MERGE_HAT,         // Debevec, Malik 1997, Eq. 4
    RELUME_MERGE_GAUSSIAN,    // Robertson, Borman, Stevenson 1999: exp(-4 (c - 1/2)^2 / (1/2)^2)
};

// How one exposure agrees with the merge of the others, over pixels that both resolve (codes in
// (0.05, 0.95)); NaN where there are none.
struct relume_exposure_report {
    double residual_ev;  // RMS of log2(own radiance / that of the others)
    double bias_ev;    // its median: the time that the picture shows is 2^bias times the one given
    double noise_ev;   // 1.4826 x median absolute deviation from the bias
    double saturated;  // part of the pixels with a channel at or above 0.995
    double black;      // part with all channels at or below 0.005
    double used;       // mean weight in [0, 1]
};

// How exposures are merged. Borrowed during the call.
struct relume_merge_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    enum relume_merge_weights weights;  // default: SPLINE
    const struct relume_image
        *masks;   // [n], one channel: the weight is multiplied by it (0: a ghost or
                  // outside of a warped picture; empty image: 1), or NULL
    int threads;  // default: all cores
};
#define relume_merge_params(...)                                                                   \
    (&(const struct relume_merge_params){RELUME_SIZED(relume_merge_params), __VA_ARGS__})

// The rule of the ends is left where a longer exposure is darker or a shorter one brighter than
// half of full scale and than that end: there something else happened. Radiance in units of the
// response's exposure / those of `exposures`. A pixel that no exposure resolves takes the longest
// exposure's value where that is dark, the shortest's where it is bright. `report` [n] may be NULL.
// RELUME_EINVAL for wrong sizes, RELUME_EUNFIT when no pixel of any exposure is resolved,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_merge(struct relume_image *out,
                                         struct relume_exposure_report *report,
                                         const struct relume_image *codes, const double *exposures,
                                         int n, const struct relume_response *response,
                                         const struct relume_merge_params *params);

#ifdef __cplusplus
}
#endif
#endif
