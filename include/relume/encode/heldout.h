// heldout.h - coders judged by lights that they have not seen
//
// A capture's samples are held in memory; for each fold a coder is made from the remaining lights,
// its coefficients are stored as a file would store them, and the lights left out are relit and
// compared with their photographs. No file is written.
#ifndef RELUME_HELDOUT_H
#define RELUME_HELDOUT_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/format/codebook.h>
#include <relume/format/coder.h>

#ifdef __cplusplus
extern "C" {
#endif

// Thread-safety: one thread at a time.
typedef struct relume_heldout relume_heldout;

struct relume_heldout_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const relume_capture *test;  // judge by these lights, none left out; same size, views and
                                 // projection; or NULL
    int leave_out;               // lights left out at a time, default 1
    enum relume_domain domain;   // as relume_project_params
    uint64_t memory;             // bytes for samples, default 2^30; a capture that needs more is
                                 // represented by bands of rows, spread evenly
    int threads;                 // default: all cores
    struct relume_transfer display;  // as relume_project_params
    bool tone_mapped;                // what is compared: each picture at an exposure of its own
                                     // (relume_tone_meter of the photograph), with a gamma of 2.2
};
#define relume_heldout_params(...)                                                                 \
    (&(const struct relume_heldout_params){RELUME_SIZED(relume_heldout_params), __VA_ARGS__})

// `capture` and `test` must outlive the object. Returns RELUME_EINVAL (leave_out leaves fewer than
// one light), an input status (an image is broken, `test` does not fit), RELUME_ENOMEM,
// RELUME_ECANCEL.
RELUME_RESULT relume_status relume_heldout_open(relume_heldout **out, const relume_capture *capture,
                                                const struct relume_heldout_params *params);
RELUME_API void relume_heldout_destroy(relume_heldout **heldout);

// What is measured on. Plain data.
struct relume_heldout_info {
    int lights;  // that may be learned from
    int folds;   // fold f leaves out the lights f, f + folds, f + 2 folds, ...
    int fewest;  // lights that the smallest fold learns from
    int judged;  // lights that are judged by, over all folds
    enum relume_domain domain;
    size_t pixels, all_pixels;  // in memory and in the capture, of all views
};
// It belongs to `heldout`.
RELUME_API const struct relume_heldout_info *relume_heldout_info(const relume_heldout *heldout);

// How coefficients are stored.
struct relume_heldout_store {
    enum relume_storage storage;              // default: 8 bits
    enum relume_step step;                    // default: a step per plane
    const struct relume_books_params *books;  // codebooks instead of planes; threads are those of
                                              // the held-out object
    bool share;                               // one set of codebooks for all views
};

// Of display values as in relume/evaluate.h; NaN where nothing could be measured.
struct relume_heldout_quality {
    double psnr_db;         // mean over the images left out (views x lights)
    double psnr_pooled_db;  // of the unrounded error over all of them; at most 200
    double ssim;            // mean over them; of the bands, where these are all there is
};

// Judge one coder: `before` quantising and `after` it in `n` ways. `coder` is as for
// relume_coder_create; hemisphere, pole and samples are filled in. Returns what relume_coder_create
// returns for a fold, RELUME_ENOMEM, RELUME_ECANCEL; the log says why.
RELUME_RESULT relume_status relume_heldout_measure(relume_heldout *heldout,
                                                   const struct relume_basis *basis,
                                                   const struct relume_coder_params *coder,
                                                   const struct relume_heldout_store *store, int n,
                                                   struct relume_heldout_quality *before,
                                                   struct relume_heldout_quality *after);

// Which of `n` points lie on the upper hull of quality over log rate: no point, and no mixture of
// two points, has at most their rate and more quality. Points whose rate is not above 0 or whose
// quality is not finite are left out.
RELUME_API void relume_rate_hull(bool *on_hull, const double *rate, const double *quality, int n);

#ifdef __cplusplus
}
#endif
#endif
