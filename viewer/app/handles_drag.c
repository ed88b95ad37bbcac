// handles_drag.c - handles of edited reflections in the picture, and what the mouse does with them
#include "app/handles_drag.h"

#include "app/sight.h"
#include "common/vec.h"
#include "relight/frame/viewport.h"
#include "world/reflect/reflection.h"

static const double grasp = 10.0;      // pixels around a handle that count as on it
static const double far_sizes = 1e4;   // where the red handle of a far thing is, in sizes of all
static const double brush_step = 0.3;  // between points of a stroke, of its radius

// ---------------------------------------------------------------- what lies where

struct look {
    struct relume_vec3 eye, direction;  // of the ray
    bool mirror;                        // the ray hits one
    bool object;                        // or anything else of the objects
    struct relume_object_reflection seen;
};

// How the frame shows the objects; false where it shows none.
static bool find_sight(struct relume_viewport *out, const struct app *app)
{
    return app->now.pass == RELUME_PASS_COLOUR && sight_of_app(out, app) &&
           out->kind != RELUME_VIEWPORT_UNFOLDED &&
           !(out->kind == RELUME_VIEWPORT_PANORAMA && out->look.stereographic);
}

static bool look_at(struct look *l, const struct app *app, double x, double y)
{
    struct relume_viewport sight;
    const struct relume_objects_info *info = relume_objects_info(app->file.objects);
    *l = (struct look){.mirror = false};
    if (!find_sight(&sight, app))
        return false;
    relume_viewport_ray(&l->eye, &l->direction, &sight, x, y);
    l->object = relume_objects_reflect(&l->seen, app->file.objects, l->eye, l->direction);
    l->mirror = l->object && info->material[info->part[l->seen.part].material].mirror;
    return true;
}

// Where a place of the world appears, and what is one pixel to the right of it and above, as units
// at its distance.
struct around {
    double x, y;
    struct relume_vec3 eye, right, up;
};

static struct relume_vec3 at_depth(const struct relume_viewport *sight, double x, double y,
                                   struct relume_vec3 place)
{
    struct relume_vec3 from, ray;
    relume_viewport_ray(&from, &ray, sight, x, y);
    return vec3_along(from, ray, vec3_dot(vec3_sub(place, from), ray));
}

static bool find_around(struct around *out, const struct app *app, struct relume_vec3 place)
{
    struct relume_viewport sight;
    struct relume_vec3 ray;
    double xy[2];
    if (!find_sight(&sight, app) || !relume_viewport_project(xy, &sight, place))
        return false;
    *out = (struct around){.x = xy[0], .y = xy[1]};
    relume_viewport_ray(&out->eye, &ray, &sight, xy[0], xy[1]);
    const struct relume_vec3 middle = at_depth(&sight, xy[0], xy[1], place);
    out->right = vec3_unit(vec3_sub(at_depth(&sight, xy[0] + 1, xy[1], place), middle));
    out->up = vec3_unit(vec3_sub(at_depth(&sight, xy[0], xy[1] - 1, place), middle));
    return true;
}

static bool is_hidden(const struct handles *h, struct relume_vec3 eye, struct relume_vec3 place)
{
    const double BEFORE = 0.02;  // of the objects' size
    const struct relume_vec3 way = vec3_sub(place, eye);
    struct relume_object_reflection seen;
    return vec3_length(way) > 0 && relume_objects_reflect(&seen, h->objects, eye, way) &&
           vec3_length(vec3_sub(seen.place.position, eye)) < vec3_length(way) - BEFORE * h->size;
}

// ---------------------------------------------------------------- where handles are

static struct relume_vec3 middle_of(const struct relume_reflection_region *r)
{
    return r->points ? r->stroke[r->points - 1] : r->centre;
}

struct handle_list {
    struct handle *out;
    int n;
    const struct app *app;
};

static void put(struct handle_list *list, enum handles_grip grip, struct handles_choice of,
                struct relume_vec3 place, double right)
{
    const struct app *app = list->app;
    struct around a;
    double xy[2];
    struct relume_viewport sight;
    if (list->n == HANDLES_MOST || !find_around(&a, app, place))
        return;
    struct handle *h = &list->out[list->n];
    *h = (struct handle){grip, of, a.x, a.y, is_hidden(app->handles, a.eye, place)};
    if (right > 0) {
        if (!find_sight(&sight, app) ||
            !relume_viewport_project(xy, &sight, vec3_along(place, a.right, right)))
            return;
        h->x = xy[0];
        h->y = xy[1];
    }
    list->n++;
}

int handles_of(struct handle out[HANDLES_MOST], const struct app *app)
{
    struct handle_list list = {out, 0, app};
    for (int o = 0; app->handles && o < app->handles->count; o++) {
        const struct handles_edit *e = &app->handles->now[o];
        for (int i = 0; i < e->edit.regions; i++) {
            const struct handles_choice of = {HANDLES_REGION, o, i};
            const struct relume_reflection_region *r = &e->region[i];
            put(&list, HANDLES_RIM, of, middle_of(r), r->radius);
            if (r->shape != RELUME_REFLECTION_STROKES)
                put(&list, HANDLES_CENTRE, of, r->centre, 0);
        }
        for (int i = 0; i < e->edit.constraints; i++) {
            const struct handles_choice of = {HANDLES_CONSTRAINT, o, i};
            if (e->mark[i].has_red)
                put(&list, HANDLES_RED, of, e->mark[i].red, 0);
            put(&list, HANDLES_GREEN, of, e->constraint[i].position, 0);
        }
    }
    return list.n;
}

bool handles_outline(double xy[2], const struct app *app, int object, int region, int step)
{
    enum { STEPS = 48 };
    const struct relume_reflection_region *r = &app->handles->now[object].region[region];
    struct relume_viewport sight;
    struct around a;
    if (!find_sight(&sight, app))
        return false;
    if (r->points > 1)
        return step < r->points && relume_viewport_project(xy, &sight, r->stroke[step]);
    if (step > STEPS || !find_around(&a, app, middle_of(r)))
        return false;
    const double turn = 2 * M_PI * step / STEPS;
    const struct relume_vec3 across = vec3_along(middle_of(r), a.right, r->radius * cos(turn));
    return relume_viewport_project(xy, &sight, vec3_along(across, a.up, r->radius * sin(turn)));
}

// The one drawn last lies on top.
static bool find_handle(struct handle *out, const struct app *app, double x, double y)
{
    struct handle list[HANDLES_MOST];
    const int n = handles_of(list, app);
    double nearest = grasp;
    bool found = false;
    for (int i = 0; i < n; i++) {
        const double far = hypot(list[i].x - x, list[i].y - y);
        if (far > nearest)
            continue;
        nearest = far;
        *out = list[i];
        found = true;
    }
    return found;
}

// ---------------------------------------------------------------- constraints

// What a constraint shows has a place where a panorama knows it.
static void find_target(const struct app *app, struct handles_mark *mark,
                        const struct relume_reflection_constraint *c)
{
    if (!mark->has_target && app->scene.reflected)
        mark->has_target =
            app->scene.reflected(app->scene.user, &mark->target, c->position, c->edited);
}

static void aim(struct relume_reflection_constraint *c, const struct handles_mark *mark,
                struct relume_vec3 far)
{
    const struct relume_vec3 way = vec3_sub(mark->target, c->position);
    c->edited = mark->has_target && vec3_length(way) > 0 ? vec3_unit(way) : far;
}

static struct relume_vec3 eye_of(const struct handles_edit *e, const struct look *l)
{
    return e->edit.frozen ? e->edit.eye : l->eye;
}

static bool begin_constraint(struct app *app, const struct look *l)
{
    struct handles *h = app->handles;
    struct handles_edit *e = handles_begin(h, l->seen.object);
    const struct relume_reflection_constraint c = {
        .position = l->seen.place.position,
        .original = l->seen.original,
        .edited = l->seen.edited,
        .eye = e ? eye_of(e, l) : l->eye,
    };
    if (!e || !handles_add_constraint(h, e, &c))
        return false;
    find_target(app, &e->mark[h->chosen.number], &c);
    h->grip = HANDLES_GREEN;
    return true;
}

// The place where a thing is seen moves over the mirror.
static bool drag_green(struct app *app, struct handles_edit *e, const struct look *l)
{
    const int i = app->handles->chosen.number;
    struct relume_reflection_constraint *c = &e->constraint[i];
    if (!l->mirror || l->seen.object != app->handles->chosen.object)
        return false;
    find_target(app, &e->mark[i], c);
    c->position = l->seen.place.position;
    c->original = l->seen.original;
    c->eye = eye_of(e, l);
    aim(c, &e->mark[i], c->edited);
    return true;
}

// Another thing is seen there: what a mirror shows unedited, or what lies beside the objects.
static bool drag_red(struct app *app, struct handles_edit *e, const struct look *l, double x,
                     double y)
{
    const int i = app->handles->chosen.number;
    struct relume_reflection_constraint *c = &e->constraint[i];
    struct handles_mark mark = {.has_red = true};
    if (l->object && (!l->mirror || l->seen.object != app->handles->chosen.object))
        return false;
    if (l->mirror) {
        const struct relume_reflection_constraint shown = {.position = l->seen.place.position,
                                                           .edited = l->seen.original};
        mark.red = l->seen.place.position;
        find_target(app, &mark, &shown);
    } else if (app->scene.surface && app->scene.surface(app->scene.user, &mark.target, x, y)) {
        mark.red = mark.target;
        mark.has_target = true;
    } else {
        mark.red = vec3_along(l->eye, l->direction, far_sizes * app->handles->size);
    }
    e->mark[i] = mark;
    aim(c, &mark, l->mirror ? l->seen.original : l->direction);
    return true;
}

// ---------------------------------------------------------------- regions

static bool begin_region(struct app *app, const struct look *l)
{
    static const enum relume_reflection_shape shapes[HANDLES_TOOLS] = {
        [HANDLES_BALL] = RELUME_REFLECTION_BALL,
        [HANDLES_ALONG] = RELUME_REFLECTION_GEODESIC,
        [HANDLES_BRUSH] = RELUME_REFLECTION_STROKES,
    };
    struct handles *h = app->handles;
    struct handles_edit *e = handles_begin(h, l->seen.object);
    const struct relume_reflection_region r = {
        .shape = shapes[h->tool],
        .centre = l->seen.place.position,
        .radius = h->radius,
        .border = h->border * h->radius,
    };
    h->grip = h->tool == HANDLES_BRUSH ? HANDLES_PAINT : HANDLES_RIM;
    return e && handles_add_region(h, e, &r);
}

static bool drag_centre(struct app *app, struct handles_edit *e, const struct look *l)
{
    if (!l->object || l->seen.object != app->handles->chosen.object)
        return false;
    e->region[app->handles->chosen.number].centre = l->seen.place.position;
    return true;
}

// The distance from the middle, in its plane across the line of sight; the border keeps its part.
static bool drag_rim(struct app *app, struct handles_edit *e, const struct look *l)
{
    const double LEAST = 1e-3;  // of the objects' size
    struct relume_reflection_region *r = &e->region[app->handles->chosen.number];
    struct around a;
    if (!find_around(&a, app, middle_of(r)))
        return false;
    const struct relume_vec3 normal = vec3_cross(a.right, a.up);
    const double ahead = vec3_dot(vec3_sub(middle_of(r), l->eye), normal);
    const double along = vec3_dot(l->direction, normal);
    if (!(ahead / along > 0))
        return false;
    const struct relume_vec3 p = vec3_along(l->eye, l->direction, ahead / along);
    const double radius = fmax(vec3_length(vec3_sub(p, middle_of(r))), LEAST * app->handles->size);
    r->border = r->border / r->radius * radius;
    r->radius = radius;
    return true;
}

static bool drag_paint(struct app *app, struct handles_edit *e, const struct look *l)
{
    struct handles *h = app->handles;
    struct relume_reflection_region *r = &e->region[h->chosen.number];
    if (!l->mirror || l->seen.object != h->chosen.object ||
        vec3_length(vec3_sub(l->seen.place.position, middle_of(r))) < brush_step * r->radius)
        return false;
    return handles_add_point(h, r, l->seen.place.position);
}

// ---------------------------------------------------------------- the mouse

bool handles_press(struct app *app, double x, double y)
{
    struct handles *h = app->handles;
    struct handle on;
    struct look l;
    if (find_handle(&on, app, x, y)) {
        h->chosen = on.of;
        h->grip = on.grip;
        return true;
    }
    if (!look_at(&l, app, x, y) || !l.object)
        return false;
    if (!l.mirror) {
        handles_tell(h, "this is no mirror; press on one");
        return false;
    }
    if (h->tool == HANDLES_MOVE ? begin_constraint(app, &l) : begin_region(app, &l))
        (void)handles_show(h);
    else
        handles_drop(h);
    return true;
}

bool handles_move(struct app *app, double x, double y)
{
    struct handles *h = app->handles;
    struct look l;
    if ((!handles_constraint(h) && !handles_region(h)) || !look_at(&l, app, x, y))
        return false;
    struct handles_edit *e = handles_begin(h, h->chosen.object);
    bool changed = false;
    if (!e)
        return false;
    switch (h->grip) {
    case HANDLES_GREEN: changed = drag_green(app, e, &l); break;
    case HANDLES_RED: changed = drag_red(app, e, &l, x, y); break;
    case HANDLES_CENTRE: changed = drag_centre(app, e, &l); break;
    case HANDLES_RIM: changed = drag_rim(app, e, &l); break;
    case HANDLES_PAINT: changed = drag_paint(app, e, &l); break;
    }
    if (changed)
        (void)handles_show(h);
    return changed;
}

bool handles_release(struct app *app)
{
    struct handles *h = app->handles;
    if (app->drag != APP_DRAG_HANDLE)
        return false;
    const bool changes = h->changes;
    app->drag = APP_DRAG_NONE;
    if (h->shown)
        (void)handles_end(h, NULL);
    else
        handles_drop(h);
    return changes;
}
