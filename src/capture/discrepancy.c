// discrepancy.c - how unevenly directions lie: the spherical cap discrepancy
//
// For a centre c, sort the directions by their cosine to c; between two of them the share of
// directions in the cap stays and its area grows, so the extremes lie just at the directions.
#include "base/memory.h"
#include "base/params.h"
#include "math/vec.h"

#include <relume/directions.h>

enum { CENTRES = 1024 };

static int descending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

static double clamped_acos(double x)
{
    return acos(fmin(fmax(x, -1.0), 1.0));
}

// The share of the hemisphere z > 0 inside the cap around a centre of height `z` with cosine `h`
// (two overlapping caps: Tovchigrechko and Vakser 2001, with one of them a hemisphere).
static double hemisphere_share(double z, double h)
{
    const double sine = sqrt(fmax(0.0, 1.0 - h * h)), side = sqrt(fmax(0.0, 1.0 - z * z));
    if (sine > fabs(z)) {
        const double lens =
            M_PI - clamped_acos(z / sine) - clamped_acos(-z * h / (side * sine)) * h;
        return lens / M_PI;
    }
    // The cap's rim does not cross the horizon.
    if (z >= 0.0)
        return h >= 0.0 ? 1.0 - h : 1.0;
    return h >= 0.0 ? 0.0 : -h;
}

static double worst_around(vec3 centre, const vec3 *lights, int n, double *cosines,
                           const struct relume_directions_params *p)
{
    for (int i = 0; i < n; i++)
        cosines[i] = fmin(fmax(vec3_dot(centre, lights[i]), -1.0), 1.0);
    qsort(cosines, (size_t)n, sizeof *cosines, descending);
    double worst = 0.0;
    for (int i = 0; i < n; i++) {
        const double area = p->hemisphere
                                ? hemisphere_share(pole_from_world(centre, p->pole_y).z, cosines[i])
                                : 0.5 * (1.0 - cosines[i]);
        const double without = (double)i / n, with = (double)(i + 1) / n;
        worst = fmax(worst, fmax(area - without, with - area));
    }
    return worst;
}

static vec3 spiral_point(int k)
{
    const double z = 1.0 - (2.0 * k + 1.0) / CENTRES, r = sqrt(1.0 - z * z);
    const double phi_rad = 2.0 * M_PI * fmod(k * 0.5 * (sqrt(5.0) - 1.0), 1.0);
    return vec3_of(r * cos(phi_rad), r * sin(phi_rad), z);
}

relume_status relume_directions_discrepancy(double *out, const struct relume_vec3 *lights, int n,
                                            const struct relume_directions_params *params)
{
    const struct relume_directions_params p = PARAMS(relume_directions_params, params);
    *out = 0.0;
    if (n < 1)
        return RELUME_EINVAL;
    double *cosines = mem_array((size_t)n, sizeof *cosines);
    if (!cosines)
        return RELUME_ENOMEM;
    const int own = n < CENTRES ? n : CENTRES;
    for (int k = 0; k < own; k++) {
        const vec3 centre = lights[(int64_t)k * n / own];
        *out = fmax(*out, worst_around(centre, lights, n, cosines, &p));
        *out = fmax(*out, worst_around(vec3_scale(centre, -1.0), lights, n, cosines, &p));
    }
    for (int k = 0; k < CENTRES; k++)
        *out = fmax(*out, worst_around(spiral_point(k), lights, n, cosines, &p));
    mem_free(cosines);
    return RELUME_OK;
}
