// coefficients.h - coefficient planes that wait in a scratch file until their ranges are known
#ifndef CODER_COEFFICIENTS_H
#define CODER_COEFFICIENTS_H

#include <relume/coder.h>
#include <sys/types.h>

enum { BAND_ROWS = 16 };

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

// Planes of integer codes wait as 16-bit numbers with a scale of their own per band of rows, finer
// than any code that follows; halves wait as they are, over a power of two where they would be too
// large; floats wait as they are. The file's order is [row][plane][x].
struct relume_coefficients {
    struct relume_coefficients_info info;
    float *scale, *offset;  // [planes]
    struct range *band;     // [bands][planes]: 65535 steps each, or a scale of halves
    int bands;
    bool coarse;  // `log`: halves of 8 significant bits
    int fd;
    struct relume_encode_report report;
};

relume_status coefficients_create(relume_coefficients **out, const relume_coder *coder, int width,
                                  int height, const struct relume_encode_params *p);
// Where the rows from `row` on lie in the scratch file.
off_t coefficients_offset(const relume_coefficients *c, int row);
// The value that a waiting number stands for is min + step * number.
float coefficients_band_step(struct range r);
// That number; `scale` is 65535 over the range, 0 for a range of no width or of an infinite one.
static inline uint16_t coefficients_code(float value, struct range r, float scale)
{
    const float code = (value - r.min) * scale + 0.5f;
    return (uint16_t)(int)(code > 0.0f ? code : 0.0f);
}
// The power of two, 1 or more, over which all of a range are halves.
float coefficients_half_scale(struct range r);
// A value as a half over such a scale; `coarse`: of 8 significant bits.
uint16_t coefficients_half(float value, float scale, bool coarse);
// Bytes of a number that waits.
size_t coefficients_waiting(const relume_coefficients *c);
// Fix scale and offset of every plane for the range that it has in the whole view.
void coefficients_choose_steps(relume_coefficients *c, const struct range *total, bool masked,
                               enum relume_step step);
// One row of one plane: waiting numbers -> codes as the storage has them.
void coefficients_quantise(const relume_coefficients *c, int plane, int row, const void *from,
                           void *to);

// One row as it waits, unquantised: out[plane][x]; `waiting` has room for as many numbers.
// RELUME_EIO.
relume_status coefficients_values(const relume_coefficients *c, int row, void *waiting, float *out);

#endif
