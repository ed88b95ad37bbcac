#include "app/app.h"

#include "app/gizmo.h"
#include "app/keys.h"
#include "app/lamps.h"
#include "app/orbit.h"
#include "common/say.h"
#include "common/vec.h"

#include <relume/tone.h>

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static const double wheel_factor = 1.1;  // of the zoom, per step
static const double zoom_least = 0.1;
static const double zoom_most = 64.0;
// A perspective look gets 150 degrees wide, a stereographic one 340; both as narrow as 2 and 4.
static const double look_least[2] = {0.26795, 0.08749};
static const double look_most = 57.29;
static const double most_spin_deg = 30;     // of a zoom
static const double hand_s = 0.05;          // the hand's speed is its mean over about so long
static const double glide_s = 0.35;         // a glide loses 63 % of its speed in that time ...
static const double still_px_s = 4.0;       // ... and is over below this speed
static const double adapt_s = 0.5;          // automatic exposure, likewise
static const double adapted_enough = 0.02;  // EV

static double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

// ---------------------------------------------------------------- start

static bool panoramic(const struct app_file *file)
{
    const enum relume_projection p = file->geometry.projection;
    return p == RELUME_CYLINDRICAL || p == RELUME_SPHERICAL || p == RELUME_CUBE;
}

static void choose_framing(struct relume_camera *camera, const struct app_file *file,
                           bool look_ahead)
{
    if (camera->framing != RELUME_FRAME_DEFAULT)
        return;
    camera->framing = RELUME_FRAME_VIEW;
    if (panoramic(file) && look_ahead)
        camera->framing = RELUME_FRAME_LOOK;
    if (file->geometry.projection != RELUME_SLAB)
        return;
    camera->framing = RELUME_FRAME_EYE;
    if (file->around) {
        camera->eye = relume_slabs_eye(file->around, 0);
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
    if (camera->framing == RELUME_FRAME_LOOK && !panoramic(file))
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
    if (!relume_slabs_window(&window, file->around, eye, &camera->aim, file->width, file->height))
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
    if (!lamps_copy(s, start))
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
    if ((!s->lights && !lamps_add(s, &front, -1)) || !lamps_copy(&app->now, s)) {
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
    lamps_release(&app->start);
    lamps_release(&app->now);
}

const char *const app_dock_names[APP_DOCKS + 1] = {"over", "left", "right", NULL};

int app_window_width(const struct app *app)
{
    return app->beside[0] + app->width + app->beside[1];
}

static void arrange(struct app *app, int window_width)
{
    const bool fits = app->panel && app->dock && 2 * app->dock_width < window_width;
    const int beside = fits ? app->dock_width : 0;
    app->beside[0] = app->dock == APP_DOCK_LEFT ? beside : 0;
    app->beside[1] = app->dock == APP_DOCK_RIGHT ? beside : 0;
    app->width = window_width - beside;
}

void app_arrange(struct app *app)
{
    arrange(app, app_window_width(app));
}

void app_reset(struct app *app)
{
    (void)lamps_copy(&app->now, &app->start);
    app_stand_still(app);
}

// ---------------------------------------------------------------- picture

struct app_rectangle app_picture(const struct app *app)
{
    const struct app_state *s = &app->now;
    if (s->camera.framing == RELUME_FRAME_LOOK)
        return (struct app_rectangle){0, 0, app->width, app->height};
    struct relume_place at = {0, 0, app->width, app->height};
    if (s->camera.aim.field_of_view_deg == 0.0)
        at = relume_place_fit(app->file.width, app->file.height, app->width, app->height);
    const double middle[2] = {0.5 * app->width, 0.5 * app->height};
    const double left = middle[0] + s->shift[0] + (at.left - middle[0]) * s->zoom;
    const double top = middle[1] + s->shift[1] + (at.top - middle[1]) * s->zoom;
    return (struct app_rectangle){left, top, left + at.width * s->zoom, top + at.height * s->zoom};
}

bool app_window(const struct app *app, struct relume_window *window)
{
    return relume_slabs_window(window, app->file.around, app->now.camera.eye, &app->now.camera.aim,
                               app->width, app->height);
}

// The point of the picture under (x, y) stays there.
static void zoom_picture(struct app *app, double x, double y, double factor)
{
    struct app_state *s = &app->now;
    const double zoom = clamp(s->zoom * factor, zoom_least, zoom_most);
    const double change = zoom / s->zoom;
    const double from[2] = {x - 0.5 * app->width, y - 0.5 * app->height};
    for (int i = 0; i < 2; i++)
        s->shift[i] = from[i] + (s->shift[i] - from[i]) * change;
    s->zoom = zoom;
}

// ---------------------------------------------------------------- turning

bool app_pole_y(const struct app *app)
{
    const relume_slabs *around = app->file.around;
    return (around && relume_slabs_count(around) > 1) || panoramic(&app->file);
}

struct relume_vec3 app_middle(const struct app *app)
{
    const struct relume_geometry *g = &app->file.geometry;
    if (app->file.around)
        return relume_slabs_middle(app->file.around);
    if (panoramic(&app->file))
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
    if (panoramic(&app->file))
        return 1;
    const bool slab = g->projection == RELUME_SLAB;
    const double *min = slab ? g->st_min : g->window_min;
    const double *max = slab ? g->st_max : g->window_max;
    return 0.5 * fmax(fabs(max[0] - min[0]), fabs(max[1] - min[1]));
}

struct app_axes app_frame_axes(const struct app *app)
{
    if (orbit_is(app))
        return orbit_axes(app);
    if (app->now.camera.framing != RELUME_FRAME_LOOK)
        return (struct app_axes){{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double pan = app->now.camera.look.pan_deg * PI / 180;
    const double tilt = app->now.camera.look.tilt_deg * PI / 180;
    return (struct app_axes){
        .right = {cos(pan), 0, sin(pan)},
        .up = {-sin(tilt) * sin(pan), cos(tilt), sin(tilt) * cos(pan)},
        .back = {-cos(tilt) * sin(pan), -sin(tilt), cos(tilt) * cos(pan)},
    };
}

struct relume_vec3 app_seen_light(const struct app *app, int light)
{
    const struct app_axes a = app_frame_axes(app);
    const struct relume_vec3 d = lamps_direction(&app->now.light[light], app_middle(app));
    return (struct relume_vec3){vec_dot(d, a.right), vec_dot(d, a.up), vec_dot(d, a.back)};
}

void app_aim_light(struct app *app, int light, struct relume_vec3 seen)
{
    const struct app_axes a = app_frame_axes(app);
    const struct relume_vec3 world = {
        seen.x * a.right.x + seen.y * a.up.x + seen.z * a.back.x,
        seen.x * a.right.y + seen.y * a.up.y + seen.z * a.back.y,
        seen.x * a.right.z + seen.y * a.up.z + seen.z * a.back.z,
    };
    lamps_aim(&app->now, light, world, app_middle(app));
}

void app_point_light(struct app *app, int light, double x, double y)
{
    const double r = fmax(hypot(x, y), 1);
    const double side = app_seen_light(app, light).z < 0 ? -1 : 1;
    const double z = sqrt(fmax(1 - (x * x + y * y) / (r * r), 0));
    app_aim_light(app, light, (struct relume_vec3){x / r, y / r, side * z});
}

void app_turn_light(struct app *app, double yaw_deg, double pitch_deg)
{
    const struct relume_vec3 seen = app_seen_light(app, app->now.selected);
    const double yaw = yaw_deg * PI / 180;
    const double pitch = pitch_deg * PI / 180;
    const double y = seen.y * cos(pitch) - seen.z * sin(pitch);
    const double ahead = seen.y * sin(pitch) + seen.z * cos(pitch);
    const double x = seen.x * cos(yaw) + ahead * sin(yaw);
    const double z = ahead * cos(yaw) - seen.x * sin(yaw);
    app_aim_light(app, app->now.selected, (struct relume_vec3){x, y, z});
}

// As if the front of a ball half as wide as the frame were dragged: right turns it about the
// frame's up, down about its right.
static void turn_light(struct app *app, double dx, double dy)
{
    const double per_pixel = 180 / fmin(app->width, app->height);
    app_turn_light(app, dx * per_pixel, dy * per_pixel);
}

static void turn_orbit(struct app *app, double dx, double dy)
{
    double turn_deg[2];
    orbit_drag(turn_deg, app, dx, dy);
    orbit_turn(app, turn_deg[0], turn_deg[1]);
    app->turned_deg[0] += turn_deg[0];
    app->turned_deg[1] += turn_deg[1];
}

// The object follows the cursor, so the eye goes the other way; it stays among the cameras.
static void move_eye(struct app *app, double dx, double dy)
{
    if (orbit_is(app)) {
        turn_orbit(app, dx, dy);
        return;
    }
    const struct app_file *f = &app->file;
    struct relume_vec3 *eye = &app->now.camera.eye;
    const double wide = f->uv_max[0] - f->uv_min[0];
    const double high = f->uv_max[1] - f->uv_min[1];
    eye->x = clamp(eye->x - dx / app->width * wide, f->uv_min[0], f->uv_max[0]);
    eye->y = clamp(eye->y + dy / app->height * high, f->uv_min[1], f->uv_max[1]);
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

static double degrees_per_pixel(const struct app *app)
{
    if (orbit_is(app))
        return orbit_degrees_per_pixel(app);
    const struct relume_look *look = &app->now.camera.look;
    const double field = (look->stereographic ? 4 : 2) * atan(1 / look->zoom) * 180 / PI;
    return field / app->width;
}

static void turn_by(struct relume_look *look, double pan_deg, double tilt_deg)
{
    look->pan_deg = remainder(look->pan_deg + pan_deg, 360);
    look->tilt_deg = clamp(look->tilt_deg + tilt_deg, -90, 90);
}

// The scene follows the cursor.
static void turn_look(struct app *app, double dx, double dy)
{
    const double per_pixel = degrees_per_pixel(app);
    turn_by(&app->now.camera.look, -dx * per_pixel, dy * per_pixel);
    app->turned_deg[0] -= dx * per_pixel;
    app->turned_deg[1] += dy * per_pixel;
}

void app_stand_still(struct app *app)
{
    app->speed_deg_s[0] = app->speed_deg_s[1] = 0;
    app->turned_deg[0] = app->turned_deg[1] = 0;
}

// Degrees that the direction at (x, y) lies to the right of and above `want`.
static void look_error(double error[2], const struct app *app, double x, double y,
                       struct relume_vec3 want)
{
    const struct relume_vec3 got =
        relume_look_ray(app->now.camera.look, app->width, app->height, x, y);
    error[0] = remainder(atan2(got.x, -got.z) - atan2(want.x, -want.z), 2 * PI) * 180 / PI;
    error[1] = (asin(clamp(got.y, -1, 1)) - asin(clamp(want.y, -1, 1))) * 180 / PI;
}

// The direction under (x, y) stays there; near the poles, where pan and tilt cannot hold it or
// would have to spin, the middle does.
static void zoom_look(struct app *app, double x, double y, double factor)
{
    enum { ROUNDS = 32 };
    struct relume_look *look = &app->now.camera.look;
    const struct relume_vec3 want = relume_look_ray(*look, app->width, app->height, x, y);
    double error[2];
    look->zoom = clamp(look->zoom * factor, look_least[look->stereographic], look_most);
    const struct relume_look middle = *look;
    for (int i = 0; i < ROUNDS; i++) {
        look_error(error, app, x, y, want);
        turn_by(look, -error[0], -error[1]);
    }
    look_error(error, app, x, y, want);
    const double spin = fabs(remainder(look->pan_deg - middle.pan_deg, 360));
    if (hypot(error[0], error[1]) > 0.1 * degrees_per_pixel(app) || spin > most_spin_deg)
        *look = middle;
}

static void move_picture(struct app *app, double dx, double dy)
{
    app->now.shift[0] += dx;
    app->now.shift[1] += dy;
}

// ---------------------------------------------------------------- events

// What the mouse does in each framing.
static void (*const drag_camera[])(struct app *, double dx, double dy) = {
    [RELUME_FRAME_VIEW] = move_picture,
    [RELUME_FRAME_EYE] = move_eye,
    [RELUME_FRAME_LOOK] = turn_look,
};

static bool pick_focus(struct app *app, const struct app_event *e)
{
    app->cursor[0] = e->x;
    app->cursor[1] = e->y;
    app->picks_focus = false;
    app->wish = APP_WISH_FOCUS;
    return true;
}

static bool on_press(struct app *app, const struct app_event *e)
{
    if (app->picks_focus && e->button == APP_LEFT)
        return pick_focus(app, e);
    const bool light = e->button == APP_RIGHT || app->light_key;
    const int grabbed = app->gizmos && !light ? gizmo_hit(app, e->x, e->y) : -1;
    const bool ball = !light && grabbed < 0 && gizmo_on_ball(app, e->x, e->y);
    app->drag = light          ? APP_DRAG_LIGHT
                : grabbed >= 0 ? APP_DRAG_GIZMO
                : ball         ? APP_DRAG_BALL
                               : APP_DRAG_CAMERA;
    app->cursor[0] = e->x;
    app->cursor[1] = e->y;
    app_stand_still(app);
    app->hint_s = 0;  // it is known
    if (grabbed >= 0)
        app->now.selected = grabbed;
    if (ball)
        gizmo_drag_ball(app, e->x, e->y);
    return grabbed >= 0 || ball;
}

// What is drawn roughly while it moves is drawn once more when it rests.
static bool is_rough(const struct app *app)
{
    return orbit_is(app) && app->now.aperture > 0;
}

static bool on_release(struct app *app, const struct app_event *e)
{
    (void)e;
    app->drag = APP_DRAG_NONE;
    return is_rough(app);
}

static bool on_move(struct app *app, const struct app_event *e)
{
    const double dx = e->x - app->cursor[0];
    const double dy = e->y - app->cursor[1];
    app->cursor[0] = e->x;
    app->cursor[1] = e->y;
    if (app->drag == APP_DRAG_NONE || (dx == 0 && dy == 0))
        return app->inspect;
    if (app->drag == APP_DRAG_LIGHT)
        turn_light(app, dx, dy);
    else if (app->drag == APP_DRAG_GIZMO)
        gizmo_drag(app, app->now.selected, e->x, e->y);
    else if (app->drag == APP_DRAG_BALL)
        gizmo_drag_ball(app, e->x, e->y);
    else
        drag_camera[app->now.camera.framing](app, dx, dy);
    return true;
}

static bool on_wheel(struct app *app, const struct app_event *e)
{
    const double factor = pow(wheel_factor, e->wheel);
    if (app->now.camera.framing == RELUME_FRAME_LOOK)
        zoom_look(app, e->x, e->y, factor);
    else if (orbit_is(app))
        orbit_dolly(app, 1 / factor);
    else
        zoom_picture(app, e->x, e->y, factor);
    return true;
}

static bool on_key_down(struct app *app, const struct app_event *e)
{
    const bool changed = keys_press(app, e->key, e->repeat);
    app->quit |= app->asks && e->unasked;
    return changed;
}

static bool on_key_up(struct app *app, const struct app_event *e)
{
    if (e->key == 'l')
        app->light_key = false;
    return false;
}

// Only text fields of the panel read text.
static bool on_text(struct app *app, const struct app_event *e)
{
    (void)app, (void)e;
    return false;
}

static bool on_size(struct app *app, const struct app_event *e)
{
    if (e->width < 1 || e->height < 1)
        return false;
    app->height = e->height;
    arrange(app, e->width);
    return true;
}

static bool (*const handlers[])(struct app *, const struct app_event *) = {
    [APP_PRESS] = on_press, [APP_RELEASE] = on_release,   [APP_MOVE] = on_move,
    [APP_WHEEL] = on_wheel, [APP_KEY_DOWN] = on_key_down, [APP_KEY_UP] = on_key_up,
    [APP_TEXT] = on_text,   [APP_SIZE] = on_size,
};

bool app_handle(struct app *app, const struct app_event *event)
{
    struct app_event in_frame = *event;
    in_frame.x -= app->beside[0];
    const bool changed = handlers[event->kind](app, &in_frame);
    app_arrange(app);
    return changed;
}

// ---------------------------------------------------------------- time

static void follow_hand(struct app *app, double seconds)
{
    const double keep = exp(-seconds / hand_s);
    for (int i = 0; i < 2; i++) {
        const double speed = app->turned_deg[i] / seconds;
        app->speed_deg_s[i] = keep * app->speed_deg_s[i] + (1 - keep) * speed;
        app->turned_deg[i] = 0;
    }
}

static bool glide(struct app *app, double seconds)
{
    double *speed = app->speed_deg_s;
    const double keep = exp(-seconds / glide_s);
    const double way = glide_s * (1 - keep);
    if (hypot(speed[0], speed[1]) < still_px_s * degrees_per_pixel(app)) {
        const bool moved = app_moves(app);
        app_stand_still(app);
        return moved && is_rough(app);
    }
    if (orbit_is(app))
        orbit_turn(app, speed[0] * way, speed[1] * way);
    else
        turn_by(&app->now.camera.look, speed[0] * way, speed[1] * way);
    speed[0] *= keep;
    speed[1] *= keep;
    return true;
}

static bool adapt(struct app *app, double seconds)
{
    const double left = app->metered_ev - app->adapted_ev;
    if (!app->now.auto_exposure || fabs(left) < adapted_enough)
        return false;
    app->adapted_ev += left * (1 - exp(-seconds / adapt_s));
    return true;
}

static const double fade_s = 0.6;

double app_note_alpha(double left_s)
{
    return clamp(left_s / fade_s, 0, 1);
}

static bool fade(double *left_s, double seconds)
{
    const double before = app_note_alpha(*left_s);
    *left_s = fmax(*left_s - seconds, 0);
    return app_note_alpha(*left_s) != before;
}

bool app_fade(struct app *app, double seconds)
{
    const bool toast = fade(&app->toast_s, seconds);
    return fade(&app->hint_s, seconds) || toast;
}

static double steady_s(double left_s)
{
    return left_s > 0 ? fmax(left_s - fade_s, 0) : INFINITY;
}

double app_steady_s(const struct app *app)
{
    return fmin(steady_s(app->toast_s), steady_s(app->hint_s));
}

void app_live(struct app *app, double seconds)
{
    if (gaze_lives(&app->now.gaze) && seconds > 0)
        app->eye_s += seconds;
}

bool app_advance(struct app *app, double seconds)
{
    if (!(seconds > 0))
        return false;
    bool changed = adapt(app, seconds);
    app_live(app, seconds);
    if (app->now.camera.framing != RELUME_FRAME_LOOK && !orbit_is(app))
        return changed;
    if (app->drag == APP_DRAG_CAMERA)
        follow_hand(app, seconds);
    else
        changed |= glide(app, seconds);
    return changed;
}

bool app_moves(const struct app *app)
{
    return app->drag != APP_DRAG_NONE || app->speed_deg_s[0] != 0 || app->speed_deg_s[1] != 0;
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
