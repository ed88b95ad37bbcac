// notes.c - notes on the picture, and what the mouse does with them
#include "app/notes.h"

#include "app/gizmo.h"
#include "app/view_geometry.h"
#include "common/vec.h"
#include "relight/view/slab_set.h"
#include "relight/view/view.h"

#include <math.h>
#include <stdlib.h>

static const double near_px = 6;  // presses so close are on a place

relume_status notes_create(struct notes **out, relume_notes *list)
{
    struct notes *n = calloc(1, sizeof *n);
    *out = n;
    if (!n) {
        relume_notes_destroy(&list);
        return RELUME_ENOMEM;
    }
    n->list = list;
    n->chosen = -1;
    return RELUME_OK;
}

void notes_destroy(struct notes **notes)
{
    struct notes *n = *notes;
    *notes = NULL;
    if (!n)
        return;
    relume_notes_destroy(&n->list);
    free(n->place);
    free(n->z);
    free(n);
}

// An object that slabs stand around.
static bool has_depth(const struct app *app)
{
    return app->file.around && relume_slab_set_count(app->file.around) > 1;
}

bool notes_have_places(const struct app *app)
{
    return (!app->file.around || has_depth(app)) && !app->file.scene && app->file.width > 0;
}

static bool looks_around(const struct app *app)
{
    return app->now.camera.framing == RELUME_FRAME_LOOK;
}

static bool on_surface(double place[2], double *z, const struct app *app, double x, double y)
{
    struct relume_vec3 p;
    if (!app->scene.surface || !app->scene.surface(app->scene.user, &p, x, y))
        return false;
    place[0] = p.x;
    place[1] = p.y;
    *z = p.z;
    return true;
}

bool notes_to_picture(double place[2], double *z, const struct app *app, double x, double y)
{
    const struct app_rectangle r = app_picture(app);
    *z = 0;
    if (has_depth(app))
        return on_surface(place, z, app, x, y);
    if (looks_around(app))
        return relume_panorama_pixel(
            place, &app->file.geometry, app->file.width, app->file.height,
            relume_pan_tilt_ray(app->now.camera.look, app->width, app->height, x, y));
    place[0] = (x - r.left) / (r.right - r.left) * app->file.width;
    place[1] = (y - r.top) / (r.bottom - r.top) * app->file.height;
    return place[0] >= 0 && place[1] >= 0 && place[0] <= app->file.width &&
           place[1] <= app->file.height;
}

bool notes_to_frame(double xy[2], const struct app *app, const double place[2], double z)
{
    const struct app_rectangle r = app_picture(app);
    if (has_depth(app))
        return gizmo_place(xy, app, (struct relume_vec3){place[0], place[1], z});
    if (looks_around(app)) {
        const struct relume_vec3 ray = relume_panorama_ray(&app->file.geometry, app->file.width,
                                                           app->file.height, place[0], place[1]);
        return vec3_length(ray) > 0 && gizmo_place(xy, app, vec3_add(app_middle(app), ray));
    }
    xy[0] = r.left + place[0] / app->file.width * (r.right - r.left);
    xy[1] = r.top + place[1] / app->file.height * (r.bottom - r.top);
    return true;
}

// ---------------------------------------------------------------- drawing

static bool add_vertex(struct notes *n, const double place[2], double z)
{
    const bool full = n->places == RELUME_NOTE_MOST_PLACES;
    const size_t capacity = (size_t)n->places + 1;
    double(*more)[2] = full ? NULL : realloc(n->place, capacity * sizeof *more);
    n->place = more ? more : n->place;
    double *deep = more ? realloc(n->z, capacity * sizeof *deep) : NULL;
    if (!deep)
        return false;
    n->z = deep;
    deep[n->places] = z;
    more[n->places][0] = place[0];
    more[n->places++][1] = place[1];
    return true;
}

static bool is_on(const struct app *app, int place, double x, double y)
{
    double at[2];
    if (place < 0 || place >= app->notes->places)
        return false;
    return notes_to_frame(at, app, app->notes->place[place], app->notes->z[place]) &&
           hypot(at[0] - x, at[1] - y) <= near_px;
}

// The note that has a place there, -1 without one.
static int find_note(const struct app *app, double x, double y)
{
    for (int i = relume_notes_count(app->notes->list) - 1; i >= 0; i--) {
        const struct relume_note *note = relume_notes_get(app->notes->list, i);
        for (int k = 0; k < note->places; k++) {
            double at[2];
            if (notes_to_frame(at, app, note->place[k], note->z ? note->z[k] : 0) &&
                hypot(at[0] - x, at[1] - y) <= near_px)
                return i;
        }
    }
    return -1;
}

bool notes_press(struct app *app, double x, double y)
{
    struct notes *n = app->notes;
    double place[2], z;
    if (!notes_have_places(app))
        return false;
    const int hit = n->places ? -1 : find_note(app, x, y);
    if (hit >= 0 || n->tool == RELUME_NOTE_VIEW) {
        n->chosen = hit;
        return hit >= 0;
    }
    if (!notes_to_picture(place, &z, app, x, y))
        return false;
    const bool closes = n->tool == RELUME_NOTE_POLYGON && is_on(app, 0, x, y);
    if (closes || is_on(app, n->places - 1, x, y))
        (void)notes_finish(app);
    else if (add_vertex(n, place, z) && n->tool == RELUME_NOTE_POINT)
        (void)notes_finish(app);
    return true;
}

bool notes_finish(struct app *app)
{
    static const int least[] = {
        [RELUME_NOTE_POINT] = 1, [RELUME_NOTE_LINE] = 2, [RELUME_NOTE_POLYGON] = 3};
    const struct notes *n = app->notes;
    if (n->tool == RELUME_NOTE_VIEW || n->places < least[n->tool])
        return false;
    app->action = APP_ACTION_NOTE;
    return true;
}

bool notes_take_back(struct app *app)
{
    const bool draws = app->notes->places > 0;
    app->notes->places -= draws;
    return draws;
}

struct relume_note notes_drawn(const struct app *app)
{
    const struct notes *n = app->notes;
    return (struct relume_note){.kind = n->tool,
                                .places = n->places,
                                .place = (const double(*)[2])n->place,
                                .z = has_depth(app) ? n->z : NULL};
}

double notes_scale_bar(const struct notes *n, double pixels, double most)
{
    static const double steps[] = {5, 2, 1};
    const double mm = relume_notes_scale(n->list) * most / pixels;  // that fit
    if (!(mm > 0) || !isfinite(mm))
        return 0;
    const double ten = pow(10, floor(log10(mm)));
    for (int i = 0; i < 2; i++)
        if (steps[i] * ten <= mm)
            return steps[i] * ten;
    return ten;
}
