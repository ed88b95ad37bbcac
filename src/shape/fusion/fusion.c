// fusion.c - the depth of a captured file as one mesh, as callers ask for it
#include "core/base/clock.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "shape/fusion/field.h"
#include "shape/fusion/seen.h"
#include "shape/fusion/texture.h"

#include <relume/shape/fusion.h>

// Where none is given: one light from before, in panoramas a weaker one from each side.
#define DISTANT(x, y, z, value)                                                                    \
    {                                                                                              \
        .kind = RELUME_LIGHT_DIRECTIONAL, .direction = {x, y, z}, .rgb = { value, value, value }   \
    }
static const struct relume_light frontal[] = {DISTANT(0, 0, 1, 1.0f)};
static const struct relume_light around[] = {DISTANT(1, 0, 0, 0.5f), DISTANT(-1, 0, 0, 0.5f),
                                             DISTANT(0, 1, 0, 0.5f), DISTANT(0, -1, 0, 0.5f),
                                             DISTANT(0, 0, 1, 0.5f), DISTANT(0, 0, -1, 0.5f)};

// What surfaces may be off by and still be what a view sees, in voxels.
static const double NEAR = 1.5;

enum { MOST_SIDE = 16384 };

static relume_status open_witness(struct witness *out, relume_pack *pack, int view,
                                  const struct relume_fusion_params *p)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct relume_image depth;
    relume_status status = relume_pack_depth(&depth, pack, view);
    if (status)
        return status;
    struct camera camera = {.geometry = *relume_pack_geometry(pack, view),
                            .width = info->width,
                            .height = info->height};
    if (info->geometry.projection == RELUME_SLAB) {
        camera.uv[0] = info->uv[view][0];
        camera.uv[1] = info->uv[view][1];
    }
    if (depth.width != info->width || depth.height != info->height) {
        relume_image_destroy(&depth);
        return log_fail(p->log, RELUME_EUNFIT, "view %d has no depth", view);
    }
    return witness_create(out, &camera, &depth, p->farthest > 0.0 ? p->farthest : (double)INFINITY,
                          thread_count(p->threads));
}

static relume_status open_witnesses(struct witness *witness, relume_pack *pack,
                                    const struct relume_fusion_params *p)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const uint64_t bytes =
        (uint64_t)info->views * (uint64_t)info->width * (uint64_t)info->height * 8;
    relume_status status = limits_memory(NULL, bytes, "the depth of all views", p->log);
    for (int i = 0; i < info->views && !status; i++) {
        status = open_witness(&witness[i], pack, i, p);
        if (!status && !log_progress(p->log, "depth", (i + 1.0) / info->views))
            status = RELUME_ECANCEL;
    }
    return status;
}

static void move(struct relume_mesh *m, vec3 origin)
{
    const float by[3] = {(float)origin.x, (float)origin.y, (float)origin.z};
    for (size_t i = 0; i < m->vertex_count; i++)
        for (int c = 0; c < 3; c++)
            m->position[i][c] += by[c];
}

static relume_status fuse(struct relume_mesh *out, struct relume_fusion_report *report,
                          const struct witness *witness, int witnesses,
                          const struct relume_fusion_params *p)
{
    struct field f = {
        .witness = witness, .witnesses = witnesses, .threads = thread_count(p->threads)};
    relume_status status = field_plan(&f, p->voxel, p->log);
    if (!status)
        status = field_fuse(&f, relume_volume_params(.log = p->log, .limits = p->limits,
                                                     .scratch = p->scratch,
                                                     .spacing = {f.voxel, f.voxel, f.voxel}));
    if (!status)
        status = relume_isosurface(out, &report->mesh, f.volume, FIELD_SURFACE,
                                   relume_isosurface_params(.log = p->log, .threads = p->threads,
                                                            .blocks = {p->block ? p->block : 2}));
    relume_volume_destroy(&f.volume);
    if (status)
        return status;
    move(out, f.origin);
    report->voxel = f.voxel;
    for (int c = 0; c < 3; c++)
        report->size[c] = f.size[c];
    return seen_keep(out, &report->unseen, witness, witnesses, NEAR * f.voxel, f.threads);
}

static relume_status paint(struct relume_mesh *mesh, struct relume_fusion_report *report,
                           const struct texture *t, const struct relume_fusion_params *p)
{
    relume_status status = RELUME_OK;
    if (p->texture)
        status = texture_make(mesh, &report->picture, t);
    if (!status && p->judge)
        status = texture_judge(&report->psnr_db, &report->shown, mesh,
                               p->texture ? &report->picture : NULL, t);
    return status;
}

static relume_status colour(struct relume_mesh *mesh, struct relume_fusion_report *report,
                            relume_pack *pack, const struct witness *witness,
                            const struct relume_fusion_params *p)
{
    relume_renderer *renderer;
    const int views = relume_pack_info(pack)->views;
    relume_status status = relume_renderer_create(
        &renderer, pack, relume_frame_params(.log = p->log, .threads = p->threads));
    const bool panorama = relume_pack_info(pack)->geometry.projection >= RELUME_CYLINDRICAL;
    if (!status && p->lights)
        status = relume_renderer_set_lights(renderer, p->lights, p->light_count);
    else if (!status)
        status =
            relume_renderer_set_lights(renderer, panorama ? around : frontal, panorama ? 6 : 1);
    if (!status && !p->texture)
        status = seen_colour(mesh, renderer, witness, views, NEAR * report->voxel,
                             thread_count(p->threads));
    if (!status)
        status = paint(mesh, report,
                       &(const struct texture){.renderer = renderer,
                                               .witness = witness,
                                               .witnesses = views,
                                               .near = NEAR * report->voxel,
                                               .side = p->texture,
                                               .threads = thread_count(p->threads),
                                               .log = p->log},
                       p);
    relume_renderer_destroy(&renderer);
    return status;
}

static relume_status fuse_views(struct relume_mesh *out, struct relume_fusion_report *report,
                                relume_pack *pack, struct witness *witness,
                                const struct relume_fusion_params *p)
{
    const double start = now_s();
    relume_status status = open_witnesses(witness, pack, p);
    if (!status)
        status = fuse(out, report, witness, relume_pack_info(pack)->views, p);
    report->seconds = now_s() - start;
    if (!status && !p->no_colours && out->vertex_count)
        status = colour(out, report, pack, witness, p);
    return status;
}

relume_status relume_fusion(struct relume_mesh *out, struct relume_fusion_report *report,
                            relume_pack *pack, const struct relume_fusion_params *params)
{
    const struct relume_fusion_params p = PARAMS_WORK(relume_fusion_params, params);
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct relume_fusion_report own = {.voxel = 0.0};
    *out = (struct relume_mesh){0};
    if (!info->has_depth)
        return log_fail(p.log, RELUME_EUNFIT,
                        "no depth; expected a file of a capture with depth maps");
    if (!(p.voxel >= 0.0 && p.farthest >= 0.0) || isinf(p.voxel))
        return log_fail(p.log, RELUME_EINVAL, "voxels of %g; expected a size above 0", p.voxel);
    if (p.texture < 0 || p.texture > MOST_SIDE || (p.texture && p.no_colours) ||
        ((p.texture || p.judge) && !report))
        return log_fail(p.log, RELUME_EINVAL,
                        "a texture of %d texels a side; expected 1 to %d, colours and a report",
                        p.texture, MOST_SIDE);
    struct witness *witness = mem_zeroed((size_t)info->views, sizeof *witness);
    relume_status status = witness ? fuse_views(out, &own, pack, witness, &p) : RELUME_ENOMEM;
    for (int i = 0; witness && i < info->views; i++)
        witness_destroy(&witness[i]);
    mem_free(witness);
    if (status) {
        relume_mesh_free(out);
        relume_image_destroy(&own.picture);
    }
    if (report)
        *report = own;
    return status;
}
