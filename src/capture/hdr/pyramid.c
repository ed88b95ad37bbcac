// pyramid.c - pictures halved again and again, for coarse-to-fine alignment
#include "capture/hdr/pyramid.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

struct halving {
    const struct relume_image *in;
    struct relume_image *out;
};

static void halve_row(void *context, size_t y, int worker)
{
    const struct halving *h = context;
    (void)worker;
    const size_t n = (size_t)h->in->channels, width = (size_t)h->in->width;
    const size_t below = 2 * y + 1 < (size_t)h->in->height ? 2 * y + 1 : 2 * y;
    const float *a = h->in->data + 2 * y * width * n, *b = h->in->data + below * width * n;
    float *out = h->out->data + y * (size_t)h->out->width * n;
    for (size_t x = 0; x < (size_t)h->out->width; x++) {
        const size_t left = 2 * x * n, right = 2 * x + 1 < width ? left + n : left;
        for (size_t c = 0; c < n; c++)
            *out++ = 0.25f * (a[left + c] + a[right + c] + b[left + c] + b[right + c]);
    }
}

relume_status pyramid_halve(struct relume_image *out, const struct relume_image *image, int threads)
{
    const relume_status status =
        relume_image_create(out, (image->width + 1) / 2, (image->height + 1) / 2, image->channels);
    if (!status)
        thread_for(threads, (size_t)out->height, halve_row, &(struct halving){image, out});
    return status;
}

relume_status pyramid_make(struct pyramid *out, const struct relume_image *image, int side,
                           int threads)
{
    const size_t samples = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    *out = (struct pyramid){.levels = 1, .level[0] = *image};
    out->level[0].data = mem_copy(image->data, samples, sizeof(float));
    relume_status status = out->level[0].data ? RELUME_OK : RELUME_ENOMEM;
    while (!status && out->levels < PYRAMID_LEVELS &&
           pyramid_longer_side(&out->level[out->levels - 1]) > side) {
        status = pyramid_halve(&out->level[out->levels], &out->level[out->levels - 1], threads);
        out->levels += !status;
    }
    if (status)
        pyramid_free(out);
    return status;
}

void pyramid_free(struct pyramid *pyramid)
{
    for (int i = 0; i < pyramid->levels; i++)
        relume_image_destroy(&pyramid->level[i]);
    pyramid->levels = 0;
}
