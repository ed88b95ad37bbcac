// slab_flat.c - one ray of a slab without depth, between texels wherever it falls
#include "view/slab.h"

#include <math.h>

static int within(int i, int n)
{
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

// Bilinear with the border clamped; texel centres are at +0.5.
static void add_sample(double sum[3], const struct relume_image *image, const double at[2],
                       double weight)
{
    const double left = floor(at[0] - 0.5), top = floor(at[1] - 0.5);
    const double part[2] = {at[0] - 0.5 - left, at[1] - 0.5 - top};
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            const size_t x = (size_t)within(relume_whole(left) + i, image->width);
            const size_t y = (size_t)within(relume_whole(top) + j, image->height);
            const float *rgb = image->data + 3 * (y * (size_t)image->width + x);
            const double w = weight * (i ? part[0] : 1.0 - part[0]) * (j ? part[1] : 1.0 - part[1]);
            for (int c = 0; c < 3; c++)
                sum[c] += w * (double)rgb[c];
        }
}

void slab_flat_shade(float rgb[3], const struct slab_frame *frame, const struct slab_ray *ray)
{
    int view[4];
    double weight[4];
    double sum[3] = {0.0, 0.0, 0.0};
    const int count = relume_slab_blend(view, weight, frame->slab, ray->uv, &frame->params);
    for (int i = 0; i < count; i++) {
        slab_need(frame, view[i], relume_whole(floor(ray->texel[0] - 0.5)),
                  relume_whole(floor(ray->texel[1] - 0.5)));
        add_sample(sum, &frame->views[view[i]], ray->texel, weight[i]);
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)sum[c];
}
