// bezier.c - reflections in convex Bezier patches (Meseth 2008, 11.2)
//
// By Fermat's principle the way of light from the eye by S(u, v) to the place is shortest:
//     d(u, v) = |S - eye| + |S - place|
// Newton's method from the middle, with steps that are halved while half of one leads to less. The
// powers' matrix has (-1)^(j - i) C(3, j) C(j, i); the thesis prints (-1)^(j - 1).
#include "cli/measure/bezier.h"

void bezier_make(struct bezier *out, const vec3 control[4][4])
{
    static const double matrix[4][4] = {
        {1, 0, 0, 0}, {-3, 3, 0, 0}, {3, -6, 3, 0}, {-1, 3, -3, 1}};  // [power][control]
    for (int j = 0; j < 4; j++)
        for (int l = 0; l < 4; l++) {
            out->power[j][l] = vec3_of(0, 0, 0);
            for (int i = 0; i <= j; i++)
                for (int k = 0; k <= l; k++)
                    out->power[j][l] =
                        vec3_along(out->power[j][l], control[i][k], matrix[j][i] * matrix[l][k]);
        }
}

// t^j and its derivatives.
struct powers {
    double of[4], once[4], twice[4];
};

static struct powers powers_of(double t)
{
    return (struct powers){{1, t, t * t, t * t * t}, {0, 1, 2 * t, 3 * t * t}, {0, 0, 2, 6 * t}};
}

static vec3 sum(const struct bezier *b, const double u[4], const double v[4])
{
    vec3 s = {0, 0, 0};
    for (int j = 0; j < 4; j++)
        for (int l = 0; l < 4; l++)
            s = vec3_along(s, b->power[j][l], u[j] * v[l]);
    return s;
}

void bezier_at(struct bezier_point *out, const struct bezier *b, double u, double v)
{
    const struct powers a = powers_of(u), c = powers_of(v);
    *out = (struct bezier_point){
        .s = sum(b, a.of, c.of),
        .u = sum(b, a.once, c.of),
        .v = sum(b, a.of, c.once),
        .uu = sum(b, a.twice, c.of),
        .uv = sum(b, a.once, c.once),
        .vv = sum(b, a.of, c.twice),
    };
}

static double length_by(const struct bezier *b, vec3 eye, vec3 place, double u, double v)
{
    const struct powers a = powers_of(u), c = powers_of(v);
    const vec3 s = sum(b, a.of, c.of);
    return vec3_length(vec3_sub(s, eye)) + vec3_length(vec3_sub(s, place));
}

// How the direction of r turns where S moves by `by`.
static vec3 turn(vec3 r, vec3 by)
{
    const double length = vec3_length(r);
    return vec3_scale(vec3_sub(by, vec3_scale(r, vec3_dot(r, by) / (length * length))),
                      1.0 / length);
}

struct slope {
    double u, v, uu, uv, vv;
};

static struct slope slope_of(const struct bezier_point *p, vec3 eye, vec3 place)
{
    const vec3 r = vec3_sub(p->s, eye), q = vec3_sub(p->s, place);
    const vec3 e = vec3_add(vec3_unit(r), vec3_unit(q));
    const vec3 by_u = vec3_add(turn(r, p->u), turn(q, p->u));
    const vec3 by_v = vec3_add(turn(r, p->v), turn(q, p->v));
    return (struct slope){
        .u = vec3_dot(p->u, e),
        .v = vec3_dot(p->v, e),
        .uu = vec3_dot(p->uu, e) + vec3_dot(p->u, by_u),
        .uv = vec3_dot(p->uv, e) + vec3_dot(p->u, by_v),
        .vv = vec3_dot(p->vv, e) + vec3_dot(p->v, by_v),
    };
}

bool bezier_reflect(struct bezier_reflection *out, const struct bezier *b, vec3 eye, vec3 place)
{
    enum { MOST = 32, HALVINGS = 20 };
    const double STILL = 1e-12;
    double u = 0.5, v = 0.5;
    for (int i = 1; i <= MOST; i++) {
        struct bezier_point p;
        bezier_at(&p, b, u, v);
        const struct slope s = slope_of(&p, eye, place);
        const double det = s.uu * s.vv - s.uv * s.uv;
        if (!(det > 0.0 && s.uu > 0.0))
            return false;
        double du = -(s.vv * s.u - s.uv * s.v) / det, dv = -(s.uu * s.v - s.uv * s.u) / det;
        for (int k = 0; k < HALVINGS && length_by(b, eye, place, u + 0.5 * du, v + 0.5 * dv) <
                                            length_by(b, eye, place, u + du, v + dv);
             k++)
            du *= 0.5, dv *= 0.5;
        u += du, v += dv;
        if (fabs(du) + fabs(dv) < STILL || i == MOST) {
            bezier_at(&p, b, u, v);
            *out = (struct bezier_reflection){u, v, p.s, length_by(b, eye, place, u, v), i};
            return fabs(du) + fabs(dv) < sqrt(STILL);
        }
    }
    return false;
}
