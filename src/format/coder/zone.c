// zone.c - where light was captured, and what replaces light from elsewhere
//
// Each light covers a cap, a part as wide as it is far from its nearest neighbour. Seen in the
// stereographic projection from the middle of what no light covers, caps are discs; their convex
// hull is the zone, so that it holds a dome between the lights of its rim. It is kept as the angle
// of its border from its middle, by azimuth: light from beyond is taken from the border at the same
// azimuth, which is continuous, and is what happens at the horizon of a hemispherical capture.
//
// What is photographed from above lies flat more often than not, and the flatter light comes, the
// less of it arrives: values at the border are taken times the cosine of the light over that at the
// border. Lights below 24, 37 and 44 degrees predicted from those above, means of 18 surfaces
// (SynthRTI, RealRTI): 27.3, 28.1, 26.0 dB for 23.5, 26.0, 20.6 by extrapolation with the best
// kernel; over flat triangles 26.2, 25.8, 23.9 for 16.3, 18.7, 14.5. Reliefs and busts alike; a
// cosine of how far beyond gives a tenth of that.
#include "format/coder/zone.h"

#include "core/math/vec.h"
#include "format/coder/basis.h"
#include "format/coder/coding.h"

#include <stdlib.h>

enum { STEPS = RELUME_CAPTURED_REGION_STEPS, LEAST_LIGHTS = 4 };
// Lights nearer than this to each other are one; those without a neighbour have one so far away;
// and each covers that distance around it, or the lights themselves would lie on the border.
static const double SAME = 1e-3, WIDEST = M_PI / 3.0, LEAST = M_PI / 90.0;
// Not all of a scene lies flat: this share of light along it still hits something.
static const double UPRIGHT = 0.05;
// A zone that ends so near to the opposite of its middle has no border worth the name.
static const double ALL_AROUND = 170.0 * M_PI / 180.0;

// How far a light speaks for directions around it: `part` of the way to its nearest neighbour.
static double reach_of(const struct relume_vec3 *lights, int n, int i, double part)
{
    double nearest = WIDEST;
    for (int j = 0; j < n; j++) {
        const double angle = j == i ? 0.0 : vec3_angle(lights[i], lights[j]);
        nearest = angle > SAME && angle < nearest ? angle : nearest;
    }
    return fmax(nearest * part, LEAST);
}

// Of the azimuth of each step, and of the difference of two.
static void find_cosines(double cosine[STEPS])
{
    for (int s = 0; s < STEPS; s++)
        cosine[s] = cos(2.0 * M_PI * s / STEPS);
}

// How far the discs reach along each azimuth of the plane. False when they leave the middle out.
static bool find_support(double support[STEPS], const double cosine[STEPS],
                         const struct relume_captured_region *z, const struct relume_vec3 *lights,
                         int n, double part)
{
    bool inside = true;
    for (int s = 0; s < STEPS; s++)
        support[s] = -(double)INFINITY;
    for (int i = 0; i < n; i++) {
        const double reach = reach_of(lights, n, i, part);
        const double x = vec3_dot(lights[i], z->right), y = vec3_dot(lights[i], z->up);
        const double r = hypot(x, y), theta = atan2(r, vec3_dot(lights[i], z->axis));
        const double cos_phi = r > 0.0 ? x / r : 1.0, sin_phi = r > 0.0 ? y / r : 0.0;
        const double near = tan(0.5 * (theta - reach));
        const double far = tan(0.5 * fmin(theta + reach, ALL_AROUND));
        for (int s = 0; s < STEPS; s++) {
            const double sine = cosine[(s + STEPS - STEPS / 4) % STEPS];
            const double along = cosine[s] * cos_phi + sine * sin_phi;
            support[s] = fmax(support[s], 0.5 * (far + near) * along + 0.5 * (far - near));
        }
    }
    for (int s = 0; s < STEPS; s++)
        inside &= support[s] > 0.0;
    return inside;
}

// The border of the hull is at the first of its tangents.
static void find_border(struct relume_captured_region *z, const double support[STEPS],
                        const double cosine[STEPS])
{
    double least = M_PI;
    for (int i = 0; i < STEPS; i++) {
        double radius = (double)INFINITY;
        for (int k = 1 - STEPS / 4; k < STEPS / 4; k++)  // those beyond a right angle are no nearer
            radius = fmin(radius, support[(i + k + STEPS) % STEPS] / cosine[abs(k)]);
        z->border[i] = (float)(2.0 * atan(radius));
        least = fmin(least, (double)z->border[i]);
    }
    z->inside = cos(least);
}

static bool try_axis(struct relume_captured_region *z, vec3 axis, const struct relume_vec3 *lights,
                     int n, double part)
{
    double support[STEPS], cosine[STEPS];
    // Any frame will do; at a pole it is that of x and y, or of x and z.
    const vec3 beside = fabs(axis.x) < 0.9 ? vec3_of(1.0, 0.0, 0.0) : vec3_of(0.0, 1.0, 0.0);
    z->axis = axis;
    z->up = vec3_unit(vec3_cross(axis, beside));
    z->right = vec3_cross(z->up, axis);
    find_cosines(cosine);
    if (!find_support(support, cosine, z, lights, n, part))
        return false;
    find_border(z, support, cosine);
    return true;
}

// A gap narrower than this was captured. Few lights all around are farther apart than those of a
// dome: as far as they would be if they were spread evenly, each with six others around it.
static double least_gap(int n, bool hemispherical)
{
    return hemispherical ? MESH_WIDE : fmax(MESH_WIDE, sqrt(8.0 * M_PI / (sqrt(3.0) * n)));
}

void zone_find(struct relume_captured_region *zone, const struct relume_vec3 *lights, int n,
               const struct zone_params *p)
{
    const double part = p->part;
    const vec3 pole = p->pole_y ? vec3_of(0.0, 1.0, 0.0) : vec3_of(0.0, 0.0, 1.0);
    vec3 mean = {0.0, 0.0, 0.0};
    for (int i = 0; i < n; i++)
        mean = vec3_add(mean, lights[i]);
    double gap;
    const vec3 lost = mesh_widest_gap(lights, n, &gap);
    *zone = (struct relume_captured_region){.everywhere = true};
    if (n < LEAST_LIGHTS || gap < least_gap(n, p->hemispherical))
        return;
    zone->everywhere =
        !(p->hemispherical && try_axis(zone, pole, lights, n, part)) &&
        !try_axis(zone, vec3_scale(lost, -1.0), lights, n, part) &&
        !(vec3_length(mean) > 1e-6 && try_axis(zone, vec3_unit(mean), lights, n, part));
    if (p->hemispherical && !p->pole_y)
        zone->facing = pole;
}

static double border_at(const struct relume_captured_region *z, double x, double y)
{
    const double at = (atan2(y, x) / (2.0 * M_PI) + 1.0) * STEPS, low = floor(at);
    const int i = (int)low % STEPS;
    return (double)z->border[i] +
           (at - low) * ((double)z->border[(i + 1) % STEPS] - (double)z->border[i]);
}

double relume_captured_region_clamp(struct relume_vec3 *inside,
                                    const struct relume_captured_region *zone,
                                    struct relume_vec3 direction)
{
    const vec3 d = direction;
    const double height = vec3_dot(d, zone->axis);
    *inside = d;
    if (zone->everywhere || height >= zone->inside)
        return 1.0;
    const double x = vec3_dot(d, zone->right), y = vec3_dot(d, zone->up), r = hypot(x, y);
    const double border = border_at(zone, x, y), beyond = atan2(r, height) - border;
    if (beyond <= 0.0)
        return 1.0;
    const double across = r > 0.0 ? sin(border) / r : 0.0;
    *inside = vec3_add(vec3_scale(zone->axis, cos(border)),
                       vec3_along(vec3_scale(zone->right, r > 0.0 ? across * x : sin(border)),
                                  zone->up, across * y));
    const double from = vec3_dot(*inside, zone->facing), to = vec3_dot(d, zone->facing);
    return from > 0.0 ? fmin(fmax((to + UPRIGHT) / (from + UPRIGHT), 0.0), 1.0)
                      : fmax(cos(beyond), 0.0);
}
