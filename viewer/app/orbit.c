// orbit.c - the eye on its way around an object that several slabs show
#include "app/orbit.h"

#include "common/vec.h"
#include "relight/view/slab_set.h"

#include <math.h>

static const double highest_deg = 89;  // above and below the object

bool orbit_is(const struct app *app)
{
    return app->file.around && app->now.camera.framing == RELUME_FRAME_EYE;
}

// What the eye goes around.
static struct relume_vec3 target_of(const struct app *app)
{
    const struct relume_look_at *look_at = &app->now.camera.look_at;
    return look_at->aimed ? look_at->at : relume_slab_set_middle(app->file.around);
}

static void put_eye(struct app *app, struct relume_vec3 d)
{
    const struct relume_vec3 m = target_of(app);
    app->now.camera.eye = (struct relume_vec3){m.x + d.x, m.y + d.y, m.z + d.z};
}

static struct relume_vec3 eye_from_middle(const struct app *app)
{
    return vec3_sub(app->now.camera.eye, target_of(app));
}

static struct relume_vec3 from_middle(double azimuth, double elevation, double away)
{
    return vec3_scale((struct relume_vec3){sin(azimuth) * cos(elevation), sin(elevation),
                                           cos(azimuth) * cos(elevation)},
                      away);
}

static double elevation_of(struct relume_vec3 d)
{
    return atan2(d.y, hypot(d.x, d.z));
}

// Whether some camera sees the middle from that side.
static bool is_covered(const struct app *app, struct relume_vec3 d)
{
    const struct relume_vec3 m = target_of(app);
    const struct relume_vec3 eye = {m.x + d.x, m.y + d.y, m.z + d.z};
    double place[2];
    int view;
    return relume_slab_set_nearest(&view, place, app->file.around, eye, vec3_scale(d, -1));
}

// As high or low as cameras go on the way from the first slab's height to the wanted one; false
// when they do not stand at this azimuth.
static bool find_covered(double *elevation, const struct app *app, double azimuth, double away)
{
    double inside =
        elevation_of(vec3_sub(relume_slab_set_eye(app->file.around, 0), target_of(app)));
    double outside = *elevation;
    if (!is_covered(app, from_middle(azimuth, inside, away)))
        return false;
    for (int i = 0; i < 40; i++) {
        const double between = 0.5 * (inside + outside);
        if (is_covered(app, from_middle(azimuth, between, away)))
            inside = between;
        else
            outside = between;
    }
    *elevation = inside;
    return true;
}

void orbit_turn(struct app *app, double right_deg, double up_deg)
{
    const struct relume_vec3 d = eye_from_middle(app);
    const double most = highest_deg * M_PI / 180;
    const double away = vec3_length(d);
    const double azimuth = atan2(d.x, d.z) + right_deg * M_PI / 180;
    double elevation = clamp(elevation_of(d) + up_deg * M_PI / 180, -most, most);
    const bool leaves =
        is_covered(app, d) && !is_covered(app, from_middle(azimuth, elevation, away));
    if (!leaves || find_covered(&elevation, app, azimuth, away))
        put_eye(app, from_middle(azimuth, elevation, away));
}

double orbit_degrees_per_pixel(const struct app *app)
{
    return 180 / fmin(app->width, app->height);
}

// The object follows the cursor, so the eye goes the other way.
void orbit_drag(double turn_deg[2], const struct app *app, double dx, double dy)
{
    turn_deg[0] = -dx * orbit_degrees_per_pixel(app);
    turn_deg[1] = dy * orbit_degrees_per_pixel(app);
}

void orbit_dolly(struct app *app, double factor)
{
    const relume_slab_set *slabs = app->file.around;
    const double captured = vec3_length(vec3_sub(relume_slab_set_eye(slabs, 0), target_of(app)));
    const struct relume_vec3 d = eye_from_middle(app);
    const double now = vec3_length(d);
    put_eye(app, vec3_scale(d, captured * clamp(now / captured * factor, 0.25, 4.0) / now));
}

void orbit_walk(struct app *app, double right, double ahead)
{
    const struct app_axes a = orbit_axes(app);
    const struct relume_vec3 at = target_of(app);
    const double away = vec3_length(eye_from_middle(app));
    const struct relume_vec3 level = {-a.back.x, 0, -a.back.z};
    const double flat = vec3_length(level);
    const struct relume_vec3 before = flat > 1e-9 ? vec3_scale(level, 1 / flat) : a.up;
    const struct relume_vec3 step =
        vec3_along(vec3_scale(a.right, right * away), before, ahead * away);
    app->now.camera.eye = vec3_add(app->now.camera.eye, step);
    app->now.camera.look_at.at = vec3_add(at, step);
    app->now.camera.look_at.aimed = true;
}

// ---------------------------------------------------------------- frame

bool orbit_place(double xy[2], const struct app *app, struct relume_vec3 point)
{
    const struct app_rectangle r = app_picture(app);
    struct relume_window w;
    if (!app_window(app, &w))
        return false;
    const struct relume_vec3 corner = vec3_sub(w.corner, w.eye);
    const struct relume_vec3 normal = vec3_cross(w.right, w.down);
    const double ahead = vec3_dot(vec3_sub(point, w.eye), normal) / vec3_dot(corner, normal);
    if (!(ahead > 1e-6))
        return false;
    const struct relume_vec3 hit = vec3_sub(vec3_scale(vec3_sub(point, w.eye), 1 / ahead), corner);
    xy[0] = r.left + vec3_dot(hit, w.right) / vec3_dot(w.right, w.right) * (r.right - r.left);
    xy[1] = r.top + vec3_dot(hit, w.down) / vec3_dot(w.down, w.down) * (r.bottom - r.top);
    return true;
}

void orbit_move(struct relume_vec3 *point, const struct app *app, double x, double y)
{
    const struct app_rectangle r = app_picture(app);
    double from[2];
    struct relume_window w;
    if (!orbit_place(from, app, *point) || !app_window(app, &w))
        return;
    const struct relume_vec3 normal = vec3_cross(w.right, w.down);
    const double ahead =
        vec3_dot(vec3_sub(*point, w.eye), normal) / vec3_dot(vec3_sub(w.corner, w.eye), normal);
    const struct relume_vec3 across =
        vec3_scale(w.right, ahead * (x - from[0]) / (r.right - r.left));
    const struct relume_vec3 down = vec3_scale(w.down, ahead * (y - from[1]) / (r.bottom - r.top));
    *point = (struct relume_vec3){point->x + across.x + down.x, point->y + across.y + down.y,
                                  point->z + across.z + down.z};
}

struct relume_vec3 orbit_ray(const struct app *app, double x, double y)
{
    const struct app_rectangle r = app_picture(app);
    struct relume_window w;
    if (!app_window(app, &w))
        return (struct relume_vec3){0};
    const struct relume_vec3 corner = vec3_sub(w.corner, w.eye);
    const struct relume_vec3 across = vec3_scale(w.right, (x - r.left) / (r.right - r.left));
    const struct relume_vec3 down = vec3_scale(w.down, (y - r.top) / (r.bottom - r.top));
    return (struct relume_vec3){corner.x + across.x + down.x, corner.y + across.y + down.y,
                                corner.z + across.z + down.z};
}

struct app_axes orbit_axes(const struct app *app)
{
    struct relume_window w;
    if (!app_window(app, &w))
        return (struct app_axes){{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const struct relume_vec3 right = vec3_scale(w.right, 1 / vec3_length(w.right));
    const struct relume_vec3 up = vec3_scale(w.down, -1 / vec3_length(w.down));
    return (struct app_axes){right, up, vec3_cross(right, up)};
}
