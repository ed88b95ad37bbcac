#include <relume/frame.h>

#include "base/log.h"
#include "base/memory.h"
#include "math/vec.h"

struct renderer {
    relume_pack *pack;
    const struct relume_pack_info *info;
    const struct relume_light *lights;
    int light_count;
    struct relume_frame_params params;
    struct relume_view_params view;
    struct shared *shared;
};

// What all views of a frame use.
struct shared {
    relume_weight_grid *grid;
};

static struct renderer renderer_of(relume_pack *pack, const struct relume_light *lights, int n,
                                   const struct relume_frame_params *params, struct shared *shared)
{
    const struct relume_frame_params p = params ? *params : (struct relume_frame_params){0};
    return (struct renderer){
        .pack = pack,
        .info = relume_pack_info(pack),
        .lights = lights,
        .light_count = n,
        .params = p,
        .shared = shared,
        .view = {.threads = p.threads, .constant = p.constant},
    };
}

static const struct relume_light *find_near(const struct renderer *r)
{
    for (int i = 0; i < r->light_count; i++)
        if (relume_light_is_near(r->lights[i].kind))
            return &r->lights[i];
    return NULL;
}

static bool has_environment(const struct renderer *r)
{
    for (int i = 0; i < r->light_count; i++)
        if (r->lights[i].kind == RELUME_LIGHT_ENVIRONMENT)
            return true;
    return false;
}

static relume_status assume_depth(const struct renderer *r, struct relume_image *depth)
{
    const size_t n = (size_t)r->info->width * (size_t)r->info->height;
    const relume_status status = relume_image_create(depth, r->info->width, r->info->height, 1);
    for (size_t i = 0; !status && i < n; i++)
        depth->data[i] = (float)r->params.assume_depth;
    return status;
}

static relume_status find_surface(const struct renderer *r, int view, struct relume_image *out)
{
    struct relume_image depth;
    relume_status status = relume_pack_depth(&depth, r->pack, view);
    if (!status && !depth.data && r->params.assume_depth > 0.0)
        status = assume_depth(r, &depth);
    if (status)
        return status;
    status = relume_surface(out, &r->info->geometry, r->info->uv[view], depth.data ? &depth : NULL,
                            r->info->width, r->info->height);
    if (status == RELUME_EINVAL)
        status = log_fail(r->params.log, RELUME_EDATA,
                          "a near light (%s) needs to know where the surface is; expected a file "
                          "with depth, or a depth to assume",
                          relume_light_kind_name(find_near(r)->kind));
    relume_image_destroy(&depth);
    return status;
}

// All views of a file have one coder.
static relume_status find_grid(const struct renderer *r, const struct relume_codes *codes,
                               const relume_weight_grid **grid)
{
    const bool folded = codes->domain != RELUME_DOMAIN_DISPLAY && has_environment(r);
    relume_status status = RELUME_OK;
    *grid = r->params.grid;
    if (*grid || !(find_near(r) || folded))
        return RELUME_OK;
    if (!r->shared->grid)
        status = relume_weight_grid_create(&r->shared->grid, codes->coder,
                                           relume_weight_grid_params(.threads = r->params.threads));
    *grid = r->shared->grid;
    return status;
}

static relume_status relight_view(const struct renderer *r, int view, struct relume_image *out)
{
    const struct relume_codes *codes;
    const relume_weight_grid *grid = NULL;
    struct relume_image surface = {0};
    relume_status status = relume_pack_codes(&codes, r->pack, view);
    if (!status && find_near(r))
        status = find_surface(r, view, &surface);
    if (!status)
        status = find_grid(r, codes, &grid);
    if (!status)
        status = relume_relight(
            out, codes, r->lights, r->light_count,
            relume_relight_params(.log = r->params.log, .cpu_off = r->params.cpu_off,
                                  .threads = r->params.threads, .surface = &surface, .grid = grid));
    relume_image_destroy(&surface);
    if (!status && !log_progress(r->params.log, "relighting", 1.0))
        return RELUME_ECANCEL;
    return status;
}

// ---------------------------------------------------------------- framings

static relume_status render_view(const struct renderer *r, const struct relume_camera *camera,
                                 struct relume_image *out)
{
    if (camera->view < 0 || camera->view >= r->info->views)
        return log_fail(r->params.log, RELUME_EINVAL, "view %d does not exist; expected 0 to %d",
                        camera->view, r->info->views - 1);
    if ((camera->width && camera->width != r->info->width) ||
        (camera->height && camera->height != r->info->height))
        return log_fail(r->params.log, RELUME_EINVAL,
                        "a captured view has its own size; expected %d x %d, found %d x %d",
                        r->info->width, r->info->height, camera->width, camera->height);
    return relight_view(r, camera->view, out);
}

static relume_status relight_needed(const struct renderer *r, const bool *needed,
                                    struct relume_image *images)
{
    struct renderer quiet = *r;
    relume_status status = RELUME_OK;
    for (int v = 0; !status && v < r->info->views; v++) {
        if (!needed[v])
            continue;
        status = relight_view(&quiet, v, &images[v]);
        quiet.params.log = NULL;  // what there is to say of the lights has been said
    }
    return status;
}

static relume_status render_eye(const struct renderer *r, const struct relume_camera *camera,
                                struct relume_image *out)
{
    const struct relume_log *log = r->params.log;
    if (r->info->geometry.projection != RELUME_SLAB)
        return log_fail(log, RELUME_EINVAL, "an eye needs a light slab; this file is %s",
                        relume_projection_name(r->info->geometry.projection));
    relume_slab *slab;
    relume_status status =
        relume_slab_create(&slab, &r->info->geometry, r->info->uv, r->info->views);
    if (status)
        return log_fail(log, status == RELUME_EINVAL ? RELUME_EDATA : status,
                        "the cameras of the slab do not form a grid");
    const size_t views = (size_t)r->info->views;
    bool *needed = mem_zeroed(views, sizeof *needed);
    struct relume_image *images = mem_zeroed(views, sizeof *images);
    const struct relume_vec3 eye =
        camera->framing == RELUME_FRAME_EYE ? camera->eye : relume_slab_middle(slab);
    if (!needed || !images)
        status = RELUME_ENOMEM;
    else if (relume_slab_needs(needed, slab, eye, &r->view) == 0)
        status = log_fail(log, RELUME_EDATA,
                          "the eye (%g, %g, %g) sees nothing of the slab; expected one whose rays "
                          "pass the camera grid",
                          eye.x, eye.y, eye.z);
    else
        status = relight_needed(r, needed, images);
    if (!status)
        status = relume_image_create(out, camera->width ? camera->width : r->info->width,
                                     camera->height ? camera->height : r->info->height, 3);
    if (!status)
        status = relume_slab_frame(out, slab, eye, images, &r->view);
    for (size_t v = 0; images && v < views; v++)
        relume_image_destroy(&images[v]);
    free(images);
    free(needed);
    relume_slab_destroy(&slab);
    return status;
}

static relume_status render_look(const struct renderer *r, const struct relume_camera *camera,
                                 struct relume_image *out)
{
    if (r->info->geometry.projection < RELUME_CYLINDRICAL)
        return log_fail(r->params.log, RELUME_EINVAL,
                        "pan, tilt and zoom need a panorama; this file is %s",
                        relume_projection_name(r->info->geometry.projection));
    struct relume_image view = {0};
    relume_status status = relight_view(r, camera->view, &view);
    if (!status)
        status = relume_image_create(out, camera->width ? camera->width : 1024,
                                     camera->height ? camera->height : 512, 3);
    if (!status)
        status = relume_panorama_frame(out, &r->info->geometry, &view, camera->look, &r->view);
    relume_image_destroy(&view);
    return status;
}

relume_status relume_frame(struct relume_image *out, relume_pack *pack,
                           const struct relume_camera *camera, const struct relume_light *lights,
                           int n, const struct relume_frame_params *params)
{
    struct shared shared = {0};
    const struct renderer r = renderer_of(pack, lights, n, params, &shared);
    *out = (struct relume_image){0};
    relume_status status = RELUME_EINVAL;
    switch (camera->framing) {
    case RELUME_FRAME_DEFAULT:
        status = r.info->geometry.projection == RELUME_SLAB ? render_eye(&r, camera, out)
                                                            : render_view(&r, camera, out);
        break;
    case RELUME_FRAME_VIEW: status = render_view(&r, camera, out); break;
    case RELUME_FRAME_EYE: status = render_eye(&r, camera, out); break;
    case RELUME_FRAME_LOOK: status = render_look(&r, camera, out); break;
    }
    if (status)
        relume_image_destroy(out);
    relume_weight_grid_destroy(&shared.grid);
    return status;
}

// ---------------------------------------------------------------- one ray

// Bilinear in linear light with the border clamped; pixel centres are at +0.5.
static void sample(float rgb[3], const struct relume_image *image, double x, double y)
{
    const double cx = fmin(fmax(x - 0.5, 0.0), image->width - 1.0);
    const double cy = fmin(fmax(y - 0.5, 0.0), image->height - 1.0);
    const int x0 = (int)cx, y0 = (int)cy;
    const int x1 = x0 + 1 < image->width ? x0 + 1 : x0, y1 = y0 + 1 < image->height ? y0 + 1 : y0;
    const double fx = cx - x0, fy = cy - y0;
    const size_t width = (size_t)image->width;
    const float *top = image->data + (size_t)y0 * width * 3;
    const float *low = image->data + (size_t)y1 * width * 3;
    for (int c = 0; c < 3; c++) {
        const double t = top[3 * x0 + c] * (1.0 - fx) + top[3 * x1 + c] * fx;
        const double l = low[3 * x0 + c] * (1.0 - fx) + low[3 * x1 + c] * fx;
        rgb[c] = (float)(t * (1.0 - fy) + l * fy);
    }
}

static relume_status no_ray(const struct renderer *r, const char *why)
{
    return log_fail(r->params.log, RELUME_EDATA, "the file holds no such ray; %s", why);
}

// Where the line of the ray meets the plane z; false when it never does.
static bool meet_plane(vec3 eye, vec3 direction, double z, double xy[2])
{
    if (fabs(direction.z) < 1e-12)
        return false;
    const double t = (z - eye.z) / direction.z;
    xy[0] = eye.x + t * direction.x;
    xy[1] = eye.y + t * direction.y;
    return isfinite(xy[0]) && isfinite(xy[1]);
}

// Pixel position of a point of a window; false outside.
static bool window_pixel(const double min[2], const double max[2], int width, int height,
                         const double at[2], double xy[2])
{
    xy[0] = (at[0] - min[0]) / (max[0] - min[0]) * width;
    xy[1] = (max[1] - at[1]) / (max[1] - min[1]) * height;
    return xy[0] >= 0.0 && xy[0] <= width && xy[1] >= 0.0 && xy[1] <= height;
}

static bool goes_towards(vec3 eye, vec3 direction, double z)
{
    return (z - eye.z) * direction.z >= 0.0;
}

static relume_status query_planar(const struct renderer *r, vec3 eye, vec3 direction, float rgb[3])
{
    const struct relume_geometry *g = &r->info->geometry;
    double at[2], xy[2];
    if (!goes_towards(eye, direction, 0.0) || !meet_plane(eye, direction, 0.0, at) ||
        !window_pixel(g->window_min, g->window_max, r->info->width, r->info->height, at, xy))
        return no_ray(r, "it misses the window");
    struct relume_image view = {0};
    const relume_status status = relight_view(r, 0, &view);
    if (!status)
        sample(rgb, &view, xy[0], xy[1]);
    relume_image_destroy(&view);
    return status;
}

static relume_status query_slab(const struct renderer *r, vec3 eye, vec3 direction, float rgb[3])
{
    const struct relume_geometry *g = &r->info->geometry;
    double st[2], uv[2], xy[2];
    if ((eye.z - g->st_z) * (g->uv_z - g->st_z) <= 0.0 || !goes_towards(eye, direction, g->st_z) ||
        !meet_plane(eye, direction, g->st_z, st) || !meet_plane(eye, direction, g->uv_z, uv) ||
        !window_pixel(g->st_min, g->st_max, r->info->width, r->info->height, st, xy))
        return no_ray(r, "it misses the window");
    relume_slab *slab;
    relume_status status =
        relume_slab_create(&slab, &r->info->geometry, r->info->uv, r->info->views);
    if (status)
        return status == RELUME_EINVAL ? no_ray(r, "the cameras do not form a grid") : status;
    int view[4];
    double weight[4];
    const int count = relume_slab_blend(view, weight, slab, uv, &r->view);
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (count == 0)
        status = no_ray(r, "it misses the camera grid");
    for (int i = 0; !status && i < count; i++) {
        struct relume_image image = {0};
        float value[3];
        status = relight_view(r, view[i], &image);
        if (!status) {
            sample(value, &image, xy[0], xy[1]);
            for (int c = 0; c < 3; c++)
                rgb[c] += (float)weight[i] * value[c];
        }
        relume_image_destroy(&image);
    }
    relume_slab_destroy(&slab);
    return status;
}

static relume_status query_panorama(const struct renderer *r, vec3 eye, vec3 direction,
                                    float rgb[3])
{
    const struct relume_geometry *g = &r->info->geometry;
    // files keep the centre in single precision
    if (vec3_length(vec3_sub(eye, g->center)) > 1e-6 * (1.0 + vec3_length(g->center)))
        return no_ray(r, "a panorama has one eye, its centre");
    struct relume_image view = {0};
    relume_status status = relight_view(r, 0, &view);
    if (!status && !relume_panorama_sample(rgb, g, &view, vec3_unit(direction)))
        status = no_ray(r, "it misses the panorama");
    relume_image_destroy(&view);
    return status;
}

static relume_status query(const struct renderer *r, vec3 eye, vec3 direction, float rgb[3])
{
    switch (r->info->geometry.projection) {
    case RELUME_PLANAR: return query_planar(r, eye, direction, rgb);
    case RELUME_SLAB: return query_slab(r, eye, direction, rgb);
    case RELUME_CYLINDRICAL:
    case RELUME_SPHERICAL:
    case RELUME_CUBE: break;
    }
    return query_panorama(r, eye, direction, rgb);
}

relume_status relume_query(float rgb[3], relume_pack *pack, struct relume_vec3 eye,
                           struct relume_vec3 direction, const struct relume_light *lights, int n,
                           const struct relume_frame_params *params)
{
    struct shared shared = {0};
    const struct renderer r = renderer_of(pack, lights, n, params, &shared);
    if (!(vec3_length(direction) > 0.0))
        return log_fail(r.params.log, RELUME_EINVAL,
                        "direction: expected three numbers, not all 0");
    const relume_status status = query(&r, eye, direction, rgb);
    relume_weight_grid_destroy(&shared.grid);
    return status;
}
