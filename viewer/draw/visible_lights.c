// visible_lights.c - the lights that are in view of the app's frame (viewport.h)
#include "draw/visible_lights.h"

#include "app/sight.h"
#include "common/vec.h"
#include "relight/frame/viewport.h"
#include "relight/view/slab_set.h"

void hiding_scene_forget(struct hiding_scene *s)
{
    relume_image_destroy(&s->surface);
    s->known = false;
}

// ---------------------------------------------------------------- the frame

static int nearest_view(const struct frame_request *q, const struct hiding_scene *s)
{
    int best = q->camera.framing == RELUME_FRAME_VIEW ? q->camera.view : 0;
    const struct relume_vec3 eye = q->camera.eye;
    double least = INFINITY;
    for (int i = 0; q->camera.framing == RELUME_FRAME_EYE && i < s->views; i++) {
        const double far = hypot(s->uv[i][0] - eye.x, s->uv[i][1] - eye.y);
        if (far < least) {
            least = far;
            best = i;
        }
    }
    return best;
}

static struct relume_vec3 camera_of(const struct frame_request *q, const struct hiding_scene *s,
                                    int view)
{
    const bool slab = s && q->file->geometry.projection == RELUME_SLAB;
    return slab ? (struct relume_vec3){s->uv[view][0], s->uv[view][1], q->file->geometry.uv_z}
                : (struct relume_vec3){0};
}

static bool viewport_of(struct relume_viewport *out, const struct frame_request *q,
                        const struct hiding_scene *s)
{
    const bool free = q->camera.framing == RELUME_FRAME_EYE;
    return sight_of_frame(out, q, free ? q->camera.eye : camera_of(q, s, q->camera.view));
}

// ---------------------------------------------------------------- what hides it

// The view that best knows what lies on the way to `p`, and the place in [0, 1] where it shows it.
static bool find_view(int *view, double at[2], const struct frame_request *q,
                      const struct hiding_scene *s, struct relume_vec3 eye, struct relume_vec3 p)
{
    const struct app_file *f = q->file;
    if (q->has_window)
        return relume_slab_set_nearest(view, at, f->around, eye, vec3_sub(p, eye));
    *view = nearest_view(q, s);
    const struct relume_viewport picture = sight_of_picture(f, camera_of(q, s, *view));
    if (!relume_viewport_project(at, &picture, p))
        return false;
    at[0] /= f->width;
    at[1] /= f->height;
    return true;
}

static bool need_surface(struct hiding_scene *s, int view)
{
    if (s->known && s->view == view)
        return s->surface.data != NULL;
    hiding_scene_forget(s);
    s->known = true;
    s->view = view;
    return s->source.surface && !s->source.surface(&s->surface, s->source.user, view);
}

const struct relume_image *visible_places(struct hiding_scene *scene, int view)
{
    return need_surface(scene, view) ? &scene->surface : NULL;
}

struct looking {
    const struct frame_request *request;
    struct hiding_scene *scene;
    struct relume_viewport viewport;
};

// What the view shows where it sees the point `p`; false where that is not known.
static bool surface_near(struct relume_vec3 *out, const struct looking *l, struct relume_vec3 p)
{
    const struct relume_image *image = &l->scene->surface;
    double at[2];
    int view;
    if (!find_view(&view, at, l->request, l->scene, relume_viewport_eye(&l->viewport), p) ||
        !need_surface(l->scene, view))
        return false;
    const double x = floor(at[0] * image->width), y = floor(at[1] * image->height);
    if (!(x >= 0 && y >= 0 && x < image->width && y < image->height))
        return false;
    const float *q = image->data + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
    *out = (struct relume_vec3){(double)q[0], (double)q[1], (double)q[2]};
    return isfinite(out->x) && isfinite(out->y) && isfinite(out->z);
}

static bool hidden(void *user, const double xy[2], struct relume_vec3 p)
{
    const struct looking *l = user;
    struct relume_vec3 surface;
    (void)xy;
    return surface_near(&surface, l, p) && relume_viewport_hides(&l->viewport, surface, p);
}

int visible_lights(struct relume_visible_light *out, const struct frame_request *q,
                   const struct relume_light *lights, int n, struct hiding_scene *scene)
{
    struct looking l = {.request = q, .scene = scene};
    if (!viewport_of(&l.viewport, q, scene))
        return 0;
    return relume_viewport_lights(out, &l.viewport, lights, n, scene ? hidden : NULL, &l);
}

// A view beside the eye sees another place of the surface; its depth is a better guess, and so on.
bool visible_surface(struct relume_vec3 *out, const struct frame_request *q,
                     struct hiding_scene *scene, double x, double y)
{
    enum { ROUNDS = 8 };
    struct looking l = {.request = q, .scene = scene};
    struct relume_vec3 from, ray;
    if (!viewport_of(&l.viewport, q, scene))
        return false;
    relume_viewport_ray(&from, &ray, &l.viewport, x, y);
    double t = vec3_dot(vec3_sub(q->middle, from), ray);
    for (int i = 0; i < ROUNDS; i++) {
        const struct relume_vec3 p = {from.x + t * ray.x, from.y + t * ray.y, from.z + t * ray.z};
        if (!surface_near(out, &l, p))
            return false;
        t = vec3_dot(vec3_sub(*out, from), ray);
        if (!(t > 0))
            return false;
    }
    *out = (struct relume_vec3){from.x + t * ray.x, from.y + t * ray.y, from.z + t * ray.z};
    return true;
}
