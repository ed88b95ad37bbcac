#include "lamps_seen.h"

#include "gizmo.h"
#include "glare_view.h"
#include "orbit.h"
#include "vec.h"

#include <math.h>

#define PI 3.14159265358979323846

static const double slack = 0.02;  // of a distance, that a surface may lie before what it shows
static const double far_away = 1e6;
enum { FACETS = 8 };  // of an area light, along one side

void lamp_scene_forget(struct lamp_scene *s)
{
    relume_image_destroy(&s->surface);
    s->known = false;
}

// ---------------------------------------------------------------- the eye

static double length_of(struct relume_vec3 v)
{
    return sqrt(vec_dot(v, v));
}

static bool orthographic(const struct app *app)
{
    const struct relume_geometry *g = &app->file.geometry;
    return g->projection == RELUME_PLANAR && !g->perspective;
}

// Where the frame is seen from; orthographic pictures as far off as a screen of their size.
static struct relume_vec3 eye_of(const struct app *app)
{
    const struct relume_geometry *g = &app->file.geometry;
    if (app_pole_y(app) && !app->file.around)
        return app_middle(app);
    if (app->now.camera.framing == RELUME_FRAME_EYE)
        return app->now.camera.eye;
    struct relume_vec3 eye = {0, 0, g->projection == RELUME_SLAB ? g->uv_z : g->camera_z};
    if (orthographic(app)) {
        eye = app_middle(app);
        eye.z = app_reach(app) / tan(0.5 * GLARE_SCREEN_DEG * PI / 180);
    }
    return eye;
}

static bool place_in_planet(double xy[2], const struct app *app, struct relume_vec3 d)
{
    const struct app_axes a = app_frame_axes(app);
    const double ahead = -vec_dot(d, a.back) / length_of(d);
    const double scale = 0.5 * app->width * app->now.camera.look.zoom / (1 + ahead) / length_of(d);
    xy[0] = 0.5 * app->width + scale * vec_dot(d, a.right);
    xy[1] = 0.5 * app->height - scale * vec_dot(d, a.up);
    return 1 + ahead > 1e-3;
}

static bool place(double xy[2], const struct app *app, struct relume_vec3 p)
{
    const bool planet =
        app->now.camera.framing == RELUME_FRAME_LOOK && app->now.camera.look.stereographic;
    const bool in_view =
        planet ? place_in_planet(xy, app, vec_sub(p, app_middle(app))) : gizmo_place(xy, app, p);
    // A pixel beyond the border still reaches into the frame.
    return in_view && xy[0] > -0.5 && xy[1] > -0.5 && xy[0] < app->width + 0.5 &&
           xy[1] < app->height + 0.5;
}

// ---------------------------------------------------------------- what hides it

static int nearest_view(const struct app *app, const struct lamp_scene *s)
{
    int best = app->now.camera.framing == RELUME_FRAME_VIEW ? app->now.camera.view : 0;
    const struct relume_vec3 eye = app->now.camera.eye;
    double least = INFINITY;
    for (int i = 0; app->now.camera.framing == RELUME_FRAME_EYE && i < s->views; i++) {
        const double far = hypot(s->uv[i][0] - eye.x, s->uv[i][1] - eye.y);
        if (far < least) {
            least = far;
            best = i;
        }
    }
    return best;
}

// Where a camera of the slab shows a point, in [0, 1].
static bool place_in_slab(double at[2], const struct relume_geometry *g, const double uv[2],
                          struct relume_vec3 p)
{
    const double ahead = (g->st_z - g->uv_z) / (p.z - g->uv_z);
    const double s = uv[0] + (p.x - uv[0]) * ahead, t = uv[1] + (p.y - uv[1]) * ahead;
    at[0] = (s - g->st_min[0]) / (g->st_max[0] - g->st_min[0]);
    at[1] = (g->st_max[1] - t) / (g->st_max[1] - g->st_min[1]);
    return ahead > 0;
}

static bool place_in_picture(double at[2], const struct app *app, struct relume_vec3 p)
{
    const struct app_rectangle r = app_picture(app);
    if (!gizmo_place(at, app, p))
        return false;
    at[0] = (at[0] - r.left) / (r.right - r.left);
    at[1] = (at[1] - r.top) / (r.bottom - r.top);
    return true;
}

// The view that best knows what lies on the way to `p`, and the place in [0, 1] where it shows it.
static bool find_view(int *view, double at[2], const struct app *app, const struct lamp_scene *s,
                      struct relume_vec3 eye, struct relume_vec3 p)
{
    const struct app_file *f = &app->file;
    if (orbit_is(app))
        return relume_slabs_nearest(view, at, f->around, eye, vec_sub(p, eye));
    *view = nearest_view(app, s);
    if (f->geometry.projection == RELUME_SLAB)
        return !f->around && place_in_slab(at, &f->geometry, s->uv[*view], p);
    if (f->geometry.projection == RELUME_PLANAR)
        return place_in_picture(at, app, p);
    if (!relume_panorama_pixel(at, &f->geometry, f->width, f->height, vec_sub(p, eye)))
        return false;
    at[0] /= f->width;
    at[1] /= f->height;
    return true;
}

static bool need_surface(struct lamp_scene *s, int view)
{
    if (s->known && s->view == view)
        return s->surface.data != NULL;
    lamp_scene_forget(s);
    s->known = true;
    s->view = view;
    return s->source.surface && !s->source.surface(&s->surface, s->source.user, view);
}

static bool hidden(const struct app *app, struct lamp_scene *s, struct relume_vec3 eye,
                   struct relume_vec3 p)
{
    double at[2];
    int view;
    if (!s || !find_view(&view, at, app, s, eye, p) || !need_surface(s, view))
        return false;
    const struct relume_image *image = &s->surface;
    const double x = floor(at[0] * image->width), y = floor(at[1] * image->height);
    if (!(x >= 0 && y >= 0 && x < image->width && y < image->height))
        return false;
    const float *q = image->data + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
    const struct relume_vec3 surface = {(double)q[0], (double)q[1], (double)q[2]};
    if (orthographic(app))
        return surface.z > p.z + slack * app_reach(app);
    return length_of(vec_sub(surface, eye)) < (1 - slack) * length_of(vec_sub(p, eye));
}

// ---------------------------------------------------------------- lights

// The solid angle of a pixel at a place, as a part of that of the middle.
static double pixel_part(const struct app *app, const double xy[2], double pixel)
{
    const enum relume_framing framing = app->now.camera.framing;
    const bool flat = app->file.geometry.projection == RELUME_PLANAR && !orthographic(app);
    const double a = pixel * (xy[0] - 0.5 * app->width), b = pixel * (xy[1] - 0.5 * app->height);
    if (framing == RELUME_FRAME_LOOK && app->now.camera.look.stereographic)
        return pow(1 + 0.25 * (a * a + b * b), -2);
    return framing == RELUME_FRAME_VIEW && !flat ? 1 : pow(1 + a * a + b * b, -1.5);
}

struct finding {
    const struct app *app;
    struct lamp_scene *scene;
    struct relume_vec3 eye;
    double pixel;  // radians, in the middle
    struct lamp_seen *out;
    int n;
};

static void add(struct finding *f, struct relume_vec3 p, const float rgb[3])
{
    double xy[2];
    if (f->n == LAMPS_SEEN_MOST || !(rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0) ||
        !place(xy, f->app, p) || hidden(f->app, f->scene, f->eye, p))
        return;
    struct lamp_seen *s = &f->out[f->n++];
    *s = (struct lamp_seen){.x = xy[0], .y = xy[1]};
    const double solid = f->pixel * f->pixel * pixel_part(f->app, xy, f->pixel);
    for (int c = 0; c < 3; c++)
        s->rgb[c] = (float)fmin(PI * (double)rgb[c] / solid, 1e30);
}

static void add_area(struct finding *f, const struct relume_light *light)
{
    struct relume_facet facets[FACETS * FACETS];
    struct relume_vec3 towards;
    float rgb[3];
    relume_light_facets(facets, light, FACETS);
    for (int i = 0; i < FACETS * FACETS; i++)
        if (relume_facet_at(&towards, rgb, &facets[i], f->eye))
            add(f, facets[i].position, rgb);
}

// As far as the eye can see.
static void add_distant(struct finding *f, const struct relume_light *light)
{
    const double reach = far_away * app_reach(f->app) / length_of(light->direction);
    add(f,
        (struct relume_vec3){f->eye.x + reach * light->direction.x,
                             f->eye.y + reach * light->direction.y,
                             f->eye.z + reach * light->direction.z},
        light->rgb);
}

int lamps_seen(struct lamp_seen *out, const struct app *app, const struct relume_light *lights,
               int n, struct lamp_scene *scene)
{
    const double pixel = relume_glare_pixel(glare_fov_deg(app), app->width);
    struct finding f = {app, scene, eye_of(app), pixel, out, 0};
    for (int i = 0; i < n; i++) {
        struct relume_vec3 towards;
        float rgb[3];
        if (lights[i].kind == RELUME_LIGHT_AREA)
            add_area(&f, &lights[i]);
        else if (lights[i].kind == RELUME_LIGHT_DIRECTIONAL && !orthographic(app))
            add_distant(&f, &lights[i]);
        else if (relume_light_is_near(lights[i].kind) &&
                 relume_light_at(&towards, rgb, &lights[i], f.eye))
            add(&f, lights[i].position, rgb);
    }
    return f.n;
}
