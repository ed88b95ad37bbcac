// colours.c - the colours of one picture brought to those of another by a 3 x 3 matrix (Meseth
// 2008, section 13.4.1, where photographs are held against renderings); least squares of a linear
// model, so in closed form
#include <relume/image/jnd.h>

#include "core/base/memory.h"
#include "core/math/lsq.h"

#include <math.h>
#include <string.h>

// Added to the diagonal, of the trace: colours that lie on one line, as of grey pictures, still
// tell that line.
#define RIDGE 1e-9

static bool same_size(const struct relume_image *a, const struct relume_image *b)
{
    return a->width == b->width && a->height == b->height;
}

relume_status relume_colours_fit(double matrix[3][3], const struct relume_image *image,
                                 const struct relume_image *reference,
                                 const struct relume_image *mask)
{
    double gram[9] = {0}, right[3][3] = {{0}};
    memset(matrix, 0, 9 * sizeof(double));
    if (image->channels != 3 || reference->channels != 3 || !same_size(image, reference) ||
        (mask && (mask->channels != 1 || !same_size(mask, image))))
        return RELUME_EINVAL;
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++) {
        const float *from = image->data + 3 * i, *to = reference->data + 3 * i;
        if (mask && !(mask->data[i] > 0.5f))
            continue;
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) {
                gram[3 * r + c] += (double)from[r] * (double)from[c];
                right[r][c] += (double)to[r] * (double)from[c];
            }
    }
    const double trace = gram[0] + gram[4] + gram[8];
    for (int c = 0; c < 3; c++)
        gram[4 * c] += RIDGE * trace;
    if (!(trace > 0.0) || !isfinite(trace) || !lsq_solve(gram, 3, right[0], 3))
        return RELUME_EUNFIT;
    memcpy(matrix, right, 9 * sizeof(double));
    return RELUME_OK;
}

relume_status relume_colours_apply(struct relume_image *image, const double matrix[3][3])
{
    if (image->channels != 3)
        return RELUME_EINVAL;
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++) {
        float *const v = image->data + 3 * i;
        const double rgb[3] = {(double)v[0], (double)v[1], (double)v[2]};
        for (int c = 0; c < 3; c++)
            v[c] = (float)(matrix[c][0] * rgb[0] + matrix[c][1] * rgb[1] + matrix[c][2] * rgb[2]);
    }
    return RELUME_OK;
}
