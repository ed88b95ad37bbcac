// shapes.c - simple solids as meshes, in their own coordinates; texture place = position
#include "world/stage/shapes.h"

static vec3 corner_of(vec3 min, vec3 max, int corner)
{
    return vec3_of(corner & 1 ? max.x : min.x, corner & 2 ? max.y : min.y,
                   corner & 4 ? max.z : min.z);
}

void shape_quad(struct mesh *out, vec3 corner, vec3 u, vec3 v)
{
    const vec3 n = vec3_unit(vec3_cross(u, v));
    const uint32_t a = mesh_vertex(out, corner, n, vec3_of(0, 0, 0));
    const uint32_t b = mesh_vertex(out, vec3_add(corner, u), n, vec3_of(1, 0, 0));
    const uint32_t c = mesh_vertex(out, vec3_add(vec3_add(corner, u), v), n, vec3_of(1, 1, 0));
    const uint32_t d = mesh_vertex(out, vec3_add(corner, v), n, vec3_of(0, 1, 0));
    mesh_triangle(out, a, b, c, 0);
    mesh_triangle(out, a, c, d, 0);
}

// A flat polygon of 3 or 4 corners whose texture place is its position; turned to face away from
// `inside`.
static void flat(struct mesh *out, const vec3 *p, int corners, vec3 inside)
{
    vec3 n = vec3_unit(vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0])));
    const bool turn = vec3_dot(n, vec3_sub(p[0], inside)) < 0.0;
    if (turn)
        n = vec3_scale(n, -1.0);
    uint32_t v[4];
    for (int i = 0; i < corners; i++)
        v[i] = mesh_vertex(out, p[i], n, p[i]);
    for (int i = 2; i < corners; i++)
        mesh_triangle(out, v[0], turn ? v[i] : v[i - 1], turn ? v[i - 1] : v[i], 0);
}

void shape_box(struct mesh *out, vec3 min, vec3 max)
{
    static const int faces[6][4] = {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1},
                                    {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};
    const vec3 center = vec3_scale(vec3_add(min, max), 0.5);
    for (int f = 0; f < 6; f++) {
        vec3 p[4];
        for (int i = 0; i < 4; i++)
            p[i] = corner_of(min, max, faces[f][i]);
        flat(out, p, 4, center);
    }
}

// The corner's point on the face across `axis`: pulled in along the two other axes.
static vec3 pulled_in(vec3 corner, vec3 center, int axis, double edge)
{
    vec3 p = corner;
    p.x -= axis == 0 ? 0.0 : copysign(edge, corner.x - center.x);
    p.y -= axis == 1 ? 0.0 : copysign(edge, corner.y - center.y);
    p.z -= axis == 2 ? 0.0 : copysign(edge, corner.z - center.z);
    return p;
}

void shape_chamfered(struct mesh *out, vec3 min, vec3 max, double edge)
{
    const vec3 center = vec3_scale(vec3_add(min, max), 0.5);
    vec3 p[8][3];
    for (int c = 0; c < 8; c++)
        for (int axis = 0; axis < 3; axis++)
            p[c][axis] = pulled_in(corner_of(min, max, c), center, axis, edge);
    for (int axis = 0; axis < 3; axis++) {
        const int i = 1 << axis, j = 1 << (axis + 1) % 3, k = 1 << (axis + 2) % 3;
        for (int side = 0; side <= i; side += i) {
            const vec3 face[4] = {p[side][axis], p[side | j][axis], p[side | j | k][axis],
                                  p[side | k][axis]};
            flat(out, face, 4, center);
        }
        // The four edges along this axis: between the faces across the two others.
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        for (int e = 0; e < 4; e++) {
            const int c = (e & 1 ? j : 0) | (e & 2 ? k : 0);
            const vec3 strip[4] = {p[c][a], p[c | i][a], p[c | i][b], p[c][b]};
            flat(out, strip, 4, center);
        }
    }
    for (int c = 0; c < 8; c++)
        flat(out, p[c], 3, center);
}

void shape_sphere(struct mesh *out, vec3 center, double radius, int segments)
{
    const int rings = segments / 2;
    const uint32_t first = (uint32_t)out->vertex_count;
    for (int i = 0; i <= rings; i++)
        for (int j = 0; j <= segments; j++) {
            const double theta_rad = M_PI * i / rings, phi_rad = 2.0 * M_PI * j / segments;
            const vec3 n = vec3_of(sin(theta_rad) * sin(phi_rad), cos(theta_rad),
                                   sin(theta_rad) * cos(phi_rad));
            const vec3 p = vec3_along(center, n, radius);
            mesh_vertex(out, p, n, p);
        }
    const uint32_t row = (uint32_t)segments + 1;
    for (uint32_t i = 0; i < (uint32_t)rings; i++)
        for (uint32_t j = 0; j < (uint32_t)segments; j++) {
            const uint32_t a = first + i * row + j, c = a + row;
            if (i + 1 < (uint32_t)rings)
                mesh_triangle(out, a, c, c + 1, 0);
            if (i > 0)
                mesh_triangle(out, a, c + 1, a + 1, 0);
        }
}

void shape_disc(struct mesh *out, double radius, double height, int segments)
{
    const vec3 up = vec3_of(0, 1, 0), middle = vec3_of(0, height, 0);
    const uint32_t center = mesh_vertex(out, middle, up, middle);
    for (int j = 0; j < segments; j++) {
        const double phi_rad = 2.0 * M_PI * j / segments;
        const vec3 p = vec3_of(radius * sin(phi_rad), height, radius * cos(phi_rad));
        mesh_vertex(out, p, up, p);
    }
    for (uint32_t j = 0; j < (uint32_t)segments; j++)
        mesh_triangle(out, center, center + 1 + j, center + 1 + (j + 1) % (uint32_t)segments, 0);
}
