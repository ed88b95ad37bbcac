// passes.c - what a frame's passes need of the file: normals, views towards the eye, photographs
#include "relight/frame/passes.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/log.h"
#include "core/math/vec.h"
#include "relight/normals/enhance.h"
#include "relight/view/view.h"

// As far as highlights are concerned, panoramas see the surface from their eye, planar files and a
// slab from +z, one of several from its own.
static relume_status find_towards(struct relume_image *out, const relume_pack *pack, int view)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const struct relume_geometry *g = relume_pack_geometry(pack, view);
    const bool panorama = g->projection >= RELUME_CYLINDRICAL;
    *out = (struct relume_image){0};
    if (!panorama && !info->slabs)
        return RELUME_OK;
    const relume_status status = relume_image_create(out, info->width, info->height, 3);
    float *to = out->data;
    for (int y = 0; !status && y < info->height; y++)
        for (int x = 0; x < info->width; x++, to += 3) {
            const vec3 towards =
                panorama
                    ? vec3_scale(
                          relume_panorama_ray(g, info->width, info->height, x + 0.5, y + 0.5), -1.0)
                    : g->pose.axis[2];
            to[0] = (float)towards.x;
            to[1] = (float)towards.y;
            to[2] = (float)towards.z;
        }
    return status;
}

// ---------------------------------------------------------------- photographs

static int find_light(const struct relume_manifest *manifest, vec3 direction)
{
    int best = 0;
    for (int i = 1; i < manifest->lights; i++)
        if (vec3_dot(manifest->directions[i], direction) >
            vec3_dot(manifest->directions[best], direction))
            best = i;
    return best;
}

static int find_view(const struct relume_manifest *manifest, const struct relume_pack_info *info,
                     int view)
{
    const double *uv = info->uv[view];
    int best = 0;
    double least = INFINITY;
    for (int i = 0; i < manifest->views; i++) {
        const double far = hypot(manifest->view[i].uv[0] - uv[0], manifest->view[i].uv[1] - uv[1]);
        if (info->slabs && manifest->view[i].slab != info->slab_of[view])
            continue;
        if (far < least)
            best = i;
        least = fmin(far, least);
    }
    return best;
}

// The photograph under the captured light nearest to the one light of the frame, times its value.
static relume_status find_photograph(struct relume_image *out, const struct relume_pack_info *info,
                                     int view, const struct relume_light *lights, int n,
                                     const struct relume_frame_params *params)
{
    const struct relume_capture *capture = params->capture;
    if (!capture || n != 1 || lights[0].kind != RELUME_LIGHT_DIRECTIONAL)
        return log_fail(params->log, RELUME_EINVAL,
                        "the pass difference needs --capture and exactly one directional light");
    if (relume_capture_width(capture) != info->width ||
        relume_capture_height(capture) != info->height)
        return log_fail(params->log, RELUME_EUNFIT,
                        "the capture's images are %d x %d; expected %d x %d",
                        relume_capture_width(capture), relume_capture_height(capture), info->width,
                        info->height);
    const struct relume_manifest *manifest = relume_capture_manifest(capture);
    const relume_status status =
        relume_capture_masked(out, capture, find_view(manifest, info, view),
                              find_light(manifest, vec3_unit(lights[0].direction)), params->log);
    const size_t samples = 3 * (size_t)info->width * (size_t)info->height;
    for (size_t i = 0; !status && i < samples; i++)
        out->data[i] *= lights[0].rgb[i % 3];
    return status;
}

relume_status passes_apply(struct relume_image *image, relume_pack *pack, int view,
                           const struct relume_codes *codes, const struct relume_light *lights,
                           int n, const struct relume_frame_params *params)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct relume_pass_params p =
        params->strength ? *params->strength : (struct relume_pass_params){0};
    p.threads = params->threads;
    p.range = NULL;
    struct relume_normals normals = {0};
    struct relume_image towards = {0}, reference = {0};
    relume_status status = RELUME_OK;
    if (params->pass == RELUME_PASS_COLOUR)
        return RELUME_OK;
    if (relume_pass_needs_normals(params->pass))
        status = relume_normals_fit(
            &normals, codes,
            relume_normals_params(.log = params->log, .cpu_off = params->cpu_off,
                                  .threads = params->threads,
                                  .eye = relume_geometry_eye(relume_pack_geometry(pack, view))));
    if (!status && params->pass == RELUME_PASS_SPECULAR)
        status = find_towards(&towards, pack, view);
    if (!status && params->pass == RELUME_PASS_DIFFERENCE)
        status = find_photograph(&reference, info, view, lights, n, params);
    p.towards = towards.data ? &towards : NULL;
    p.reference = reference.data ? &reference : NULL;
    if (!status)
        status = relume_pass_apply(image, params->pass, &normals, lights, n, &p);
    relume_normals_destroy(&normals);
    relume_image_destroy(&towards);
    relume_image_destroy(&reference);
    return status;
}
