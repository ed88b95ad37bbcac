// report_picture.c - see report_picture.h
#include "capture/acquire/report_picture.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/base64.h"
#include "image/image/picture.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static relume_status put_file(FILE *f, const char *path, const struct relume_log *log)
{
    uint8_t block[3 * 4096];
    size_t n;
    FILE *from = fopen(path, "rb");
    if (!from)
        return log_fail(log, RELUME_EIO, "%s: cannot be read back; %s", path, strerror(errno));
    while ((n = fread(block, 1, sizeof block, from)) > 0)
        base64_print(f, block, n);
    fclose(from);
    return RELUME_OK;
}

static float coded(float v, enum report_look look)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    if (look == LOOK_NORMAL)
        return 0.5f + 0.5f * v;
    return relume_transfer_encode(srgb, fminf(fmaxf(v, 0.0f), 1.0f));
}

// The mean of the pixels [from, to) of a channel.
static float mean_of(const struct relume_image *image, const int from[2], const int to[2],
                     size_t channel)
{
    float sum = 0.0f;
    int n = 0;
    for (int y = from[1]; y < to[1]; y++)
        for (int x = from[0]; x < to[0]; x++, n++)
            sum += image->data[((size_t)y * (size_t)image->width + (size_t)x) *
                                   (size_t)image->channels +
                               channel];
    return sum / (float)n;
}

static int at_most(double a, int b)
{
    return a < b ? relume_whole(a) : b;
}

static void shrink(uint8_t *bytes, int width, int height, const struct relume_image *image,
                   double step, float gain, enum report_look look)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const int from[2] = {(int)(x * step), (int)(y * step)};
            const int to[2] = {at_most((x + 1) * step, image->width),
                               at_most((y + 1) * step, image->height)};
            for (size_t c = 0; c < 3; c++) {
                const float v = mean_of(image, from, to, image->channels == 3 ? c : 0);
                const float code = fminf(fmaxf(coded(gain * v, look), 0.0f), 1.0f);
                *bytes++ = (uint8_t)(255.0f * code + 0.5f);
            }
        }
}

// Coded bytes as a data: URL, through a file that does not stay.
static relume_status put_bytes(FILE *page, const char *dir, int width, int height,
                               const uint8_t *bytes, const struct relume_log *log)
{
    char *path = mem_format("%s/thumbnail.jpg", dir);
    if (!path)
        return RELUME_ENOMEM;
    relume_status status = picture_write_bytes(path, NULL, width, height, 3, bytes, log);
    fprintf(page, "<img width=\"%d\" height=\"%d\" src=\"data:image/jpeg;base64,", width, height);
    if (!status)
        status = put_file(page, path, log);
    fputs("\" alt=\"\">", page);
    unlink(path);
    mem_free(path);
    return status;
}

relume_status report_picture(FILE *page, const char *dir, const struct relume_image *image,
                             int side, float gain, enum report_look look,
                             const struct relume_log *log)
{
    const int most = image->width > image->height ? image->width : image->height;
    const double step = most > side ? (double)most / side : 1.0;
    const int w = (int)fmax(image->width / step, 1.0), h = (int)fmax(image->height / step, 1.0);
    uint8_t *bytes = mem_array((size_t)w * (size_t)h, 3);
    if (!bytes)
        return RELUME_ENOMEM;
    shrink(bytes, w, h, image, step, gain, look);
    const relume_status status = put_bytes(page, dir, w, h, bytes, log);
    mem_free(bytes);
    return status;
}

float report_gain(const struct relume_image *image)
{
    const size_t n = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    double sum = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += (double)image->data[i] * (double)image->data[i];
    const float rms = (float)sqrt(sum / (double)n);
    return rms > 0.0f ? 0.35f / rms : 1.0f;
}
