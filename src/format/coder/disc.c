// disc.c - cosines on the stereographic discs of the sphere (Wong 1998, 9.1.2)
#include "format/coder/disc.h"

#include <string.h>

struct disc_point disc_from_direction(vec3 d)
{
    const double t = 1.0 / (1.0 + fabs(d.z));  // tan(theta / 2) = sin theta / (1 + cos theta)
    return (struct disc_point){(d.x * t + 1.0) / 2.0, (1.0 - d.y * t) / 2.0, d.z < 0.0};
}

vec3 disc_to_direction(struct disc_point p)
{
    double x = 2.0 * p.x - 1.0, y = 1.0 - 2.0 * p.y, r = hypot(x, y);
    if (r > 1.0) {
        x /= r;
        y /= r;
        r = 1.0;
    }
    const double z = (1.0 - r * r) / (1.0 + r * r);
    return vec3_of(x * (1.0 + z), y * (1.0 + z), p.lower ? -z : z);
}

struct disc_wave disc_wave_of(int k)
{
    int zone = 0;
    while (k > zone) {
        k -= zone + 1;
        zone++;
    }
    return (struct disc_wave){k, zone - k};
}

int disc_upper_count(const relume_coder *coder)
{
    const int k = coder->info.coefficients;
    return coder->info.hemispherical ? k : (k + 1) / 2;
}

double disc_cosine(struct disc_wave w, struct disc_point p)
{
    const double scale = (w.u ? M_SQRT2 : 1.0) * (w.v ? M_SQRT2 : 1.0);
    return scale * cos(M_PI * w.u * p.x) * cos(M_PI * w.v * p.y);
}

bool disc_has_count(int count)
{
    return count >= 1 && count <= RELUME_MOST_COEFFICIENTS;
}

// By itself half as many coefficients as lights, at most 28: seven zones.
int disc_fit_count(int want, int lights)
{
    const int most = want ? want : lights / 2 < 28 ? lights / 2 : 28;
    return most < 1 ? 1 : most > lights ? lights : most;
}

void disc_evaluate(const relume_coder *coder, struct relume_vec3 light, double *values)
{
    const struct disc_point p = disc_from_direction(light);
    const int upper = disc_upper_count(coder), all = coder->info.coefficients;
    const int first = p.lower ? upper : 0, count = p.lower ? all - upper : upper;
    memset(values, 0, (size_t)all * sizeof *values);
    for (int k = 0; k < count; k++)
        values[first + k] = disc_cosine(disc_wave_of(k), p);
}

void disc_release(relume_coder *coder)
{
    (void)coder;
}
