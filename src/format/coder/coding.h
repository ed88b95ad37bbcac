// coding.h - coefficients while a capture is encoded, and codes while they are read
#ifndef CODER_CODING_H
#define CODER_CODING_H

#include <relume/format/coder.h>

extern const struct relume_basis relume_basis_ptm;  // polynomial texture maps
extern const struct relume_basis relume_basis_hsh;  // hemispherical harmonics
extern const struct relume_basis relume_basis_dct;  // cosines on the stereographic disc
// The same as dct, the thesis's way.
extern const struct relume_basis relume_basis_dct_resampled;
extern const struct relume_basis relume_basis_eigen;  // eigenimages

// Where light was captured: all directions but the widest gap between the lights, where that is 60
// degrees wide or more and there are four lights. Its border is the hull of the lights, wider by
// half their local spacing, a quarter with interpolants that do not extrapolate. Seen from its
// middle, the axis, a direction at the azimuth atan2(d.up, d.right) is inside while it is no
// farther from the axis than border[azimuth STEPS / 2 pi], linear between these and periodic.
enum { RELUME_CAPTURED_REGION_STEPS = 256 };
// A zone; relume_captured_region_clamp asks it. Plain data.
struct relume_captured_region {
    bool everywhere;                             // there is no such gap; the rest is not set
    struct relume_vec3 right, up, axis;          // unit vectors of the world, right-handed
    struct relume_vec3 facing;                   // what the scene faces; 0: all sides
    float border[RELUME_CAPTURED_REGION_STEPS];  // radians
    double inside;                               // the cosine of the least of them
};

// What replaces light from a unit direction: `*inside` is the direction itself, or that on the
// border at its azimuth. Returns the share of it, in linear light: 1 inside; beyond, the cosine of
// the light (and 0.05) over that at the border, or of how far beyond it lies where scenes face all
// sides.
double relume_captured_region_clamp(struct relume_vec3 *inside,
                                    const struct relume_captured_region *zone,
                                    struct relume_vec3 direction);

// The zone of the coder's lights; it belongs to the coder.
const struct relume_captured_region *relume_coder_region(const relume_coder *coder);
// Where relighting takes light from a unit direction from, and the share of it: the horizon of a
// hemispherical capture, then the zone. relume_coder_weights knows the horizon only.
double relume_coder_clamp(struct relume_vec3 *from, const relume_coder *coder,
                          struct relume_vec3 direction);

// The mean becomes the last of the functions, one more than before: its coefficient, a plane behind
// the others, is 1 where the mean counts and 0 on the background; encoding gives 1. For a
// coder that nobody else uses yet; nothing happens to one without a mean, or a robust one.
// RELUME_ENOMEM.
relume_status relume_coder_append_mean(relume_coder *coder);

// False where the coder's interpolant is another one.
bool relume_coder_triangles(struct relume_coder_triangles *out, const relume_coder *coder);

// As relume_coder_triangles, of the lights of a coder whose interpolant extrapolates: shares for
// sums over many lights, which may not be negative. False for other coders.
bool relume_coder_hull(struct relume_coder_triangles *out, const relume_coder *coder);

// The plane that holds coefficient k of channel c.
static inline int relume_coder_plane(const struct relume_coder_info *info, int k, int c)
{
    return info->joint ? k : 3 * k + c;
}

// Coefficient planes of one view, computed and waiting in an unlinked temporary file, with what is
// needed to quantise them. Thread-safety: reading is safe.
typedef struct relume_coefficients relume_coefficients;

// What `capture` is looked at with: its own gamma, else sRGB.
struct relume_transfer relume_encode_display(const relume_capture *capture);
// The curve of the display domain: `asked`, else relume_encode_display.
struct relume_transfer relume_encode_curve(const relume_capture *capture,
                                           struct relume_transfer asked);

// At most `pixels` (default 65536) pixels of all views, spread evenly and by no regular pattern;
// masked ones are left out. The caller destroys `out`. `params` as for relume_project (log, domain,
// threads). Returns an input status, RELUME_ENOMEM, RELUME_ECANCEL.
relume_status relume_samples_read(struct relume_samples *out, const relume_capture *capture,
                                  size_t pixels, const struct relume_project_params *params);
void relume_samples_destroy(struct relume_samples *samples);

// How values between the captured lights follow where the planes are the pictures themselves,
// `table`: by `delaunay`, or by `chord` with the parameters that `choose` finds but no smoothing,
// whichever foretells samples of lights left out better. It replaces interpolant, parameters and
// choice in `coder`; `delaunay` of fewer than 8 lights or more than 400. Errors of
// relume_coder_learn.
relume_status relume_coder_between(struct relume_coder_params *coder, const relume_capture *capture,
                                   const struct relume_project_params *encode);

// What relume_coder_decide chose. Plain data.
struct relume_decision {
    enum relume_domain domain;
    enum relume_storage storage;
    double psnr_db;    // captured lights, before storing, mean over lights of at most 60
    double unseen_db;  // lights left out, likewise; 0: not known
    double pooled_db;  // captured lights, as relume_evaluation.psnr_pooled_db
    double sharp_db;   // lights left out where nothing smooths, for RELUME_STEP_HALVED
    bool is_hdr;       // linear light far above white, or one picture of linear light
};
// The choice for that quality, in dB; the caller destroys `*out`. `decision` may be NULL.
// `display`: for display values, unless the dynamic range is high.
relume_status relume_coder_decide(relume_coder **out, struct relume_decision *decision,
                                  const relume_capture *capture, double quality_db, bool display,
                                  const struct relume_coder_params *coder,
                                  const struct relume_project_params *encode);

// Run `coder` over one view of `capture`. Pixels outside the view's mask become 0.
// Returns an input status, RELUME_EIO (temporary file), RELUME_ENOMEM, RELUME_ECANCEL.
relume_status relume_project(relume_coefficients **out, const relume_coder *coder,
                             const relume_capture *capture, int view,
                             const struct relume_project_params *params);
void relume_coefficients_destroy(relume_coefficients **coefficients);

// A copy.
struct relume_fidelity relume_coefficients_report(const relume_coefficients *coefficients);
// Whether the steps of the codes are too coarse beside what is typical: half floats do better.
bool relume_fidelity_is_coarse(const struct relume_fidelity *report);

// What coefficients are; pointers belong to them.
struct relume_coefficients_info {
    const relume_coder *coder;
    int width, height, planes;
    enum relume_storage storage;
    const float *scale, *offset;  // [planes]: coefficient = code * scale + offset
};
// It belongs to the coefficients.
const struct relume_coefficients_info *relume_coefficients_info(
    const relume_coefficients *coefficients);

// Codes of `rows` rows from `row` on of every plane: out[row][plane][x], uint8_t, uint16_t, half
// bits or float by the storage. RELUME_EIO when the temporary file cannot be read back.
relume_status relume_coefficients_read(const relume_coefficients *coefficients, int row, int rows,
                                       void *out);

// Some of the pixels. Planes with their scales and offsets, or indices, are copied; the rest is
// borrowed from the codes that they are taken from.
struct relume_codes_part {
    struct relume_codes codes;
    void *memory;  // owned: what is copied; NULL: nothing is there
};
// Those of a rectangle, which lies within `codes`. RELUME_ENOMEM.
relume_status relume_codes_crop(struct relume_codes_part *out, const struct relume_codes *codes,
                                const struct relume_rect *rect);
// Every `step`-th pixel from `first` on, `n` of them, as one row. RELUME_ENOMEM.
relume_status relume_codes_pick(struct relume_codes_part *out, const struct relume_codes *codes,
                                size_t first, size_t step, size_t n);
void relume_codes_part_destroy(struct relume_codes_part *part);

// Codes that are there already, of any positive scales, halves of powers of two, as what a file is
// written from: the codes come back as they are. Not for floats. Of `params` log and scratch are
// used. RELUME_EIO, RELUME_ENOMEM.
relume_status relume_coefficients_keep(relume_coefficients **out, const struct relume_codes *codes,
                                       const struct relume_project_params *params);

#endif
