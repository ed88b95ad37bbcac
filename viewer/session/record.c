// record.c - moving pictures: what moves in them
#include "session/record.h"

#include "app/light_list.h"
#include "app/orbit.h"
#include "cli/program/say.h"
#include "common/vec.h"

#include <math.h>
#include <string.h>

static const double lowest_deg = 20;  // of a light that sweeps
static const double highest_deg = 60;

relume_status record_parse(enum record_kind *out, const char *name)
{
    static const char *const names[] = {
        [RECORD_SWEEP] = "sweep", [RECORD_TURNTABLE] = "turntable", [RECORD_SCRIPT] = "script"};
    for (int i = 0; i < (int)(sizeof names / sizeof *names); i++)
        if (!strcmp(names[i], name)) {
            *out = (enum record_kind)i;
            return RELUME_OK;
        }
    return RELUME_EINVAL;
}

static void pose_sweep(struct app *app, double part)
{
    const bool pole_y = app_pole_y(app);
    const int light = app->now.selected;
    const struct relume_vec3 from = light_list_direction(
        &app->start.light[light < app->start.lights ? light : 0], app_middle(app));
    const double height = asin(clamp(pole_y ? from.y : from.z, -1, 1)) * 180 / M_PI;
    const double elevation = clamp(height, lowest_deg, highest_deg) * M_PI / 180;
    const double azimuth = 2 * M_PI * part;
    const double x = cos(elevation) * cos(azimuth);
    const double y = cos(elevation) * sin(azimuth);
    const double z = sin(elevation);
    light_list_aim(&app->now, light,
                   pole_y ? (struct relume_vec3){x, z, -y} : (struct relume_vec3){x, y, z},
                   app_middle(app));
}

relume_status record_pose(struct app *app, enum record_kind kind, double part,
                          const struct relume_log *log)
{
    const enum relume_framing framing = app->now.camera.framing;
    if (kind == RECORD_SWEEP)
        pose_sweep(app, part);
    else if (orbit_is(app)) {
        app->now.camera.eye = app->start.camera.eye;
        orbit_turn(app, 360 * part, 0);
    } else if (framing == RELUME_FRAME_EYE) {
        // As far as all sides of the grid allow.
        const struct app_file *f = &app->file;
        struct relume_vec3 *eye = &app->now.camera.eye;
        const double angle = 2 * M_PI * part;
        eye->x =
            0.5 * (f->uv_min[0] + f->uv_max[0]) + 0.5 * (f->uv_max[0] - f->uv_min[0]) * cos(angle);
        eye->y =
            0.5 * (f->uv_min[1] + f->uv_max[1]) + 0.5 * (f->uv_max[1] - f->uv_min[1]) * sin(angle);
    } else if (framing == RELUME_FRAME_LOOK)
        app->now.camera.look.pan_deg = remainder(app->start.camera.look.pan_deg + 360 * part, 360);
    else
        return say(log, RELUME_EINVAL,
                   "turntable: expected a slab or a look into a panorama (--pan); found one view");
    return RELUME_OK;
}
