// smooth.c - see smooth.h
#include "material/change/smooth.h"

#include "core/base/thread.h"
#include "core/math/scalar.h"

#include <math.h>
#include <string.h>

enum { REACH = 48 };

struct axis_step {
    const struct relume_image *from;
    struct relume_image *to;
    bool down;
    int reach;
    float weight[REACH + 1];
};

static void do_row(void *context, size_t y, int worker)
{
    (void)worker;
    const struct axis_step *p = context;
    const int width = p->from->width, height = p->from->height;
    const size_t channels = (size_t)p->from->channels, stride = channels * (size_t)width;
    const int sides = p->down ? height : width;
    for (int x = 0; x < width; x++) {
        const int here = p->down ? (int)y : x;
        const int first = larger_of(here - p->reach, 0),
                  last = smaller_of(here + p->reach, sides - 1);
        const size_t step = p->down ? stride : channels;
        const float *v = p->from->data + (p->down ? channels * (size_t)x : y * stride);
        float *to = p->to->data + y * stride + channels * (size_t)x, sum = 0.0f;
        for (size_t c = 0; c < channels; c++)
            to[c] = 0.0f;
        for (int i = first; i <= last; i++) {
            const float w = p->weight[i < here ? here - i : i - here];
            sum += w;
            add_scaled(to, v + (size_t)i * step, w, channels);
        }
        for (size_t c = 0; c < channels; c++)
            to[c] /= sum;
    }
}

relume_status smooth(struct relume_image *image, double sigma, int threads)
{
    struct relume_image between;
    struct axis_step p = {.from = image, .to = &between};
    p.reach = smaller_of((int)ceil(3.0 * sigma), REACH);
    for (int i = 0; i <= p.reach; i++)
        p.weight[i] = (float)exp(-0.5 * i * i / (sigma * sigma));
    const relume_status status =
        relume_image_create(&between, image->width, image->height, image->channels);
    if (status)
        return status;
    thread_for(threads, (size_t)image->height, do_row, &p);
    p.from = &between, p.to = image, p.down = true;
    thread_for(threads, (size_t)image->height, do_row, &p);
    relume_image_destroy(&between);
    return RELUME_OK;
}

relume_status smooth_copy(struct relume_image *out, const struct relume_image *image, double sigma,
                          int threads)
{
    relume_status status = relume_image_create(out, image->width, image->height, image->channels);
    if (status)
        return status;
    memcpy(out->data, image->data,
           (size_t)image->width * (size_t)image->height * (size_t)image->channels *
               sizeof *image->data);
    status = smooth(out, sigma, threads);
    if (status)
        relume_image_destroy(out);
    return status;
}

relume_status smooth_known(struct relume_image *image, const struct relume_image *known,
                           double sigma, int threads)
{
    struct relume_image share;
    const size_t pixels = (size_t)image->width * (size_t)image->height,
                 channels = (size_t)image->channels;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < channels && known->data[i] < 0.5f; c++)
            image->data[channels * i + c] = 0.0f;
    relume_status status = smooth_copy(&share, known, sigma, threads);
    if (!status)
        status = smooth(image, sigma, threads);
    for (size_t i = 0; !status && i < pixels; i++)
        for (size_t c = 0; c < channels; c++)
            image->data[channels * i + c] *=
                known->data[i] > 0.5f && share.data[i] > 0.0f ? 1.0f / share.data[i] : 0.0f;
    relume_image_destroy(&share);
    return status;
}
