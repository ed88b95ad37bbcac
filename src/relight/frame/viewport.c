// viewport.c - the ray of a pixel and the pixel of a point, for every kind of frame
#include <relume/relight/viewport.h>

#include "core/math/vec.h"
#include "relight/view/slab_set.h"
#include "relight/view/view.h"
#include "relight/frame/viewport.h"

// ---------------------------------------------------------------- of a frame

struct relume_window relume_planar_window(const struct relume_geometry *g)
{
    return (struct relume_window){
        .eye = {0, 0, g->camera_z},
        .corner = {g->window_min[0], g->window_max[1], 0},
        .right = {g->window_max[0] - g->window_min[0], 0, 0},
        .down = {0, g->window_min[1] - g->window_max[1], 0},
    };
}

static void viewport_of_view(struct relume_viewport *s, const relume_pack *pack, int view)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    s->geometry = *relume_pack_geometry(pack, view);
    const struct relume_geometry *g = &s->geometry;
    if (g->projection == RELUME_SLAB) {
        const vec3 camera = vec3_of(info->uv[view][0], info->uv[view][1], g->uv_z);
        s->window = relume_slab_window(g, relume_pose_world(&g->pose, camera));
        s->kind = RELUME_VIEWPORT_PERSPECTIVE;
    } else if (g->projection == RELUME_PLANAR) {
        s->window = relume_planar_window(g);
        s->kind = g->perspective ? RELUME_VIEWPORT_PERSPECTIVE : RELUME_VIEWPORT_PARALLEL;
    } else {
        s->kind = RELUME_VIEWPORT_UNFOLDED;
    }
}

static relume_status viewport_of_eye(struct relume_viewport *s, const relume_pack *pack,
                                     const struct relume_camera *camera)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    relume_slab_set *slabs;
    const relume_status status =
        relume_slab_set_create(&slabs, info->slabs ? info->slab : &info->geometry,
                               info->slabs ? info->slabs : 1, info->uv, info->slab_of, info->views);
    if (status)
        return status;
    const vec3 eye =
        camera->framing == RELUME_FRAME_EYE ? camera->eye : relume_slab_set_eye(slabs, 0);
    const bool window = !info->slabs && !relume_look_at_given(&camera->look_at);
    const int through = window ? 1 : camera->through;
    bool sees = true;
    if (through > 0 && through <= relume_slab_set_count(slabs))
        s->window = relume_slab_window(relume_slab_set_geometry(slabs, through - 1), eye);
    else
        sees =
            relume_slab_set_window(&s->window, slabs, eye, &camera->look_at, s->width, s->height);
    relume_slab_set_destroy(&slabs);
    return sees ? RELUME_OK : RELUME_EINVAL;
}

relume_status relume_frame_viewport(struct relume_viewport *out, relume_pack *pack,
                                    const struct relume_camera *camera, int width, int height)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const bool slab = info->geometry.projection == RELUME_SLAB;
    const int view = camera->framing == RELUME_FRAME_VIEW ? camera->view : 0;
    struct relume_camera sized = *camera;
    int frame[2];
    sized.width = width;
    sized.height = height;
    const struct relume_rect place = relume_camera_rect(frame, info, &sized);
    *out = (struct relume_viewport){.width = width,
                                    .height = height,
                                    .left = place.left,
                                    .top = place.top,
                                    .wide = place.width,
                                    .high = place.height,
                                    .geometry = info->geometry,
                                    .look = camera->look};
    if (view < 0 || view >= info->views)
        return RELUME_EINVAL;
    if (camera->framing == RELUME_FRAME_LOOK)
        out->kind = RELUME_VIEWPORT_PANORAMA;
    else if (camera->framing == RELUME_FRAME_EYE || (slab && camera->framing != RELUME_FRAME_VIEW))
        return viewport_of_eye(out, pack, camera);
    else
        viewport_of_view(out, pack, view);
    return RELUME_OK;
}

// ---------------------------------------------------------------- pictures in frames

// The picture's part of the frame.
struct part {
    double left, top, wide, high;
};

static struct part part_of(const struct relume_viewport *s)
{
    return s->wide > 0.0 ? (struct part){s->left, s->top, s->wide, s->high}
                         : (struct part){0, 0, s->width, s->height};
}

static vec3 on_window(const struct relume_viewport *s, double x, double y)
{
    const struct relume_window *w = &s->window;
    const struct part p = part_of(s);
    return vec3_add(w->corner, vec3_along(vec3_scale(w->right, (x - p.left) / p.wide), w->down,
                                          (y - p.top) / p.high));
}

static vec3 normal_of(const struct relume_window *w)
{
    return vec3_cross(w->right, w->down);
}

// Unit vectors of a look.
struct axes {
    vec3 right, up, ahead;
};

static struct axes axes_of(struct relume_pan_tilt look)
{
    const double pan = look.pan_deg * M_PI / 180.0, tilt = look.tilt_deg * M_PI / 180.0;
    return (struct axes){
        .right = {cos(pan), 0, sin(pan)},
        .up = {-sin(tilt) * sin(pan), cos(tilt), sin(tilt) * cos(pan)},
        .ahead = {cos(tilt) * sin(pan), sin(tilt), -cos(tilt) * cos(pan)},
    };
}

static double zoom_of(const struct relume_viewport *s)
{
    return s->look.zoom > 0.0 ? s->look.zoom : 1.0;
}

void relume_viewport_ray(struct relume_vec3 *origin, struct relume_vec3 *direction,
                         const struct relume_viewport *s, double x, double y)
{
    const struct part p = part_of(s);
    vec3 at;
    switch (s->kind) {
    case RELUME_VIEWPORT_PERSPECTIVE:
        *origin = s->window.eye;
        *direction = vec3_unit(vec3_sub(on_window(s, x, y), s->window.eye));
        break;
    case RELUME_VIEWPORT_PARALLEL:
        at = on_window(s, x, y);
        *direction = vec3_unit(normal_of(&s->window));
        *origin = vec3_along(at, *direction, vec3_dot(vec3_sub(s->window.eye, at), *direction));
        break;
    case RELUME_VIEWPORT_PANORAMA:
        *origin = s->geometry.center;
        *direction = relume_pan_tilt_ray(s->look, s->width, s->height, x, y);
        break;
    case RELUME_VIEWPORT_UNFOLDED:
        *origin = s->geometry.center;
        *direction =
            relume_panorama_ray(&s->geometry, s->width, s->height, (x - p.left) / p.wide * s->width,
                                (y - p.top) / p.high * s->height);
        break;
    }
}

struct relume_vec3 relume_viewport_eye(const struct relume_viewport *s)
{
    const struct relume_window *w = &s->window;
    if (s->kind == RELUME_VIEWPORT_PERSPECTIVE)
        return w->eye;
    if (s->kind != RELUME_VIEWPORT_PARALLEL)
        return s->geometry.center;
    const vec3 middle = vec3_along(w->corner, vec3_add(w->right, w->down), 0.5);
    const double away = 0.5 * vec3_length(w->right) / tan(0.5 * RELUME_SCREEN_DEG * M_PI / 180.0);
    return vec3_sub(middle, vec3_scale(vec3_unit(normal_of(w)), away));
}

// ---------------------------------------------------------------- where points appear

// point - eye = a right + b down + c (corner - eye), or - c normal: it appears at (a, b) / c.
static bool place_in_window(double xy[2], const struct relume_viewport *s, vec3 point)
{
    const struct relume_window *w = &s->window;
    const struct part p = part_of(s);
    const vec3 normal = normal_of(w);
    const bool parallel = s->kind == RELUME_VIEWPORT_PARALLEL;
    const vec3 ahead = parallel ? normal : vec3_sub(w->corner, w->eye);
    const vec3 d = vec3_sub(point, parallel ? w->corner : w->eye);
    const double volume = vec3_dot(normal, ahead);
    const double c = parallel ? 1.0 : vec3_dot(normal, d) / volume;
    if (volume == 0.0 || !(c > 1e-9))
        return false;
    xy[0] = p.left + p.wide * vec3_dot(vec3_cross(w->down, ahead), d) / volume / c;
    xy[1] = p.top + p.high * vec3_dot(vec3_cross(ahead, w->right), d) / volume / c;
    return true;
}

static bool place_in_look(double xy[2], const struct relume_viewport *s, vec3 point)
{
    const struct axes a = axes_of(s->look);
    const vec3 d = vec3_sub(point, s->geometry.center);
    const double length = vec3_length(d), ahead = vec3_dot(d, a.ahead);
    const double depth = s->look.stereographic ? length + ahead : ahead;
    const double scale = 0.5 * s->width * zoom_of(s) / depth;
    if (!(depth > (s->look.stereographic ? 1e-3 : 1e-9) * length))
        return false;
    xy[0] = 0.5 * s->width + scale * vec3_dot(d, a.right);
    xy[1] = 0.5 * s->height - scale * vec3_dot(d, a.up);
    return true;
}

bool relume_viewport_project(double xy[2], const struct relume_viewport *s,
                             struct relume_vec3 point)
{
    const struct part p = part_of(s);
    if (s->kind == RELUME_VIEWPORT_PANORAMA)
        return place_in_look(xy, s, point);
    if (s->kind != RELUME_VIEWPORT_UNFOLDED)
        return place_in_window(xy, s, point);
    if (!relume_panorama_pixel(xy, &s->geometry, s->width, s->height,
                               vec3_sub(point, s->geometry.center)))
        return false;
    xy[0] = p.left + xy[0] / s->width * p.wide;
    xy[1] = p.top + xy[1] / s->height * p.high;
    return true;
}

// ---------------------------------------------------------------- solid angles, shadows

static double window_pixel(const struct relume_viewport *s, double x, double y)
{
    const struct part p = part_of(s);
    const vec3 normal = normal_of(&s->window);
    if (s->kind == RELUME_VIEWPORT_PARALLEL) {  // as the screen's middle
        x = p.left + 0.5 * p.wide;
        y = p.top + 0.5 * p.high;
    }
    const vec3 away = vec3_sub(on_window(s, x, y), relume_viewport_eye(s));
    return fabs(vec3_dot(normal, away)) / pow(vec3_length(away), 3.0) / (p.wide * p.high);
}

double relume_viewport_solid_angle(const struct relume_viewport *s, double x, double y)
{
    const bool round = s->kind == RELUME_VIEWPORT_PANORAMA && s->look.stereographic;
    if (s->kind == RELUME_VIEWPORT_UNFOLDED) {
        const double around = s->geometry.projection == RELUME_CUBE ? 12.0 : 2.0 * M_PI;
        return pow(around / part_of(s).wide, 2.0);
    }
    if (s->kind != RELUME_VIEWPORT_PANORAMA)
        return window_pixel(s, x, y);
    const double pixel = (round ? 4.0 : 2.0) / (zoom_of(s) * s->width);
    const double a = pixel * (x - 0.5 * s->width), b = pixel * (y - 0.5 * s->height);
    const double far = a * a + b * b;
    return pixel * pixel * (round ? pow(1.0 + 0.25 * far, -2.0) : pow(1.0 + far, -1.5));
}

static const double slack = 0.02;

bool relume_viewport_hides(const struct relume_viewport *s, struct relume_vec3 surface,
                           struct relume_vec3 point)
{
    const vec3 eye = relume_viewport_eye(s);
    const double to_surface = vec3_length(vec3_sub(surface, eye));
    const double to_point = vec3_length(vec3_sub(point, eye));
    if (s->kind != RELUME_VIEWPORT_PARALLEL)
        return to_surface < (1.0 - slack) * to_point;
    const vec3 towards = vec3_unit(normal_of(&s->window));
    return vec3_dot(vec3_sub(point, surface), towards) > 0.5 * slack * vec3_length(s->window.right);
}
