// geometry.c - projections and poses: names, defaults, what fits, from the world and back
#include "core/base/names.h"
#include "core/math/vec.h"
#include "image/geometry/geometry.h"

#include <relume/camera.h>
#include <string.h>

static const char *const names[] = {
    [RELUME_PLANAR] = "planar",       [RELUME_SLAB] = "slab", [RELUME_CYLINDRICAL] = "cylindrical",
    [RELUME_SPHERICAL] = "spherical", [RELUME_CUBE] = "cube",
};
enum { PROJECTIONS = sizeof names / sizeof *names };

const char *relume_projection_name(enum relume_projection projection)
{
    return (unsigned)projection < PROJECTIONS ? names[projection] : NULL;
}

relume_status relume_projection_parse(enum relume_projection *out, const char *name)
{
    const int i = name_find(name, names, PROJECTIONS);
    *out = (enum relume_projection)(i < 0 ? 0 : i);
    return i < 0 ? RELUME_EINVAL : RELUME_OK;
}

struct relume_vec3 relume_geometry_eye(const struct relume_geometry *geometry)
{
    const bool same = geometry->projection == RELUME_PLANAR && !geometry->perspective;
    return (struct relume_vec3){0.0, 0.0, same ? 1.0 : 0.0};
}

struct relume_geometry relume_geometry_default(enum relume_projection projection, int width,
                                               int height)
{
    const double half_height = (double)height / (double)width;
    return (struct relume_geometry){
        .projection = projection,
        .window_min = {-1.0, -half_height},
        .window_max = {1.0, half_height},
        .camera_z = 4.0,
        .uv_z = 3.0,
        .st_min = {-1.0, -1.0},
        .st_max = {1.0, 1.0},
        .v_min = -1.0,
        .v_max = 1.0,
    };
}

// ---------------------------------------------------------------- discs

bool relume_geometry_fits(const struct relume_geometry *g, int width, int height)
{
    if (g->projection != RELUME_CYLINDRICAL || !g->disc)
        return g->disc == 0;
    return g->disc > 0 && g->disc < height && g->disc <= width / 2 && g->v_min < 0.0 &&
           g->v_max > 0.0;
}

bool relume_geometry_shows(const struct relume_geometry *g, int width, int height, int column,
                           int row)
{
    (void)width;
    const int top = height - g->disc;
    if (g->projection != RELUME_CYLINDRICAL || !g->disc || row < top)
        return true;
    const double a = (column % g->disc + 0.5) / g->disc - 0.5;
    const double b = (row - top + 0.5) / g->disc - 0.5;
    return column < 2 * g->disc && a * a + b * b <= 0.25;
}

// ---------------------------------------------------------------- parts

void geometry_crop(struct relume_geometry *g, int width, int height, const struct relume_rect *part)
{
    const bool slab = g->projection == RELUME_SLAB;
    double *low = slab ? g->st_min : g->window_min, *high = slab ? g->st_max : g->window_max;
    const double pixel[2] = {(high[0] - low[0]) / width, (high[1] - low[1]) / height};
    low[0] += pixel[0] * part->left;
    high[0] = low[0] + pixel[0] * part->width;
    high[1] -= pixel[1] * part->top;
    low[1] = high[1] - pixel[1] * part->height;
}

// ---------------------------------------------------------------- pose

static bool near_to(double found, double wanted)
{
    return fabs(found - wanted) <= 1e-3;
}

bool relume_pose_normalise(struct relume_pose *pose)
{
    vec3 *a = pose->axis;
    if (vec3_is_zero(a[0]) && vec3_is_zero(a[1]) && vec3_is_zero(a[2])) {
        a[0] = vec3_of(1, 0, 0);
        a[1] = vec3_of(0, 1, 0);
        a[2] = vec3_of(0, 0, 1);
    }
    for (int i = 0; i < 3; i++) {
        const vec3 turned = vec3_cross(a[(i + 1) % 3], a[(i + 2) % 3]);
        if (!near_to(vec3_length(a[i]), 1.0) || !near_to(vec3_dot(turned, a[i]), 1.0) ||
            !near_to(vec3_dot(a[i], a[(i + 1) % 3]), 0.0))
            return false;
    }
    a[2] = vec3_unit(a[2]);
    a[0] = vec3_unit(vec3_cross(a[1], a[2]));
    a[1] = vec3_cross(a[2], a[0]);
    return isfinite(pose->origin.x) && isfinite(pose->origin.y) && isfinite(pose->origin.z);
}

vec3 relume_pose_turn(const struct relume_pose *pose, vec3 local)
{
    const vec3 *a = pose->axis;
    if (vec3_is_zero(a[0]))  // the world; nobody has normalised
        return local;
    return vec3_add(vec3_scale(a[0], local.x),
                    vec3_along(vec3_scale(a[1], local.y), a[2], local.z));
}

vec3 relume_pose_turn_back(const struct relume_pose *pose, vec3 world)
{
    const vec3 *a = pose->axis;
    if (vec3_is_zero(a[0]))
        return world;
    return vec3_of(vec3_dot(a[0], world), vec3_dot(a[1], world), vec3_dot(a[2], world));
}

vec3 relume_pose_world(const struct relume_pose *pose, vec3 local)
{
    return vec3_add(pose->origin, relume_pose_turn(pose, local));
}

vec3 relume_pose_local(const struct relume_pose *pose, vec3 world)
{
    return relume_pose_turn_back(pose, vec3_sub(world, pose->origin));
}
