// visible_lights.c - lights that stand in the frame, so that they can dazzle
#include <relume/relight/viewport.h>

#include "core/base/memory.h"
#include "core/math/bilinear.h"
#include "relight/frame/renderer.h"
#include "relight/frame/renderer_views.h"
#include "relight/frame/viewport.h"
#include "relight/light/environment.h"

static const double far_away = 1e6;  // of directional lights, in widths of the picture
enum { PATCHES = 8 };                // of an area light, along one side

// ---------------------------------------------------------------- finding

struct finding {
    const struct relume_viewport *viewport;
    vec3 eye;
    bool (*hides)(void *user, const double xy[2], vec3 point);
    void *user;
    struct relume_visible_light *out;
    int n;
};

// A pixel beyond the border still reaches into the frame.
static bool in_frame(const struct relume_viewport *s, const double xy[2])
{
    return xy[0] > -0.5 && xy[1] > -0.5 && xy[0] < s->width + 0.5 && xy[1] < s->height + 0.5;
}

static void add(struct finding *f, vec3 point, const float rgb[3])
{
    double xy[2];
    if (f->n == RELUME_VISIBLE_LIGHTS_MOST || !(rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0) ||
        !relume_viewport_project(xy, f->viewport, point) || !in_frame(f->viewport, xy) ||
        (f->hides && f->hides(f->user, xy, point)))
        return;
    struct relume_visible_light *const s = &f->out[f->n++];
    const double solid = relume_viewport_solid_angle(f->viewport, xy[0], xy[1]);
    *s = (struct relume_visible_light){.x = xy[0], .y = xy[1]};
    for (int c = 0; c < 3; c++)
        s->rgb[c] = (float)fmin(M_PI * (double)rgb[c] / solid, 1e30);
}

static void add_area(struct finding *f, const struct relume_light *light)
{
    struct relume_light_patch patches[PATCHES * PATCHES];
    vec3 towards;
    float rgb[3];
    relume_light_patches(patches, light, PATCHES);
    for (int i = 0; i < PATCHES * PATCHES; i++)
        if (relume_light_patch_at(&towards, rgb, &patches[i], f->eye))
            add(f, patches[i].position, rgb);
}

static void add_distant(struct finding *f, const struct relume_light *light)
{
    const bool window = f->viewport->kind == RELUME_VIEWPORT_PERSPECTIVE;
    const double wide = window ? vec3_length(f->viewport->window.right) : 1.0;
    const vec3 towards = vec3_unit(light->direction);
    if (f->viewport->kind != RELUME_VIEWPORT_PARALLEL)
        add(f, vec3_along(f->eye, towards, far_away * wide), light->rgb);
}

int relume_viewport_lights(struct relume_visible_light *out, const struct relume_viewport *viewport,
                           const struct relume_light *lights, int n,
                           bool (*hides)(void *user, const double xy[2], struct relume_vec3 point),
                           void *user)
{
    struct finding f = {viewport, relume_viewport_eye(viewport), hides, user, out, 0};
    for (int i = 0; i < n; i++) {
        vec3 towards;
        float rgb[3];
        if (lights[i].kind == RELUME_LIGHT_AREA)
            add_area(&f, &lights[i]);
        else if (lights[i].kind == RELUME_LIGHT_DIRECTIONAL)
            add_distant(&f, &lights[i]);
        else if (relume_light_is_near(lights[i].kind) &&
                 relume_light_at(&towards, rgb, &lights[i], f.eye))
            add(&f, lights[i].position, rgb);
    }
    return f.n;
}

// ---------------------------------------------------------------- drawing

void relume_visible_lights_draw(struct relume_image *frame,
                                const struct relume_visible_light *sources, int n)
{
    for (int i = 0; i < n; i++) {
        const double x = sources[i].x - 0.5, y = sources[i].y - 0.5;
        for (int k = 0; k < 4; k++) {
            const double px = floor(x) + k % 2, py = floor(y) + k / 2;
            const double share = (1.0 - fabs(x - px)) * (1.0 - fabs(y - py));
            if (!(px >= 0.0 && px < frame->width && py >= 0.0 && py < frame->height))
                continue;
            float *const to = frame->data + 3 * ((size_t)py * (size_t)frame->width + (size_t)px);
            for (int c = 0; c < 3; c++)
                to[c] += (float)share * sources[i].rgb[c];
        }
    }
}

// ---------------------------------------------------------------- a frame

struct scene {
    const struct relume_viewport *viewport;
    struct relume_image places;
};

static bool hidden(void *user, const double xy[2], vec3 point)
{
    const struct scene *s = user;
    const int x = index_clamped(relume_whole(xy[0]), s->places.width);
    const int y = index_clamped(relume_whole(xy[1]), s->places.height);
    const float *const at = s->places.data + 3 * ((size_t)y * (size_t)s->places.width + (size_t)x);
    const vec3 surface = vec3_of((double)at[0], (double)at[1], (double)at[2]);
    return !isnan(surface.x) && relume_viewport_hides(s->viewport, surface, point);
}

relume_status relume_frame_visible_lights(struct relume_image *frame, int *seen,
                                          relume_renderer *renderer,
                                          const struct relume_camera *camera)
{
    relume_renderer *r = renderer;
    const struct relume_frame_params params = r->params;
    struct relume_frame_params sharp = params;
    struct relume_camera sized = *camera;
    struct relume_viewport viewport;
    struct scene scene = {.viewport = &viewport};
    struct relume_visible_light *sources = NULL;
    sharp.aperture = sharp.focus = 0.0;
    sized.width = frame->width;
    sized.height = frame->height;
    relume_status status =
        relume_frame_viewport(&viewport, r->pack, camera, frame->width, frame->height);
    r->params = sharp;
    if (!status && r->info->has_depth)
        status = relume_renderer_places(&scene.places, r, &sized);
    r->params = params;
    if (!status && !(sources = mem_array(RELUME_VISIBLE_LIGHTS_MOST, sizeof *sources)))
        status = RELUME_ENOMEM;
    const int count = status ? 0
                             : relume_viewport_lights(sources, &viewport, r->lights, r->light_count,
                                                      scene.places.data ? hidden : NULL, &scene);
    relume_visible_lights_draw(frame, sources, count);
    if (seen)
        *seen = count;
    mem_free(sources);
    relume_image_destroy(&scene.places);
    return status;
}
