// frame_request.c - what a frame shall show: all that drawing needs to know of the app's state
#include "app/frame_request.h"

#include "app/app.h"
#include "app/fov.h"
#include "app/light_list.h"
#include "app/orbit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static relume_status take_lights(struct frame_request *q, const struct app_state *now)
{
    if (now->lights > q->capacity) {
        struct relume_light *light = realloc(q->light, (size_t)now->lights * sizeof *light);
        if (!light)
            return RELUME_ENOMEM;
        q->light = light;
        q->capacity = now->lights;
    }
    q->lights = light_list_shining(now, q->light);
    return RELUME_OK;
}

static void take_ball(struct frame_request *q, const struct app *app)
{
    q->ball = app->now.ball;
    if (!q->ball)
        return;
    q->ball_place = gizmo_ball(app);
    q->ball_light = app_light_direction(app, app->now.selected);
    memcpy(q->ball_rgb, app->now.light[app->now.selected].rgb, sizeof q->ball_rgb);
}

void frame_request_look(struct frame_request *q, const struct app *app)
{
    const struct app_state *now = &app->now;
    *q = (struct frame_request){
        .file = &app->file,
        .width = app->width,
        .height = app->height,
        .picture = app_picture(app),
        .exposure = (float)exp2(app_exposure_ev(app)),
        .camera = now->camera,
        .middle = app_middle(app),
        .view = {.interpolation = now->interpolation,
                 .aperture = now->aperture,
                 .focus = now->focus_z - (app->file.around ? 0 : app->file.geometry.st_z)},
        .moves = app_moves(app),
        .pass = now->pass,
        .enhance = now->enhance,
        .light = q->light,
        .capacity = q->capacity,
        .observer = now->observer,
        .eye_s = app->eye_s,
        .fov_deg = app_fov_deg(app),
        .split = now->split,
        .other = now->other,
        .way = now->way,
        .ways = now->ways,
        .other_way = now->other_way,
        .way_samples = now->way_samples,
        .bounces = now->bounces,
        .timed = app->panel,
    };
    q->has_window = orbit_is(app) && app_window(app, &q->window);
}

relume_status frame_request_make(struct frame_request *q, const struct app *app)
{
    frame_request_look(q, app);
    take_ball(q, app);
    return take_lights(q, &app->now);
}

void frame_request_free(struct frame_request *q)
{
    free(q->light);
    *q = (struct frame_request){0};
}
