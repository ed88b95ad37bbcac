// again.c - a relume file whose planes become lossy
//
// The coefficients are there, so that the pipeline of coded.c begins behind the photographs.
#include "encode/encode/again.h"

#include "core/base/memory.h"
#include "encode/encode/coded.h"
#include "encode/encode/contents.h"
#include "format/coder/coefficients.h"

#include <string.h>

static relume_status take_plane(float *to, relume_pack *pack, int view,
                                relume_status (*read)(struct relume_image *, relume_pack *, int),
                                float missing)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const size_t n = (size_t)info->width * (size_t)info->height;
    struct relume_image image;
    const relume_status status = read(&image, pack, view);
    for (size_t i = 0; !status && i < n; i++)
        to[i] = image.data ? image.data[i] : missing;
    relume_image_destroy(&image);
    return status;
}

static relume_status take_planes(struct again_capture *a, relume_pack *pack)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const size_t n = (size_t)info->width * (size_t)info->height, views = (size_t)info->views;
    relume_status status = RELUME_OK;
    if (info->has_depth)
        a->depth = mem_array(views * n, sizeof *a->depth);
    if (info->has_mask)
        a->mask = mem_array(views * n, sizeof *a->mask);
    if ((info->has_depth && !a->depth) || (info->has_mask && !a->mask))
        return RELUME_ENOMEM;
    for (size_t v = 0; !status && v < views; v++) {
        if (a->depth)
            status = take_plane(a->depth + v * n, pack, (int)v, relume_pack_depth, 0.0f);
        if (!status && a->mask)
            status = take_plane(a->mask + v * n, pack, (int)v, relume_pack_mask, 1.0f);
    }
    return status;
}

// The coder of the stored planes. A file with masks has the mean as one more function.
static relume_status make_coder(struct again_capture *a, const struct relume_pack_info *info,
                                const struct relume_log *log)
{
    const struct relume_coder_info *c = relume_coder_info(info->coder);
    const size_t k = (size_t)info->coefficients, all = (size_t)c->coefficients;
    const size_t raw = (size_t)c->functions;
    const bool grown = all > k;
    struct relume_coder_params p = {
        .log = log,
        .coefficients = info->coefficients,
        .decode = true,
        .force = true,
        .hemispherical = c->hemispherical,
        .pole_y = c->pole_y,
        .ridge = c->ridge,
        .luminance = c->luminance,
        .interpolant = c->interpolant,
        .transform = c->transform,
        .mean = c->mean,
    };
    float *transform = grown ? mem_array(3 * (k + 1) * raw, sizeof *transform) : NULL;
    if (grown && !transform)
        return RELUME_ENOMEM;
    memcpy(p.parameter, c->parameter, sizeof p.parameter);
    for (size_t i = 0; grown && i < 3; i++) {
        memcpy(transform + i * k * raw, c->transform + i * all * raw, k * raw * sizeof *transform);
        memcpy(transform + 3 * k * raw + i * raw, c->transform + (i * all + k) * raw,
               raw * sizeof *transform);
    }
    if (grown) {
        p.transform = transform;
        p.mean = transform + 3 * k * raw;
    }
    const relume_status status =
        relume_coder_create(&a->coder, c->basis, c->directions, c->lights, &p);
    mem_free(transform);
    return status;
}

// Pictures are not looked at, since nothing is fitted.
static relume_status make_capture(struct again_capture *a, const struct relume_pack_info *info,
                                  const struct relume_log *log)
{
    const struct relume_coder_info *c = relume_coder_info(info->coder);
    static const float nothing;
    struct relume_manifest_view *view = mem_zeroed((size_t)info->views, sizeof *view);
    const bool gamma = info->display.curve == RELUME_CURVE_GAMMA;
    const struct relume_manifest m = {
        .transfer = gamma ? info->display : (struct relume_transfer){.curve = RELUME_CURVE_SRGB},
        .geometry = info->geometry,
        .slabs = info->slabs,
        .slab = info->slab,
        .lights = c->lights,
        .directions = c->directions,
        .views = info->views,
        .view = view,
    };
    const struct relume_pictures pictures = {.width = info->width,
                                             .height = info->height,
                                             .channels = 3,
                                             .data = &nothing,
                                             .depth = a->depth,
                                             .mask = a->mask};
    for (int v = 0; view && v < info->views; v++) {
        view[v].uv[0] = info->uv ? info->uv[v][0] : 0.0;
        view[v].uv[1] = info->uv ? info->uv[v][1] : 0.0;
        view[v].slab = info->slab_of ? info->slab_of[v] : 0;
    }
    const relume_status status =
        view ? relume_capture_create(&a->capture, &m, &pictures, relume_capture_params(.log = log))
             : RELUME_ENOMEM;
    mem_free(view);
    return status;
}

relume_status again_open(struct again_capture *out, relume_pack *pack, const struct relume_log *log)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const uint64_t pixels = (uint64_t)info->width * (uint64_t)info->height;
    *out = (struct again_capture){0};
    relume_status status = limits_memory(NULL, pixels * (uint64_t)info->views * 4 * sizeof(float),
                                         "coding all views again", log);
    if (!status)
        status = take_planes(out, pack);
    if (!status)
        status = make_coder(out, info, log);
    return status ? status : make_capture(out, info, log);
}

void again_close(struct again_capture *a)
{
    relume_capture_destroy(&a->capture);
    relume_coder_destroy(&a->coder);
    mem_free(a->depth);
    mem_free(a->mask);
    *a = (struct again_capture){0};
}

static relume_status take_view(struct contents *f, int i)
{
    const struct relume_codes *codes;
    relume_status status = relume_pack_codes(&codes, f->again, i);
    if (!status)
        status = coefficients_take(&f->coefficients[i], f->coder, codes, f->encode);
    relume_pack_drop(f->again, i);
    if (!status)
        status = relume_pack_shadow(&f->shadow[i], f->again, i);
    f->report[i] = relume_pack_info(f->again)->report;
    f->view[i].coefficients = f->coefficients[i];
    return status;
}

relume_status again_write(struct encode_request *r, const struct again_capture *a,
                          relume_pack *pack)
{
    const struct encode_share all = {.views = relume_pack_info(pack)->views};
    const struct relume_project_params encode = {.log = r->log,
                                                 .domain = r->pack.domain,
                                                 .display = r->pack.display,
                                                 .storage = RELUME_STORE_12,
                                                 .step = RELUME_STEP_HALVED,
                                                 .threads = r->pack.threads,
                                                 .scratch = r->pack.writer ? NULL : r->path};
    struct contents f = {
        .capture = a->capture, .coder = a->coder, .p = &r->pack, .encode = &encode, .again = pack};
    struct relume_image gloss = {0};
    relume_status status = contents_create(&f, &all);
    if (!status)
        status = relume_pack_gloss(&gloss, pack, 0);
    r->pack.gloss = gloss.data ? &gloss : NULL;
    for (int i = 0; !status && i < f.views; i++)
        status = take_view(&f, i);
    if (!status)
        status = encode_coded(&f, r->path, &r->result.measured);
    contents_destroy(&f);
    relume_image_destroy(&gloss);
    r->pack.gloss = NULL;
    return status;
}
