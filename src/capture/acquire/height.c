// height.c - the height of a surface from its normals
//
// Of surfaces with steps: stepped.h. As least squares over all of the picture: slopes p = -n_x /
// n_z to the right and q = -n_y / n_z upwards stand between neighbouring pixels (mean of both
// ends). The height z minimises
//     sum (z_right - z - p)^2 + (z_up - z - q)^2 + screen z^2
// with nothing flowing through the border, which cosine transforms make diagonal:
//     Z_k = -div_k / (4 - 2 cos(pi i / W) - 2 cos(pi j / H) + screen).
// Pixels without a normal have no slope of their own and take those of their neighbours where these
// are known; else 0.
#include <relume/capture/photometric.h>

#include "capture/acquire/photometric.h"
#include "capture/acquire/stepped.h"
#include "core/base/params.h"
#include "core/math/fft.h"

#include <math.h>

// The lowest wave of a picture loses so little of its height to the screen: a thousandth.
static const double SCREEN = 0.01;  // over the square of the longer side

bool slopes_of(float slope[2], const float normal[3])
{
    if (normal[0] == 0.0f && normal[1] == 0.0f && normal[2] == 0.0f)
        return false;
    const float up = fmaxf(normal[2], 1e-3f);
    slope[0] = fminf(fmaxf(-normal[0] / up, -STEEPEST), STEEPEST);
    slope[1] = fminf(fmaxf(normal[1] / up, -STEEPEST), STEEPEST);  // rows run down
    return true;
}

static float between(const float *a, const float *b, int axis)
{
    float p[2], q[2];
    const bool known_a = slopes_of(p, a), known_b = slopes_of(q, b);
    return known_a && known_b ? 0.5f * (p[axis] + q[axis])
           : known_a          ? p[axis]
           : known_b          ? q[axis]
                              : 0.0f;
}

// minus the divergence of the slopes
static void gather(float *z, const struct relume_image *normal)
{
    const int w = normal->width, h = normal->height;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const size_t at = (size_t)y * (size_t)w + (size_t)x;
            const float *n = normal->data + 3 * at;
            if (x + 1 < w) {
                const float p = between(n, n + 3, 0);
                z[at] -= p;
                z[at + 1] += p;
            }
            if (y + 1 < h) {
                const float q = between(n, n + 3 * (size_t)w, 1);
                z[at] -= q;
                z[at + (size_t)w] += q;
            }
        }
}

static void divide(float *z, int width, int height, double screen)
{
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            const double a = 4.0 - 2.0 * cos(M_PI * i / width) - 2.0 * cos(M_PI * j / height);
            z[(size_t)j * (size_t)width + (size_t)i] *= i || j ? (float)(1.0 / (a + screen)) : 0.0f;
        }
}

static void scale(struct relume_image *z, const struct relume_image *normal, double pixel)
{
    const size_t pixels = (size_t)z->width * (size_t)z->height;
    double sum = 0.0;
    size_t known = 0;
    float ignored[2];
    for (size_t i = 0; i < pixels; i++)
        if (slopes_of(ignored, normal->data + 3 * i)) {
            sum += (double)z->data[i];
            known++;
        }
    const double mean = known ? sum / (double)known : 0.0;
    for (size_t i = 0; i < pixels; i++)
        z->data[i] = (float)(((double)z->data[i] - mean) * pixel);
}

static relume_status integrate(struct relume_image *out, const struct relume_image *normal,
                               double screen)
{
    relume_status status = relume_image_create(out, normal->width, normal->height, 1);
    if (!status) {
        gather(out->data, normal);
        status = fft_cosine(out->data, out->width, out->height, false);
    }
    if (!status) {
        divide(out->data, out->width, out->height, screen);
        status = fft_cosine(out->data, out->width, out->height, true);
    }
    return status;
}

relume_status relume_height_integrate(struct relume_image *out, const struct relume_image *normal,
                                      const struct relume_height_params *params)
{
    struct relume_height_params p = PARAMS_WORK(relume_height_params, params);
    const struct relume_image *const sure = p.confidence;
    *out = (struct relume_image){0};
    if (normal->channels != 3 || p.pixel < 0.0 || p.screen < 0.0 ||
        (sure &&
         (sure->channels != 1 || sure->width != normal->width || sure->height != normal->height)))
        return RELUME_EINVAL;
    const double longer = fmax(normal->width, normal->height);
    p.screen = p.screen > 0.0 ? p.screen : SCREEN / (longer * longer);
    const relume_status status =
        p.smooth ? integrate(out, normal, p.screen) : stepped_integrate(out, normal, &p);
    if (status)
        relume_image_destroy(out);
    else
        scale(out, normal, p.pixel > 0.0 ? p.pixel : 1.0);
    return status;
}
