// stage.c - rays through the depth of a view
//
// A ray goes in steps of less than a pixel. Where it is behind the surface that the view sees
// there, but not by more than what stands there is thick, light is stopped. Distances are measured
// so that their inverse is linear over the pixels of a plane (of STAGE_FLAT the distance itself).
#include "relight/shadow/stage.h"

#include "core/base/memory.h"
#include "relight/shadow/moving.h"

#include <math.h>
#include <string.h>

// In pixels: how far rays go at once, how far from the surface they start and are behind it before
// it counts, how much nearer a neighbour is at most on the same surface, how far rays are followed
// beyond all that is seen.
static const double STEP = 0.7, START = 1.0, NEAR = 0.25, SAME = 12.0, MARGIN = 2.0;

// Parallel rays: what lies deeper than that many pictures are wide is background, which renderers
// write as some large number. Rays would go there step by step.
static const double DEEPEST = 16.0;

// Rays that are in front of all that is seen nearby go by tiles.
enum { TILE = RELUME_SHADOW_TILE };

bool stage_suits(const struct relume_geometry *g)
{
    if (g->projection == RELUME_SLAB)
        return g->uv_z != g->st_z;
    if (g->projection == RELUME_PLANAR)
        return !g->perspective || g->camera_z != 0.0;
    return g->projection != RELUME_CUBE && !(g->projection == RELUME_CYLINDRICAL && g->disc);
}

// ---------------------------------------------------------------- places

static void set_window(struct stage *s, const double min[2], const double max[2], double u,
                       double v, double distance)
{
    s->axis = distance > 0.0 ? -1.0 : 1.0;
    s->scale[0] = fabs(distance) * s->width / (max[0] - min[0]);
    s->scale[1] = -fabs(distance) * s->height / (max[1] - min[1]);
    s->shift[0] = (u - min[0]) * s->width / (max[0] - min[0]);
    s->shift[1] = (max[1] - v) * s->height / (max[1] - min[1]);
    s->pixel = 1.0 / fmax(s->scale[0], -s->scale[1]);
}

static void set_up(struct stage *s, const struct relume_geometry *g, const double uv[2])
{
    switch (g->projection) {
    case RELUME_SLAB:
        s->kind = STAGE_EYE;
        s->pose = g->pose;
        s->eye = relume_pose_world(&g->pose, vec3_of(uv[0], uv[1], g->uv_z));
        set_window(s, g->st_min, g->st_max, uv[0], uv[1], g->uv_z - g->st_z);
        return;
    case RELUME_CYLINDRICAL:
        s->kind = STAGE_CYLINDER;
        s->scale[1] = s->height / (g->v_min - g->v_max);
        s->shift[1] = -g->v_max * s->scale[1];
        break;
    case RELUME_SPHERICAL:
        s->kind = STAGE_SPHERE;
        s->scale[1] = -s->height / M_PI;
        s->shift[1] = 0.5 * s->height;
        break;
    case RELUME_CUBE:
    case RELUME_PLANAR:
        s->kind = g->perspective ? STAGE_EYE : STAGE_FLAT;
        s->eye.z = g->perspective ? g->camera_z : 0.0;
        set_window(s, g->window_min, g->window_max, 0.0, 0.0, g->perspective ? g->camera_z : 1.0);
        return;
    }
    s->eye = g->center;
    s->scale[0] = s->width / (2.0 * M_PI);
    s->shift[0] = 0.5 * s->width;
    s->pixel = 1.0 / s->scale[0];
}

// Where the axis of the ray through a pixel is at distance 1; STAGE_FLAT: where it starts.
static vec3 ray_of(const struct stage *s, double x, double y)
{
    const double a = (x - s->shift[0]) / s->scale[0], b = (y - s->shift[1]) / s->scale[1];
    switch (s->kind) {
    case STAGE_CYLINDER: return vec3_of(sin(a), b, -cos(a));
    case STAGE_SPHERE: return vec3_of(sin(a) * cos(b), sin(b), -cos(a) * cos(b));
    case STAGE_EYE: return vec3_of(a, b, s->axis);
    case STAGE_FLAT: break;
    }
    return vec3_of(a, b, 0.0);
}

static vec3 at_distance(const struct stage *s, double x, double y, double far)
{
    const vec3 ray = ray_of(s, x, y);
    return s->kind == STAGE_FLAT ? vec3_of(ray.x, ray.y, -far) : vec3_scale(ray, far);
}

// atan2, within 2e-8: a ten thousandth of a pixel of pictures 2^15 wide (Abramowitz and Stegun
// 1964, 4.4.49).
static inline double angle_of(double y, double x)
{
    const double across = fabs(y), along = fabs(x);
    const bool steep = across > along;
    const double larger = steep ? across : along,
                 t = larger > 0.0 ? (steep ? along : across) / larger : 0.0;
    const double u = t * t;
    double a = 0.0028662257;
    a = -0.0161657367 + a * u;
    a = 0.0429096138 + a * u;
    a = -0.0752896400 + a * u;
    a = 0.1065626393 + a * u;
    a = -0.1420889944 + a * u;
    a = 0.1999355085 + a * u;
    a = -0.3333314528 + a * u;
    a = t + t * u * a;
    a = steep ? 0.5 * M_PI - a : a;
    return copysign(x < 0.0 ? M_PI - a : a, y);
}

// The pixel that sees a point and how far it is.
struct place {
    double x, y, far;
};

// False outside the picture.
static inline bool place_of(struct place *at, const struct stage *s, enum stage_kind kind, vec3 p)
{
    double a = p.x, b = p.y, far = s->axis * p.z;
    if (kind == STAGE_EYE) {
        a /= far;
        b /= far;
    } else if (kind != STAGE_FLAT) {
        const double level = sqrt(p.x * p.x + p.z * p.z);
        far = kind == STAGE_CYLINDER ? level : vec3_length(p);
        a = angle_of(p.x, -p.z);
        b = kind == STAGE_CYLINDER ? p.y / level : angle_of(p.y, level);
    }
    a = s->scale[0] * a + s->shift[0];
    b = s->scale[1] * b + s->shift[1];
    if (kind >= STAGE_CYLINDER && a >= s->width)
        a = 0.0;
    *at = (struct place){a, b, far};
    return (kind == STAGE_FLAT || far > 0.0) && a >= 0.0 && a < s->width && b >= 0.0 &&
           b < s->height;
}

static inline double side_at(const struct stage *s, enum stage_kind kind, double far)
{
    const double side = s->pixel * far;
    return kind == STAGE_FLAT ? s->pixel : side > s->least_side ? side : s->least_side;
}

// ---------------------------------------------------------------- the surface

static double far_of(const struct stage *s, int x, int y)
{
    if (s->kind >= STAGE_CYLINDER)
        x = (x % s->width + s->width) % s->width;
    x = x < 0 ? 0 : x < s->width ? x : s->width - 1;
    y = y < 0 ? 0 : y < s->height ? y : s->height - 1;
    return (double)s->far[(size_t)y * (size_t)s->width + (size_t)x];
}

// The four pixels around (x, y).
static const struct cell *cell_at(const struct stage *s, double x, double y)
{
    return s->cell + (size_t)(int)(y + 0.5) * ((size_t)s->width + 1) + (size_t)(int)(x + 0.5);
}

// Between four pixels of one surface what lies on their plane, else the nearest of them.
static double surface_at(const struct stage *s, double x, double y)
{
    const int i = (int)(x + 0.5) - 1, j = (int)(y + 0.5) - 1;
    const double a = x - 0.5 - i, b = y - 0.5 - j;
    const double z[4] = {far_of(s, i, j), far_of(s, i + 1, j), far_of(s, i, j + 1),
                         far_of(s, i + 1, j + 1)};
    const struct cell *c = cell_at(s, x, y);
    const double least = (double)c->least, most = (double)c->most;
    if (!(most - least < SAME * side_at(s, s->kind, least)))
        return z[(a > 0.5) + 2 * (b > 0.5)];
    const double w[4] = {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b};
    if (s->kind == STAGE_FLAT)
        return w[0] * z[0] + w[1] * z[1] + w[2] * z[2] + w[3] * z[3];
    return 1.0 / (w[0] / z[0] + w[1] / z[1] + w[2] / z[2] + w[3] / z[3]);
}

bool stage_point(vec3 *point, const struct stage *s, double x, double y)
{
    const double far = surface_at(s, x, y);
    *point = at_distance(s, x, y, far);
    return isfinite(far);
}

// ---------------------------------------------------------------- rays

// How far a ray from inside goes until it leaves the box.
static double leaves_box(const struct stage *s, vec3 p, vec3 d)
{
    const double from[3] = {p.x, p.y, p.z}, along[3] = {d.x, d.y, d.z};
    const double low[3] = {s->low.x, s->low.y, s->low.z};
    const double high[3] = {s->high.x, s->high.y, s->high.z};
    double end = INFINITY;
    for (int i = 0; i < 3; i++)
        if (along[i] != 0.0)
            end = fmin(end, ((along[i] > 0.0 ? high[i] : low[i]) - from[i]) / along[i]);
    return end;
}

void stage_keep_least(float least[STAGE_LEAST], float value)
{
    for (int i = 0; i < STAGE_LEAST && value < least[STAGE_LEAST - 1]; i++)
        if (value < least[i]) {
            const float larger = least[i];
            least[i] = value;
            value = larger;
        }
}

// Whether a ray is in front of all that it can meet within a tile's side.
static bool is_free(const struct stage *s, const struct place *at, double side)
{
    const int tile = (int)at->y / TILE * ((s->width + TILE - 1) / TILE) + (int)at->x / TILE;
    return at->far + TILE * side < (double)s->front[tile];
}

static double behind_at(const struct stage *s, const struct place *at)
{
    return at->far - surface_at(s, at->x, at->y);
}

// Most places are clear of what their cell spans: between them the surface need not be known.
static bool is_behind(const struct stage *s, const struct place *at, double by)
{
    const struct cell *c = cell_at(s, at->x, at->y);
    return at->far - (double)c->least > by &&
           (at->far - (double)c->most > by || behind_at(s, at) > by);
}

static bool is_within(const struct stage *s, const struct place *at, double thick)
{
    const struct cell *c = cell_at(s, at->x, at->y);
    return at->far - (double)c->most < thick && behind_at(s, at) < thick;
}

// Goes on to the end where `least` is given, for light that does arrive; `free` is cleared where
// the ray passes behind anything.
static inline bool walk(float (*least)[STAGE_LEAST], bool *free, const struct stage *s,
                        enum stage_kind kind, vec3 p, vec3 d, double distance)
{
    const double end = fmin(leaves_box(s, p, d), distance);
    struct place at;
    if (!place_of(&at, s, kind, p))
        return true;
    double side = side_at(s, kind, at.far), step;
    struct place last = at;
    bool was_behind = false;
    for (double t = START * side; t < end; t += step) {
        if (!place_of(&at, s, kind, vec3_along(p, d, t)))
            return true;
        side = side_at(s, kind, at.far);
        step = STEP * side;
        if (!was_behind && is_free(s, &at, side)) {
            step = (TILE - 1) * side;
            continue;
        }
        const bool now_behind = is_behind(s, &at, NEAR * side);
        if (now_behind != was_behind &&
            fabs(surface_at(s, at.x, at.y) - surface_at(s, last.x, last.y)) < SAME * side)
            return false;
        last = at;
        was_behind = now_behind;
        if (!now_behind)
            continue;
        const size_t pixel = (size_t)(int)at.y * (size_t)s->width + (size_t)(int)at.x;
        if (!least && is_within(s, &at, (double)s->thick[pixel]))
            return false;
        if (least) {
            *free = false;
            if (is_within(s, &at, (double)least[pixel][STAGE_LEAST - 1]))
                stage_keep_least(least[pixel], (float)behind_at(s, &at));
        }
    }
    return true;
}

bool stage_reaches(const struct stage *s, vec3 p, vec3 d, double distance)
{
    switch (s->kind) {
    case STAGE_FLAT: return walk(NULL, NULL, s, STAGE_FLAT, p, d, distance);
    case STAGE_EYE: return walk(NULL, NULL, s, STAGE_EYE, p, d, distance);
    case STAGE_CYLINDER: return walk(NULL, NULL, s, STAGE_CYLINDER, p, d, distance);
    case STAGE_SPHERE: break;
    }
    return walk(NULL, NULL, s, STAGE_SPHERE, p, d, distance);
}

bool stage_carve(float (*least)[STAGE_LEAST], const struct stage *s, vec3 p, vec3 d)
{
    bool free = true;
    return walk(least, &free, s, s->kind, p, d, INFINITY) && free;
}

// ---------------------------------------------------------------- life

static void grow(struct stage *s, vec3 p, double by)
{
    s->low = vec3_of(fmin(s->low.x, p.x - by), fmin(s->low.y, p.y - by), fmin(s->low.z, p.z - by));
    s->high =
        vec3_of(fmax(s->high.x, p.x + by), fmax(s->high.y, p.y + by), fmax(s->high.z, p.z + by));
}

// From distances along rays: how far the nearest is.
static float fill(struct stage *s, const struct relume_image *depth, double camera_z)
{
    const bool flat = s->kind == STAGE_FLAT;
    float nearest = INFINITY;
    for (int y = 0, i = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++, i++) {
            const double d = (double)depth->data[i];
            const double far = flat ? d - camera_z : d / vec3_length(ray_of(s, x + 0.5, y + 0.5));
            s->far[i] = isfinite(far) ? (float)far : INFINITY;
            if (flat || s->far[i] > 0.0f)
                nearest = fminf(nearest, s->far[i]);
        }
    return nearest;
}

// How large it is.
static double enclose(struct stage *s, double farthest)
{
    s->low = vec3_of(INFINITY, INFINITY, INFINITY);
    s->high = vec3_scale(s->low, -1.0);
    for (int y = 0, i = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++, i++) {
            const double far = (double)s->far[i];
            if (!(far <= farthest) || isinf(far))
                s->far[i] = INFINITY;
            else
                grow(s, at_distance(s, x + 0.5, y + 0.5, far), MARGIN * side_at(s, s->kind, far));
        }
    return vec3_length(vec3_sub(s->high, s->low));
}

// Of a tile and those around it; panoramas close.
static float front_of(const struct stage *s, int column, int row)
{
    float least = INFINITY;
    for (int y = (row - 1) * TILE; y < (row + 2) * TILE; y++)
        for (int x = (column - 1) * TILE; x < (column + 2) * TILE; x++)
            least = fminf(least, (float)far_of(s, x, y));
    return least;
}

static void find_cells(struct stage *s)
{
    struct cell *c = s->cell;
    for (int y = 0; y <= s->height; y++)
        for (int x = 0; x <= s->width; x++, c++)
            for (int i = 0; i < 4; i++) {
                const float far = (float)far_of(s, x - (i & 1), y - i / 2);
                c->least = i ? fminf(c->least, far) : far;
                c->most = i ? fmaxf(c->most, far) : far;
            }
}

static void find_fronts(struct stage *s)
{
    const int columns = (s->width + TILE - 1) / TILE, rows = (s->height + TILE - 1) / TILE;
    for (int y = 0, i = 0; y < rows; y++)
        for (int x = 0; x < columns; x++, i++)
            s->front[i] = front_of(s, x, y);
}

relume_status stage_create(struct stage *s, const struct relume_geometry *g, const double uv[2],
                           const struct relume_image *depth)
{
    const size_t n = (size_t)depth->width * (size_t)depth->height;
    *s = (struct stage){.width = depth->width, .height = depth->height};
    s->far = mem_array(n, sizeof *s->far);
    s->thick = mem_array(n, sizeof *s->thick);
    s->front =
        mem_array((size_t)((s->width + TILE - 1) / TILE) * (size_t)((s->height + TILE - 1) / TILE),
                  sizeof *s->front);
    s->cell = mem_array(((size_t)s->width + 1) * sizeof *s->cell, (size_t)s->height + 1);
    if (!s->far || !s->thick || !s->front || !s->cell)
        return RELUME_ENOMEM;
    set_up(s, g, uv);
    const double nearest = (double)fill(s, depth, g->camera_z);
    const int longer = s->width > s->height ? s->width : s->height;
    const double large = enclose(s, s->kind == STAGE_FLAT ? nearest + DEEPEST * longer * s->pixel
                                                          : (double)INFINITY);
    // Pixels shrink towards an eye. A ray that meets it would go in ever smaller steps for ever.
    s->least_side = s->pixel * fmax(nearest / 8.0, 1e-6 * large);
    find_fronts(s);
    find_cells(s);
    for (size_t i = 0; i < n; i++)
        s->thick[i] = (float)large;
    return RELUME_OK;
}

void stage_destroy(struct stage *s)
{
    mem_free(s->far);
    mem_free(s->thick);
    mem_free(s->front);
    mem_free(s->cell);
    *s = (struct stage){0};
}
