// events.c - what the mouse, the keys and time do to the state
#include "app/events.h"

#include "app/app.h"
#include "app/gizmo.h"
#include "app/handles_drag.h"
#include "app/keys.h"
#include "app/notes.h"
#include "app/orbit.h"
#include "app/way.h"
#include "common/vec.h"

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

// ---------------------------------------------------------------- turning

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

// The object follows the cursor, so the eye goes the other way; it stays among the cameras.
static void move_eye(struct app *app, double dx, double dy)
{
    if (orbit_is(app)) {
        double turn_deg[2];
        orbit_drag(turn_deg, app, dx, dy);
        orbit_turn(app, turn_deg[0], turn_deg[1]);
        app->turned_deg[0] += turn_deg[0];
        app->turned_deg[1] += turn_deg[1];
        return;
    }
    const struct app_file *f = &app->file;
    struct relume_vec3 *eye = &app->now.camera.eye;
    const double wide = f->uv_max[0] - f->uv_min[0];
    const double high = f->uv_max[1] - f->uv_min[1];
    eye->x = clamp(eye->x - dx / app->width * wide, f->uv_min[0], f->uv_max[0]);
    eye->y = clamp(eye->y + dy / app->height * high, f->uv_min[1], f->uv_max[1]);
}

static double degrees_per_pixel(const struct app *app)
{
    if (orbit_is(app))
        return orbit_degrees_per_pixel(app);
    const struct relume_pan_tilt *look = &app->now.camera.look;
    const double field = (look->stereographic ? 4 : 2) * atan(1 / look->zoom) * 180 / M_PI;
    return field / app->width;
}

static void turn_by(struct relume_pan_tilt *look, double pan_deg, double tilt_deg)
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

// Degrees that the direction at (x, y) lies to the right of and above `want`.
static void look_error(double error[2], const struct app *app, double x, double y,
                       struct relume_vec3 want)
{
    const struct relume_vec3 got =
        relume_pan_tilt_ray(app->now.camera.look, app->width, app->height, x, y);
    error[0] = remainder(atan2(got.x, -got.z) - atan2(want.x, -want.z), 2 * M_PI) * 180 / M_PI;
    error[1] = (asin(clamp(got.y, -1, 1)) - asin(clamp(want.y, -1, 1))) * 180 / M_PI;
}

// The direction under (x, y) stays there; near the poles, where pan and tilt cannot hold it or
// would have to spin, the middle does.
static void zoom_look(struct app *app, double x, double y, double factor)
{
    enum { ROUNDS = 32 };
    struct relume_pan_tilt *look = &app->now.camera.look;
    const struct relume_vec3 want = relume_pan_tilt_ray(*look, app->width, app->height, x, y);
    double error[2];
    look->zoom = clamp(look->zoom * factor, look_least[look->stereographic], look_most);
    const struct relume_pan_tilt middle = *look;
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

static bool begin_drag(struct app *app, const struct app_event *e)
{
    if (app->picks_focus && e->button == APP_LEFT) {
        app->cursor[0] = e->x;
        app->cursor[1] = e->y;
        app->picks_focus = false;
        app->action = APP_ACTION_FOCUS;
        return true;
    }
    const bool light = e->button == APP_RIGHT || app->light_key;
    if (app->reflects && !light && handles_press(app, e->x, e->y)) {
        app->drag = APP_DRAG_HANDLE;
        app->cursor[0] = e->x;
        app->cursor[1] = e->y;
        app_stand_still(app);
        return true;
    }
    if (app->noting && !light && notes_press(app, e->x, e->y)) {
        app->drag = APP_DRAG_NONE;
        app->cursor[0] = e->x;
        app->cursor[1] = e->y;
        return true;
    }
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

// Of two buttons the later one counts.
static bool on_press(struct app *app, const struct app_event *e)
{
    const bool edited = handles_release(app);
    return begin_drag(app, e) || edited;
}

// What is drawn roughly while it moves is drawn once more when it rests.
static bool is_rough(const struct app *app)
{
    return way_is_slow(app) || (orbit_is(app) && app->now.aperture > 0);
}

static bool on_release(struct app *app, const struct app_event *e)
{
    (void)e;
    const bool edited = handles_release(app);
    app->drag = APP_DRAG_NONE;
    return edited || is_rough(app);
}

static bool on_move(struct app *app, const struct app_event *e)
{
    const double dx = e->x - app->cursor[0];
    const double dy = e->y - app->cursor[1];
    app->cursor[0] = e->x;
    app->cursor[1] = e->y;
    if (app->drag == APP_DRAG_NONE || (dx == 0 && dy == 0))
        return app->inspect;
    if (app->drag == APP_DRAG_HANDLE)
        return handles_move(app, e->x, e->y);
    if (app->drag == APP_DRAG_LIGHT) {
        // As if the front of a ball half as wide as the frame were dragged: right turns it about
        // the frame's up, down about its right.
        const double per_pixel = 180 / fmin(app->width, app->height);
        app_turn_light(app, dx * per_pixel, dy * per_pixel);
    } else if (app->drag == APP_DRAG_GIZMO)
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
    app->width = e->width - app->beside[0] - app->beside[1];  // app_handle shares it out
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
    if (observer_lives(&app->now.observer) && seconds > 0)
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
