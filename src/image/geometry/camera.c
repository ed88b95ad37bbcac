// camera.c - the viewing rays of every projection that a capture knows (conventions: capture.h)
#include "image/geometry/camera.h"

static double mix(double a, double b, double t)
{
    return a + (b - a) * t;
}

static struct camera_ray towards(vec3 eye, vec3 target)
{
    return (struct camera_ray){eye, vec3_unit(vec3_sub(target, eye))};
}

// From the centre at azimuth phi (0 is -z, growing towards +x) and height h per unit of radius.
static struct camera_ray around(const struct relume_geometry *g, double phi_rad, double h)
{
    return (struct camera_ray){g->center, vec3_unit(vec3_of(sin(phi_rad), h, -cos(phi_rad)))};
}

static struct camera_ray planar(const struct relume_geometry *g, double across, double down)
{
    const vec3 window = vec3_of(mix(g->window_min[0], g->window_max[0], across),
                                mix(g->window_max[1], g->window_min[1], down), 0.0);
    if (g->perspective)
        return towards(vec3_of(0, 0, g->camera_z), window);
    return (struct camera_ray){vec3_of(window.x, window.y, g->camera_z), vec3_of(0, 0, -1)};
}

static struct camera_ray rectified(const struct camera *c, double across, double down)
{
    const vec3 back = vec3_scale(c->towards, c->geometry.camera_z / c->towards.z);
    return (struct camera_ray){vec3_add(vec3_of(across - 0.5, 0.5 - down, 0.0), back),
                               vec3_scale(c->towards, -1.0)};
}

static struct camera_ray slab(const struct camera *c, double across, double down)
{
    const struct relume_geometry *g = &c->geometry;
    const struct camera_ray local =
        towards(vec3_of(c->uv[0], c->uv[1], g->uv_z),
                vec3_of(mix(g->st_min[0], g->st_max[0], across),
                        mix(g->st_max[1], g->st_min[1], down), g->st_z));
    return (struct camera_ray){relume_pose_world(&g->pose, local.origin),
                               relume_pose_turn(&g->pose, local.direction)};
}

// Below the rows of a cylinder: its discs in their squares, the upper one first.
static struct camera_ray disc(const struct camera *c, double x, double y)
{
    const struct relume_geometry *g = &c->geometry;
    const bool lower = x >= g->disc;
    const double right = 2.0 * (x - (lower ? g->disc : 0)) / g->disc - 1.0;
    const double up = 1.0 - 2.0 * (y - (c->height - g->disc)) / g->disc;
    const vec3 at = lower ? vec3_of(right, g->v_min, -up) : vec3_of(right, g->v_max, up);
    return (struct camera_ray){g->center, vec3_unit(at)};
}

static struct camera_ray cylinder(const struct camera *c, double x, double y)
{
    const struct relume_geometry *g = &c->geometry;
    const int rows = c->height - g->disc;
    if (g->disc && y >= rows)
        return disc(c, x, y);
    return around(g, 2.0 * M_PI * x / c->width - M_PI, mix(g->v_max, g->v_min, y / rows));
}

// Faces +x -x +y -y +z -z side by side; right = direction x up.
static struct camera_ray cube(const struct camera *c, double x, double down)
{
    static const vec3 direction[6] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                      {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    static const vec3 up[6] = {{0, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 1, 0}, {0, 1, 0}};
    const double faces = 6.0 * x / c->width;
    const int face = faces >= 6.0 ? 5 : relume_whole(faces);
    const vec3 right = vec3_cross(direction[face], up[face]);
    const vec3 sideways = vec3_scale(right, 2.0 * (faces - face) - 1.0);
    const vec3 upwards = vec3_scale(up[face], 1.0 - 2.0 * down);
    return (struct camera_ray){c->geometry.center,
                               vec3_unit(vec3_add(direction[face], vec3_add(sideways, upwards)))};
}

struct camera_ray camera_ray_at(const struct camera *camera, double x, double y)
{
    const struct relume_geometry *g = &camera->geometry;
    const double across = x / camera->width, down = y / camera->height;
    if (camera->rectified)
        return rectified(camera, across, down);
    switch (g->projection) {
    case RELUME_SLAB: return slab(camera, across, down);
    case RELUME_CYLINDRICAL: return cylinder(camera, x, y);
    case RELUME_SPHERICAL: {
        const double phi_rad = 2.0 * M_PI * across - M_PI;
        const double elevation_rad = M_PI * (0.5 - down);
        const double r = cos(elevation_rad);
        return (struct camera_ray){
            g->center, vec3_of(r * sin(phi_rad), sin(elevation_rad), -r * cos(phi_rad))};
    }
    case RELUME_CUBE: return cube(camera, x, down);
    case RELUME_PLANAR: break;
    }
    return planar(g, across, down);
}
