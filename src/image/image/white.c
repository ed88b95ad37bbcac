// white.c - the colour of the light and the primaries: gains and matrices on linear images
#include <relume/image/photograph.h>

#include "core/base/log.h"

#include <math.h>

static const double luminance[3] = {0.2126, 0.7152, 0.0722};  // BT.709
static const double most_clipped = 0.1;

static float highest(const struct relume_image *image)
{
    const size_t samples = 3 * (size_t)image->width * (size_t)image->height;
    float most = 0.0f;
    for (size_t i = 0; i < samples; i++)
        most = fmaxf(most, image->data[i]);
    return most;
}

relume_status relume_white_measure(float gain[3], const struct relume_image *image, int x, int y,
                                   int width, int height, const struct relume_log *log)
{
    double mean[3] = {0.0, 0.0, 0.0}, grey = 0.0;
    const bool ends_at_1 = highest(image) <= 1.0f;
    size_t clipped = 0;
    if (image->channels != 3 || x < 0 || y < 0 || width < 1 || height < 1 ||
        width > image->width - x || height > image->height - y)
        return log_fail(log, RELUME_EINVAL,
                        "white region %d,%d of %d x %d; expected it inside of %d x %d pixels", x, y,
                        width, height, image->width, image->height);
    const double count = (double)width * height;
    for (int row = y; row < y + height; row++) {
        const float *p = image->data + 3 * ((size_t)row * (size_t)image->width + (size_t)x);
        for (int i = 0; i < width; i++, p += 3) {
            clipped += ends_at_1 && (p[0] >= 1.0f || p[1] >= 1.0f || p[2] >= 1.0f);
            for (int c = 0; c < 3; c++)
                mean[c] += (double)p[c] / count;
        }
    }
    for (int c = 0; c < 3; c++)
        grey += luminance[c] * mean[c];
    if (!(mean[0] > 0.0 && mean[1] > 0.0 && mean[2] > 0.0) ||
        (double)clipped > most_clipped * count)
        return log_fail(log, RELUME_EUNFIT,
                        "white region %d,%d of %d x %d is %s; expected a grey that is lit", x, y,
                        width, height, clipped ? "saturated" : "black");
    for (int c = 0; c < 3; c++)
        gain[c] = (float)(grey / mean[c]);
    return RELUME_OK;
}

void relume_white_apply(struct relume_image *image, const float gain[3])
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++)
            image->data[3 * i + c] *= gain[c];
}

void relume_primaries_apply(struct relume_image *image, const float m[9])
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++) {
        float *p = image->data + 3 * i;
        const float r = p[0], g = p[1], b = p[2];
        for (int c = 0; c < 3; c++)
            p[c] = m[3 * c] * r + m[3 * c + 1] * g + m[3 * c + 2] * b;
    }
}
