// from_pack.c - a file relit under its own lights stands in for photographs
#include "base/log.h"
#include "base/memory.h"
#include "base/params.h"
#include "base/scratch.h"
#include "math/vec.h"

#include <relume/maps.h>
#include <relume/relight.h>
#include <errno.h>
#include <string.h>

enum { MOST_LIGHTS = 64 };

struct relit {
    relume_pack *pack;
    const struct relume_codes *codes;
    const struct relume_maps_params *params;
    int lights;
    struct relume_vec3 direction[MOST_LIGHTS];
    float *pictures;  // [lights][height][width][3], mapped
    size_t bytes;
    struct relume_image depth, mask;
};

// All of the file's lights, or so many spread over them.
static void choose_lights(struct relit *r)
{
    const struct relume_coder_info *info = relume_coder_info(r->codes->coder);
    r->lights = info->lights < MOST_LIGHTS ? info->lights : MOST_LIGHTS;
    for (int i = 0; i < r->lights; i++)
        r->direction[i] = info->directions[(int)((i + 0.5) * info->lights / r->lights)];
}

static relume_status relight(struct relit *r)
{
    const size_t pixels = (size_t)r->codes->width * (size_t)r->codes->height;
    relume_status status = RELUME_OK;
    r->bytes = (size_t)r->lights * pixels * 3 * sizeof(float);
    r->pictures = scratch_map(NULL, r->bytes);
    if (!r->pictures)
        return log_fail(r->params->log, RELUME_EIO, "%s: no room for %.0f MB of relit pictures; %s",
                        scratch_folder(), (double)r->bytes / 1e6, strerror(errno));
    for (int i = 0; !status && i < r->lights; i++) {
        const struct relume_light light = {.direction = r->direction[i], .rgb = {1, 1, 1}};
        struct relume_image into = {r->codes->width, r->codes->height, 3,
                                    .data = r->pictures + (size_t)i * 3 * pixels};
        status = relume_relight(&into, r->codes, &light, 1,
                                relume_relight_params(.threads = r->params->threads));
        for (size_t k = 0; !status && k < 3 * pixels; k++)
            into.data[k] = into.data[k] > 0.0f ? into.data[k] : 0.0f;
        if (!status && !log_progress(r->params->log, "relighting", (i + 1.0) / r->lights))
            status = RELUME_ECANCEL;
    }
    return status;
}

static relume_status fit(struct relume_maps *out, struct relit *r, int view)
{
    const struct relume_pack_info *info = relume_pack_info(r->pack);
    const struct relume_manifest_view of = {
        .uv = {info->uv ? info->uv[view][0] : 0.0, info->uv ? info->uv[view][1] : 0.0}};
    const struct relume_manifest m = {
        .geometry = *relume_pack_geometry(r->pack, view),
        .lights = r->lights,
        .directions = r->direction,
        .views = 1,
        .view = &of,
    };
    const struct relume_pictures pictures = {
        .width = r->codes->width,
        .height = r->codes->height,
        .channels = 3,
        .data = r->pictures,
        .depth = r->depth.data,
        .mask = r->mask.data,
    };
    struct relume_maps_params p = *r->params;
    p.view = 0;
    relume_capture *capture;
    relume_status status =
        relume_capture_create(&capture, &m, &pictures, relume_capture_params(.log = p.log));
    if (!status)
        status = relume_maps_fit(out, capture, &p);
    relume_capture_destroy(&capture);
    return status;
}

relume_status relume_maps_fit_pack(struct relume_maps *out, relume_pack *pack,
                                   const struct relume_maps_params *params)
{
    const struct relume_maps_params p = PARAMS_WORK(relume_maps_params, params);
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct relit r = {.pack = pack, .params = &p};
    *out = (struct relume_maps){0};
    if (info->geometry.projection >= RELUME_CYLINDRICAL || info->slabs)
        return log_fail(p.log, RELUME_EUNSUPPORTED,
                        "maps lie on a plane: expected a planar file or one slab; found %s (its "
                        "normals: relume relight --pass normals)",
                        info->slabs ? "slabs around an object" : "a panorama");
    if (p.view < 0 || p.view >= info->views)
        return log_fail(p.log, RELUME_EINVAL, "view %d does not exist; expected 0 to %d", p.view,
                        info->views - 1);
    relume_status status = relume_pack_codes(&r.codes, pack, p.view);
    if (!status)
        status = relume_pack_depth(&r.depth, pack, p.view);
    if (!status)
        status = relume_pack_mask(&r.mask, pack, p.view);
    if (!status) {
        choose_lights(&r);
        status = relight(&r);
    }
    if (!status)
        status = fit(out, &r, p.view);
    relume_image_destroy(&r.depth);
    relume_image_destroy(&r.mask);
    if (r.pictures)
        scratch_unmap(r.pictures, r.bytes);
    return status;
}
