// homography.c - a plane seen in perspective, from points of it
#include "capture/acquire/chart.h"

#include "core/math/lsq.h"

#include <math.h>
#include <string.h>

// Algebraic error with h[8] = 1, which is good enough for a flat thing before the camera: pixels
// are shifted and scaled so that they are about 1.
bool homography_fit(struct homography *out, const double (*plane)[2], const double (*pixel)[2],
                    int n)
{
    double gram[64] = {0.0}, right[8] = {0.0}, mean[2] = {0.0, 0.0}, size = 0.0;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 2; k++)
            mean[k] += pixel[i][k] / n;
    for (int i = 0; i < n; i++)
        size += hypot(pixel[i][0] - mean[0], pixel[i][1] - mean[1]) / n;
    if (!(size > 0.0))
        return false;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 2; k++) {
            const double v = (pixel[i][k] - mean[k]) / size, x = plane[i][0], y = plane[i][1];
            double row[8] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -x * v, -y * v};
            row[3 * k] = x, row[3 * k + 1] = y, row[3 * k + 2] = 1.0;
            lsq_add_gram(gram, 8, row, 1);
            for (int j = 0; j < 8; j++)
                right[j] += row[j] * v;
        }
    for (int j = 0; j < 8; j++)
        gram[9 * j] *= 1.0 + 1e-12;
    if (!lsq_solve(gram, 8, right, 1))
        return false;
    double *h = out->h;
    h[6] = right[6], h[7] = right[7], h[8] = 1.0;
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 3; j++)
            h[3 * k + j] = size * right[3 * k + j] + mean[k] * h[6 + j];
    for (int i = 0; i < n; i++)  // nothing behind the camera
        if (!(h[6] * plane[i][0] + h[7] * plane[i][1] + 1.0 > 0.01))
            return false;
    return true;
}

void homography_apply(double out[2], const struct homography *h, double x, double y)
{
    const double w = h->h[6] * x + h->h[7] * y + h->h[8];
    out[0] = (h->h[0] * x + h->h[1] * y + h->h[2]) / w;
    out[1] = (h->h[3] * x + h->h[4] * y + h->h[5]) / w;
}
