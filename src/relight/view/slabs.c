// slabs.c - slabs around an object: who they are, and what a picture of them looks at
#include "relight/view/slabs.h"

#include "core/base/memory.h"
#include "core/math/scalar.h"
#include "image/geometry/geometry.h"
#include "relight/view/slab_set.h"
#include "relight/view/view.h"

// Of the extent of the camera grid, and of the window's: where a slab's word begins to fade.
static const double fade_uv = 0.25;
static const double fade_st = 0.0625;
// Cameras at the border keep this weight where there is no other slab.
static const double least = 1e-4;

relume_status relume_slab_set_create(relume_slab_set **out, const struct relume_geometry *slab,
                                     int slabs, const double (*uv)[2], const int *slab_of,
                                     int views)
{
    *out = NULL;
    if (slabs < 1 || slabs > RELUME_MOST_SLABS)
        return RELUME_EINVAL;
    relume_slab_set *s = mem_zeroed(1, sizeof *s);
    if (!s)
        return RELUME_ENOMEM;
    s->count = slabs;
    s->views = views;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < slabs; i++) {
        struct relume_geometry geometry = slab[i];
        status = relume_pose_normalise(&geometry.pose)
                     ? slab_create(&s->slab[i], &geometry, uv, slab_of, i, views)
                     : RELUME_EINVAL;
    }
    if (status)
        relume_slab_set_destroy(&s);
    *out = s;
    return status;
}

void relume_slab_set_destroy(relume_slab_set **slabs)
{
    if (!*slabs)
        return;
    for (int i = 0; i < (*slabs)->count; i++)
        relume_slab_destroy(&(*slabs)->slab[i]);
    mem_free(*slabs);
    *slabs = NULL;
}

int relume_slab_set_count(const relume_slab_set *slabs)
{
    return slabs->count;
}

const struct relume_geometry *relume_slab_set_geometry(const relume_slab_set *slabs, int i)
{
    return &slabs->slab[i]->geometry;
}

const relume_slab *relume_slab_set_slab(const relume_slab_set *slabs, int i)
{
    return slabs->slab[i];
}

vec3 relume_slab_set_middle(const relume_slab_set *slabs)
{
    vec3 sum = {0};
    for (int i = 0; i < slabs->count; i++) {
        const struct relume_geometry *g = &slabs->slab[i]->geometry;
        const vec3 middle = vec3_of(0.5 * (g->st_min[0] + g->st_max[0]),
                                    0.5 * (g->st_min[1] + g->st_max[1]), g->st_z);
        sum = vec3_add(sum, relume_pose_world(&g->pose, middle));
    }
    return vec3_scale(sum, 1.0 / slabs->count);
}

vec3 relume_slab_set_eye(const relume_slab_set *slabs, int i)
{
    const relume_slab *slab = slabs->slab[i];
    return relume_pose_world(&slab->geometry.pose, relume_slab_middle(slab));
}

// ---------------------------------------------------------------- weights

double relume_slab_weight(const relume_slab *slab, const double uv[2], const double st[2])
{
    const struct relume_geometry *g = &slab->geometry;
    const double *lines[2] = {slab->u, slab->v};
    const int last[2] = {slab->columns - 1, slab->rows - 1};
    double grid = 1.0;
    double window = 1.0;
    for (int axis = 0; axis < 2; axis++) {
        const double low = lines[axis][0];
        const double high = lines[axis][last[axis]];
        if (!(uv[axis] >= low - slab->slack && uv[axis] <= high + slab->slack))
            return 0.0;
        // Of a place between `low` and `high`; a grid of one line has no inside to fade in.
        grid *= high > low
                    ? smoothstep(0.0, fade_uv * (high - low), fmin(uv[axis] - low, high - uv[axis]))
                    : 1.0;
        window *= smoothstep(0.0, fade_st * (g->st_max[axis] - g->st_min[axis]),
                             fmin(st[axis] - g->st_min[axis], g->st_max[axis] - st[axis]));
    }
    return fmax(grid, least) * window;
}

// ---------------------------------------------------------------- windows

struct relume_window relume_slab_window(const struct relume_geometry *g, vec3 eye)
{
    const vec3 corner = vec3_of(g->st_min[0], g->st_max[1], g->st_z);
    return (struct relume_window){
        .eye = eye,
        .corner = relume_pose_world(&g->pose, corner),
        .right = relume_pose_turn(&g->pose, vec3_of(g->st_max[0] - g->st_min[0], 0, 0)),
        .down = relume_pose_turn(&g->pose, vec3_of(0, g->st_min[1] - g->st_max[1], 0)),
    };
}

// Half the extent of the largest st window.
static void find_half(double half[2], const relume_slab_set *slabs)
{
    half[0] = half[1] = 0.0;
    for (int i = 0; slabs && i < slabs->count; i++)
        for (int axis = 0; axis < 2; axis++) {
            const struct relume_geometry *g = &slabs->slab[i]->geometry;
            half[axis] = fmax(half[axis], 0.5 * (g->st_max[axis] - g->st_min[axis]));
        }
}

static vec3 choose_up(vec3 wanted, vec3 ahead)
{
    if (!vec3_is_zero(wanted))
        return wanted;
    const bool steep = fabs(ahead.y) > 1.0 - 1e-9;
    return steep ? vec3_of(0, 0, ahead.y < 0.0 ? -1.0 : 1.0) : vec3_of(0, 1, 0);
}

bool relume_look_at_given(const struct relume_look_at *look_at)
{
    return look_at->aimed || look_at->field_of_view_deg != 0.0 || !vec3_is_zero(look_at->up);
}

bool relume_slab_set_window(struct relume_window *out, const relume_slab_set *slabs, vec3 eye,
                            const struct relume_look_at *look_at, int width, int height)
{
    const struct relume_look_at a = look_at ? *look_at : (struct relume_look_at){0};
    const vec3 at = a.aimed ? a.at : relume_slab_set_middle(slabs);
    const double distance = vec3_length(vec3_sub(at, eye));
    const vec3 ahead = vec3_unit(vec3_sub(at, eye));
    const vec3 sideways = vec3_cross(ahead, vec3_unit(choose_up(a.up, ahead)));
    double half[2];
    find_half(half, slabs);
    if (a.field_of_view_deg != 0.0) {
        half[0] = distance * tan(a.field_of_view_deg * M_PI / 360.0);
        half[1] = half[0] * height / width;
    }
    const vec3 right = vec3_unit(sideways);
    const vec3 down = vec3_cross(ahead, right);
    *out = (struct relume_window){
        .eye = eye,
        .corner = vec3_sub(at, vec3_along(vec3_scale(right, half[0]), down, half[1])),
        .right = vec3_scale(right, 2.0 * half[0]),
        .down = vec3_scale(down, 2.0 * half[1]),
    };
    const bool open = a.field_of_view_deg >= 0.0 && a.field_of_view_deg < 180.0;
    return open && distance > 0.0 && isfinite(distance) && vec3_length(sideways) > 1e-9 &&
           isfinite(vec3_length(out->corner));
}
