// gizmo.c - handles of the lights in the picture: where they are, and what dragging them does
#include "app/gizmo.h"

#include "app/aim.h"
#include "app/light_list.h"
#include "app/orbit.h"
#include "common/vec.h"
#include "format/coder/coding.h"
#include "relight/view/view.h"

#include <math.h>

static const double grip = 10.0;  // pixels around a handle that count as on it

struct gizmo_circle gizmo_disc(const struct app *app)
{
    return (struct gizmo_circle){
        .x = 0.5 * app->width,
        .y = 0.5 * app->height,
        .radius = 0.42 * fmin(app->width, app->height),
    };
}

struct gizmo_circle gizmo_ball(const struct app *app)
{
    const double radius = fmin(0.09 * fmin(app->width, app->height), 48.0);
    return (struct gizmo_circle){app->width - 1.4 * radius, app->height - 1.4 * radius, radius};
}

bool gizmo_on_ball(const struct app *app, double x, double y)
{
    const struct gizmo_circle ball = gizmo_ball(app);
    return app->now.ball && hypot(x - ball.x, y - ball.y) <= ball.radius;
}

void gizmo_drag_ball(struct app *app, double x, double y)
{
    const struct gizmo_circle ball = gizmo_ball(app);
    app_point_light(app, app->now.selected, (x - ball.x) / ball.radius, (ball.y - y) / ball.radius);
}

// `d`: right, up, towards the viewer.
static struct gizmo on_disc(const struct app *app, struct relume_vec3 d)
{
    const struct gizmo_circle disc = gizmo_disc(app);
    return (struct gizmo){
        .x = disc.x + disc.radius * d.x,
        .y = disc.y - disc.radius * d.y,
        .behind = d.z < 0,
    };
}

bool gizmo_border(struct gizmo *out, const struct app *app, int step)
{
    const struct relume_captured_region *z = app->file.zone;
    if (!z || z->everywhere)
        return false;
    const double phi = 2 * M_PI * step / RELUME_CAPTURED_REGION_STEPS;
    const double border = z->border[step % RELUME_CAPTURED_REGION_STEPS], r = sin(border);
    const struct relume_vec3 across =
        vec3_along(vec3_scale(z->right, r * cos(phi)), z->up, r * sin(phi));
    const struct relume_vec3 d = vec3_add(vec3_scale(z->axis, cos(border)), across);
    const struct app_axes a = app_frame_axes(app);
    *out = on_disc(
        app, (struct relume_vec3){vec3_dot(d, a.right), vec3_dot(d, a.up), vec3_dot(d, a.back)});
    return true;
}

// ---------------------------------------------------------------- near lights

// Where the window of a planar file or a slab lies.
struct window {
    double min[2], max[2], z;
};

static struct window window_of(const struct app *app)
{
    const struct relume_geometry *g = &app->file.geometry;
    if (g->projection == RELUME_SLAB)
        return (struct window){{g->st_min[0], g->st_min[1]}, {g->st_max[0], g->st_max[1]}, g->st_z};
    return (struct window){
        {g->window_min[0], g->window_min[1]}, {g->window_max[0], g->window_max[1]}, 0};
}

// How much a step at height `z` moves on the window, as the viewer sees it from `eye`; 0 for points
// beside or behind the viewer. Orthographic views see all heights alike.
static double scale_at(const struct app *app, double z, struct relume_vec3 *eye)
{
    const struct relume_geometry *g = &app->file.geometry;
    const struct window w = window_of(app);
    *eye = app->now.camera.framing == RELUME_FRAME_EYE
               ? app->now.camera.eye
               : (struct relume_vec3){0, 0, g->projection == RELUME_SLAB ? g->uv_z : g->camera_z};
    if (g->projection == RELUME_PLANAR && !g->perspective)
        return 1;
    const double ahead = (eye->z - z) / (eye->z - w.z);
    return ahead > 1e-6 ? 1 / ahead : 0;
}

static bool place_before_window(double xy[2], const struct app *app, struct relume_vec3 p)
{
    struct relume_vec3 eye;
    const struct window w = window_of(app);
    const struct app_rectangle r = app_picture(app);
    const double scale = scale_at(app, p.z, &eye);
    if (scale == 0)
        return false;
    const double s = scale == 1 ? p.x : eye.x + scale * (p.x - eye.x);
    const double t = scale == 1 ? p.y : eye.y + scale * (p.y - eye.y);
    xy[0] = r.left + (s - w.min[0]) / (w.max[0] - w.min[0]) * (r.right - r.left);
    xy[1] = r.top + (w.max[1] - t) / (w.max[1] - w.min[1]) * (r.bottom - r.top);
    return true;
}

static void drag_before_window(struct relume_vec3 *p, const struct app *app, double x, double y)
{
    struct relume_vec3 eye;
    const struct window w = window_of(app);
    const struct app_rectangle r = app_picture(app);
    const double scale = scale_at(app, p->z, &eye);
    const double s = w.min[0] + (x - r.left) / (r.right - r.left) * (w.max[0] - w.min[0]);
    const double t = w.max[1] - (y - r.top) / (r.bottom - r.top) * (w.max[1] - w.min[1]);
    p->x = scale == 1 ? s : eye.x + (s - eye.x) / scale;
    p->y = scale == 1 ? t : eye.y + (t - eye.y) / scale;
}

// By which a look divides what lies to the right of it and above; above 0 where it shows the point.
static double depth_in_look(const struct app *app, const struct app_axes *a, struct relume_vec3 d)
{
    const double ahead = -vec3_dot(d, a->back), far = vec3_length(d);
    const double depth = app->now.camera.look.stereographic ? far + ahead : ahead;
    return depth > 1e-3 * far ? depth : 0.0;
}

static bool place_in_look(double xy[2], const struct app *app, struct relume_vec3 p)
{
    const struct app_axes a = app_frame_axes(app);
    const struct relume_vec3 d = vec3_sub(p, app_middle(app));
    const double depth = depth_in_look(app, &a, d);
    const double scale = 0.5 * app->width * app->now.camera.look.zoom / depth;
    if (!(depth > 0.0))
        return false;
    xy[0] = 0.5 * app->width + scale * vec3_dot(d, a.right);
    xy[1] = 0.5 * app->height - scale * vec3_dot(d, a.up);
    return true;
}

static void drag_in_look(struct relume_vec3 *p, const struct app *app, double x, double y)
{
    const struct app_axes a = app_frame_axes(app);
    const struct relume_vec3 middle = app_middle(app);
    const double ahead = -vec3_dot(vec3_sub(*p, middle), a.back);
    const double scale = depth_in_look(app, &a, vec3_sub(*p, middle)) /
                         (0.5 * app->width * app->now.camera.look.zoom);
    const double right = scale * (x - 0.5 * app->width);
    const double up = scale * (0.5 * app->height - y);
    *p = (struct relume_vec3){
        middle.x + right * a.right.x + up * a.up.x - ahead * a.back.x,
        middle.y + right * a.right.y + up * a.up.y - ahead * a.back.y,
        middle.z + right * a.right.z + up * a.up.z - ahead * a.back.z,
    };
}

static bool place_unfolded(double xy[2], const struct app *app, struct relume_vec3 p)
{
    const struct app_rectangle r = app_picture(app);
    if (!relume_panorama_pixel(xy, &app->file.geometry, app->file.width, app->file.height,
                               vec3_sub(p, app_middle(app))))
        return false;
    xy[0] = r.left + xy[0] / app->file.width * (r.right - r.left);
    xy[1] = r.top + xy[1] / app->file.height * (r.bottom - r.top);
    return true;
}

static void drag_unfolded(struct relume_vec3 *p, const struct app *app, double x, double y)
{
    const struct app_rectangle r = app_picture(app);
    const struct relume_vec3 middle = app_middle(app);
    const struct relume_vec3 was = vec3_sub(*p, middle);
    const double far = sqrt(vec3_dot(was, was));
    const struct relume_vec3 ray =
        relume_panorama_ray(&app->file.geometry, app->file.width, app->file.height,
                            (x - r.left) / (r.right - r.left) * app->file.width,
                            (y - r.top) / (r.bottom - r.top) * app->file.height);
    *p = (struct relume_vec3){middle.x + far * ray.x, middle.y + far * ray.y,
                              middle.z + far * ray.z};
}

// How points of the scene appear in each framing, and move.
struct scene_framing {
    bool (*place)(double xy[2], const struct app *app, struct relume_vec3 p);
    void (*drag)(struct relume_vec3 *p, const struct app *app, double x, double y);
};

static struct scene_framing framing_of(const struct app *app)
{
    if (orbit_is(app))
        return (struct scene_framing){orbit_place, orbit_move};
    if (app->now.camera.framing == RELUME_FRAME_LOOK)
        return (struct scene_framing){place_in_look, drag_in_look};
    if (app_pole_y(app))
        return (struct scene_framing){place_unfolded, drag_unfolded};
    return (struct scene_framing){place_before_window, drag_before_window};
}

// ---------------------------------------------------------------- interface

static bool is_near(const struct app *app, int light)
{
    return relume_light_is_near(app->now.light[light].kind);
}

bool gizmo_place(double xy[2], const struct app *app, struct relume_vec3 point)
{
    return framing_of(app).place(xy, app, point);
}

bool gizmo_of(struct gizmo *out, const struct app *app, int light)
{
    double xy[2];
    if (!is_near(app, light)) {
        *out = on_disc(app, app_light_direction(app, light));
        return true;
    }
    if (!gizmo_place(xy, app, app->now.light[light].position))
        return false;
    *out = (struct gizmo){.x = xy[0], .y = xy[1], .near = true};
    return true;
}

int gizmo_first(const struct app *app)
{
    const int middle = app->now.selected - GIZMOS / 2, last = app->now.lights - GIZMOS;
    return middle < 0 || last < 0 ? 0 : middle < last ? middle : last;
}

int gizmo_hit(const struct app *app, double x, double y)
{
    int best = -1;
    double nearest = grip;
    const int first = gizmo_first(app);
    for (int i = first; i < app->now.lights && i < first + GIZMOS; i++) {
        struct gizmo g;
        if (!gizmo_of(&g, app, i))
            continue;
        const double far = hypot(g.x - x, g.y - y);
        if (far < nearest) {
            nearest = far;
            best = i;
        }
    }
    return best;
}

void gizmo_drag(struct app *app, int light, double x, double y)
{
    if (is_near(app, light))
        framing_of(app).drag(&app->now.light[light].position, app, x, y);
    else {
        const struct gizmo_circle disc = gizmo_disc(app);
        app_point_light(app, light, (x - disc.x) / disc.radius, (disc.y - y) / disc.radius);
    }
}
