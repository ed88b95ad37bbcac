// coder.h - a coder is a basis: reflectance = sum of coefficients x basis functions of the light
//
// For a fixed view the value of pixel x under light direction L is (Wong 1998, Eq. 7.6, 9.2)
//     rho_x,c(L) = constant_c + sum_k coefficient[x,k] * b_k,c(L)
// Encoding is one linear map from the captured samples of a pixel to its coefficients.
#ifndef RELUME_CODER_H
#define RELUME_CODER_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/image.h>
#include <relume/pack.h>

#ifdef __cplusplus
extern "C" {
#endif

// No basis has more coefficients per channel than this: three times as many are the weights of a
// direction, and at most the planes of a view.
enum { RELUME_MOST_COEFFICIENTS = 4096 };

// A family of basis functions. Constant; a NULL-terminated list of all is relume_bases.
struct relume_basis {
    const char *name;
    const char *summary;  // one line for help texts
    bool interpolates;    // its raw functions are the weights of an interpolant, one per light
    bool learned;         // its functions are found from samples of the capture
    bool joint;       // functions of R, G, B of their own, one set of coefficients for the three
    bool upper_only;  // its functions exist only on the pole's hemisphere
    bool halves;      // no function reaches across the horizon
    bool fits;        // by least squares: robustly too, and to lamps near by
    // The largest number of coefficients <= `want` that the basis has and `lights` can determine;
    // 0 when there is none. `want` 0 asks for the basis's own choice.
    int (*fit_count)(int want, int lights);
    // Whether `count` is a number of coefficients that the basis has.
    bool (*has_count)(int count);
    // Build the private data and the encoding map of `coder`; see src/format/coder/basis.h.
    relume_status (*prepare)(relume_coder *coder, const struct relume_log *log);
    // The raw functions at a unit direction in the pole's frame (pole = third axis): K values, or
    // one per light where the basis interpolates.
    void (*evaluate)(const relume_coder *coder, struct relume_vec3 light, double *values);
    void (*release)(relume_coder *coder);  // free the private data; NULL: there is none
};
extern RELUME_API const struct relume_basis relume_basis_table;  // the captured pictures themselves
extern RELUME_API const struct relume_basis relume_basis_sh;     // spherical harmonics
extern RELUME_API const struct relume_basis relume_basis_pca;    // principal components
// All bases; NULL ends the list.
extern RELUME_API const struct relume_basis *const relume_bases[];
// NULL when there is none of that name.
RELUME_API const struct relume_basis *relume_basis_find(const char *name);

struct relume_coder_triangles;

// How values between the captured lights follow from those at them: one weight per light.
// Constant; a NULL-terminated list of all is relume_interpolants.
struct relume_interpolant {
    const char *name;
    const char *summary;  // one line for help texts
    bool extrapolates;    // weights may be negative: values leave the range of the captured ones
    // `lights` in the pole's frame; `parameter[4]` as in struct relume_coder_params.
    relume_status (*prepare)(void **data, const struct relume_vec3 *lights, int n,
                             const double *parameter, const struct relume_log *log);
    // The weights of the lights for a unit direction in the pole's frame.
    void (*evaluate)(const void *data, struct relume_vec3 light, double *weights);
    void (*release)(void *data);  // free the private data
    // The N x N matrix B by which light i, predicted from all others, is missed by (B t)_i / B_ii
    // (Dubrule 1983), t being the samples. NULL where there is none.
    void (*predictor)(const void *data, double *b);
    // Weights that are linear over triangles: these (relume_coder_triangles); else NULL.
    struct relume_coder_triangles (*triangles)(const void *data);
};
// All interpolants; NULL ends the list.
extern RELUME_API const struct relume_interpolant *const relume_interpolants[];
// NULL when there is none of that name.
RELUME_API const struct relume_interpolant *relume_interpolant_find(const char *name);

struct relume_sample_sums;

// Samples of some pixels under every light of a capture: what a learned basis learns from.
// Thread-safety: plain data.
struct relume_samples {
    int lights;
    size_t pixels;
    float *data;  // [lights][pixels][rgb], in the domain of the coefficients
    const struct relume_sample_sums *sums;  // what was added up of them before, for the library's
                                            // own use; default: `data` is added up
};

// How a coder is made. All that is pointed at is borrowed during the call and copied where it is
// kept.
struct relume_coder_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int coefficients;    // K; default: the basis's choice for this number of lights
    bool hemispherical;  // the lights cover only the pole's hemisphere
    bool pole_y;         // theta is measured from +y (panoramas); default +z
    double ridge;        // Tikhonov weight relative to the data, [0, 1]; default: the basis's own
    bool no_ridge;       // its weight is 0
    bool luminance;      // one set of coefficients for the luminance and one colour per pixel
                         // (LRGB); not for learned bases
    bool robust;  // shadows, highlights and stray values weigh less; slower. Not for table and
                  // dct-resampled, which fit nothing
    bool force;   // more coefficients than the lights determine are a warning, not an error
    const struct relume_interpolant *interpolant;  // table and pca; default: the basis's own
    bool choose;  // the interpolant is `chord`, its parameters those with which the lights of
                  // `samples` predict each other best
    double parameter[4];                   // of the interpolant; 0 means its default
    const struct relume_samples *samples;  // what a learned basis and `choose` learn from
    int threads;                           // while learning; default: all cores
    bool decode;             // only weights will be asked for: no encoding map is made
    const float *transform;  // decoding: stored functions = transform x raw functions, [K][raw], or
                             // [3][K][raw] for joint bases. Default: the identity
    const float *mean;       // decoding, joint bases: [3][raw]. Default: zero
};
#define relume_coder_params(...)                                                                   \
    (&(const struct relume_coder_params){RELUME_SIZED(relume_coder_params), __VA_ARGS__})

// Prepare `basis` for `n` unit directions `lights`. Returns RELUME_EINVAL when the basis has no
// such K, RELUME_EUNFIT when the lights cannot determine it (too few, or degenerate),
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_coder_create(relume_coder **out,
                                                const struct relume_basis *basis,
                                                const struct relume_vec3 *lights, int n,
                                                const struct relume_coder_params *params);
RELUME_API void relume_coder_destroy(relume_coder **coder);

// What a coder is made of; pointers belong to the coder.
struct relume_coder_info {
    const struct relume_basis *basis;  // constant
    int coefficients;                  // K
    bool joint;      // one set of K planes for R, G, B together (joint bases, luminance)
    bool luminance;  // planes K, K + 1, K + 2 are the pixel's colour, which multiplies the sum
    int planes;      // 3 K; joint K; luminance K + 3
    int functions;   // raw functions of the basis: K, or the lights where it interpolates
    bool hemispherical, pole_y;
    double ridge;  // as it was applied
    int lights;
    const struct relume_vec3 *directions;  // [lights], world
    const float *transform;                // [K][functions], joint [3][K][functions], or NULL
    const float *mean;                     // joint: [3][functions], or NULL
    const struct relume_interpolant *interpolant;  // or NULL
    double parameter[4];                           // of the interpolant, as applied
    double predicted_rms;  // after `choose`: how lights left out are predicted, geometric mean over
                           // lights, 1 = white; else 0
};
// It belongs to the coder.
RELUME_API const struct relume_coder_info *relume_coder_info(const relume_coder *coder);

// The triangles of `delaunay`: in a direction d = sum of w_i p_i over the corners p_i of its
// triangle, all w_i >= 0, functions are linear in w over the corners that are lights, w made to sum
// to 1 over these. Points from the number of lights on fill gaps between lights and have no value.
// Pointers belong to the coder.
struct relume_coder_triangles {
    int points, triangles;
    const struct relume_vec3 *point;  // [points], unit, in the pole's frame
    const int (*corner)[3];           // [triangles], counter-clockwise seen from outside
};

// The 3 x K basis values and three constants at unit direction `light` (world):
// channel c = constant[c] + sum_k weights[c * K + k] * coefficient(k, c), times the pixel's colour
// where the coder is a luminance coder. Below the horizon of a hemispherical capture the value is
// that at the horizon of the same azimuth.
RELUME_API void relume_coder_weights(const relume_coder *coder, struct relume_vec3 light,
                                     float *weights, float constant[3]);

// Coefficients of `n` pixels: samples[light * stride + 3 * pixel + channel], read only, become
// planes[plane * plane_stride + pixel]. RELUME_EINVAL for a coder that only decodes, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_coder_apply(const relume_coder *coder, const float *samples,
                                               size_t stride, size_t n, float *planes,
                                               size_t plane_stride);

// The usual delta of RELUME_CURVE_LOG.
#define RELUME_LOG_DELTA 1e-2f
// "auto", "linear", "display"; "log" and "log:DELTA" are the display domain with that curve, which
// `display` (else AUTO) says. RELUME_EINVAL when `text` is none of these.
RELUME_RESULT relume_status relume_domain_parse(enum relume_domain *out,
                                                struct relume_transfer *display, const char *text);
// "auto", "linear", "display" or "log".
RELUME_API const char *relume_domain_name(enum relume_domain domain,
                                          struct relume_transfer display);

// "8", "10", "12", "16", "half", "float", "log".
RELUME_API const char *relume_storage_name(enum relume_storage storage);
// RELUME_EINVAL when `name` is none of these.
RELUME_RESULT relume_status relume_storage_parse(enum relume_storage *out, const char *name);
// The largest code: 255, 1023, 4095, 65535; 0 for half, log and float.
RELUME_API int relume_storage_top(enum relume_storage storage);
// Of a code in memory.
static inline size_t relume_storage_bytes(enum relume_storage storage)
{
    return storage == RELUME_STORE_8 ? 1 : storage == RELUME_STORE_FLOAT ? 4 : 2;
}

// How views are encoded. Borrowed during the call.
struct relume_project_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    enum relume_domain domain;    // default: display for captures that are not linear, else linear
    enum relume_storage storage;  // default 8 bits
    enum relume_step step;        // default: a step per plane
    int threads;                  // default: all cores
    const char *scratch;          // temporary data goes beside this path; default: $TMPDIR
    const struct relume_team *team;  // of what learns: each member reads its part of the samples;
                                     // default: alone
    struct relume_transfer display;  // the curve of DOMAIN_DISPLAY, as RELUME_CURVE_LOG for high
                                     // dynamic range; default: the transfer of the capture
};
#define relume_project_params(...)                                                                 \
    (&(const struct relume_project_params){RELUME_SIZED(relume_project_params), __VA_ARGS__})

// The domain that DOMAIN_AUTO means for `capture`.
RELUME_API enum relume_domain relume_capture_domain(const relume_capture *capture,
                                                    enum relume_domain domain);

// Prepare `basis` for the lights of `capture`: relume_coder_create with its directions, hemisphere
// and pole, and with samples where they are needed. Errors of both, and of
// reading samples.
RELUME_RESULT relume_status relume_coder_learn(relume_coder **out, const struct relume_basis *basis,
                                               const relume_capture *capture,
                                               const struct relume_coder_params *coder,
                                               const struct relume_project_params *encode);

// What the capture itself asks for: `pca` and an interpolant as in `coder` (default: chosen), with
// as many coefficients and in the domain in which samples of the captured lights are reproduced at
// `quality_db` (PSNR of display values as `relume eval` measures it; default 38), and the least
// storage that adds nothing visible; `table` of one light, and where the pictures take fewer bytes
// than so many components. What the params fix -
// coefficients, domain, storage - stays. Errors of relume_coder_learn.
#define RELUME_USUAL_DB 38.0

// The stored coefficients of one view in memory, ready to be relit. Plain data, borrowed.
struct relume_codes {
    const relume_coder *coder;
    enum relume_domain domain;
    struct relume_transfer display;  // the curve of DOMAIN_DISPLAY
    int width, height, planes;
    enum relume_storage storage;
    const void *const *plane;     // [planes] -> [height][width] of codes, as `storage`
    const float *scale, *offset;  // [planes]: coefficient = code * scale + offset
    // With codebooks there are no planes: storage is 0, plane, scale and offset are NULL, and the
    // coefficients of a pixel are the sum over books b of vectors[b][index[b][pixel]].
    int books;
    const uint16_t *const *index;  // [books] -> [height][width], below codes[b]
    const float *const *vectors;   // [books] -> [codes][planes]
    const int *book_codes;         // [books]
};

// The coefficients of the `n` pixels from `first` on, row by row, in one plane, whatever they are
// stored as.
RELUME_API void relume_codes_plane(const struct relume_codes *codes, int plane, size_t first,
                                   size_t n, float *out);

#ifdef __cplusplus
}
#endif
#endif
