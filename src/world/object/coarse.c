// coarse.c - pictures of fewer pixels, and what is found by them for one of all pixels
#include "world/object/coarse.h"

#include "core/base/thread.h"

#include <string.h>

// The first of the pixels that pixel `i` of a picture of fewer has its mean of.
static size_t first_of(int i, int pixels, int fewer)
{
    return ((size_t)(2 * i) * (size_t)pixels + (size_t)fewer) / (2 * (size_t)fewer);
}

static size_t middle_of(int i, int pixels, int fewer)
{
    return (size_t)(2 * i + 1) * (size_t)pixels / (2 * (size_t)fewer);
}

static void put_mean(float out[3], const struct relume_image *from, const size_t x[2],
                     const size_t y[2])
{
    float sum[3] = {0.0f, 0.0f, 0.0f};
    for (size_t j = y[0]; j < y[1]; j++)
        for (size_t i = x[0]; i < x[1]; i++)
            for (size_t c = 0; c < 3; c++)
                sum[c] += from->data[3 * (j * (size_t)from->width + i) + c];
    for (int c = 0; c < 3; c++)
        out[c] = sum[c] / (float)((x[1] - x[0]) * (y[1] - y[0]));
}

void coarse_means(struct relume_image *image, int width, int height)
{
    const struct relume_image from = *image;
    if (width == from.width && height == from.height)
        return;
    image->width = width, image->height = height;
    for (int j = 0; j < height; j++) {
        const size_t y[] = {first_of(j, from.height, height), first_of(j + 1, from.height, height)};
        for (int i = 0; i < width; i++) {
            const size_t x[] = {first_of(i, from.width, width), first_of(i + 1, from.width, width)};
            put_mean(image->data + 3 * ((size_t)j * (size_t)width + (size_t)i), &from, x, y);
        }
    }
}

relume_status coarse_places(struct relume_image *out, const struct relume_image *places, int fewer)
{
    const int width = (places->width + fewer / 2) / fewer,
              height = (places->height + fewer / 2) / fewer;
    const relume_status status =
        relume_image_create(out, width > 0 ? width : 1, height > 0 ? height : 1, 3);
    for (int j = 0; !status && j < out->height; j++)
        for (int i = 0; i < out->width; i++) {
            const size_t x = middle_of(i, places->width, out->width),
                         y = middle_of(j, places->height, out->height);
            memcpy(out->data + 3 * ((size_t)j * (size_t)out->width + (size_t)i),
                   places->data + 3 * (y * (size_t)places->width + x), 3 * sizeof *out->data);
        }
    return status;
}

struct quotient {
    struct relume_image *panorama;
    const struct relume_image *with, *without;  // of fewer pixels
    enum edge columns;
};

static void multiply_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct quotient *q = context;
    const struct relume_image *with = q->with, *without = q->without;
    float *to = q->panorama->data + 3 * row * (size_t)q->panorama->width;
    for (int x = 0; x < q->panorama->width; x++) {
        const struct bilinear b =
            bilinear_at((x + 0.5) * with->width / q->panorama->width - 0.5,
                        ((double)row + 0.5) * with->height / q->panorama->height - 0.5, with->width,
                        with->height, q->columns);
        for (size_t c = 0; c < 3; c++) {
            float part = 0.0f;
            for (int k = 0; k < 4; k++) {
                const size_t at = 3 * b.at[k] + c;
                part += bilinear_sharef(
                    &b, k, without->data[at] > 0.0f ? with->data[at] / without->data[at] : 1.0f);
            }
            *to++ *= part;
        }
    }
}

void coarse_multiply(struct relume_image *image, const struct relume_image *with,
                     const struct relume_image *without, enum edge columns, int threads)
{
    struct quotient q = {image, with, without, columns};
    thread_for(threads, (size_t)image->height, multiply_row, &q);
}
