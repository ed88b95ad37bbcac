// pyramid.c - the reduced levels of a large view
#include "encode/levels/pyramid.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "encode/levels/reduction.h"
#include "format/coder/coding.h"
#include "format/pack/pack_write.h"
#include "format/pack/views.h"

#include <string.h>

// A view of up to so many pixels is read and relit in half a second anyway, ...
static const int64_t LARGE = 16 << 20;
// ... and levels end where nothing is gained by a smaller one.
enum { SMALLEST = 128 };

// Around a panorama the last pixel of an odd side would be half as wide as the others.
static bool can_be_halved(const struct relume_geometry *g, int width, int height, int level)
{
    const bool round = g->projection >= RELUME_CYLINDRICAL;
    const bool odd = width % 2 || height % 2 || (g->disc >> level) % 2;
    return (width > SMALLEST || height > SMALLEST) && !(round && odd);
}

static relume_status refuse(const struct relume_pack_contents *c, const struct relume_log *log)
{
    const char *what = c->slabs || c->geometry.projection == RELUME_SLAB ? "views of a slab"
                       : relume_coder_info(c->coder)->luminance          ? "luminance coefficients"
                                                                         : NULL;
    return what ? log_fail(log, RELUME_EUNFIT,
                           "%s cannot have a pyramid; expected --pyramid auto or no", what)
                : RELUME_OK;
}

static relume_status make_levels(struct relume_pack_levels *out, const struct relume_geometry *g,
                                 const struct relume_pack_view *view, const struct reduction *how)
{
    const relume_coefficients *from = view->coefficients;
    struct relume_image whole = {0}, *share = &whole;
    relume_status status = view->mask ? share_create(&whole, view->mask, &how->encode) : RELUME_OK;
    while (!status && out->levels < RELUME_MOST_LEVELS) {
        const struct relume_coefficients_info *info = relume_coefficients_info(from);
        const int i = out->levels;
        if (!can_be_halved(g, info->width, info->height, i))
            break;
        status = coefficients_reduce(&out->level[i], from, share, how);
        if (!status && share->data)
            status = share_reduce(&out->share[i], share, &how->encode);
        share = &out->share[i];
        from = out->level[i];
        out->levels += !status;
    }
    relume_image_destroy(&whole);
    return status;
}

bool pyramid_is_wanted(enum relume_pyramid pyramid, int width, int height)
{
    return pyramid == RELUME_PYRAMID_YES || (!pyramid && (int64_t)width * height > LARGE);
}

bool pyramid_is_possible(const struct relume_pack_contents *contents)
{
    return !refuse(contents, NULL);
}

relume_status relume_pack_reduce(struct relume_pack_levels *out,
                                 const struct relume_pack_contents *contents,
                                 const struct relume_pack_view *view, enum relume_pyramid pyramid,
                                 const struct relume_project_params *params)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(view->coefficients);
    const struct reduction how = {
        .domain = contents->domain, .display = contents->display, .encode = *params};
    *out = (struct relume_pack_levels){0};
    if (!pyramid_is_wanted(pyramid, info->width, info->height))
        return RELUME_OK;
    relume_status status = refuse(contents, pyramid ? params->log : NULL);
    if (status)
        return pyramid ? status : RELUME_OK;
    status = make_levels(out, &contents->geometry, view, &how);
    if (status)
        relume_pack_levels_destroy(out);
    return status;
}

void relume_pack_levels_destroy(struct relume_pack_levels *levels)
{
    for (int i = 0; i < RELUME_MOST_LEVELS; i++) {
        relume_coefficients_destroy(&levels->level[i]);
        relume_image_destroy(&levels->share[i]);
        mem_free(levels->coded[i]);
    }
    *levels = (struct relume_pack_levels){0};
}
