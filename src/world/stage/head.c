// head.c - a marble head: an egg whose surface is pushed in and out by a few soft features
//
// The face looks along +z. A direction from the middle of the head is sent to a point of an egg;
// features are bumps placed in the face's own plane (x, y), each given by hand.
#include "world/stage/shapes.h"
#include "core/math/scalar.h"
#include "world/stage/texture.h"

static double bell(double x, double width)
{
    return exp(-(x * x) / (width * width));
}

static double bump(vec3 p, double x, double y, double width_x, double width_y)
{
    return bell(p.x - x, width_x) * bell(p.y - y, width_y);
}

// How far the face stands out along z; p.x is made positive, the face is symmetric.
static double relief(vec3 p)
{
    p.x = fabs(p.x);
    const double bridge = smoothstep(-0.20, -0.12, p.y) * smoothstep(0.24, 0.10, p.y);
    const double along = fmin(fmax((0.22 - p.y) / 0.38, 0.0), 1.0);
    double z = 0.0;
    z += bridge * (0.045 + 0.13 * along) * bell(p.x, 0.045 + 0.035 * along);  // nose
    z += 0.055 * bump(p, 0.075, -0.145, 0.045, 0.04);                         // nostrils
    z -= 0.085 * bump(p, 0.215, 0.105, 0.115, 0.075);                         // eye sockets
    z += 0.062 * bump(p, 0.205, 0.095, 0.070, 0.042);                         // eyeballs
    z += 0.016 * bump(p, 0.205, 0.135, 0.085, 0.014);                         // upper lids
    z += 0.010 * bump(p, 0.205, 0.058, 0.075, 0.012);                         // lower lids
    z += 0.036 * bump(p, 0.21, 0.215, 0.13, 0.035);                           // brows
    z += 0.030 * bump(p, 0.28, -0.09, 0.12, 0.11);                            // cheeks
    z += 0.040 * bump(p, 0.0, -0.335, 0.16, 0.095);                           // the mouth's round
    z += 0.022 * bump(p, 0.035, -0.295, 0.085, 0.022);                        // upper lip
    z += 0.028 * bump(p, 0.0, -0.365, 0.080, 0.026);                          // lower lip
    z -= 0.026 * bump(p, 0.0, -0.328, 0.135, 0.011);                          // between the lips
    z -= 0.016 * bump(p, 0.0, -0.235, 0.022, 0.035);                          // philtrum
    z -= 0.022 * bump(p, 0.0, -0.425, 0.10, 0.030);                           // under the lip
    z += 0.050 * bump(p, 0.0, -0.53, 0.13, 0.085);                            // chin
    return z;
}

static vec3 egg(vec3 d)
{
    const double jaw = smoothstep(0.05, -0.75, d.y);
    return vec3_of(d.x * (0.50 - 0.13 * jaw), d.y * 0.66, d.z * (0.58 - 0.09 * jaw) + 0.05 * jaw);
}

// Waves of hair over the skull, combed back from a hairline above the brow.
static double hair(vec3 d, vec3 p)
{
    const double line =
        0.36 - 0.30 * smoothstep(0.55, -0.1, d.z) - 0.55 * smoothstep(0.0, -0.6, d.z);
    const double covered = smoothstep(line - 0.02, line + 0.05, p.y);
    const double bend = noise_sum((float)(4.0 * p.x), (float)(4.0 * p.y), (float)(4.0 * p.z), 3);
    const double angle_rad = atan2(p.x, p.y + 0.35);
    const double strands = sin(26.0 * angle_rad + 5.0 * bend + 7.0 * p.z);
    return covered * (0.055 + 0.016 * strands + 0.02 * bend);
}

static vec3 head_at(vec3 d)
{
    const vec3 p = egg(d);
    vec3 out = p;
    out.z += relief(p) * smoothstep(0.1, 0.45, d.z);
    out = vec3_along(out, d, hair(d, p));
    // Ears: a rim with a hollow at the sides.
    const double ear = exp(-(pow((p.y - 0.02) / 0.12, 2) + pow((p.z + 0.02) / 0.065, 2)));
    const double hollow = exp(-(pow((p.y - 0.03) / 0.065, 2) + pow((p.z - 0.005) / 0.03, 2)));
    out.x += copysign(0.06 * ear - 0.045 * hollow, d.x) * smoothstep(0.5, 0.85, fabs(d.x));
    return out;
}

// The seam of the grid is at the back and shares its vertices, so that normals run across it.
void shape_head(struct mesh *out, int steps)
{
    const uint32_t first = (uint32_t)out->vertex_count, row = (uint32_t)steps + 1;
    for (int i = 0; i <= steps; i++)
        for (int j = 0; j <= steps; j++) {
            const double theta_rad = M_PI * (i + 1e-3) / (steps + 2e-3);
            const double phi_rad = 2.0 * M_PI * (j % steps) / steps;
            const vec3 d = vec3_of(-sin(theta_rad) * sin(phi_rad), cos(theta_rad),
                                   -sin(theta_rad) * cos(phi_rad));
            const vec3 p = head_at(d);
            mesh_vertex(out, p, d, p);
        }
    for (uint32_t i = 0; i + 1 < row; i++)
        for (uint32_t j = 0; j + 1 < row; j++) {
            const uint32_t a = first + i * row + j, b = first + i * row + (j + 1) % (row - 1);
            mesh_triangle(out, a, a + row, b + row, 0);
            mesh_triangle(out, a, b + row, b, 0);
        }
    if (!out->failed)
        mesh_smooth(out);
}
