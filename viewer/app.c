#include "app.h"

#include "say.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static const double wheel_factor = 1.1;  // of the zoom, per step
static const double zoom_least = 0.1;
static const double zoom_most = 64.0;
static const double exposure_step = 0.25;  // EV per key
static const double dolly_factor = 1.05;   // of the eye's distance, per key

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

static bool behind_cameras(const struct app_file *file, double z)
{
    const struct relume_geometry *g = &file->geometry;
    return !((z - g->st_z) / (g->uv_z - g->st_z) < 1.0);
}

relume_status app_start(struct app *app, const struct app_file *file, const struct app_state *start,
                        bool look_ahead, const struct relume_log *log)
{
    *app = (struct app){.file = *file, .start = *start};
    struct app_state *s = &app->start;
    choose_framing(&s->camera, file, look_ahead);
    const relume_status status = check_camera(&s->camera, file, log);
    if (status)
        return status;
    if (!s->focused)
        s->focus_z = file->geometry.st_z;
    else if (file->geometry.projection == RELUME_SLAB && behind_cameras(file, s->focus_z))
        return say(log, RELUME_EINVAL,
                   "--focus: expected a plane in front of the cameras at z = %g; found z = %g",
                   file->geometry.uv_z, s->focus_z);
    if (s->camera.look.zoom <= 0.0)
        s->camera.look.zoom = 1.0;
    s->zoom = 1.0;
    if (!s->lights) {
        s->light[0] = (struct relume_light){.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
        s->lights = 1;
    }
    const bool look = s->camera.framing == RELUME_FRAME_LOOK;
    app->width = s->camera.width ? s->camera.width : look ? 1024 : file->width;
    app->height = s->camera.height ? s->camera.height : look ? 512 : file->height;
    app->now = app->start;
    return RELUME_OK;
}

// ---------------------------------------------------------------- picture

struct app_rectangle app_picture(const struct app *app)
{
    const struct app_state *s = &app->now;
    if (s->camera.framing == RELUME_FRAME_LOOK)
        return (struct app_rectangle){0, 0, app->width, app->height};
    double width = app->width;
    double height = app->height;
    if (app->letterbox) {
        const double fit = fmin(width / app->file.width, height / app->file.height);
        width = app->file.width * fit;
        height = app->file.height * fit;
    }
    const double x = 0.5 * app->width + s->shift[0];
    const double y = 0.5 * app->height + s->shift[1];
    return (struct app_rectangle){
        x - 0.5 * width * s->zoom,
        y - 0.5 * height * s->zoom,
        x + 0.5 * width * s->zoom,
        y + 0.5 * height * s->zoom,
    };
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

// Directions of the frame in the world: right, up, and towards the viewer.
struct axes {
    struct relume_vec3 right, up, back;
};

static struct axes frame_axes(const struct app *app)
{
    if (app->now.camera.framing != RELUME_FRAME_LOOK)
        return (struct axes){{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double pan = app->now.camera.look.pan_deg * PI / 180;
    const double tilt = app->now.camera.look.tilt_deg * PI / 180;
    return (struct axes){
        .right = {cos(pan), 0, sin(pan)},
        .up = {-sin(tilt) * sin(pan), cos(tilt), sin(tilt) * cos(pan)},
        .back = {-cos(tilt) * sin(pan), -sin(tilt), cos(tilt) * cos(pan)},
    };
}

static double dot(struct relume_vec3 a, struct relume_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

struct relume_vec3 app_seen_light(const struct app *app, int light)
{
    const struct axes a = frame_axes(app);
    const struct relume_vec3 d = app->now.light[light].direction;
    const double scale = 1 / sqrt(dot(d, d));
    return (struct relume_vec3){dot(d, a.right) * scale, dot(d, a.up) * scale,
                                dot(d, a.back) * scale};
}

// As if the front of a ball half as wide as the frame were dragged: right turns it about the
// frame's up, down about its right.
static void turn_light(struct app *app, double dx, double dy)
{
    const double per_pixel = PI / fmin(app->width, app->height);
    const struct axes a = frame_axes(app);
    const struct relume_vec3 seen = app_seen_light(app, 0);
    const double yaw = dx * per_pixel;
    const double pitch = dy * per_pixel;
    const double y = seen.y * cos(pitch) - seen.z * sin(pitch);
    const double ahead = seen.y * sin(pitch) + seen.z * cos(pitch);
    const double x = seen.x * cos(yaw) + ahead * sin(yaw);
    const double z = ahead * cos(yaw) - seen.x * sin(yaw);
    app->now.light[0].direction = (struct relume_vec3){
        x * a.right.x + y * a.up.x + z * a.back.x,
        x * a.right.y + y * a.up.y + z * a.back.y,
        x * a.right.z + y * a.up.z + z * a.back.z,
    };
}

// The object follows the cursor, so the eye goes the other way; it stays among the cameras.
static void move_eye(struct app *app, double dx, double dy)
{
    const struct app_file *f = &app->file;
    struct relume_vec3 *eye = &app->now.camera.eye;
    const double wide = f->uv_max[0] - f->uv_min[0];
    const double high = f->uv_max[1] - f->uv_min[1];
    eye->x = clamp(eye->x - dx / app->width * wide, f->uv_min[0], f->uv_max[0]);
    eye->y = clamp(eye->y + dy / app->height * high, f->uv_min[1], f->uv_max[1]);
}

static void dolly(struct app *app, double factor)
{
    const double st_z = app->file.geometry.st_z;
    const double captured = app->file.geometry.uv_z - st_z;
    double *z = &app->now.camera.eye.z;
    *z = st_z + captured * clamp((*z - st_z) / captured * factor, 0.25, 4.0);
}

// The scene follows the cursor.
static void turn_look(struct app *app, double dx, double dy)
{
    struct relume_look *look = &app->now.camera.look;
    const double per_pixel = 2 * atan(1 / look->zoom) * 180 / PI / app->width;
    look->pan_deg = remainder(look->pan_deg - dx * per_pixel, 360);
    look->tilt_deg = clamp(look->tilt_deg + dy * per_pixel, -90, 90);
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

static bool on_press(struct app *app, const struct app_event *e)
{
    const bool light = e->button == APP_RIGHT || app->light_key;
    app->drag = light ? APP_DRAG_LIGHT : APP_DRAG_CAMERA;
    app->cursor[0] = e->x;
    app->cursor[1] = e->y;
    return false;
}

static bool on_release(struct app *app, const struct app_event *e)
{
    (void)e;
    app->drag = APP_DRAG_NONE;
    return false;
}

static bool on_move(struct app *app, const struct app_event *e)
{
    const double dx = e->x - app->cursor[0];
    const double dy = e->y - app->cursor[1];
    app->cursor[0] = e->x;
    app->cursor[1] = e->y;
    if (app->drag == APP_DRAG_NONE || (dx == 0 && dy == 0))
        return false;
    if (app->drag == APP_DRAG_LIGHT)
        turn_light(app, dx, dy);
    else
        drag_camera[app->now.camera.framing](app, dx, dy);
    return true;
}

static bool on_wheel(struct app *app, const struct app_event *e)
{
    const double factor = pow(wheel_factor, e->wheel);
    struct relume_look *look = &app->now.camera.look;
    if (app->now.camera.framing == RELUME_FRAME_LOOK)
        look->zoom = clamp(look->zoom * factor, zoom_least, zoom_most);
    else
        zoom_picture(app, e->x, e->y, factor);
    return true;
}

static bool on_key_down(struct app *app, const struct app_event *e)
{
    struct app_state *s = &app->now;
    switch (e->key) {
    case APP_KEY_ESCAPE: app->quit = true; return false;
    case 'l': app->light_key = true; return false;
    case 'r': *s = app->start; return true;
    case 'b': s->ball = !s->ball; return true;
    case '+': s->exposure_ev += exposure_step; return true;
    case '-': s->exposure_ev -= exposure_step; return true;
    case '[':
    case ']':
        if (s->camera.framing != RELUME_FRAME_EYE)
            return false;
        dolly(app, e->key == '[' ? 1 / dolly_factor : dolly_factor);
        return true;
    default: return false;
    }
}

static bool on_key_up(struct app *app, const struct app_event *e)
{
    if (e->key == 'l')
        app->light_key = false;
    return false;
}

static bool on_size(struct app *app, const struct app_event *e)
{
    if (e->width < 1 || e->height < 1)
        return false;
    app->width = e->width;
    app->height = e->height;
    return true;
}

static bool (*const handlers[])(struct app *, const struct app_event *) = {
    [APP_PRESS] = on_press, [APP_RELEASE] = on_release,   [APP_MOVE] = on_move,
    [APP_WHEEL] = on_wheel, [APP_KEY_DOWN] = on_key_down, [APP_KEY_UP] = on_key_up,
    [APP_SIZE] = on_size,
};

bool app_handle(struct app *app, const struct app_event *event)
{
    return handlers[event->kind](app, event);
}
