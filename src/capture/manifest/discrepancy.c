// discrepancy.c - how unevenly directions lie: the spherical cap discrepancy
//
// For a centre c, sort the directions by their cosine to c; between two of them the share of
// directions in the cap stays and its area grows, so the extremes lie just at the directions.
// Between two rims the share is at least that at the inner one and the area at most that at the
// outer one, or the other way round: where that is no worse than what is known, nothing is sorted.
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/vec.h"

#include <relume/image/directions.h>
#include <stdlib.h>
#include <string.h>

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

static double area_of(double z, double h, const struct relume_directions_params *p)
{
    return p->hemisphere ? hemisphere_share(z, h) : 0.5 * (1.0 - h);
}

// Directions by classes of their cosines, from 1 down: a class is sorted only where it may be worse
// than what is known, which few are.
struct classes {
    const vec3 *lights;
    const struct relume_directions_params *p;
    double *cosine, *sorted;  // [n]
    int *end;                 // [count + 1]: directions before each class, then behind it
    int n, count;
};

enum { EACH = 4, MOST = 4096 };
static const double ROUNDING = 1e-9;

static int class_of(const struct classes *c, double cosine)
{
    const int k = (int)(0.5 * (1.0 - cosine) * c->count);
    return k < c->count ? k : c->count - 1;
}

static double rim(const struct classes *c, int k)
{
    return 1.0 - 2.0 * k / c->count;
}

// begin[k] of the classes, and `sorted` in their order.
static void distribute(struct classes *c)
{
    for (int i = 0; i < c->n; i++)
        c->sorted[c->end[class_of(c, c->cosine[i])]++] = c->cosine[i];
}

// Of the directions `first` .. `end` in order.
static double worst_of(const struct classes *c, double z, int first, int end)
{
    double worst = 0.0;
    qsort(c->sorted + first, (size_t)(end - first), sizeof *c->sorted, descending);
    for (int i = first; i < end; i++) {
        const double area = area_of(z, c->sorted[i], c->p);
        const double without = (double)i / c->n, with = (double)(i + 1) / c->n;
        worst = fmax(worst, fmax(area - without, with - area));
    }
    return worst;
}

// `known`, or what is worse around a centre.
static double worst_around(vec3 centre, struct classes *c, double known)
{
    const double z = pole_from_world(centre, c->p->pole_y).z;
    bool distributed = false;
    memset(c->end, 0, ((size_t)c->count + 1) * sizeof *c->end);
    for (int i = 0; i < c->n; i++) {
        c->cosine[i] = fmin(fmax(vec3_dot(centre, c->lights[i]), -1.0), 1.0);
        c->end[class_of(c, c->cosine[i]) + 1]++;
    }
    for (int k = 0; k < c->count; k++)
        c->end[k + 1] += c->end[k];
    double inner = area_of(z, 1.0, c->p);
    for (int k = 0; k < c->count; k++) {
        // once they are distributed, `end` of a class is that of its directions, before it was
        // where they begin
        const int first = distributed ? k ? c->end[k - 1] : 0 : c->end[k];
        const int end = distributed ? c->end[k] : c->end[k + 1];
        const double outer = area_of(z, rim(c, k + 1), c->p);
        const double most = fmax(outer - (double)first / c->n, (double)end / c->n - inner);
        inner = outer;
        if (first == end || most + ROUNDING <= known)
            continue;
        if (!distributed)
            distribute(c);
        distributed = true;
        known = fmax(known, worst_of(c, z, first, end));
    }
    return known;
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
    struct classes c = {.lights = lights, .p = &p, .n = n, .count = n / EACH + 1};
    c.count = c.count < MOST ? c.count : MOST;
    c.cosine = mem_array((size_t)n, sizeof *c.cosine);
    c.sorted = mem_array((size_t)n, sizeof *c.sorted);
    c.end = mem_array((size_t)c.count + 1, sizeof *c.end);
    const bool good = c.cosine && c.sorted && c.end;
    const int own = n < CENTRES ? n : CENTRES;
    for (int k = 0; good && k < own; k++) {
        const vec3 centre = lights[(int64_t)k * n / own];
        *out = worst_around(centre, &c, *out);
        *out = worst_around(vec3_scale(centre, -1.0), &c, *out);
    }
    for (int k = 0; good && k < CENTRES; k++)
        *out = worst_around(spiral_point(k), &c, *out);
    mem_free(c.cosine);
    mem_free(c.sorted);
    mem_free(c.end);
    return good ? RELUME_OK : RELUME_ENOMEM;
}
