#include "base/log.h"
#include "frame/passes.h"
#include "frame/renderer.h"
#include "math/vec.h"

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
        .view = {.threads = p.threads,
                 .interpolation = p.interpolation,
                 .aperture = p.aperture,
                 .focus = p.focus,
                 .filter = p.filter,
                 .one = p.places,
                 .nothing = p.places ? NAN : 0.0f},
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
    status = relume_surface(out, relume_pack_geometry(r->pack, view), r->info->uv[view],
                            depth.data ? &depth : NULL, r->info->width, r->info->height);
    if (status == RELUME_EINVAL)
        status = log_fail(r->params.log, RELUME_EDATA,
                          "a near light (%s) needs to know how far the surface is; use a file with "
                          "depth, or --assume-depth D",
                          relume_light_kind_name(find_near(r)->kind));
    relume_image_destroy(&depth);
    return status;
}

// All views of a file have one coder, and so have all their refits.
static relume_status find_grid(const struct renderer *r, const struct relume_codes *codes,
                               const relume_refit *refit, const relume_weight_grid **grid)
{
    const bool folded = codes->domain != RELUME_DOMAIN_DISPLAY && has_environment(r);
    const bool refitted = refit && !find_near(r);
    relume_status status = RELUME_OK;
    *grid = refitted ? NULL : r->params.grid;
    if (*grid || !(find_near(r) || folded || refitted))
        return RELUME_OK;
    if (!r->shared->grid)
        status = relume_weight_grid_create(
            &r->shared->grid, refitted ? relume_refit_codes(refit)->coder : codes->coder,
            relume_weight_grid_params(.sums = !find_near(r), .threads = r->params.threads));
    *grid = r->shared->grid;
    return status;
}

// Of codes of the display domain under an environment: what the first view learned serves all.
static relume_status find_refit(const struct renderer *r, const struct relume_codes *codes,
                                relume_refit **refit)
{
    *refit = NULL;
    if (codes->domain != RELUME_DOMAIN_DISPLAY || !has_environment(r))
        return RELUME_OK;
    return relume_refit_create(refit, codes,
                               relume_refit_params(.log = r->shared->learned ? NULL : r->params.log,
                                                   .like = r->shared->learned,
                                                   .cpu_off = r->params.cpu_off,
                                                   .threads = r->params.threads));
}

static void keep_refit(const struct renderer *r, relume_refit **refit)
{
    if (r->shared->learned || !*refit) {
        relume_refit_destroy(refit);
        return;
    }
    relume_refit_forget(*refit);
    r->shared->learned = *refit;
}

static void shared_destroy(struct shared *shared)
{
    relume_weight_grid_destroy(&shared->grid);
    relume_refit_destroy(&shared->learned);
}

// Background is a thousand times as far as the farthest surface, so that it is finite between
// pixels.
static void fill_background(struct relume_image *depth)
{
    const size_t n = (size_t)depth->width * (size_t)depth->height;
    float farthest = 1.0f;
    for (size_t i = 0; i < n; i++)
        if (isfinite(depth->data[i]))
            farthest = fmaxf(farthest, depth->data[i]);
    for (size_t i = 0; i < n; i++)
        if (!isfinite(depth->data[i]))
            depth->data[i] = 1e3f * farthest;
}

static relume_status find_places(const struct renderer *r, int view, struct relume_image *out)
{
    struct relume_image depth;
    relume_status status = relume_pack_depth(&depth, r->pack, view);
    if (!status && depth.data)
        fill_background(&depth);
    else if (!status && r->params.assume_depth > 0.0)
        status = assume_depth(r, &depth);
    if (!status)
        status = relume_surface(out, relume_pack_geometry(r->pack, view), r->info->uv[view],
                                depth.data ? &depth : NULL, r->info->width, r->info->height);
    if (status == RELUME_EINVAL)
        status = log_fail(r->params.log, RELUME_EDATA,
                          "objects need to know how far the scene is; use a file with depth, or "
                          "--assume-depth D");
    relume_image_destroy(&depth);
    return status;
}

relume_status renderer_relight(const struct renderer *r, int view, struct relume_image *out)
{
    if (r->params.places)
        return find_places(r, view, out);
    const struct relume_codes *codes;
    const relume_weight_grid *grid = NULL;
    relume_refit *refit = NULL;
    struct relume_image surface = {0};
    relume_status status = relume_pack_codes(&codes, r->pack, view);
    if (!status && find_near(r))
        status = find_surface(r, view, &surface);
    if (!status)
        status = find_refit(r, codes, &refit);
    if (!status)
        status = find_grid(r, codes, refit, &grid);
    if (!status)
        status =
            relume_relight(out, codes, r->lights, r->light_count,
                           relume_relight_params(.log = r->params.log, .cpu_off = r->params.cpu_off,
                                                 .threads = r->params.threads, .surface = &surface,
                                                 .grid = grid, .refit = refit));
    keep_refit(r, &refit);
    if (!status)
        status = passes_apply(out, r->pack, view, codes, r->lights, r->light_count, &r->params);
    relume_image_destroy(&surface);
    if (!status && !log_progress(r->params.log, "relighting", 1.0))
        return RELUME_ECANCEL;
    return status;
}

// ---------------------------------------------------------------- framings

// Positions have no mean: the nearest texel's.
static relume_status scale_view(const struct renderer *r, const struct relume_camera *camera,
                                const struct relume_image *view, struct relume_image *out)
{
    const struct relume_geometry *g = &r->info->geometry;
    const bool round = g->projection == RELUME_CYLINDRICAL || g->projection == RELUME_SPHERICAL;
    return relume_image_scale(
        out, view, camera->width, camera->height,
        relume_scale_params(.threads = r->params.threads,
                            .filter = r->params.places ? RELUME_FILTER_NEAREST : r->params.filter,
                            .wrap = round && !g->disc,
                            .tiles = g->projection == RELUME_CUBE ? 6 : 1));
}

static relume_status render_view(const struct renderer *r, const struct relume_camera *camera,
                                 struct relume_image *out)
{
    if (camera->view < 0 || camera->view >= r->info->views)
        return log_fail(r->params.log, RELUME_EINVAL, "view %d does not exist; expected 0 to %d",
                        camera->view, r->info->views - 1);
    struct relume_image view = {0};
    relume_status status = renderer_relight(r, camera->view, &view);
    if (status || (camera->width == view.width && camera->height == view.height)) {
        *out = view;
        return status;
    }
    status = scale_view(r, camera, &view, out);
    relume_image_destroy(&view);
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
    relume_status status = renderer_relight(r, camera->view, &view);
    if (!status)
        status = relume_image_create(out, camera->width, camera->height, 3);
    if (!status)
        status = relume_panorama_frame(out, &r->info->geometry, &view, camera->look, &r->view);
    relume_image_destroy(&view);
    return status;
}

static relume_status check_size(const struct renderer *r, const int frame[2])
{
    if (frame[0] >= 1 && frame[1] >= 1 && (int64_t)frame[0] * frame[1] <= 1 << 30)
        return RELUME_OK;
    return log_fail(r->params.log, RELUME_EINVAL,
                    "a picture of %d x %d pixels is too large; expected at most 2^30", frame[0],
                    frame[1]);
}

static relume_status render(const struct renderer *r, const struct relume_camera *camera,
                            struct relume_image *out)
{
    switch (camera->framing) {
    case RELUME_FRAME_DEFAULT:
        return r->info->geometry.projection == RELUME_SLAB ? frame_eye(r, camera, out)
                                                           : render_view(r, camera, out);
    case RELUME_FRAME_VIEW: return render_view(r, camera, out);
    case RELUME_FRAME_EYE: return frame_eye(r, camera, out);
    case RELUME_FRAME_LOOK: return render_look(r, camera, out);
    }
    return RELUME_EINVAL;
}

relume_status relume_frame(struct relume_image *out, relume_pack *pack,
                           const struct relume_camera *camera, const struct relume_light *lights,
                           int n, const struct relume_frame_params *params)
{
    struct shared shared = {0};
    const struct renderer r = renderer_of(pack, lights, n, params, &shared);
    struct relume_camera within = *camera;
    int frame[2];
    const struct relume_place place = relume_camera_place(frame, r.info, camera);
    *out = (struct relume_image){0};
    within.width = place.width;
    within.height = place.height;
    relume_status status = check_size(&r, frame);
    if (!status)
        status = render(&r, &within, out);
    if (!status)
        status = frame_put(out, &place, frame, &r);
    if (status)
        relume_image_destroy(out);
    shared_destroy(&shared);
    return status;
}

// ---------------------------------------------------------------- rays

relume_status relume_query_rays(float (*rgb)[3], relume_pack *pack, const struct relume_ray *rays,
                                int n, const struct relume_light *lights, int light_count,
                                const struct relume_frame_params *params)
{
    struct shared shared = {0};
    const struct renderer r = renderer_of(pack, lights, light_count, params, &shared);
    const relume_status status = query_rays(rgb, &r, rays, n);
    shared_destroy(&shared);
    return status;
}

relume_status relume_query(float rgb[3], relume_pack *pack, struct relume_vec3 eye,
                           struct relume_vec3 direction, const struct relume_light *lights, int n,
                           const struct relume_frame_params *params)
{
    const struct relume_ray ray = {eye, direction};
    return relume_query_rays((float(*)[3])rgb, pack, &ray, 1, lights, n, params);
}
