// surface_draw.c - pictures of a surface that lies on z = 0
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "material/model/environment.h"
#include "material/surface/surface.h"
#include "material/surface/texels.h"
#include "relight/light/environment.h"

static const double TO_RADIANS = M_PI / 180.0;

struct lens {
    vec3 forward, right, up;  // the last two: half the picture at distance 1
};

struct drawing {
    struct relume_image *image;
    const relume_btf_surface *surface;
    const struct relume_btf_camera *camera;
    struct lens lens;
    const struct relume_light *lights;
    relume_btf_oriented_light **ambient;  // of each light, NULL: no environment
    relume_prefiltered_maps **prefiltered;
    int count;
    double unit;           // texels of a world unit
    double width, height;  // of the surface, texels
    int first_row;
};

// ---------------------------------------------------------------- where pixels look

static struct lens make_lens(const struct relume_btf_camera *camera, int width, int height)
{
    struct lens l = {.forward = vec3_unit(vec3_sub(camera->at, camera->eye))};
    const vec3 above = fabs(l.forward.y) < 0.999999 ? vec3_of(0.0, 1.0, 0.0) : vec3_of(0, 0, 1);
    const double half = tan(0.5 * camera->fov_deg * TO_RADIANS);
    const vec3 right = vec3_unit(vec3_cross(l.forward, above));
    l.right = vec3_scale(right, half);
    l.up = vec3_scale(vec3_cross(right, l.forward), half * height / width);
    return l;
}

// Where the ray through a place of the picture hits the surface, in texels; false above the
// horizon.
static bool hit(const struct drawing *d, double px, double py, double out[2])
{
    if (!d->camera->perspective) {
        out[0] = px / d->image->width * d->width;
        out[1] = py / d->image->height * d->height;
        return true;
    }
    const double a = 2.0 * px / d->image->width - 1.0, b = 1.0 - 2.0 * py / d->image->height;
    const vec3 ray =
        vec3_add(d->lens.forward, vec3_along(vec3_scale(d->lens.right, a), d->lens.up, b));
    const vec3 eye = d->camera->eye;
    if (!(ray.z < -1e-6))
        return false;
    const double t = -eye.z / ray.z;
    out[0] = 0.5 * d->width + d->unit * (eye.x + t * ray.x);
    out[1] = 0.5 * d->height - d->unit * (eye.y + t * ray.y);
    return true;
}

static vec3 point_of(const struct drawing *d, const double at[2])
{
    return vec3_of((at[0] - 0.5 * d->width) / d->unit, (0.5 * d->height - at[1]) / d->unit, 0.0);
}

// The pixel's footprint; false when it is not on the surface, whole.
static bool footprint(const struct drawing *d, int x, int y, struct relume_btf_footprint *out)
{
    double middle[2], left[2], right[2], above[2], below[2];
    if (!hit(d, x + 0.5, y + 0.5, middle) || !hit(d, x, y + 0.5, left) ||
        !hit(d, x + 1.0, y + 0.5, right) || !hit(d, x + 0.5, y, above) ||
        !hit(d, x + 0.5, y + 1.0, below))
        return false;
    *out = (struct relume_btf_footprint){.x = middle[0],
                                         .y = middle[1],
                                         .right = {right[0] - left[0], right[1] - left[1]},
                                         .down = {below[0] - above[0], below[1] - above[1]}};
    return true;
}

// ---------------------------------------------------------------- light

static void draw_pixel(const struct drawing *d, int x, int y, float *to)
{
    struct relume_btf_footprint f;
    to[0] = to[1] = to[2] = 0.0f;
    if (!footprint(d, x, y, &f))
        return;
    const vec3 point = point_of(d, (double[2]){f.x, f.y});
    struct relume_btf_ray ray = {
        .view =
            vec3_unit(d->camera->perspective ? vec3_sub(d->camera->eye, point) : d->camera->eye)};
    for (int i = 0; i < d->count; i++) {
        const struct relume_light *light = &d->lights[i];
        float sent[3] = {light->rgb[0], light->rgb[1], light->rgb[2]}, value[3];
        ray.ambient = d->ambient[i];
        if (ray.ambient)  // has the colour of the light
            sent[0] = sent[1] = sent[2] = 1.0f;
        else if (light->kind == RELUME_LIGHT_DIRECTIONAL)
            ray.light = vec3_unit(light->direction);
        else if (!relume_light_at(&ray.light, sent, light, point))
            continue;
        relume_btf_surface_filter(d->surface, &f, &ray, value);
        for (int c = 0; c < 3; c++)
            to[c] += sent[c] * value[c];
    }
}

static void draw_row(void *context, size_t item, int worker)
{
    (void)worker;
    const struct drawing *d = context;
    const int y = d->first_row + (int)item;
    float *to = d->image->data + 3 * (size_t)y * (size_t)d->image->width;
    for (int x = 0; x < d->image->width; x++, to += 3)
        draw_pixel(d, x, y, to);
}

static relume_status draw_rows(struct drawing *d, const struct relume_btf_draw_params *p)
{
    enum { AT_ONCE = 32 };
    const int height = d->image->height;
    for (; d->first_row < height; d->first_row += AT_ONCE) {
        const int left = height - d->first_row;
        thread_for(p->threads, (size_t)(left < AT_ONCE ? left : AT_ONCE), draw_row, d);
        if (!log_progress(p->log, "drawing", fmin((d->first_row + AT_ONCE) / (double)height, 1.0)))
            return RELUME_ECANCEL;
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- what can be drawn

static bool is_finite(vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static relume_status check_camera(const struct relume_btf_camera *c, const struct relume_log *log)
{
    if (!is_finite(c->eye) || !(c->eye.z > 0.0))
        return log_fail(log, RELUME_EINVAL, "camera: expected an eye with z > 0; found %g, %g, %g",
                        c->eye.x, c->eye.y, c->eye.z);
    if (!c->perspective)
        return RELUME_OK;
    if (!is_finite(c->at) || !(vec3_length(vec3_sub(c->at, c->eye)) > 1e-9))
        return log_fail(log, RELUME_EINVAL, "camera: expected a point to look at, not the eye");
    if (!(c->fov_deg > 0.0 && c->fov_deg < 180.0))
        return log_fail(log, RELUME_EINVAL,
                        "camera: expected a field of view above 0, below 180; found %g",
                        c->fov_deg);
    return RELUME_OK;
}

static relume_status check_lights(const struct relume_light *lights, int count,
                                  const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < count && !status; i++) {
        status = relume_light_check(&lights[i], "light", log);
        if (!status && lights[i].kind == RELUME_LIGHT_AREA)
            status = log_fail(log, RELUME_EINVAL, "light: area lights are not drawn on materials");
    }
    return status;
}

// ---------------------------------------------------------------- environments

static relume_status make_ambient(struct drawing *d, int i, const struct relume_btf_draw_params *p)
{
    // the surface lies in the world as in its own frame
    const struct relume_btf_frame frame = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    const relume_btf_fitted *model = d->surface->level[0].model;
    const relume_status status = relume_prefiltered_maps_create(
        &d->prefiltered[i], &d->lights[i],
        relume_prefiltered_maps_params(.log = p->log, .rim = relume_btf_fitted_info(model)->rim,
                                       .threads = p->threads));
    return status ? status
                  : relume_btf_oriented_light_create(
                        &d->ambient[i], model, d->prefiltered[i], &frame,
                        relume_btf_oriented_light_params(.own_maps = true, .threads = p->threads));
}

static relume_status make_ambients(struct drawing *d, const struct relume_btf_draw_params *p)
{
    d->ambient = mem_zeroed((size_t)d->count, sizeof *d->ambient);
    d->prefiltered = mem_zeroed((size_t)d->count, sizeof *d->prefiltered);
    relume_status status = d->ambient && d->prefiltered ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; i < d->count && !status; i++)
        if (d->lights[i].kind == RELUME_LIGHT_ENVIRONMENT)
            status = make_ambient(d, i, p);
    return status;
}

static void free_ambients(struct drawing *d)
{
    for (int i = 0; i < d->count && d->ambient && d->prefiltered; i++) {
        relume_btf_oriented_light_destroy(&d->ambient[i]);
        relume_prefiltered_maps_destroy(&d->prefiltered[i]);
    }
    mem_free(d->ambient);
    mem_free(d->prefiltered);
}

relume_status relume_btf_draw(struct relume_image *image, const relume_btf_surface *surface,
                              const struct relume_btf_camera *camera,
                              const struct relume_light *lights, int count,
                              const struct relume_btf_draw_params *params)
{
    const struct relume_btf_draw_params p = PARAMS_WORK(relume_btf_draw_params, params);
    const struct relume_btf_surface_info *info = relume_btf_surface_info(surface);
    if (!image->data || image->channels != 3)
        return log_fail(p.log, RELUME_EINVAL, "picture: expected three channels");
    relume_status status = check_camera(camera, p.log);
    if (!status)
        status = check_lights(lights, count, p.log);
    if (status)
        return status;
    struct drawing d = {.image = image,
                        .surface = surface,
                        .camera = camera,
                        .lights = lights,
                        .count = count,
                        .unit = 0.5 * info->width,
                        .width = info->width,
                        .height = info->height};
    if (camera->perspective)
        d.lens = make_lens(camera, image->width, image->height);
    status = make_ambients(&d, &p);
    if (!status)
        status = draw_rows(&d, &p);
    free_ambients(&d);
    return status;
}
