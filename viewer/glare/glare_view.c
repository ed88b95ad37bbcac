// glare_view.c - how large a pixel of the frame is to the eye, and what of the pattern fits it
#include "glare/glare_view.h"
#include "relight/eye/veil.h"

#include <math.h>

struct relume_glare_params glare_view(const struct frame_request *q,
                                      const struct relume_psf_geometry *pattern)
{
    struct relume_glare_params p = {
        .fov_deg = q->fov_deg,
        .magnify = observer_magnify(&q->observer),
    };
    const double pixel = relume_glare_pixel(p.fov_deg, q->width);
    const double most = fmax(fmax(q->width, q->height), 64) * pixel;
    p.no_veil = RELUME_VEIL_DEG * M_PI / 180 * p.magnify > most;
    p.magnify = fmax(fmin(p.magnify, 0.5 * most / pattern->radius), 0.01);
    return p;
}
