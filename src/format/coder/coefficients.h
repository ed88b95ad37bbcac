// coefficients.h - coefficient planes that wait in a scratch file until their ranges are known
#ifndef CODER_COEFFICIENTS_H
#define CODER_COEFFICIENTS_H

#include "format/coder/coding.h"

#include <relume/format/coder.h>
#include <sys/types.h>

// Bands are encoded together; the blocks of a file have no more rows than this, or a part of it.
enum { BAND_ROWS = 16, ENCODE_BLOCK = 32 };

struct range {
    float min, max;
};

// Ranges below this are one value: their steps would leave single precision.
#define TINY_RANGE 1e-30f

// Of `n` values; empty ones have min > max.
struct range range_of(const float *values, size_t n);
struct range range_join(struct range a, struct range b);
// A tiny range becomes one value.
struct range range_settle(struct range r);

// Rows of a view that were encoded by themselves, and what of them the whole view's report takes.
struct project_rows {
    int row, rows;        // 0 rows: all of the view
    double *error;        // [height of the view]: squared, each row's own sum, so that sums do not
                          // depend on who adds them up
    double *shown_error;  // [lights]: squared, of display values
    double root_sum;
    size_t error_count, lit_count;
    bool *lit;                     // [lights]: whether a sample of these rows is above 0
    struct encode_stored *stored;  // [height of the view], or NULL: steps are not known yet
};

// What storing costs on a row.
struct encode_stored {
    double square, shown;
    size_t count;
    relume_status status;
};

// Planes of integer codes wait as 16-bit numbers with a scale of their own per band of rows, finer
// than any code that follows; halves wait as they are, over a power of two where they would be too
// large; floats wait as they are. The file's order is [row][plane][x].
struct relume_coefficients {
    struct relume_coefficients_info info;
    float *scale, *offset;  // [planes]
    float *most;            // [planes]: the largest size of a value, once steps are chosen; or NULL
    struct range *band;     // [bands][planes]: 65535 steps each, or a scale of halves
    int bands;
    bool coarse;  // `log`: halves of 8 significant bits
    int fd;
    struct relume_fidelity report;
    struct project_rows some;
};

relume_status coefficients_create(relume_coefficients **out, const relume_coder *coder, int width,
                                  int height, const struct relume_project_params *p);
// Where the rows from `row` on lie in the scratch file.
off_t coefficients_offset(const relume_coefficients *c, int row);
// The step between the values of waiting codes, which begin at the range's minimum.
float coefficients_band_step(struct range r);
// The power of two, 1 or more, over which all of a range are halves.
float coefficients_half_scale(struct range r);
// Bytes of a number that waits.
size_t coefficients_waiting(const relume_coefficients *c);
// Fix scale and offset of every plane for the range that it has in the whole view.
void coefficients_choose_steps(relume_coefficients *c, const struct range *total, bool masked,
                               enum relume_step step);
// The same steps for all of them, of integer codes and one coder: those of what each plane holds in
// any. RELUME_ENOMEM.
relume_status coefficients_share_steps(relume_coefficients *const *c, int count, bool masked,
                                       enum relume_step step);
// The quantiser, in two steps for `n` pixels of one plane in the band of `row`: values -> numbers
// that wait, by the band's range; numbers that wait -> codes as the storage has them, by the steps.
void coefficients_wait(const relume_coefficients *c, int plane, int row, const float *values,
                       size_t n, void *to);
void coefficients_quantise(const relume_coefficients *c, int plane, int row, const void *waiting,
                           size_t n, void *to);
// Both, and back: values as a reader of the file finds them.
void coefficients_restore(const relume_coefficients *c, int plane, int row, const float *values,
                          size_t n, float *out);

// One row as it waits, unquantised: out[plane][x]; `waiting` holds as many numbers.
// RELUME_EIO.
relume_status coefficients_values(const relume_coefficients *c, int row, void *waiting, float *out);

// The rows `row` .. `row + rows` of a view, from BAND_ROWS on to BAND_ROWS on: they wait, steps are
// not chosen. As relume_project.
relume_status project_some_rows(relume_coefficients **out, const relume_coder *coder,
                                const relume_capture *capture, int view, int row, int rows,
                                const struct relume_project_params *p);
// Rows that join those that `c` has, which may be the same: `some` and the census of the report are
// theirs alone. As above.
relume_status project_more_rows(relume_coefficients *c, const relume_capture *capture, int view,
                                int row, int rows, const struct relume_project_params *p);
// The planes of `coder` that `codes` have, perhaps beside others, wait as if they had been encoded;
// steps are not chosen. RELUME_EIO, RELUME_ENOMEM.
relume_status coefficients_take(relume_coefficients **out, const relume_coder *coder,
                                const struct relume_codes *codes,
                                const struct relume_project_params *p);
// All rows wait in `c`, its bands and `some` are those of all of them: choose the steps and fill in
// the report. `display` is the curve of the domain `p->domain`, which is not AUTO. RELUME_EIO,
// RELUME_ENOMEM.
relume_status project_finish_rows(relume_coefficients *c, const struct relume_image *mask,
                                  struct relume_transfer display,
                                  const struct relume_project_params *p);

// Some rows wait in `c`, its bands are those of all rows: choose the steps, and measure what
// storing costs on those that are here, into `some.stored`. `masked` and the rest are as above.
relume_status project_settle_rows(relume_coefficients *c, const struct relume_image *mask,
                                  struct relume_transfer display,
                                  const struct relume_project_params *p);
// The report of a view, of what was added up and measured of all its rows; its census is left
// empty.
struct relume_fidelity project_rows_fidelity(const struct project_rows *all, int height,
                                             int lights);

// Which of `parts` parts holds what: whole views, or where there are fewer views than parts rows of
// one.
struct encode_share {
    int first, views;
    int row, rows;  // 0 rows: all
};
// False when there are more parts than bands of rows.
bool encode_share_of(struct encode_share *out, int part, int parts, int views, int height);
// The same of a capture: RELUME_EUNFIT with a sentence.
relume_status encode_share_find(struct encode_share *out, int part, int parts,
                                const relume_capture *capture, const struct relume_log *log);

// Of all views: root mean squares, means, sums. `steps_rms` of each is set.
struct relume_fidelity fidelity_mean(const struct relume_fidelity *view, int views);

// Coefficients in place of a view's own: planes[plane * stride + x] of a row.
struct encode_values {
    void (*row)(const void *user, int row, float *planes, size_t stride);
    const void *user;
    bool own;  // judged by what the view's own coefficients show, not by images
};
// How well they reproduce the captured images, as `relume eval` measures it.
// The PSNR of a report, on its rows. The images are read again. An input status, RELUME_ENOMEM,
// RELUME_ECANCEL.
relume_status encode_judge(double *psnr_db, relume_coefficients *c, const relume_capture *capture,
                           int view, const struct encode_values *values,
                           const struct relume_project_params *p);

// Of the tiles of a view, numbered row by row: those from `first` to `end`. The side is a multiple
// of BAND_ROWS.
struct encode_tiles {
    int side, across, first, end;
};
struct encode_square {
    double sum;  // of squared differences of display values, 1 = white, of all lights
    uint64_t count;
};
// The same on tiles: out[end - first], each by itself. Views of 800000 pixels or more are judged
// by samples: one row of 2, 4 or 8, at least 400000 pixels of the view. Values of those tiles alone
// are asked for.
relume_status encode_judge_tiles(struct encode_square *out, relume_coefficients *c,
                                 const relume_capture *capture, int view,
                                 const struct encode_tiles *tiles,
                                 const struct encode_values *values,
                                 const struct relume_project_params *p);

#endif
