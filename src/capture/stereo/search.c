// search.c - hexagons that shrink
#include "capture/stereo/search.h"

enum { MOST = 40 };
static const double lowest = 0.15;   // cosine to the eye of the last start
static const double grazing = 0.02;  // cosine to the eye
static const double turned = 0.3;    // from round to round, so that no side stays unseen

vec3 search_beside(vec3 n, double angle, int side, double turn)
{
    const vec3 other = fabs(n.x) < 0.8 ? vec3_of(1, 0, 0) : vec3_of(0, 1, 0);
    const vec3 t = vec3_unit(vec3_cross(n, other)), b = vec3_cross(n, t);
    const double phi = side * M_PI / 3.0 + turn, s = sin(angle);
    return vec3_along(vec3_along(vec3_scale(n, cos(angle)), t, s * cos(phi)), b, s * sin(phi));
}

vec3 search_start(int i, vec3 eye)
{
    const double z = 1.0 - (1.0 - lowest) * (i + 0.5) / SEARCH_STARTS, r = sqrt(1.0 - z * z);
    const double golden = M_PI * (3.0 - sqrt(5.0));
    const vec3 other = fabs(eye.x) < 0.8 ? vec3_of(1, 0, 0) : vec3_of(0, 1, 0);
    const vec3 t = vec3_unit(vec3_cross(other, eye)), b = vec3_cross(eye, t);
    return vec3_along(vec3_along(vec3_scale(eye, z), t, r * cos(golden * i)), b,
                      r * sin(golden * i));
}

vec3 search_find(const struct search *s, vec3 best)
{
    double step = s->first;
    for (int round = 0; step > s->last && round < MOST; round++) {
        const vec3 centre = best;
        bool moved = false;
        double least = s->settle(s->context, centre);
        for (int i = 0; i < SEARCH_SIDES; i++) {
            const vec3 n = search_beside(centre, step, i, turned * round);
            if (vec3_dot(n, s->eye) < grazing)
                continue;
            const double cost = s->cost(s->context, n);
            if (cost < least) {
                least = cost;
                best = n;
                moved = true;
                s->accept(s->context);
            }
        }
        if (!moved)
            step *= 0.5;
    }
    return vec3_unit(best);
}
