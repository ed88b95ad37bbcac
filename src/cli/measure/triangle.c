// triangle.c - reflections in triangles with normals at their corners (Meseth 2008, 11.3)
//
// Places and directions are interpolated alike, directions are not made unit again:
//     p = (1 - a - b) (t1 + k d1) + a (t2 + k d2) + b (t3 + k d3)                          (11.12)
// so that the three t_i - p + k d_i lie in a plane, which is a cubic in k. The thesis prints a sign
// of C and Cardano's q and rho wrongly; here they are as they follow from the determinant.
#include "cli/measure/triangle.h"

void mirror_triangle_make(struct mirror_triangle *out, const vec3 corner[3], const vec3 normal[3],
                          vec3 eye)
{
    for (int i = 0; i < 3; i++) {
        const vec3 e = vec3_unit(vec3_sub(eye, corner[i]));
        out->t[i] = corner[i];
        out->d[i] = vec3_sub(vec3_scale(normal[i], 2.0 * vec3_dot(e, normal[i])), e);
    }
}

static double det(vec3 a, vec3 b, vec3 c)
{
    return vec3_dot(a, vec3_cross(b, c));
}

// a x^2 + b x + c
static int roots_of_square(double x[3], double a, double b, double c)
{
    const double inside = b * b - 4.0 * a * c;
    if (a == 0.0) {
        x[0] = -c / b;
        return b != 0.0;
    }
    if (inside < 0.0)
        return 0;
    const double q = -0.5 * (b + copysign(sqrt(inside), b));
    x[0] = q / a;
    x[1] = q != 0.0 ? c / q : 0.0;
    return 2;
}

// Cardano's formula, or its trigonometric form.
static int roots_of_cube(double x[3], double a, double b, double c, double d)
{
    const double r = b / a, s = c / a, t = d / a;
    const double p = s - r * r / 3.0, q = 2.0 * r * r * r / 27.0 - r * s / 3.0 + t;
    const double inside = p * p * p / 27.0 + 0.25 * q * q;
    if (inside >= 0.0) {
        const double root = sqrt(inside);
        x[0] = cbrt(-0.5 * q + root) + cbrt(-0.5 * q - root) - r / 3.0;
        x[1] = -cbrt(-0.5 * q) - r / 3.0;  // twice, where `inside` is 0
        return inside > 0.0 ? 1 : 2;
    }
    const double rho = sqrt(-p * p * p / 27.0);
    const double angle = acos(fmin(fmax(-0.5 * q / rho, -1.0), 1.0)) / 3.0;
    for (int i = 0; i < 3; i++)
        x[i] = 2.0 * cbrt(rho) * cos(angle + 2.0 * M_PI * i / 3.0) - r / 3.0;
    return 3;
}

// Newton's method takes off what the formula loses to cancellation.
static double polish(double x, double a, double b, double c, double d)
{
    for (int i = 0; i < 3; i++) {
        const double slope = (3.0 * a * x + 2.0 * b) * x + c;
        const double step = slope != 0.0 ? (((a * x + b) * x + c) * x + d) / slope : 0.0;
        x -= isfinite(step) ? step : 0.0;
    }
    return x;
}

// Weights of p in the triangle of the three s.
static bool weigh(struct triangle_reflection *out, const vec3 s[3], vec3 p)
{
    const vec3 u = vec3_sub(s[1], s[0]), v = vec3_sub(s[2], s[0]), w = vec3_sub(p, s[0]);
    const vec3 n = vec3_cross(u, v);
    const double area = vec3_dot(n, n);
    out->a = vec3_dot(vec3_cross(w, v), n) / area;
    out->b = vec3_dot(vec3_cross(u, w), n) / area;
    return area > 0.0;
}

static double off_middle(const struct triangle_reflection *r)
{
    const double a = r->a - 1.0 / 3.0, b = r->b - 1.0 / 3.0;
    return a * a + b * b + (a + b) * (a + b);
}

bool mirror_triangle_reflect(struct triangle_reflection *out, const struct mirror_triangle *m,
                             vec3 p)
{
    const double TINY = 1e-9;  // of the other coefficients: rays are nearly parallel
    const vec3 *d = m->d;
    vec3 t[3];
    double x[3];
    bool found = false;
    for (int i = 0; i < 3; i++)
        t[i] = vec3_sub(m->t[i], p);
    const double size = vec3_length(t[0]);
    const double a = det(d[0], d[1], d[2]);
    const double b = det(t[0], d[1], d[2]) + det(d[0], t[1], d[2]) + det(d[0], d[1], t[2]);
    const double c = det(t[0], t[1], d[2]) + det(t[0], d[1], t[2]) + det(d[0], t[1], t[2]);
    const double e = det(t[0], t[1], t[2]);
    const double others = fabs(b) / size + fabs(c) / (size * size) + fabs(e) / (size * size * size);
    const int roots =
        fabs(a) > TINY * others ? roots_of_cube(x, a, b, c, e) : roots_of_square(x, b, c, e);
    for (int i = 0; i < roots; i++) {
        struct triangle_reflection r = {.k = polish(x[i], a, b, c, e)};
        vec3 s[3];
        for (int k = 0; k < 3; k++)
            s[k] = vec3_along(m->t[k], d[k], r.k);
        if (!(r.k > 0.0) || !weigh(&r, s, p) || (found && off_middle(&r) >= off_middle(out)))
            continue;
        *out = r;
        found = true;
    }
    return found;
}
