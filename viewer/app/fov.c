// fov.c - how wide the frame is to who looks at it
#include "app/fov.h"

#include "app/orbit.h"
#include "app/view_geometry.h"

#include <math.h>

// Half the frame's width, at distance 1, of a picture whose whole width is `picture` at distance 1.
static double half_frame(const struct app *app, double picture)
{
    const struct app_rectangle r = app_picture(app);
    return 0.5 * picture * app->width / (r.right - r.left);
}

static double tangent_of_look(const struct app *app)
{
    const struct relume_pan_tilt *look = &app->now.camera.look;
    return (look->stereographic ? 2 : 1) / look->zoom;
}

static double tangent_of_orbit(const struct app *app)
{
    const double x = 0.5 * app->width, y = 0.5 * app->height;
    const struct relume_vec3 a = orbit_ray(app, x, y), b = orbit_ray(app, x + 1, y);
    const double aa = a.x * a.x + a.y * a.y + a.z * a.z, ab = a.x * b.x + a.y * b.y + a.z * b.z;
    const double bb = b.x * b.x + b.y * b.y + b.z * b.z;
    const double across = sqrt(fmax(aa * bb - ab * ab, 0));  // |a x b|
    return ab > 0 ? 0.5 * app->width * across / ab : 0;
}

static double tangent_of_eye(const struct app *app)
{
    const struct relume_geometry *g = &app->file.geometry;
    if (orbit_is(app))
        return tangent_of_orbit(app);
    const double away = fabs(app->now.camera.eye.z - g->st_z);
    return half_frame(app, fabs(g->st_max[0] - g->st_min[0]) / away);
}

static double tangent_of_view(const struct app *app)
{
    const struct relume_geometry *g = &app->file.geometry;
    if (g->projection == RELUME_CUBE)  // six faces of 90 degrees side by side
        return half_frame(app, 12);
    if (g->projection == RELUME_CYLINDRICAL || g->projection == RELUME_SPHERICAL)
        return half_frame(app, 2 * M_PI);
    if (g->projection == RELUME_SLAB)
        return half_frame(app, fabs((g->st_max[0] - g->st_min[0]) / (g->uv_z - g->st_z)));
    if (g->perspective)
        return half_frame(app, fabs((g->window_max[0] - g->window_min[0]) / g->camera_z));
    return half_frame(app, 2 * tan(0.5 * APP_SCREEN_DEG * M_PI / 180));
}

double app_fov_deg(const struct app *app)
{
    static double (*const tangents[])(const struct app *) = {
        [RELUME_FRAME_VIEW] = tangent_of_view,
        [RELUME_FRAME_EYE] = tangent_of_eye,
        [RELUME_FRAME_LOOK] = tangent_of_look,
    };
    const double half = tangents[app->now.camera.framing](app);
    const double deg = isfinite(half) && half > 0 ? 2 * atan(half) * 180 / M_PI : APP_SCREEN_DEG;
    return fmin(fmax(deg, 0.01), 170);
}
