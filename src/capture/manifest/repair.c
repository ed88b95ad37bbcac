// repair.c - pixels that hold NaN or infinity
#include "capture/manifest/repair.h"

#include <math.h>

enum { NEAREST = 3 };

static bool is_whole(const float *pixel)
{
    return isfinite(pixel[0]) && isfinite(pixel[1]) && isfinite(pixel[2]);
}

size_t repair_count(const float *pixels, size_t n)
{
    float sum = 0.0f;  // 0 x finite is 0, 0 x anything else is NaN
    for (size_t i = 0; i < 3 * n; i++)
        sum += 0.0f * pixels[i];
    size_t count = 0;
    for (size_t x = 0; !(sum == 0.0f) && x < n; x++)
        count += !is_whole(pixels + 3 * x);
    return count;
}

struct donors {
    int count;
    int light[NEAREST];
    double angle[NEAREST];  // ascending
};

static void offer(struct donors *d, int light, double angle)
{
    int at = d->count < NEAREST ? d->count++ : NEAREST;
    if (at == NEAREST && angle >= d->angle[NEAREST - 1])
        return;
    for (at = at < NEAREST ? at : NEAREST - 1; at > 0 && angle < d->angle[at - 1]; at--) {
        d->light[at] = d->light[at - 1];
        d->angle[at] = d->angle[at - 1];
    }
    d->light[at] = light;
    d->angle[at] = angle;
}

// `whole` holds the lights under which the pixel may be trusted, also after others were repaired.
static void repair_pixel(float *out, const bool *whole, const vec3 *directions, int lights,
                         size_t n, int light)
{
    struct donors d = {0};
    for (int i = 0; i < lights; i++)
        if (whole[i])
            offer(&d, i, vec3_angle(directions[i], directions[light]));
    double sum[3] = {0.0, 0.0, 0.0}, total = 0.0;
    for (int i = 0; i < d.count; i++) {
        const double weight = 1.0 / fmax(d.angle[i], 1e-6);
        total += weight;
        for (size_t c = 0; c < 3; c++)
            sum[c] += weight * (double)out[3 * (size_t)d.light[i] * n + c];
    }
    for (size_t c = 0; c < 3; c++)
        out[3 * (size_t)light * n + c] = total > 0.0 ? (float)(sum[c] / total) : 0.0f;
}

void repair_band(float *out, const size_t *broken, const vec3 *directions, int lights, size_t n,
                 bool *whole)
{
    for (size_t x = 0; x < n; x++, out += 3) {
        bool all = true;
        for (int i = 0; i < lights; i++) {
            whole[i] = !broken[i] || is_whole(out + 3 * (size_t)i * n);
            all &= whole[i];
        }
        for (int i = 0; !all && i < lights; i++)
            if (!whole[i])
                repair_pixel(out, whole, directions, lights, n, i);
    }
}
