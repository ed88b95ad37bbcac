// warp.c - a picture as the anchor's camera would have seen it
#include <relume/capture/align.h>

#include "core/base/log.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"

#include <math.h>
#include <string.h>

struct warp {
    const struct relume_image *image;
    const struct relume_displacements *field;  // or NULL: the homography
    const struct relume_homography *h;
    struct relume_image *out, *valid;
};

// Place (x, y) of the anchor in the image, pixels with centres at +0.5.
static void place_pixel(const struct warp *w, double x, double y, double at[2])
{
    if (w->field) {
        double d[2];
        relume_displacements_at(w->field, x, y, d);
        at[0] = x + d[0];
        at[1] = y + d[1];
        return;
    }
    const double(*m)[3] = w->h->m;
    const double z = m[2][0] * x + m[2][1] * y + m[2][2];
    at[0] = (m[0][0] * x + m[0][1] * y + m[0][2]) / z;
    at[1] = (m[1][0] * x + m[1][1] * y + m[1][2]) / z;
}

static void sample(const struct relume_image *image, double x, double y, float *out)
{
    const double u = fmin(fmax(x - 0.5, 0.0), image->width - 1);
    const double v = fmin(fmax(y - 0.5, 0.0), image->height - 1);
    const struct bilinear b = bilinear_at(u, v, image->width, image->height, EDGE_CLAMPED);
    const size_t n = (size_t)image->channels;
    const float s = (float)b.across, t = (float)b.down, *a = image->data;
    for (size_t c = 0; c < n; c++, a++) {
        const float top = a[n * b.at[0]] + s * (a[n * b.at[1]] - a[n * b.at[0]]);
        const float bottom = a[n * b.at[2]] + s * (a[n * b.at[3]] - a[n * b.at[2]]);
        out[c] = top + t * (bottom - top);
    }
}

static void warp_row(void *context, size_t y, int worker)
{
    const struct warp *w = context;
    (void)worker;
    const size_t width = (size_t)w->out->width, n = (size_t)w->out->channels;
    for (size_t x = 0; x < width; x++) {
        double at[2];
        place_pixel(w, (double)x + 0.5, (double)y + 0.5, at);
        sample(w->image, at[0], at[1], w->out->data + (y * width + x) * n);
        if (w->valid)
            w->valid->data[y * width + x] = at[0] >= 0.0 && at[1] >= 0.0 &&
                                            at[0] <= w->image->width && at[1] <= w->image->height;
    }
}

static relume_status warp_all(struct warp *w, const struct relume_align_params *params)
{
    *w->out = (struct relume_image){0};
    if (w->valid)
        *w->valid = (struct relume_image){0};
    relume_status status =
        relume_image_create(w->out, w->image->width, w->image->height, w->image->channels);
    if (!status && w->valid)
        status = relume_image_create(w->valid, w->image->width, w->image->height, 1);
    if (status)
        relume_image_destroy(w->out);
    else
        thread_for(params ? params->threads : 0, (size_t)w->out->height, warp_row, w);
    return status;
}

relume_status relume_warp_displacements(struct relume_image *out, struct relume_image *valid,
                                        const struct relume_image *image,
                                        const struct relume_displacements *d,
                                        const struct relume_align_params *params)
{
    return warp_all(&(struct warp){image, d, NULL, out, valid}, params);
}

relume_status relume_warp_homography(struct relume_image *out, struct relume_image *valid,
                                     const struct relume_image *image,
                                     const struct relume_homography *h,
                                     const struct relume_align_params *params)
{
    return warp_all(&(struct warp){image, NULL, h, out, valid}, params);
}
