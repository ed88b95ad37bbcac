// teapot.c - the Utah teapot (Newell 1975): 32 bicubic Bezier patches
//
// Body, rim, lid, knob and bottom are profiles turned about the axis in quarter turns whose inner
// control points lie 0.56 of the radius off the axis planes; handle and spout are half patches
// mirrored in the plane of symmetry. Newell's axis is z; here it becomes y.
#include "world/stage/shapes.h"

#include <string.h>

struct patch {
    vec3 control[4][4];
};

// Radius and height of the four control rows of each turned part.
static const double turned[6][4][2] = {
    {{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}},  // rim
    {{1.5, 2.4}, {1.75, 1.875}, {2.0, 1.35}, {2.0, 0.9}},            // upper body
    {{2.0, 0.9}, {2.0, 0.45}, {1.5, 0.225}, {1.5, 0.15}},            // lower body
    {{0.0, 3.15}, {0.8, 3.15}, {0.0, 2.85}, {0.2, 2.7}},             // knob
    {{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}},              // lid
    {{1.5, 0.15}, {1.5, 0.075}, {1.425, 0.0}, {0.0, 0.0}},           // bottom
};
static const double ROUND = 0.56;  // 4/3 tan(pi/8) = 0.5523 would be nearer to a circle

// Half of handle and spout, for y <= 0: x, y, z of Newell.
static const double halves[4][4][4][3] = {
    {{{-1.6, 0, 2.025}, {-1.6, -0.3, 2.025}, {-1.5, -0.3, 2.25}, {-1.5, 0, 2.25}},
     {{-2.3, 0, 2.025}, {-2.3, -0.3, 2.025}, {-2.5, -0.3, 2.25}, {-2.5, 0, 2.25}},
     {{-2.7, 0, 2.025}, {-2.7, -0.3, 2.025}, {-3, -0.3, 2.25}, {-3, 0, 2.25}},
     {{-2.7, 0, 1.8}, {-2.7, -0.3, 1.8}, {-3, -0.3, 1.8}, {-3, 0, 1.8}}},
    {{{-2.7, 0, 1.8}, {-2.7, -0.3, 1.8}, {-3, -0.3, 1.8}, {-3, 0, 1.8}},
     {{-2.7, 0, 1.575}, {-2.7, -0.3, 1.575}, {-3, -0.3, 1.35}, {-3, 0, 1.35}},
     {{-2.5, 0, 1.125}, {-2.5, -0.3, 1.125}, {-2.65, -0.3, 0.9375}, {-2.65, 0, 0.9375}},
     {{-2, 0, 0.9}, {-2, -0.3, 0.9}, {-1.9, -0.3, 0.6}, {-1.9, 0, 0.6}}},
    {{{1.7, 0, 1.425}, {1.7, -0.66, 1.425}, {1.7, -0.66, 0.6}, {1.7, 0, 0.6}},
     {{2.6, 0, 1.425}, {2.6, -0.66, 1.425}, {3.1, -0.66, 0.825}, {3.1, 0, 0.825}},
     {{2.3, 0, 2.1}, {2.3, -0.25, 2.1}, {2.4, -0.25, 2.025}, {2.4, 0, 2.025}},
     {{2.7, 0, 2.4}, {2.7, -0.25, 2.4}, {3.3, -0.25, 2.4}, {3.3, 0, 2.4}}},
    {{{2.7, 0, 2.4}, {2.7, -0.25, 2.4}, {3.3, -0.25, 2.4}, {3.3, 0, 2.4}},
     {{2.8, 0, 2.475}, {2.8, -0.25, 2.475}, {3.525, -0.25, 2.49375}, {3.525, 0, 2.49375}},
     {{2.9, 0, 2.475}, {2.9, -0.15, 2.475}, {3.45, -0.15, 2.5125}, {3.45, 0, 2.5125}},
     {{2.8, 0, 2.4}, {2.8, -0.15, 2.4}, {3.2, -0.15, 2.4}, {3.2, 0, 2.4}}},
};

static struct patch quarter_turn(const double profile[4][2], int quarter)
{
    struct patch p;
    const struct frame turn = frame_turn_y(0.5 * M_PI * quarter);
    for (int i = 0; i < 4; i++) {
        const double r = profile[i][0], y = profile[i][1];
        const vec3 row[4] = {{r, y, 0}, {r, y, ROUND * r}, {ROUND * r, y, r}, {0, y, r}};
        for (int j = 0; j < 4; j++)
            p.control[i][j] = frame_vector(&turn, row[j]);
    }
    return p;
}

static struct patch half_tube(const double half[4][4][3], bool mirrored)
{
    struct patch p;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            const double *c = half[i][j];
            p.control[i][j] = vec3_of(c[0], c[2], mirrored ? c[1] : -c[1]);
        }
    return p;
}

static void bernstein(double t, double value[4], double slope[4])
{
    const double s = 1.0 - t;
    const double b[4] = {s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t};
    const double d[4] = {-3.0 * s * s, 3.0 * s * s - 6.0 * s * t, 6.0 * s * t - 3.0 * t * t,
                         3.0 * t * t};
    memcpy(value, b, sizeof b);
    memcpy(slope, d, sizeof d);
}

struct tangent_plane {
    vec3 position, along_u, along_v;
};

static struct tangent_plane evaluate(const struct patch *p, double u, double v)
{
    double bu[4], du[4], bv[4], dv[4];
    bernstein(u, bu, du);
    bernstein(v, bv, dv);
    struct tangent_plane at = {0};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            const vec3 c = p->control[i][j];
            at.position = vec3_along(at.position, c, bu[i] * bv[j]);
            at.along_u = vec3_along(at.along_u, c, du[i] * bv[j]);
            at.along_v = vec3_along(at.along_v, c, bu[i] * dv[j]);
        }
    return at;
}

// Where a row of control points falls together on the axis, the normal is that of a hair beside.
static vec3 normal_at(const struct patch *p, double u, double v)
{
    const double hair = 1e-4;
    const struct tangent_plane at = evaluate(p, fmin(fmax(u, hair), 1.0 - hair), v);
    const vec3 n = vec3_cross(at.along_v, at.along_u);
    return vec3_length(n) > 0.0 ? vec3_unit(n) : vec3_of(0, 1, 0);
}

static void tessellate(struct mesh *out, const struct patch *p, bool turned_over, int steps)
{
    const uint32_t first = (uint32_t)out->vertex_count, row = (uint32_t)steps + 1;
    for (int i = 0; i <= steps; i++)
        for (int j = 0; j <= steps; j++) {
            const double u = (double)i / steps, v = (double)j / steps;
            const vec3 at = evaluate(p, u, v).position;
            mesh_vertex(out, at, vec3_scale(normal_at(p, u, v), turned_over ? -1.0 : 1.0), at);
        }
    for (uint32_t i = 0; i + 1 < row; i++)
        for (uint32_t j = 0; j + 1 < row; j++) {
            const uint32_t a = first + i * row + j, c = a + row;
            const uint32_t b = turned_over ? c : a + 1, d = turned_over ? a + 1 : c;
            mesh_triangle(out, a, b, c + 1, 0);
            mesh_triangle(out, a, c + 1, d, 0);
        }
}

void shape_teapot(struct mesh *out, int steps)
{
    for (int part = 0; part < 6; part++)
        for (int quarter = 0; quarter < 4; quarter++) {
            const struct patch p = quarter_turn(turned[part], quarter);
            tessellate(out, &p, false, steps);
        }
    for (int part = 0; part < 4; part++)
        for (int mirrored = 0; mirrored < 2; mirrored++) {
            const struct patch p = half_tube(halves[part], mirrored);
            tessellate(out, &p, mirrored, steps);
        }
}
