// from_pack.c - a file relit under its own lights stands in for photographs
#include "material/maps/from_pack.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/scratch.h"
#include "core/math/vec.h"

#include <relume/material/maps.h>
#include <relume/relight/relight.h>
#include <errno.h>
#include <string.h>

enum { MOST_LIGHTS = 64 };

struct lights {
    int count;
    struct relume_vec3 direction[MOST_LIGHTS];
};

// All of the file's lights, or so many spread over them.
static void choose_lights(struct lights *l, const struct relume_codes *codes)
{
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    l->count = info->lights < MOST_LIGHTS ? info->lights : MOST_LIGHTS;
    for (int i = 0; i < l->count; i++)
        l->direction[i] = info->directions[(int)((i + 0.5) * info->lights / l->count)];
}

static relume_status relight(struct relit *r, const struct relume_codes *codes,
                             const struct lights *l, int threads, const struct relume_log *log)
{
    const size_t pixels = (size_t)codes->width * (size_t)codes->height;
    relume_status status = RELUME_OK;
    r->bytes = (size_t)l->count * pixels * 3 * sizeof(float);
    r->pictures = scratch_map(NULL, r->bytes);
    if (!r->pictures)
        return log_fail(log, RELUME_EIO, "%s: no room for %.0f MB of relit pictures; %s",
                        scratch_folder(), (double)r->bytes / 1e6, strerror(errno));
    for (int i = 0; !status && i < l->count; i++) {
        const struct relume_light light = {.direction = l->direction[i], .rgb = {1, 1, 1}};
        struct relume_image into = {codes->width, codes->height, 3,
                                    .data = r->pictures + (size_t)i * 3 * pixels};
        status = relume_relight(&into, codes, &light, 1, relume_relight_params(.threads = threads));
        for (size_t k = 0; !status && k < 3 * pixels; k++)
            into.data[k] = into.data[k] > 0.0f ? into.data[k] : 0.0f;
        if (!status && !log_progress(log, "relighting", (i + 1.0) / l->count))
            status = RELUME_ECANCEL;
    }
    return status;
}

static relume_status create(struct relit *r, relume_pack *pack, int view,
                            const struct relume_codes *codes, const struct lights *l,
                            const struct relume_log *log)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const struct relume_manifest_view of = {
        .uv = {info->uv ? info->uv[view][0] : 0.0, info->uv ? info->uv[view][1] : 0.0}};
    const struct relume_manifest m = {
        .geometry = *relume_pack_geometry(pack, view),
        .lights = l->count,
        .directions = l->direction,
        .views = 1,
        .view = &of,
    };
    const struct relume_pictures pictures = {
        .width = codes->width,
        .height = codes->height,
        .channels = 3,
        .data = r->pictures,
        .depth = r->depth.data,
        .mask = r->mask.data,
    };
    return relume_capture_create(&r->capture, &m, &pictures, relume_capture_params(.log = log));
}

relume_status relit_open(struct relit *out, relume_pack *pack, int view, int threads,
                         const struct relume_log *log)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const struct relume_codes *codes = NULL;
    struct lights lights;
    *out = (struct relit){0};
    if (info->geometry.projection >= RELUME_CYLINDRICAL || info->slabs)
        return log_fail(log, RELUME_EUNSUPPORTED,
                        "maps lie on a plane: expected a planar file or one slab; found %s (its "
                        "normals: relume relight --pass normals)",
                        info->slabs ? "slabs around an object" : "a panorama");
    if (view < 0 || view >= info->views)
        return log_fail(log, RELUME_EINVAL, "view %d does not exist; expected 0 to %d", view,
                        info->views - 1);
    relume_status status = relume_pack_codes(&codes, pack, view);
    if (!status)
        status = relume_pack_depth(&out->depth, pack, view);
    if (!status)
        status = relume_pack_mask(&out->mask, pack, view);
    if (!status) {
        choose_lights(&lights, codes);
        status = relight(out, codes, &lights, threads, log);
    }
    if (!status)
        status = create(out, pack, view, codes, &lights, log);
    if (status)
        relit_close(out);
    return status;
}

void relit_close(struct relit *r)
{
    relume_capture_destroy(&r->capture);
    relume_image_destroy(&r->depth);
    relume_image_destroy(&r->mask);
    if (r->pictures)
        scratch_unmap(r->pictures, r->bytes);
    *r = (struct relit){0};
}

relume_status relume_maps_fit_pack(struct relume_maps *out, relume_pack *pack,
                                   const struct relume_maps_params *params)
{
    struct relume_maps_params p = PARAMS_WORK(relume_maps_params, params);
    struct relit relit;
    *out = (struct relume_maps){0};
    relume_status status = relit_open(&relit, pack, p.view, p.threads, p.log);
    p.view = 0;
    if (!status)
        status = relume_maps_fit(out, relit.capture, &p);
    relit_close(&relit);
    return status;
}
