// rotation.c - the rotation nearest to a matrix
//
// With M = U S V^T it is U diag(1, 1, det(U V^T)) V^T: whatever the signs, the first singular pair
// goes over into each other, v1 to u1, and what is left is a turn in the plane across v1. So only
// v1 is looked for, as the first eigenvector of M^T M. M is then brought back by the least rotation
// from v1 to u1, and the turn T of the plane that has the greatest trace(T^T B) with what is left
// of M there, B, is a plain arc tangent. Where B is 0 (rank one) there is no turn, and between both
// cases it fades: nothing is divided by the second singular value.
#include "world/reflect/rotation.h"

// Turns that are smaller than this part of the first singular value are rounding.
static const double OPEN = 1e-10;

static vec3 some_across(vec3 v)
{
    const vec3 axis = fabs(v.x) < 0.7 ? vec3_of(1, 0, 0) : vec3_of(0, 1, 0);
    return vec3_unit(vec3_cross(v, axis));
}

static struct rotation transposed(const struct rotation *m)
{
    return (struct rotation){{vec3_of(m->row[0].x, m->row[1].x, m->row[2].x),
                              vec3_of(m->row[0].y, m->row[1].y, m->row[2].y),
                              vec3_of(m->row[0].z, m->row[1].z, m->row[2].z)}};
}

static struct rotation product(const struct rotation *a, const struct rotation *b)
{
    const struct rotation columns = transposed(b);
    struct rotation out;
    for (int i = 0; i < 3; i++)
        out.row[i] = rotate(&columns, a->row[i]);
    return out;
}

// Rodrigues; `sine` is the length of from x to, which is along the axis.
struct rotation rotation_least(vec3 from, vec3 to)
{
    const vec3 cross = vec3_cross(from, to);
    const double cosine = vec3_dot(from, to);
    struct rotation r = {{vec3_of(cosine, -cross.z, cross.y), vec3_of(cross.z, cosine, -cross.x),
                          vec3_of(-cross.y, cross.x, cosine)}};
    if (cosine > -1.0 + 1e-12) {
        add_outer(&r, 1.0 / (1.0 + cosine), cross, cross);
        return r;
    }
    const vec3 axis = some_across(from);
    r = (struct rotation){{vec3_of(-1, 0, 0), vec3_of(0, -1, 0), vec3_of(0, 0, -1)}};
    add_outer(&r, 2.0, axis, axis);
    return r;
}

// One rotation of Jacobi's method: a[p][q] of the symmetric matrix becomes 0.
static void annihilate(double a[3][3], double v[3][3], int p, int q)
{
    if (a[p][q] == 0.0)
        return;
    const double tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    const double t = copysign(1.0, tau) / (fabs(tau) + hypot(1.0, tau));
    const double c = 1.0 / sqrt(1.0 + t * t), s = t * c;
    for (int k = 0; k < 3; k++) {
        const double kp = a[k][p], kq = a[k][q];
        a[k][p] = c * kp - s * kq;
        a[k][q] = s * kp + c * kq;
    }
    for (int k = 0; k < 3; k++) {
        const double pk = a[p][k], qk = a[q][k], vp = v[k][p], vq = v[k][q];
        a[p][k] = c * pk - s * qk;
        a[q][k] = s * pk + c * qk;
        v[k][p] = c * vp - s * vq;
        v[k][q] = s * vp + c * vq;
    }
}

// The unit eigenvector of the largest eigenvalue of m^T m.
static vec3 first_axis(const struct rotation *m)
{
    enum { SWEEPS = 6 };  // convergence is quadratic
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, a[3][3];
    const struct rotation columns = transposed(m);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            a[i][k] = vec3_dot(columns.row[i], columns.row[k]);
    for (int i = 0; i < SWEEPS; i++) {
        annihilate(a, v, 0, 1);
        annihilate(a, v, 0, 2);
        annihilate(a, v, 1, 2);
    }
    const int two = a[1][1] > a[0][0], first = a[2][2] > a[two][two] ? 2 : two;
    return vec3_unit(vec3_of(v[0][first], v[1][first], v[2][first]));
}

struct rotation rotation_nearest(const struct rotation *m)
{
    const vec3 v = first_axis(m), image = rotate(m, v);
    const double largest = vec3_length(image);
    if (!(largest > 0.0))
        return rotation_least(v, v);
    const struct rotation least = rotation_least(v, vec3_scale(image, 1.0 / largest));
    const vec3 x = some_across(v), y = vec3_cross(v, x);
    const vec3 mx = rotate(m, x), my = rotate(m, y), ux = rotate(&least, x), uy = rotate(&least, y);
    const double across = vec3_dot(ux, mx) + vec3_dot(uy, my) + OPEN * largest;
    const double along = vec3_dot(uy, mx) - vec3_dot(ux, my);
    const double length = hypot(across, along);
    const double c = length > 0.0 ? across / length : 1.0, s = length > 0.0 ? along / length : 0.0;
    struct rotation turn = {{vec3_of(0, 0, 0), vec3_of(0, 0, 0), vec3_of(0, 0, 0)}};
    add_outer(&turn, 1.0, v, v);
    add_outer(&turn, 1.0, vec3_along(vec3_scale(x, c), y, s), x);
    add_outer(&turn, 1.0, vec3_along(vec3_scale(y, c), x, -s), y);
    return product(&least, &turn);
}
