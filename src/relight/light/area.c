// area.c - area lights as sums over patches
//
// A point sees the area's radiance E as E / pi times the integral of basis x cos / distance^2 over
// the area. Gauss-Legendre nodes converge to it like rho^-2n, where rho = exp(asinh(d / s)) for
// points at distance d from a light of half size s (the integrand's pole lies that far off the
// light; Trefethen, "Is Gauss quadrature better than Clenshaw-Curtis?", SIAM Review 2008).
#include <relume/light.h>

#include "core/math/vec.h"
#include "relight/light/environment.h"

#include <math.h>

int relume_light_patch_side(const struct relume_light *area, double distance)
{
    const double half = fmax(vec3_length(area->u), vec3_length(area->v));
    // rho^-2n = e^-7 leaves some for the pole's second order.
    const double side = ceil(1.0 + 3.5 / asinh(fmax(distance, 1e-9 * half) / half));
    return side < RELUME_LIGHT_PATCHES_MOST ? (int)side : RELUME_LIGHT_PATCHES_MOST;
}

// The Legendre polynomial of degree n and its derivative.
static double legendre(int n, double x, double *derivative)
{
    double before = 1.0, now = x;
    for (int k = 2; k <= n; k++) {
        const double next = ((2 * k - 1) * x * now - (k - 1) * before) / k;
        before = now;
        now = next;
    }
    *derivative = n * (x * now - before) / (x * x - 1.0);
    return now;
}

// Nodes and weights on [-1, 1] by Newton's iteration from Tricomi's guess.
static void gauss_legendre(double *node, double *weight, int n)
{
    for (int i = 0; i < n; i++) {
        double x = cos(M_PI * (i + 0.75) / (n + 0.5)), slope;
        for (int round = 0; round < 8; round++)
            x -= legendre(n, x, &slope) / slope;
        legendre(n, x, &slope);
        node[i] = x;
        weight[i] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
}

static struct relume_light_patch patch(const struct relume_light *area, double a, double b,
                                       double share)
{
    const vec3 across = vec3_cross(area->u, area->v);
    const double size = share * vec3_length(across) / M_PI;
    const vec3 offset = vec3_along(vec3_scale(area->u, a), area->v, b);
    return (struct relume_light_patch){
        .position = vec3_add(area->position, offset),
        .normal = vec3_unit(across),
        .rgb = {(float)(area->rgb[0] * size), (float)(area->rgb[1] * size),
                (float)(area->rgb[2] * size)},
    };
}

void relume_light_patches(struct relume_light_patch *out, const struct relume_light *area, int side)
{
    double node[RELUME_LIGHT_PATCHES_MOST] = {0.0}, weight[RELUME_LIGHT_PATCHES_MOST] = {2.0};
    if (side > 1)
        gauss_legendre(node, weight, side);
    for (int i = 0; i < side; i++)
        for (int j = 0; j < side; j++, out++) {
            const double r = sqrt(0.5 + 0.5 * node[i]), phi = 2.0 * M_PI * (j + 0.5) / side;
            if (area->disc)
                *out = patch(area, r * cos(phi), r * sin(phi), weight[i] * M_PI / (2.0 * side));
            else
                *out = patch(area, node[i], node[j], weight[i] * weight[j]);
        }
}

static double clamp_unit(double x)
{
    return fmin(fmax(x, -1.0), 1.0);
}

// The distance of `point` from the light's parallelogram; infinite behind it.
static double distance_of(const struct relume_light *l, vec3 point)
{
    const vec3 d = vec3_sub(point, l->position);
    if (!(vec3_dot(d, vec3_cross(l->u, l->v)) > 0.0))
        return (double)INFINITY;
    const double a = clamp_unit(vec3_dot(d, l->u) / vec3_dot(l->u, l->u));
    const double b = clamp_unit(vec3_dot(d, l->v) / vec3_dot(l->v, l->v));
    return vec3_length(vec3_sub(d, vec3_along(vec3_scale(l->u, a), l->v, b)));
}

double relume_area_distance(const struct relume_light *area, const struct relume_image *surface)
{
    const size_t n = (size_t)surface->width * (size_t)surface->height;
    double least = (double)INFINITY;
    for (size_t i = 0; i < n; i++) {
        const float *p = surface->data + 3 * i;
        const double d = distance_of(area, vec3_of((double)p[0], (double)p[1], (double)p[2]));
        least = d < least ? d : least;
    }
    return least;
}
