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

#ifdef __cplusplus
extern "C" {
#endif

// A basis prepared for one set of lights. Never changes. Thread-safety: safe.
typedef struct relume_coder relume_coder;

// A family of basis functions. Constant; a NULL-terminated list of all is relume_bases.
struct relume_basis {
    const char *name;
    const char *summary;  // one line for help texts
    // The largest number of coefficients <= `want` that the basis has and `lights` can determine;
    // 0 when there is none. `want` 0 asks for the basis's own choice.
    int (*fit_count)(int want, int lights);
    // Whether `count` is a number of coefficients that the basis has.
    bool (*has_count)(int count);
    // Build the private data and the encoding map of `coder`; see src/coder/basis.h.
    relume_status (*prepare)(relume_coder *coder, const struct relume_log *log);
    // The K values at a unit direction in the pole's frame (pole = third axis).
    void (*evaluate)(const relume_coder *coder, struct relume_vec3 light, double *values);
    void (*release)(relume_coder *coder);
};
extern RELUME_API const struct relume_basis relume_basis_table;
extern RELUME_API const struct relume_basis relume_basis_sh;
extern RELUME_API const struct relume_basis *const relume_bases[];
// NULL when there is none of that name.
RELUME_API const struct relume_basis *relume_basis_find(const char *name);

struct relume_coder_params {
    const struct relume_log *log;
    int coefficients;    // K; default: the basis's choice for this number of lights
    bool hemispherical;  // the lights cover only the pole's hemisphere
    bool pole_y;         // theta is measured from +y (panoramas); default +z
    double ridge;        // Tikhonov weight relative to the data, [0, 1]; default: the basis's own
    bool decode;         // only weights will be asked for: no encoding map is made
    const float *transform;  // decoding: K x K, row by row; stored functions = transform x basis
                             // functions. Default: the identity
};
#define relume_coder_params(...) (&(const struct relume_coder_params){__VA_ARGS__})

// Prepare `basis` for `n` unit directions `lights`. Returns RELUME_EINVAL when the basis has no
// such K, RELUME_EDATA when the lights cannot determine it (too few, or degenerate), RELUME_ENOMEM.
RELUME_RESULT relume_status relume_coder_create(relume_coder **out,
                                                const struct relume_basis *basis,
                                                const struct relume_vec3 *lights, int n,
                                                const struct relume_coder_params *params);
RELUME_API void relume_coder_destroy(relume_coder **coder);

// What a coder is made of; pointers belong to the coder.
struct relume_coder_info {
    const struct relume_basis *basis;
    int coefficients;  // K
    bool joint;        // one set of K planes for R, G, B together; else 3 K planes
    int planes;        // K or 3 K; plane of (k, channel c) = joint ? k : 3 k + c
    bool hemispherical, pole_y;
    double ridge;
    int lights;
    const struct relume_vec3 *directions;  // [lights], world
    const float *transform;                // [K][K], or NULL: identity
};
RELUME_API const struct relume_coder_info *relume_coder_info(const relume_coder *coder);

// The 3 x K basis values and three constants at unit direction `light` (world):
// channel c = constant[c] + sum_k weights[c * K + k] * coefficient(k, c). Below the horizon of a
// hemispherical capture the value is that at the horizon of the same azimuth.
RELUME_API void relume_coder_weights(const relume_coder *coder, struct relume_vec3 light,
                                     float *weights, float constant[3]);

// In which light the coefficients live (architecture: "Domain").
enum relume_domain { RELUME_DOMAIN_AUTO = 0, RELUME_DOMAIN_LINEAR, RELUME_DOMAIN_DISPLAY };

enum relume_storage {
    RELUME_STORE_DEFAULT = 0,
    RELUME_STORE_8,
    RELUME_STORE_16,
    RELUME_STORE_HALF
};

// Coefficient planes of one view, computed and waiting in an unlinked temporary file, with what is
// needed to quantise them. Thread-safety: reading is safe.
typedef struct relume_coefficients relume_coefficients;

struct relume_encode_params {
    const struct relume_log *log;
    enum relume_domain domain;    // default: display for captures that are not linear, else linear
    enum relume_storage storage;  // default 8 bits
    int threads;                  // default: all cores
    const char *scratch;          // temporary data goes beside this path; default: $TMPDIR
};
#define relume_encode_params(...) (&(const struct relume_encode_params){__VA_ARGS__})

// The domain that DOMAIN_AUTO means for `capture`.
RELUME_API enum relume_domain relume_encode_domain(const relume_capture *capture,
                                                   enum relume_domain domain);
// The curve of the display domain: the capture's own gamma, else sRGB.
RELUME_API struct relume_transfer relume_encode_display(const relume_capture *capture);

// Run `coder` over one view of `capture`. Pixels outside the view's mask become 0.
// Returns RELUME_EDATA, RELUME_EIO (temporary file), RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_encode(relume_coefficients **out, const relume_coder *coder,
                                          const relume_capture *capture, int view,
                                          const struct relume_encode_params *params);
RELUME_API void relume_coefficients_destroy(relume_coefficients **coefficients);

// How well a view was encoded, in the coefficients' own domain over the captured lights, in units
// where 1 is white; measured on every 16th or 64th row.
struct relume_encode_report {
    double fit_rms;    // captured samples against unquantised coefficients
    double store_rms;  // unquantised against stored coefficients
};
RELUME_API struct relume_encode_report relume_coefficients_report(
    const relume_coefficients *coefficients);

struct relume_coefficients_info {
    const relume_coder *coder;
    int width, height, planes;
    enum relume_storage storage;
    const float *scale, *offset;  // [planes]: coefficient = code * scale + offset
};
RELUME_API const struct relume_coefficients_info *relume_coefficients_info(
    const relume_coefficients *coefficients);

// Codes of `rows` rows from `row` on of every plane: out[row][plane][x], uint8_t, uint16_t or half
// bits by the storage. RELUME_EIO when the temporary file cannot be read back.
RELUME_RESULT relume_status relume_coefficients_read(const relume_coefficients *coefficients,
                                                     int row, int rows, void *out);

// The stored coefficients of one view in memory, ready to be relit. Plain data, borrowed.
struct relume_codes {
    const relume_coder *coder;
    enum relume_domain domain;
    struct relume_transfer display;  // the curve of DOMAIN_DISPLAY
    int width, height, planes;
    enum relume_storage storage;
    const void *const *plane;     // [planes] -> [height][width] of uint8_t, uint16_t or half bits
    const float *scale, *offset;  // [planes]: coefficient = code * scale + offset
};

#ifdef __cplusplus
}
#endif
#endif
