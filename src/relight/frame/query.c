// query.c - single rays: the plenoptic-illumination function (Wong 1998, 6.4)
//
// Of a few rays only the texels that they hit are relit; of many, whole views. Either is kept for
// the rays that follow.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "relight/frame/renderer.h"
#include "relight/frame/renderer_views.h"
#include "relight/view/slab_set.h"
#include "relight/view/view.h"

#include <relume/relight/viewport.h>

// Relighting two texels costs about as much as a thousand of many.
enum { FEW = 64 };

struct rays {
    relume_renderer *r;
    bool few;
    bool by_depth;
    const char *none;  // why the file does not hold a ray
};

static relume_status need(struct rays *q, int view)
{
    relume_renderer *r = q->r;
    const relume_status status = (q->few ? renderer_need_partly : renderer_need)(r, view);
    return !status && q->by_depth ? renderer_need_disparity(r, view) : status;
}

// Of an image that may be there partly.
static void sample(const struct rays *q, int view, const double xy[2], float rgb[3])
{
    const struct relume_image *image = &q->r->image[SHOWN_LIGHT][view];
    if (q->r->view.need)
        renderer_texels(q->r, view, relume_whole(floor(xy[0] - 0.5)),
                        relume_whole(floor(xy[1] - 0.5)));
    ray_sample(rgb, image, xy[0], xy[1]);
}

static const struct relume_image *images(const struct rays *q)
{
    return q->r->image[SHOWN_LIGHT];
}

// ---------------------------------------------------------------- one ray

static relume_status none(struct rays *q, const char *why)
{
    q->none = why;
    return RELUME_OK;
}

static relume_status planar(struct rays *q, const struct relume_ray *ray, float rgb[3])
{
    const struct relume_pack_info *info = q->r->info;
    const struct relume_geometry *g = &info->geometry;
    double at[2], xy[2];
    if (!ray_goes_towards(ray->eye, ray->direction, 0.0) ||
        !ray_crosses_plane(ray->eye, ray->direction, 0.0, at) ||
        !ray_window_pixel(g->window_min, g->window_max, info->width, info->height, at, xy))
        return none(q, "it misses the window");
    const relume_status status = need(q, 0);
    if (!status)
        sample(q, 0, xy, rgb);
    return status;
}

static relume_status panorama(struct rays *q, const struct relume_ray *ray, float rgb[3])
{
    const struct relume_geometry *g = &q->r->info->geometry;
    // files keep the centre in single precision
    if (vec3_length(vec3_sub(ray->eye, g->center)) > 1e-6 * (1.0 + vec3_length(g->center)))
        return none(q, "a panorama has one eye, its centre");
    const relume_status status = need(q, 0);
    if (!status &&
        !relume_panorama_sample(rgb, g, &images(q)[0], vec3_unit(ray->direction), &q->r->view))
        return none(q, "it misses the panorama");
    return status;
}

static relume_status blend(struct rays *q, const int *view, const double *weight, int count,
                           const double xy[2], float rgb[3])
{
    for (int i = 0; i < count; i++) {
        float value[3];
        sample(q, view[i], xy, value);
        for (int c = 0; c < 3; c++)
            rgb[c] += (float)weight[i] * value[c];
    }
    return RELUME_OK;
}

static struct relume_view_params view_params(const struct rays *q)
{
    struct relume_view_params params = q->r->view;
    params.disparity = q->by_depth ? q->r->disparity : NULL;
    params.range = q->by_depth ? (const double(*)[2])q->r->range : NULL;
    return params;
}

static relume_status one_slab(struct rays *q, const struct relume_ray *ray, float rgb[3])
{
    const struct relume_pack_info *info = q->r->info;
    const struct relume_geometry *g = &info->geometry;
    const struct relume_view_params params = view_params(q);
    const vec3 eye = ray->eye, direction = ray->direction;
    double st[2], uv[2], xy[2], weight[4];
    int view[4];
    relume_status status = RELUME_OK;
    if ((eye.z - g->st_z) * (g->uv_z - g->st_z) <= 0.0 ||
        !ray_goes_towards(eye, direction, g->st_z) ||
        !ray_crosses_plane(eye, direction, g->st_z, st) ||
        !ray_crosses_plane(eye, direction, g->uv_z, uv) ||
        !ray_window_pixel(g->st_min, g->st_max, info->width, info->height, st, xy))
        return none(q, "it misses the window");
    const int count = relume_slab_blend(view, weight, q->r->slab, uv, &q->r->view);
    if (count == 0)
        return none(q, "it misses the camera grid");
    for (int i = 0; !status && i < count; i++)
        status = need(q, view[i]);
    if (status)
        return status;
    return count > 1 && q->by_depth
               ? relume_slab_value(rgb, q->r->slab, eye, st, images(q), &params)
               : blend(q, view, weight, count, xy, rgb);
}

static relume_status several_slabs(struct rays *q, const struct relume_ray *ray, float rgb[3])
{
    const struct relume_window window = {.eye = ray->eye,
                                         .corner = vec3_add(ray->eye, ray->direction)};
    const struct relume_view_params params = view_params(q);
    if (relume_slab_set_needs(q->r->needed, q->r->slabs, &window, 1, &params) == 0)
        return none(q, "it misses the camera grids or the windows");
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < q->r->info->views; i++)
        if (q->r->needed[i])
            status = need(q, i);
    if (!status)
        status =
            relume_slab_set_value(rgb, q->r->slabs, ray->eye, ray->direction, images(q), &params);
    return status == RELUME_EINVAL ? none(q, "it misses the camera grids or the windows") : status;
}

static relume_status one_ray(struct rays *q, const struct relume_ray *ray, float rgb[3])
{
    q->none = NULL;
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (!(vec3_length(ray->direction) > 0.0) || !isfinite(vec3_length(ray->direction)))
        return log_fail(q->r->params.log, RELUME_EINVAL,
                        "direction: expected three numbers, not all 0");
    switch (q->r->info->geometry.projection) {
    case RELUME_PLANAR: return planar(q, ray, rgb);
    case RELUME_SLAB: return q->r->slabs ? several_slabs(q, ray, rgb) : one_slab(q, ray, rgb);
    case RELUME_CYLINDRICAL:
    case RELUME_SPHERICAL:
    case RELUME_CUBE: break;
    }
    return panorama(q, ray, rgb);
}

// ---------------------------------------------------------------- all rays

static relume_status begin(struct rays *q, relume_renderer *r, int n)
{
    const bool slab = r->info->geometry.projection == RELUME_SLAB;
    renderer_begin(r, SHOWN_LIGHT);
    *q = (struct rays){.r = r, .few = n <= FEW, .by_depth = slab && renderer_takes_depth(r)};
    r->texels = RELUME_OK;
    if (q->few) {
        r->view.need = renderer_texels;
        r->view.user = r;
    }
    const relume_status status = renderer_check_depth(r);
    if (status || !slab)
        return status;
    return r->info->slabs ? renderer_need_slabs(r) : renderer_need_slab(r);
}

relume_status relume_renderer_rays(float (*rgb)[3], relume_renderer *r,
                                   const struct relume_ray *rays, int n)
{
    struct rays q;
    relume_status status = begin(&q, r, n);
    for (int i = 0; !status && i < n; i++) {
        status = one_ray(&q, &rays[i], rgb[i]);
        if (!status)
            status = r->texels;
        if (!status && q.none && n == 1)
            status =
                log_fail(r->params.log, RELUME_EUNFIT, "this ray is not in the file; %s", q.none);
        else if (!status && q.none)
            rgb[i][0] = rgb[i][1] = rgb[i][2] = NAN;
        if (!status && i % 4096 == 4095 && !log_progress(r->params.log, "looking", (double)i / n))
            status = RELUME_ECANCEL;
    }
    return status;
}

relume_status relume_renderer_pixel(float rgb[3], relume_renderer *r,
                                    const struct relume_camera *camera, double x, double y)
{
    int frame[2];
    struct relume_viewport viewport;
    struct relume_ray ray;
    (void)relume_camera_rect(frame, r->info, camera);
    const relume_status status =
        relume_frame_viewport(&viewport, r->pack, camera, frame[0], frame[1]);
    if (status)
        return status;
    relume_viewport_ray(&ray.eye, &ray.direction, &viewport, x, y);
    return relume_renderer_rays((float(*)[3])rgb, r, &ray, 1);
}

relume_status relume_query_rays(float (*rgb)[3], relume_pack *pack, const struct relume_ray *rays,
                                int n, const struct relume_light *lights, int light_count,
                                const struct relume_frame_params *params)
{
    relume_renderer *r;
    relume_status status = relume_renderer_create(&r, pack, params);
    if (!status)
        status = relume_renderer_set_lights(r, lights, light_count);
    if (!status)
        status = relume_renderer_rays(rgb, r, rays, n);
    relume_renderer_destroy(&r);
    return status;
}

relume_status relume_query(float rgb[3], relume_pack *pack, struct relume_vec3 eye,
                           struct relume_vec3 direction, const struct relume_light *lights, int n,
                           const struct relume_frame_params *params)
{
    const struct relume_ray ray = {eye, direction};
    return relume_query_rays((float(*)[3])rgb, pack, &ray, 1, lights, n, params);
}
