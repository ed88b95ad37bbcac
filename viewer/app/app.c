// app.c - the state of the viewer: how it begins, ends, and answers
#include "app/app.h"

#include "app/handles.h"
#include "app/light_list.h"
#include "app/notes.h"
#include "app/orbit.h"
#include "cli/program/say.h"
#include "common/vec.h"
#include "relight/view/slab_set.h"

#include <relume/relight/tone.h>

static void choose_framing(struct relume_camera *camera, const struct app_file *file,
                           bool look_ahead)
{
    if (camera->framing != RELUME_FRAME_DEFAULT)
        return;
    camera->framing = RELUME_FRAME_VIEW;
    if (app_is_panorama(file) && look_ahead)
        camera->framing = RELUME_FRAME_LOOK;
    if (file->geometry.projection != RELUME_SLAB)
        return;
    camera->framing = RELUME_FRAME_EYE;
    if (file->around) {
        camera->eye = relume_slab_set_eye(file->around, 0);
        return;
    }
    camera->eye = (struct relume_vec3){
        .x = 0.5 * (file->uv_min[0] + file->uv_max[0]),
        .y = 0.5 * (file->uv_min[1] + file->uv_max[1]),
        .z = file->geometry.uv_z,
    };
}

static relume_status check_camera(const struct relume_camera *camera, const struct app_file *file,
                                  const struct relume_log *log)
{
    const char *is = relume_projection_name(file->geometry.projection);
    if (camera->framing == RELUME_FRAME_EYE && file->geometry.projection != RELUME_SLAB)
        return say(log, RELUME_EINVAL, "--eye: expected a slab; found a %s file", is);
    if (camera->framing == RELUME_FRAME_LOOK && !app_is_panorama(file))
        return say(log, RELUME_EINVAL,
                   "--pan, --tilt, --zoom: expected a panorama; found a %s file", is);
    if (camera->framing == RELUME_FRAME_VIEW && (camera->view < 0 || camera->view >= file->views))
        return say(log, RELUME_EINVAL, "--view: expected a number from 0 to %d; found %d",
                   file->views - 1, camera->view);
    return RELUME_OK;
}

static relume_status check_around(const struct relume_camera *camera, const struct app_file *file,
                                  const struct app_state *start, const struct relume_log *log)
{
    const struct relume_vec3 eye = camera->eye;
    struct relume_window window;
    if (!file->around || camera->framing != RELUME_FRAME_EYE)
        return RELUME_OK;
    if (!relume_slab_set_window(&window, file->around, eye, &camera->look_at, file->width,
                                file->height))
        return say(log, RELUME_EINVAL,
                   "--eye: expected a point away from what it looks at; found %g,%g,%g", eye.x,
                   eye.y, eye.z);
    if (!relume_lens_fits(&window, start->aperture, start->focused ? start->focus_z : 0.0))
        return say(log, RELUME_EINVAL,
                   "--focus: expected less than %g in front of the look-at point; found %g",
                   relume_window_distance(&window), start->focus_z);
    return RELUME_OK;
}

static bool behind_cameras(const struct app_file *file, double z)
{
    const struct relume_geometry *g = &file->geometry;
    return !((z - g->st_z) / (g->uv_z - g->st_z) < 1.0);
}

relume_status app_start(struct app *app, const struct app_file *file, const struct app_state *start,
                        bool look_ahead, const struct relume_log *log)
{
    struct relume_camera camera = start->camera;
    *app = (struct app){.file = *file};
    choose_framing(&camera, file, look_ahead);
    relume_status status = check_camera(&camera, file, log);
    if (!status)
        status = check_around(&camera, file, start, log);
    if (status)
        return status;
    if (start->focused && file->geometry.projection == RELUME_SLAB && !file->around &&
        behind_cameras(file, start->focus_z))
        return say(log, RELUME_EINVAL,
                   "--focus: expected a plane in front of the cameras at z = %g; found z = %g",
                   file->geometry.uv_z, start->focus_z);
    struct app_state *s = &app->start;
    if (!light_list_copy(s, start))
        return RELUME_ENOMEM;
    s->camera = camera;
    if (!s->focused)
        s->focus_z = file->around ? 0.0 : file->geometry.st_z;
    if (s->camera.look.zoom <= 0.0)
        s->camera.look.zoom = 1.0;
    s->zoom = 1.0;
    if (s->white <= 0.0)
        s->white = RELUME_TONE_WHITE;
    const struct relume_light front = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
    if ((!s->lights && !light_list_add(s, &front, -1)) || !light_list_copy(&app->now, s)) {
        app_release(app);
        return RELUME_ENOMEM;
    }
    const bool look = s->camera.framing == RELUME_FRAME_LOOK;
    const int own[2] = {look ? 1024 : file->width, look ? 512 : file->height};
    relume_frame_size(&app->width, &app->height, own, &s->camera);
    return RELUME_OK;
}

void app_release(struct app *app)
{
    light_list_release(&app->start);
    light_list_release(&app->now);
    handles_destroy(&app->handles);
    notes_destroy(&app->notes);
}

const char *const app_dock_names[APP_DOCKS + 1] = {"over", "left", "right", NULL};

int app_window_width(const struct app *app)
{
    return app->beside[0] + app->width + app->beside[1];
}

void app_arrange(struct app *app)
{
    const int window_width = app_window_width(app);
    const bool fits = app->panel && app->dock && 2 * app->dock_width < window_width;
    const int beside = fits ? app->dock_width : 0;
    app->beside[0] = app->dock == APP_DOCK_LEFT ? beside : 0;
    app->beside[1] = app->dock == APP_DOCK_RIGHT ? beside : 0;
    app->width = window_width - beside;
}

void app_reset(struct app *app)
{
    (void)light_list_copy(&app->now, &app->start);
    app_stand_still(app);
}

void app_dolly(struct app *app, double factor)
{
    if (orbit_is(app)) {
        orbit_dolly(app, factor);
        return;
    }
    const double st_z = app->file.geometry.st_z;
    const double captured = app->file.geometry.uv_z - st_z;
    double *z = &app->now.camera.eye.z;
    *z = st_z + captured * clamp((*z - st_z) / captured * factor, 0.25, 4.0);
}

void app_stand_still(struct app *app)
{
    app->speed_deg_s[0] = app->speed_deg_s[1] = 0;
    app->turned_deg[0] = app->turned_deg[1] = 0;
}

bool app_moves(const struct app *app)
{
    return app->drag != APP_DRAG_NONE || app->speed_deg_s[0] != 0 || app->speed_deg_s[1] != 0;
}

int app_passes(const struct app *app)
{
    return app->file.only_colour ? 1 : app->compared ? RELUME_PASSES : RELUME_PASS_DIFFERENCE;
}

double app_exposure_ev(const struct app *app)
{
    return app->now.exposure_ev + (app->now.auto_exposure ? app->adapted_ev : 0);
}

void app_meter(struct app *app, double ev)
{
    app->metered_ev = app->adapted_ev + ev + app->now.exposure_ev;
    if (!app->metered)
        app->adapted_ev = app->metered_ev;
    app->metered = true;
}
