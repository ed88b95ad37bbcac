// light.c - what each kind of light is, and what point-like ones send to a point
#include "relight/light/light.h"

#include "core/base/log.h"
#include "core/math/bilinear.h"
#include "core/math/scalar.h"
#include "core/math/vec.h"
#include "relight/light/environment.h"

static const char *const kind_names[] = {
    [RELUME_LIGHT_DIRECTIONAL] = "dir", [RELUME_LIGHT_ENVIRONMENT] = "env",
    [RELUME_LIGHT_POINT] = "point",     [RELUME_LIGHT_SPOT] = "spot",
    [RELUME_LIGHT_SLIDE] = "slide",     [RELUME_LIGHT_AREA] = "area",
    [RELUME_LIGHT_IES] = "ies",         [RELUME_LIGHT_GONIO] = "gonio",
};

const char *relume_light_kind_name(enum relume_light_kind kind)
{
    return kind_names[kind];
}

static bool same_vector(struct relume_vec3 a, struct relume_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool relume_light_equal(const struct relume_light *a, const struct relume_light *b)
{
    return a->kind == b->kind && same_vector(a->direction, b->direction) &&
           same_vector(a->position, b->position) && same_vector(a->u, b->u) &&
           same_vector(a->v, b->v) && a->disc == b->disc && a->nofall == b->nofall &&
           a->half_angle_deg == b->half_angle_deg && a->rotate_deg == b->rotate_deg &&
           a->rgb[0] == b->rgb[0] && a->rgb[1] == b->rgb[1] && a->rgb[2] == b->rgb[2] &&
           a->image == b->image && a->environment == b->environment && a->ies == b->ies &&
           a->gonio == b->gonio;
}

// ---------------------------------------------------------------- checks

enum needs {
    DIRECTION = 1,
    POSITION = 2,
    ANGLE = 4,
    EDGES = 8,
    IMAGE = 16,
    MAP = 32,
    TABLE = 64,
    FACES = 128
};

static const int needs[] = {
    [RELUME_LIGHT_DIRECTIONAL] = DIRECTION,
    [RELUME_LIGHT_ENVIRONMENT] = MAP,
    [RELUME_LIGHT_POINT] = POSITION,
    [RELUME_LIGHT_SPOT] = POSITION | DIRECTION | ANGLE,
    [RELUME_LIGHT_SLIDE] = POSITION | DIRECTION | ANGLE | IMAGE,
    [RELUME_LIGHT_AREA] = POSITION | EDGES,
    [RELUME_LIGHT_IES] = POSITION | DIRECTION | TABLE,
    [RELUME_LIGHT_GONIO] = POSITION | DIRECTION | FACES,
};

// Sums of products of values and 1 / distance^2 stay far from the largest float.
static const double MOST_VALUE = 1e9;
static const double MOST_EDGE = 1e6;  // values times areas too

static bool all_finite(vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static bool fits(vec3 edge)
{
    return vec3_length(edge) <= MOST_EDGE;
}

static bool has_length(vec3 v)
{
    const double length = vec3_length(v);
    return length > 1e-12 && isfinite(length);
}

const char *light_complaint(const struct relume_light *l, bool with_files)
{
    const int files = IMAGE | MAP | TABLE | FACES,
              need = needs[l->kind] & (with_files ? ~0 : ~files);
    for (int c = 0; c < 3; c++)
        if (!(fabs((double)l->rgb[c]) <= MOST_VALUE))
            return "expected values of at most 1e9";
    if (need & DIRECTION && !has_length(l->direction))
        return "expected a direction, found zero";
    if (need & POSITION && !all_finite(l->position))
        return "expected a finite position";
    if (need & ANGLE && !(l->half_angle_deg > 0.0 && l->half_angle_deg < 90.0))
        return "expected a half angle between 0 and 90 degrees, both excluded";
    if (need & EDGES && !has_length(vec3_cross(l->u, l->v)))
        return "expected two half edges that span an area";
    if (need & EDGES && !(fits(l->u) && fits(l->v)))
        return "expected half edges of at most 1e6";
    if (need & IMAGE && !(l->image && l->image->data && l->image->channels == 3))
        return "expected a picture of three channels";
    if (!(fabs(l->rotate_deg) <= MOST_VALUE))
        return "expected a finite rotation";
    if (need & MAP && !l->environment)
        return "expected an environment map";
    if ((need & TABLE && !l->ies) || (need & FACES && !l->gonio))
        return "expected a distribution";
    return NULL;
}

relume_status relume_light_check(const struct relume_light *light, const char *name,
                                 const struct relume_log *log)
{
    const bool known = light->kind >= 0 && (size_t)light->kind < sizeof needs / sizeof *needs;
    const char *wrong = known ? light_complaint(light, true) : "unknown kind";
    return wrong ? log_fail(log, RELUME_EINVAL, "%s: %s", name, wrong) : RELUME_OK;
}

// ---------------------------------------------------------------- near lights

void relume_light_frame(struct relume_vec3 *right, struct relume_vec3 *up, struct relume_vec3 axis)
{
    const vec3 a = vec3_unit(axis), y = {0.0, 1.0, 0.0}, z = {0.0, 0.0, 1.0};
    const bool vertical = fabs(a.y) > 1.0 - 1e-9;
    *right = vec3_unit(vec3_cross(a, vertical ? z : y));
    *up = vec3_cross(*right, a);
}

static double radians(double degrees)
{
    return degrees * (M_PI / 180.0);
}

// Full inside 0.9 of the half angle, by angle. Most of what lies outside is found by cos x >= 1 -
// x^2 / 2.
static bool spot_factor(float rgb[3], const struct relume_light *l, vec3 ray)
{
    const vec3 axis = vec3_unit(l->direction);
    const double half = radians(l->half_angle_deg);
    if (vec3_dot(ray, axis) < 1.0 - 0.5 * half * half)
        return false;
    const double angle = vec3_angle(ray, axis);
    const float f = (float)(1.0 - smoothstep(0.9 * half, half, angle));
    for (int c = 0; c < 3; c++)
        rgb[c] *= f;
    return f > 0.0f;
}

static bool slide_factor(float rgb[3], const struct relume_light *l, vec3 ray)
{
    vec3 right, up;
    relume_light_frame(&right, &up, l->direction);
    const double forward = vec3_dot(ray, vec3_unit(l->direction));
    if (!(forward > 0.0))
        return false;
    const double scale = l->image->width / (2.0 * tan(radians(l->half_angle_deg)) * forward);
    const double x = 0.5 * l->image->width + scale * vec3_dot(ray, right);
    const double y = 0.5 * l->image->height - scale * vec3_dot(ray, up);
    if (!(x >= 0.0 && x <= l->image->width && y >= 0.0 && y <= l->image->height))
        return false;
    const struct bilinear b =
        bilinear_at(x - 0.5, y - 0.5, l->image->width, l->image->height, EDGE_CLAMPED);
    for (size_t c = 0; c < 3; c++)
        rgb[c] *= bilinear_valuef(&b, l->image->data, 3, c);
    return true;
}

// The plane of horizontal angle 0 holds the right of the lamp's frame, that of 90 its up.
static bool ies_factor(float rgb[3], const struct relume_light *l, vec3 ray)
{
    vec3 right, up;
    relume_light_frame(&right, &up, l->direction);
    const double vertical = vec3_angle(ray, vec3_unit(l->direction));
    const double horizontal = atan2(vec3_dot(ray, up), vec3_dot(ray, right));
    const float f =
        (float)relume_ies_value(l->ies, vertical * (180.0 / M_PI), horizontal * (180.0 / M_PI));
    for (int c = 0; c < 3; c++)
        rgb[c] *= f;
    return f > 0.0f;
}

// The axis is ahead (-z) in the map.
static bool gonio_factor(float rgb[3], const struct relume_light *l, vec3 ray)
{
    vec3 right, up;
    float value[3];
    relume_light_frame(&right, &up, l->direction);
    const double ahead = vec3_dot(ray, vec3_unit(l->direction));
    relume_gonio_value(value, l->gonio, vec3_of(vec3_dot(ray, right), vec3_dot(ray, up), -ahead));
    for (int c = 0; c < 3; c++)
        rgb[c] *= value[c];
    return value[0] > 0.0f || value[1] > 0.0f || value[2] > 0.0f;
}

// Nearer than this a light is taken to be in the surface, and nothing arrives.
static const double LEAST_DISTANCE = 1e-6;

static bool ray_to(vec3 *towards, double *distance, vec3 from, vec3 point)
{
    const vec3 d = vec3_sub(from, point);
    *distance = vec3_length(d);
    *towards = vec3_scale(d, 1.0 / *distance);
    return *distance >= LEAST_DISTANCE && isfinite(*distance);
}

bool relume_light_at(struct relume_vec3 *towards, float rgb[3], const struct relume_light *light,
                     struct relume_vec3 point)
{
    double distance;
    if (!ray_to(towards, &distance, light->position, point))
        return false;
    const float fall = light->nofall ? 1.0f : (float)(1.0 / (distance * distance));
    for (int c = 0; c < 3; c++)
        rgb[c] = light->rgb[c] * fall;
    const vec3 ray = vec3_scale(*towards, -1.0);
    switch (light->kind) {
    case RELUME_LIGHT_POINT: return true;
    case RELUME_LIGHT_SPOT: return spot_factor(rgb, light, ray);
    case RELUME_LIGHT_SLIDE: return slide_factor(rgb, light, ray);
    case RELUME_LIGHT_IES: return ies_factor(rgb, light, ray);
    case RELUME_LIGHT_GONIO: return gonio_factor(rgb, light, ray);
    case RELUME_LIGHT_DIRECTIONAL:
    case RELUME_LIGHT_ENVIRONMENT:
    case RELUME_LIGHT_AREA: break;
    }
    return false;
}

bool relume_light_patch_at(struct relume_vec3 *towards, float rgb[3],
                           const struct relume_light_patch *patch, struct relume_vec3 point)
{
    double distance;
    if (!ray_to(towards, &distance, patch->position, point))
        return false;
    const double cosine = -vec3_dot(*towards, patch->normal);
    const float f = (float)(cosine / (distance * distance));
    for (int c = 0; c < 3; c++)
        rgb[c] = patch->rgb[c] * f;
    return cosine > 0.0;
}
