// captured.c - a capture of many views as a BTF: the cameras of a slab see one window, rectified,
// which is the sample
//
// A camera is as near as it stands: the direction to it, which differs over the window, is that
// from the window's middle.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/tree.h"
#include "material/btf/btf.h"
#include "material/btf/values.h"

#include <relume/capture.h>
#include <string.h>

static const double LOWEST = 1e-3;  // z of a light that reaches the sample

struct captured {
    relume_capture *capture;
    const struct relume_manifest *m;
    vec3 *view, *light;
    int *light_at;  // its number in the capture
    int lights;
};

static relume_status check(const struct captured *c, const char *path, const struct relume_log *log)
{
    if (c->m->geometry.projection != RELUME_SLAB || c->m->slabs)
        return log_fail(
            log, RELUME_EUNFIT,
            "%s: a BTF needs the views of one slab; expected a capture with projection \"slab\"",
            path);
    if (c->m->positions)
        return log_fail(log, RELUME_EUNFIT,
                        "%s: a BTF needs distant lights; expected a capture with light directions, "
                        "not positions",
                        path);
    return RELUME_OK;
}

// Views and lights in the frame of the window; lights behind it show nothing.
static relume_status find_directions(struct captured *c)
{
    const struct relume_geometry *g = &c->m->geometry;
    c->view = mem_array((size_t)c->m->views, sizeof *c->view);
    c->light = mem_array((size_t)c->m->lights, sizeof *c->light);
    c->light_at = mem_array((size_t)c->m->lights, sizeof *c->light_at);
    if (!c->view || !c->light || !c->light_at)
        return RELUME_ENOMEM;
    const vec3 middle =
        vec3_of(0.5 * (g->st_min[0] + g->st_max[0]), 0.5 * (g->st_min[1] + g->st_max[1]), g->st_z);
    for (int i = 0; i < c->m->views; i++) {
        const double *uv = c->m->view[i].uv;
        c->view[i] = vec3_unit(vec3_sub(vec3_of(uv[0], uv[1], g->uv_z), middle));
    }
    for (int i = 0; i < c->m->lights; i++) {
        const vec3 l = relume_pose_turn_back(&g->pose, c->m->directions[i]);
        if (!(l.z >= LOWEST))
            continue;
        c->light[c->lights] = vec3_unit(l);
        c->light_at[c->lights++] = i;
    }
    return RELUME_OK;
}

static relume_status start(relume_btf **out, const struct captured *c, const char *path,
                           const struct relume_btf_params *params)
{
    const struct relume_log *log = params ? params->log : NULL;
    const char *name = path_name(path);
    const struct relume_btf_info info = {
        .name = *name ? name : path,
        .width = relume_capture_width(c->capture),
        .height = relume_capture_height(c->capture),
        .views = c->m->views,
        .lights = c->lights,
        .view = c->view,
        .light = c->light,
    };
    const int behind = c->m->lights - c->lights;
    if (behind)
        log_line(log, RELUME_WARNING, "%s: %d of %d lights are behind the sample; left out", path,
                 behind, c->m->lights);
    const relume_status status = btf_start(out, &info, path, log);
    return status ? status : btf_allocate(*out, params);
}

static relume_status store(const struct captured *c, relume_btf *btf, const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    for (int v = 0; v < c->m->views && !status; v++) {
        for (int l = 0; l < c->lights && !status; l++) {
            struct relume_image image = {0};
            status = relume_capture_image(&image, c->capture, v, c->light_at[l], log);
            if (!status)
                relume_btf_store(btf, v, l, image.data);
            relume_image_destroy(&image);
        }
        if (!status && !log_progress(log, "reading", (v + 1.0) / c->m->views))
            status = RELUME_ECANCEL;
    }
    return status;
}

relume_status btf_open_capture(relume_btf **out, const char *path,
                               const struct relume_btf_params *params)
{
    const struct relume_log *log = params ? params->log : NULL;
    struct captured c = {.capture = NULL};
    *out = NULL;
    relume_status status = relume_capture_open(
        &c.capture, path,
        relume_capture_params(.log = log, .limits = params ? params->limits : NULL));
    if (status)
        return status;
    c.m = relume_capture_manifest(c.capture);
    status = check(&c, path, log);
    if (!status)
        status = find_directions(&c);
    if (!status)
        status = start(out, &c, path, params);
    if (!status)
        status = store(&c, *out, log);
    if (status)
        relume_btf_destroy(out);
    relume_capture_destroy(&c.capture);
    mem_free(c.view);
    mem_free(c.light);
    mem_free(c.light_at);
    return status;
}
