// lathe.c - surfaces of revolution from a profile with smooth stretches and creases
//
// Stretches between creases are uniform Catmull-Rom splines (Catmull and Rom
// 1974): they pass through every listed point, so a profile can be read off a drawing.
#include "world/stage/shapes.h"

struct ring {
    double radius, height;
    double out, up;  // the profile's normal
};

static struct lathe_point spline(const struct lathe_point p[4], double t)
{
    const double w[4] = {
        t * (-0.5 + t * (1.0 - 0.5 * t)),
        1.0 + t * t * (-2.5 + 1.5 * t),
        t * (0.5 + t * (2.0 - 1.5 * t)),
        t * t * (-0.5 + 0.5 * t),
    };
    struct lathe_point at = {0, 0, false};
    for (int i = 0; i < 4; i++) {
        at.radius += w[i] * p[i].radius;
        at.height += w[i] * p[i].height;
    }
    at.radius = at.radius < 0.0 ? 0.0 : at.radius;
    return at;
}

static struct ring ring_at(const struct lathe_point p[4], double t)
{
    const double h = 1e-3;
    const struct lathe_point here = spline(p, t);
    const struct lathe_point before = spline(p, t - h < 0.0 ? 0.0 : t - h);
    const struct lathe_point after = spline(p, t + h > 1.0 ? 1.0 : t + h);
    const double along_r = after.radius - before.radius, along_h = after.height - before.height;
    const double length = hypot(along_r, along_h);
    const double scale = length > 0.0 ? 1.0 / length : 0.0;
    return (struct ring){here.radius, here.height, along_h * scale, -along_r * scale};
}

static void add_ring(struct mesh *out, struct ring ring, int segments)
{
    for (int j = 0; j <= segments; j++) {
        const double phi_rad = 2.0 * M_PI * j / segments;
        const vec3 p = vec3_of(ring.radius * sin(phi_rad), ring.height, ring.radius * cos(phi_rad));
        mesh_vertex(out, p, vec3_of(ring.out * sin(phi_rad), ring.up, ring.out * cos(phi_rad)), p);
    }
}

static void join_rings(struct mesh *out, uint32_t lower, int segments, bool lower_point,
                       bool upper_point)
{
    const uint32_t upper = lower + (uint32_t)segments + 1;
    for (uint32_t j = 0; j < (uint32_t)segments; j++) {
        if (!lower_point)
            mesh_triangle(out, lower + j, lower + j + 1, upper + j + 1, 0);
        if (!upper_point)
            mesh_triangle(out, lower + j, upper + j + 1, upper + j, 0);
    }
}

void shape_lathe(struct mesh *out, const struct lathe_point *profile, int points, int steps,
                 int segments)
{
    for (int i = 0; i + 1 < points; i++) {
        struct lathe_point p[4];
        // The neighbours that shape the piece from point i to i + 1: a crease has none beyond it.
        p[1] = profile[i];
        p[2] = profile[i + 1];
        p[0] = i > 0 && !profile[i].sharp ? profile[i - 1] : profile[i];
        p[3] = i + 2 < points && !profile[i + 1].sharp ? profile[i + 2] : profile[i + 1];
        const bool straight = profile[i].sharp && profile[i + 1].sharp;
        const int pieces = straight ? 1 : steps;
        double radius = 0.0;
        for (int k = 0; k <= pieces; k++) {
            const struct ring ring = ring_at(p, (double)k / pieces);
            const uint32_t first = (uint32_t)out->vertex_count;
            add_ring(out, ring, segments);
            if (k > 0)
                join_rings(out, first - (uint32_t)segments - 1, segments, radius <= 0.0,
                           ring.radius <= 0.0);
            radius = ring.radius;
        }
    }
}
