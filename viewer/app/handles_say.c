// handles_say.c - edited reflections in words: of scripts, and of the panel's buttons
#include "app/handles_say.h"

#include "app/handles.h"
#include "app/handles_drag.h"
#include "app/orbit.h"
#include "app/sight.h"
#include "cli/program/say.h"
#include "common/vec.h"
#include "world/reflect/reflection.h"

#include <stdio.h>
#include <string.h>

bool handles_turn_on(struct app *app, bool on)
{
    if (on && !app->handles && app->file.objects)
        (void)!handles_create(&app->handles, app->file.objects);
    app->reflects = on && app->handles;
    return app->reflects == on;
}

// ---------------------------------------------------------------- words

// What a word says; `rest` is what stands behind it. False when that is not understood.
static bool say_tool(struct app *app, const char *rest)
{
    for (int i = 0; i < HANDLES_TOOLS; i++)
        if (!strcmp(rest, handles_tool_names[i])) {
            app->handles->tool = (enum handles_tool)i;
            return true;
        }
    return false;
}

static bool say_choose(struct app *app, const char *rest)
{
    char kind[16];
    struct handles_choice c = {.object = 0};
    struct handles *h = app->handles;
    int end = 0;
    if (sscanf(rest, "%15s %9d %n%9d %n", kind, &c.number, &end, &c.object, &end) < 2 ||
        rest[end] || c.number < 0 || c.object < 0 || c.object >= h->count)
        return false;
    c.kind = !strcmp(kind, "constraint") ? HANDLES_CONSTRAINT
             : !strcmp(kind, "region")   ? HANDLES_REGION
                                         : HANDLES_NOTHING;
    const struct handles_choice before = h->chosen;
    h->chosen = c;
    if (handles_constraint(h) || handles_region(h))
        return true;
    h->chosen = before;
    return false;
}

static bool say_delete(struct app *app, const char *rest)
{
    return !*rest && handles_remove(app->handles);
}

static bool say_undo(struct app *app, const char *rest)
{
    return !*rest && handles_undo(app->handles);
}

static bool say_redo(struct app *app, const char *rest)
{
    return !*rest && handles_redo(app->handles);
}

static bool freeze(struct app *app, bool frozen)
{
    struct handles *h = app->handles;
    struct relume_viewport sight;
    struct handles_edit *e = sight_of_app(&sight, app) ? handles_begin(h, h->chosen.object) : NULL;
    if (!e)
        return false;
    e->edit.frozen = frozen;
    e->edit.eye = relume_viewport_eye(&sight);
    return handles_end(h, NULL);
}

static bool say_freeze(struct app *app, const char *rest)
{
    return !*rest && freeze(app, true);
}

static bool say_unfreeze(struct app *app, const char *rest)
{
    return !*rest && freeze(app, false);
}

static bool say_view(struct app *app, const char *rest)
{
    const struct relume_reflection_constraint *c = handles_constraint(app->handles);
    struct relume_camera *camera = &app->now.camera;
    if (*rest || !c)
        return false;
    if (camera->framing == RELUME_FRAME_EYE)
        camera->eye = c->eye;
    if (camera->framing != RELUME_FRAME_LOOK)
        return camera->framing == RELUME_FRAME_EYE;
    const struct relume_vec3 d = vec3_unit(vec3_sub(c->position, app->file.geometry.center));
    camera->look.pan_deg = atan2(d.x, -d.z) * 180 / M_PI;
    camera->look.tilt_deg = asin(clamp(d.y, -1, 1)) * 180 / M_PI;
    return true;
}

static bool say_distance(struct app *app, const char *rest)
{
    struct handles *h = app->handles;
    const bool geodesic = !strcmp(rest, "geodesic");
    struct handles_edit *e =
        geodesic || !strcmp(rest, "straight") ? handles_begin(h, h->chosen.object) : NULL;
    if (!e)
        return false;
    e->edit.geodesic = geodesic;
    return handles_end(h, NULL);
}

static const double MOST = 1e3;  // radius of a region, sizes of the objects; border, radii

static bool take_number(double *out, const char *rest, double most)
{
    char more;
    return sscanf(rest, "%lf %c", out, &more) == 1 && *out <= most;
}

// Of the chosen region, and of the next one.
static bool say_radius(struct app *app, const char *rest)
{
    struct handles *h = app->handles;
    double radius;
    if (!take_number(&radius, rest, MOST * h->size) || !(radius > 0))
        return false;
    h->radius = radius;
    struct handles_edit *e = handles_region(h) ? handles_begin(h, h->chosen.object) : NULL;
    if (!e)
        return true;
    struct relume_reflection_region *r = &e->region[h->chosen.number];
    r->border = r->border / r->radius * radius;
    r->radius = radius;
    return handles_end(h, "radius");
}

static bool say_border(struct app *app, const char *rest)
{
    struct handles *h = app->handles;
    double border;
    if (!take_number(&border, rest, MOST) || !(border >= 0))
        return false;
    h->border = border;
    struct handles_edit *e = handles_region(h) ? handles_begin(h, h->chosen.object) : NULL;
    if (!e)
        return true;
    e->region[h->chosen.number].border = border * e->region[h->chosen.number].radius;
    return handles_end(h, "border");
}

// ---------------------------------------------------------------- table

static const struct word {
    const char *name;
    bool (*say)(struct app *app, const char *rest);
    const char *expected;
} table[] = {
    {"tool", say_tool, "tool move, ball, along or brush"},
    {"choose", say_choose,
     "choose constraint|region NUMBER [OBJECT], counted from 0, that is there"},
    {"delete", say_delete, "delete, with a constraint or a region chosen"},
    {"undo", say_undo, "undo, with a change left to undo"},
    {"redo", say_redo, "redo, with a change left to redo"},
    {"freeze", say_freeze, "freeze"},
    {"unfreeze", say_unfreeze, "unfreeze"},
    {"view", say_view, "view, with a constraint chosen and an eye that can move"},
    {"distance", say_distance, "distance straight or geodesic"},
    {"radius", say_radius, "radius R, above 0, up to 1000 sizes of the objects"},
    {"border", say_border, "border PART of the radius, 0 to 1000"},
};

static const struct word *find_word(const char *words, const char **rest)
{
    const size_t n = strcspn(words, " \t");
    *rest = words + n + strspn(words + n, " \t");
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (strlen(table[i].name) == n && !strncmp(words, table[i].name, n))
            return &table[i];
    return NULL;
}

relume_status handles_say(struct app *app, const char *words, const struct relume_log *log)
{
    const bool off = !strcmp(words, "off");
    const char *rest;
    (void)handles_release(app);
    if (!handles_turn_on(app, !off))
        return say(log, RELUME_EUNFIT, "reflection: expected objects of which one is a mirror");
    if (off || !strcmp(words, "on"))
        return RELUME_OK;
    struct handles *h = app->handles;
    const struct word *word = find_word(words, &rest);
    h->said[0] = '\0';
    if (!word)
        return say(log, RELUME_EINVAL,
                   "reflection: expected on, off, tool, choose, delete, undo, redo, freeze, "
                   "unfreeze, view, distance, radius, border or save; found '%s'",
                   words);
    if (word->say(app, rest))
        return RELUME_OK;
    return say(log, RELUME_EINVAL, h->said[0] ? "%s" : "reflection: expected %s",
               h->said[0] ? h->said : word->expected);
}
