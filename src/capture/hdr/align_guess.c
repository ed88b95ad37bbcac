// align_guess.c - how two exposures of one scene lie on each other, about
#include "capture/hdr/align_guess.h"

#include "capture/hdr/pyramid.h"
#include "capture/hdr/tones.h"

enum { SMALL = 512 };  // pixels of the longer side, at most

// Halved until it is small; `scale` gets pixels of the image in one of these.
static relume_status shrink(struct relume_image *out, int *scale, const struct relume_image *image,
                            int threads)
{
    relume_status status = pyramid_halve(out, image, threads);
    for (*scale = 2; !status && (out->width > SMALL || out->height > SMALL); *scale *= 2) {
        struct relume_image half = {0};
        status = pyramid_halve(&half, out, threads);
        relume_image_destroy(out);
        *out = half;
    }
    return status;
}

static double sum_of(const struct relume_image *image)
{
    const size_t samples = 3 * (size_t)image->width * (size_t)image->height;
    double sum = 0.0;
    for (size_t i = 0; i < samples; i++)
        sum += (double)image->data[i];
    return sum;
}

// The darker one is given the tones of the brighter one: it saturates where that does.
static relume_status clip_alike(struct relume_image small[2], int threads)
{
    const int dark = sum_of(&small[0]) < sum_of(&small[1]) ? 0 : 1;
    struct relume_image alike;
    const relume_status status = tones_match(&alike, &small[dark], &small[1 - dark], threads);
    if (status)
        return status;
    relume_image_destroy(&small[dark]);
    small[dark] = alike;
    return RELUME_OK;
}

relume_status align_guess(struct relume_homography *out, const struct relume_image *anchor,
                          const struct relume_image *image, int threads)
{
    struct relume_image small[2] = {{0}, {0}};
    int scale = 1;
    *out = (struct relume_homography){.m = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    relume_status status = shrink(&small[0], &scale, anchor, threads);
    if (!status)
        status = shrink(&small[1], &scale, image, threads);
    if (!status)
        status = clip_alike(small, threads);
    if (!status) {
        status = relume_align_homography(out, &small[0], &small[1],
                                         relume_align_params(.threads = threads));
        if (status == RELUME_EUNFIT || status == RELUME_EINVAL) {  // nothing to see, or too small
            out->correlation = 0.0;
            status = RELUME_OK;
        }
    }
    for (int k = 0; k < 2; k++) {
        out->m[k][2] *= scale;
        out->m[2][k] /= scale;
        relume_image_destroy(&small[k]);
    }
    return status;
}
