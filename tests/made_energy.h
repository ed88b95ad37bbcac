// made_energy.h - what a texel of a g-BRDF sends back
#ifndef MADE_ENERGY_H
#define MADE_ENERGY_H

#include "material/gbrdf/gbrdf.h"

// Of light from `l`, of a plane, by the midpoint rule over the hemisphere in so many rings.
static inline double sent_back(const struct gbrdf *g, double x, double y, vec3 l, int channel,
                               int rings)
{
    double sum = 0.0;
    for (int r = 0; r < rings; r++)
        for (int i = 0; i < 2 * rings; i++) {
            const double theta = (r + 0.5) * 0.5 * M_PI / rings, phi = (i + 0.5) * M_PI / rings;
            const vec3 v = vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
            float rgb[3];
            gbrdf_evaluate(g, x, y, v, l, rgb);
            sum += (double)rgb[channel] / (M_PI * l.z) * v.z * sin(theta) * (0.5 * M_PI / rings) *
                   (M_PI / rings);
        }
    return sum;
}

#endif
