// slab_flat.c - one ray of a slab without depth, between texels wherever it falls
#include "relight/view/slab.h"

#include "core/math/bilinear.h"
#include "relight/view/view.h"

#include <math.h>

// The border is clamped; texel centres are at +0.5.
static void add_sample(double sum[3], const struct relume_image *image, const double at[2],
                       double weight)
{
    const struct bilinear b =
        bilinear_at(at[0] - 0.5, at[1] - 0.5, image->width, image->height, EDGE_CLAMPED);
    for (int k = 0; k < 4; k++)
        for (size_t c = 0; c < 3; c++)
            sum[c] += bilinear_share(&b, k, weight) * (double)image->data[3 * b.at[k] + c];
}

void slab_flat_shade(float rgb[3], const struct slab_frame *frame, const struct slab_ray *ray)
{
    int view[4];
    double weight[4];
    double sum[3] = {0.0, 0.0, 0.0};
    const int count = relume_slab_blend(view, weight, frame->slab, ray->at, &frame->params);
    double here = 1.0;
    for (int i = 0; i < count; i++) {
        if (!frame->needed[view[i]]) {
            here -= weight[i];
            continue;
        }
        slab_need(frame, view[i], relume_whole(floor(ray->texel[0] - 0.5)),
                  relume_whole(floor(ray->texel[1] - 0.5)));
        add_sample(sum, &frame->views[view[i]], ray->texel, weight[i]);
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(sum[c] / fmax(here, 1e-6));
}
