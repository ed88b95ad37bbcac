// project.c - where a camera sees a place: the inverse of its rays
#include "image/geometry/project.h"

static double part(double x, double a, double b)
{
    return (x - a) / (b - a);
}

static bool planar(double xy[2], double *distance, const struct camera *c, vec3 p)
{
    const struct relume_geometry *g = &c->geometry;
    const double before = g->camera_z - p.z;
    const double scale = g->perspective ? g->camera_z / before : 1.0;
    if (!(before > 0.0))
        return false;
    xy[0] = part(p.x * scale, g->window_min[0], g->window_max[0]) * c->width;
    xy[1] = part(p.y * scale, g->window_max[1], g->window_min[1]) * c->height;
    *distance = g->perspective ? vec3_length(vec3_sub(p, vec3_of(0, 0, g->camera_z))) : before;
    return true;
}

static bool slab(double xy[2], double *distance, const struct camera *c, vec3 place)
{
    const struct relume_geometry *g = &c->geometry;
    const vec3 p = relume_pose_local(&g->pose, place);
    const double t = (g->st_z - g->uv_z) / (p.z - g->uv_z);
    if (!(t > 0.0))
        return false;
    xy[0] = part(c->uv[0] + t * (p.x - c->uv[0]), g->st_min[0], g->st_max[0]) * c->width;
    xy[1] = part(c->uv[1] + t * (p.y - c->uv[1]), g->st_max[1], g->st_min[1]) * c->height;
    *distance = vec3_length(vec3_sub(p, vec3_of(c->uv[0], c->uv[1], g->uv_z)));
    return true;
}

static bool disc(double xy[2], const struct camera *c, vec3 d)
{
    const struct relume_geometry *g = &c->geometry;
    const bool lower = d.y < 0.0;
    const double scale = (lower ? g->v_min : g->v_max) / d.y;
    const double right = d.x * scale, up = (lower ? -d.z : d.z) * scale;
    if (!g->disc || !(right * right + up * up <= 1.0))
        return false;
    xy[0] = (right + 1.0) / 2.0 * g->disc + (lower ? g->disc : 0);
    xy[1] = (1.0 - up) / 2.0 * g->disc + (c->height - g->disc);
    return true;
}

static bool cylinder(double xy[2], const struct camera *c, vec3 d)
{
    const struct relume_geometry *g = &c->geometry;
    const double h = d.y / hypot(d.x, d.z);
    if (!(h >= g->v_min && h <= g->v_max))
        return disc(xy, c, d);
    xy[0] = (atan2(d.x, -d.z) / (2.0 * M_PI) + 0.5) * c->width;
    xy[1] = part(h, g->v_max, g->v_min) * (c->height - g->disc);
    return true;
}

// Faces as camera.c has them.
static void cube(double xy[2], const struct camera *c, vec3 d)
{
    static const vec3 direction[6] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                      {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    static const vec3 up[6] = {{0, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 1, 0}, {0, 1, 0}};
    int face = 0;
    for (int i = 1; i < 6; i++)
        if (vec3_dot(d, direction[i]) > vec3_dot(d, direction[face]))
            face = i;
    const double scale = 1.0 / vec3_dot(d, direction[face]);
    const double right = scale * vec3_dot(d, vec3_cross(direction[face], up[face]));
    xy[0] = (face + (right + 1.0) / 2.0) / 6.0 * c->width;
    xy[1] = (1.0 - scale * vec3_dot(d, up[face])) / 2.0 * c->height;
}

bool camera_project(double xy[2], double *distance, const struct camera *c, vec3 place)
{
    const struct relume_geometry *g = &c->geometry;
    const vec3 d = vec3_sub(place, g->center);
    if (g->projection == RELUME_PLANAR)
        return planar(xy, distance, c, place);
    if (g->projection == RELUME_SLAB)
        return slab(xy, distance, c, place);
    *distance = vec3_length(d);
    if (!(*distance > 0.0))
        return false;
    if (g->projection == RELUME_CYLINDRICAL)
        return cylinder(xy, c, d);
    if (g->projection == RELUME_CUBE) {
        cube(xy, c, d);
        return true;
    }
    xy[0] = (atan2(d.x, -d.z) / (2.0 * M_PI) + 0.5) * c->width;
    xy[1] = (0.5 - asin(d.y / *distance) / M_PI) * c->height;
    return true;
}
