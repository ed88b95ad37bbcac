// sheet.c - up to three planes as one JPEG, quantised by steps in the planes' own units
#include "exchange/formats/sheet.h"

#include "core/base/memory.h"
#include "image/image/jpeg.h"
#include "image/image/trellis.h"

#include <math.h>

// Squared error of R, G and B together for a unit of error in Y, Cb, Cr.
static const double ycbcr_energy[3] = {3.0, 0.344136 * 0.344136 + 1.772 * 1.772,
                                       1.402 * 1.402 + 0.714136 * 0.714136};

// How a plane's values become codes: code = value / unit + zero.
struct coding {
    double unit, zero;
    int step;  // of DCT coefficients, in codes
};

// `most`: the largest range of the planes that share the unit. Zero lies on the lattice of the
// quantised DC, so that planes that are mostly zero stay so; `whole`: it is a code, too.
static struct coding choose_coding(double min, double max, double most, double step, bool whole)
{
    const double least = fmax(most, 1e-9) / 254.0;
    struct coding c;
    c.step = (int)fmin(fmax(floor(step / least), 1.0), 255.0);
    c.unit = fmax(step / c.step, least);
    const double middle = (min + max) / 2.0 / c.unit, lattice = whole ? c.step : c.step / 8.0;
    c.zero = 128.0 - rint(middle / lattice) * lattice;
    if (min / c.unit + c.zero < 0.0 || max / c.unit + c.zero > 255.0)
        c.zero = whole ? rint(127.5 - middle) : 127.5 - middle;
    return c;
}

static void choose_codings(const struct sheet *s, double step, struct coding *out)
{
    double most = 0.0, min = 1e300, max = -1e300, weight = 0.0;
    for (int p = 0; p < s->planes; p++) {
        most = fmax(most, s->maximum[p] - s->minimum[p]);
        min = fmin(min, s->minimum[p]);
        max = fmax(max, s->maximum[p]);
        weight = fmax(weight, s->weight[p]);
    }
    for (int p = 0; p < SHEET_PLANES; p++) {
        const bool own = p < s->planes && (s->own || s->weight[p] < weight);
        if (p >= s->planes)
            out[p] = (struct coding){1.0, 128.0, out[0].step};
        else if (s->ycbcr)
            out[p] =
                choose_coding(min, max, max - min, step / weight / sqrt(ycbcr_energy[0]), false);
        else if (own)
            out[p] = choose_coding(s->minimum[p], s->maximum[p], s->maximum[p] - s->minimum[p],
                                   step / s->weight[p], s->own);
        else
            out[p] = choose_coding(s->minimum[p], s->maximum[p], most, step / weight, false);
        if (s->fixed && p < s->planes) {
            out[p].unit = 1.0 / 255.0;
            out[p].zero = 0.0;
            out[p].step = (int)fmin(
                fmax(rint(255.0 * step / s->weight[p] / (s->ycbcr ? sqrt(ycbcr_energy[0]) : 1.0)),
                     1.0),
                255.0);
        }
    }
    for (int p = 1; s->ycbcr && p < 3; p++)
        out[p].step = (int)fmin(
            fmax(rint(out[0].step * sqrt(ycbcr_energy[0] / ycbcr_energy[p])), 1.0), 255.0);
}

// Component `c` of the JPEG in codes around zero.
static void component(const struct sheet *s, const struct coding *coding, int c, float *out)
{
    static const float to_ycbcr[3][3] = {
        {0.299f, 0.587f, 0.114f}, {-0.168736f, -0.331264f, 0.5f}, {0.5f, -0.418688f, -0.081312f}};
    const size_t n = (size_t)s->width * (size_t)s->height;
    const float a = (float)(1.0 / coding[c].unit), b = (float)(coding[c].zero - 128.0);
    if (c >= s->planes) {
        for (size_t i = 0; i < n; i++)
            out[i] = 0.0f;
    } else if (!s->ycbcr) {
        for (size_t i = 0; i < n; i++)
            out[i] = s->plane[c][i] * a + b;
    } else {
        const float *t = to_ycbcr[c];
        for (size_t i = 0; i < n; i++)
            out[i] = (t[0] * s->plane[0][i] + t[1] * s->plane[1][i] + t[2] * s->plane[2][i]) * a +
                     (c == 0 ? b : 0.0f);
    }
}

// What a component adds to the squares of every block.
static void add_blocks(const struct sheet *s, const struct coding *coding, int c, const float *dct,
                       const int16_t *codes, struct sheet_block *block)
{
    const double weight = c < s->planes ? s->weight[c] * coding[c].unit : 0.0;
    const float square = (float)(weight * weight * (s->ycbcr ? ycbcr_energy[c] : 1.0));
    const float zero = s->ycbcr && c > 0 ? 0.0f : 8.0f * (float)(coding[c].zero - 128.0);
    const size_t blocks = trellis_blocks(s->width, s->height);
    for (size_t b = 0; b < blocks; b++) {
        float error = 0.0f, texture = 0.0f;
        for (size_t k = 64 * b; k < 64 * (b + 1); k++) {
            const float d = dct[k] - (float)(coding[c].step * codes[k]);
            error += d * d;
            texture += k > 64 * b ? dct[k] * dct[k] : 0.0f;
        }
        const float mean = dct[64 * b] - zero;
        block[b].error += square * error;
        block[b].texture += square * texture;
        block[b].energy += square * (texture + mean * mean);
    }
}

static void report(const struct sheet *s, const struct coding *coding, struct sheet_result *out)
{
    const double n = (double)s->width * s->height;
    for (int c = 0; c < SHEET_PLANES; c++) {
        const double energy = s->ycbcr ? ycbcr_energy[c] : 1.0;
        const double weight = c < s->planes ? s->weight[c] * coding[c].unit : 0.0;
        out->scale[c] = 255.0 * coding[c].unit;
        out->bias[c] = coding[c].zero / 255.0;
        out->distortion[c] *= energy * weight * weight / n;
    }
}

relume_status sheet_encode(struct sheet_result *out, const struct sheet *sheet, double step)
{
    const size_t blocks = trellis_blocks(sheet->width, sheet->height);
    const size_t n = (size_t)sheet->width * (size_t)sheet->height;
    struct coding coding[SHEET_PLANES];
    *out = (struct sheet_result){0};
    float *codes = mem_array(n, sizeof *codes), *dct = mem_array(64 * blocks, sizeof *dct);
    int16_t *quantised = mem_array(SHEET_PLANES * 64 * blocks, sizeof *quantised);
    relume_status status = codes && dct && quantised ? RELUME_OK : RELUME_ENOMEM;
    if (!status && sheet->blocks)
        status = (out->block = mem_zeroed(blocks, sizeof *out->block)) ? RELUME_OK : RELUME_ENOMEM;
    struct jpeg_picture picture = {.width = sheet->width,
                                   .height = sheet->height,
                                   .planes = SHEET_PLANES,
                                   .colour = sheet->ycbcr ? JPEG_YCBCR : JPEG_PLANES};
    choose_codings(sheet, step, coding);
    for (size_t c = 0; !status && c < SHEET_PLANES; c++) {
        component(sheet, coding, (int)c, codes);
        trellis_transform(codes, sheet->width, sheet->height, dct);
        out->distortion[c] =
            trellis_quantise(dct, blocks, coding[c].step, SHEET_LAMBDA, quantised + c * 64 * blocks)
                .distortion;
        if (out->block)
            add_blocks(sheet, coding, (int)c, dct, quantised + c * 64 * blocks, out->block);
        picture.step[c] = coding[c].step;
        picture.coefficients[c] = quantised + c * 64 * blocks;
    }
    if (!status)
        status = jpeg_encode(&out->bytes, &out->size, &picture);
    report(sheet, coding, out);
    mem_free(codes);
    mem_free(dct);
    mem_free(quantised);
    return status;
}
