// aim.c - where lights come from, as the viewer sees it
#include "app/aim.h"

#include "app/orbit.h"
#include "common/vec.h"

struct app_axes app_frame_axes(const struct app *app)
{
    if (orbit_is(app))
        return orbit_axes(app);
    if (app->now.camera.framing != RELUME_FRAME_LOOK)
        return (struct app_axes){{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double pan = app->now.camera.look.pan_deg * M_PI / 180;
    const double tilt = app->now.camera.look.tilt_deg * M_PI / 180;
    return (struct app_axes){
        .right = {cos(pan), 0, sin(pan)},
        .up = {-sin(tilt) * sin(pan), cos(tilt), sin(tilt) * cos(pan)},
        .back = {-cos(tilt) * sin(pan), -sin(tilt), cos(tilt) * cos(pan)},
    };
}

struct relume_vec3 app_light_direction(const struct app *app, int light)
{
    const struct app_axes a = app_frame_axes(app);
    const struct relume_vec3 d = light_list_direction(&app->now.light[light], app_middle(app));
    return (struct relume_vec3){vec3_dot(d, a.right), vec3_dot(d, a.up), vec3_dot(d, a.back)};
}

void app_aim_light(struct app *app, int light, struct relume_vec3 seen)
{
    const struct app_axes a = app_frame_axes(app);
    const struct relume_vec3 world = {
        seen.x * a.right.x + seen.y * a.up.x + seen.z * a.back.x,
        seen.x * a.right.y + seen.y * a.up.y + seen.z * a.back.y,
        seen.x * a.right.z + seen.y * a.up.z + seen.z * a.back.z,
    };
    light_list_aim(&app->now, light, world, app_middle(app));
}

void app_point_light(struct app *app, int light, double x, double y)
{
    const double r = fmax(hypot(x, y), 1);
    const double side = app_light_direction(app, light).z < 0 ? -1 : 1;
    const double z = sqrt(fmax(1 - (x * x + y * y) / (r * r), 0));
    app_aim_light(app, light, (struct relume_vec3){x / r, y / r, side * z});
}

void app_turn_light(struct app *app, double yaw_deg, double pitch_deg)
{
    const struct relume_vec3 seen = app_light_direction(app, app->now.selected);
    const double yaw = yaw_deg * M_PI / 180;
    const double pitch = pitch_deg * M_PI / 180;
    const double y = seen.y * cos(pitch) - seen.z * sin(pitch);
    const double ahead = seen.y * sin(pitch) + seen.z * cos(pitch);
    const double x = seen.x * cos(yaw) + ahead * sin(yaw);
    const double z = ahead * cos(yaw) - seen.x * sin(yaw);
    app_aim_light(app, app->now.selected, (struct relume_vec3){x, y, z});
}

// The side from which raking light shall come: what it made of a side would be another one.
static struct relume_vec3 raking_side(const struct app *app)
{
    const struct app_state *s = &app->now;
    const struct relume_light *light = &s->light[s->selected];
    if (light->kind == RELUME_LIGHT_ENVIRONMENT)
        return (struct relume_vec3){0, 0, 1};
    const struct relume_vec3 d = light_list_direction(light, app_middle(app));
    return vec3_dot(d, s->raked_to) > 1 - 1e-9 ? s->raked_from : d;
}

void app_arrange_lights(struct app *app, const struct light_preset *preset)
{
    const struct relume_vec3 side = raking_side(app);
    light_list_arrange(&app->now, preset, app_pole_y(app));
    if (preset->rakes && app->file.relief)
        light_list_rake(&app->now, preset, app->file.relief, side);
}
