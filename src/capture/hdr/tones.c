// tones.c - one exposure made to look like another
#include "capture/hdr/tones.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <math.h>

enum { BINS = 1024, MOST = 1 << 20 };  // pixels that are counted

struct tones {
    const struct relume_image *in;
    struct relume_image *out;
    float map[3][BINS + 1];
};

static int bin_of(float code)
{
    return code > 0.0f ? (int)(fminf(code, 1.0f) * BINS + 0.5f) : 0;
}

// Pixels below the middle of each bin, as a part of all.
static void distribution(double cdf[BINS + 1], const struct relume_image *image, size_t channel)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    const size_t step = pixels / MOST + 1;
    size_t count[BINS + 1] = {0}, below = 0, all = (pixels + step - 1) / step;
    for (size_t i = 0; i < pixels; i += step)
        count[bin_of(image->data[3 * i + channel])]++;
    for (int z = 0; z <= BINS; z++) {
        cdf[z] = ((double)below + 0.5 * (double)count[z]) / (double)all;
        below += count[z];
    }
}

static void match_channel(float map[BINS + 1], const double from[BINS + 1],
                          const double to[BINS + 1])
{
    int k = 0;
    for (int z = 0; z <= BINS; z++) {
        while (k < BINS && to[k + 1] < from[z])
            k++;
        const double gap = k < BINS ? to[k + 1] - to[k] : 0.0;
        const double t = gap > 0.0 ? fmin(fmax((from[z] - to[k]) / gap, 0.0), 1.0) : 0.0;
        map[z] = (float)((k + t) / BINS);
    }
}

static void map_row(void *context, size_t y, int worker)
{
    const struct tones *t = context;
    (void)worker;
    const size_t stride = 3 * (size_t)t->in->width;
    const float *in = t->in->data + y * stride;
    float *out = t->out->data + y * stride;
    for (size_t i = 0; i < stride; i++)
        out[i] = t->map[i % 3][bin_of(in[i])];
}

relume_status tones_match(struct relume_image *out, const struct relume_image *image,
                          const struct relume_image *like, int threads)
{
    relume_status status = relume_image_create(out, image->width, image->height, 3);
    struct tones *t = mem_array(1, sizeof *t);
    double(*cdf)[BINS + 1] = mem_array(2, sizeof *cdf);
    if (!status && (!t || !cdf))
        status = RELUME_ENOMEM;
    for (size_t c = 0; !status && c < 3; c++) {
        distribution(cdf[0], image, c);
        distribution(cdf[1], like, c);
        match_channel(t->map[c], cdf[0], cdf[1]);
    }
    if (!status) {
        t->in = image;
        t->out = out;
        thread_for(threads, (size_t)image->height, map_row, t);
    } else {
        relume_image_destroy(out);
    }
    mem_free(t);
    mem_free(cdf);
    return status;
}
