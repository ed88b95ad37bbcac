// view_geometry.c - where what the file shows lies in the frame
#include "app/view_geometry.h"
#include "relight/view/slab_set.h"

#include <math.h>

bool app_is_panorama(const struct app_file *file)
{
    const enum relume_projection p = file->geometry.projection;
    return p == RELUME_CYLINDRICAL || p == RELUME_SPHERICAL || p == RELUME_CUBE;
}

struct app_rectangle app_picture(const struct app *app)
{
    const struct app_state *s = &app->now;
    if (s->camera.framing == RELUME_FRAME_LOOK)
        return (struct app_rectangle){0, 0, app->width, app->height};
    struct relume_rect at = {0, 0, app->width, app->height};
    if (s->camera.look_at.field_of_view_deg == 0.0)
        at = relume_rect_fit(app->file.width, app->file.height, app->width, app->height);
    const double middle[2] = {0.5 * app->width, 0.5 * app->height};
    const double left = middle[0] + s->shift[0] + (at.left - middle[0]) * s->zoom;
    const double top = middle[1] + s->shift[1] + (at.top - middle[1]) * s->zoom;
    return (struct app_rectangle){left, top, left + at.width * s->zoom, top + at.height * s->zoom};
}

bool app_window(const struct app *app, struct relume_window *window)
{
    return relume_slab_set_window(window, app->file.around, app->now.camera.eye,
                                  &app->now.camera.look_at, app->width, app->height);
}

bool app_pole_y(const struct app *app)
{
    const relume_slab_set *around = app->file.around;
    return (around && relume_slab_set_count(around) > 1) || app_is_panorama(&app->file);
}

struct relume_vec3 app_middle(const struct app *app)
{
    const struct relume_geometry *g = &app->file.geometry;
    if (app->file.around)
        return relume_slab_set_middle(app->file.around);
    if (app_is_panorama(&app->file))
        return g->center;
    const bool slab = g->projection == RELUME_SLAB;
    const double *min = slab ? g->st_min : g->window_min;
    const double *max = slab ? g->st_max : g->window_max;
    return (struct relume_vec3){0.5 * (min[0] + max[0]), 0.5 * (min[1] + max[1]),
                                slab ? g->st_z : 0.0};
}

double app_reach(const struct app *app)
{
    const struct relume_geometry *g = &app->file.geometry;
    if (app_is_panorama(&app->file))
        return 1;
    const bool slab = g->projection == RELUME_SLAB;
    const double *min = slab ? g->st_min : g->window_min;
    const double *max = slab ? g->st_max : g->window_max;
    return 0.5 * fmax(fabs(max[0] - min[0]), fabs(max[1] - min[1]));
}
