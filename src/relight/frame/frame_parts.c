// frame_parts.c - what a frame reads of many views, where it reads little of each
//
// An eye near a slab looks through many cells of the camera grid and sees a small rectangle of the
// window through each: only these are read, relit and kept, so that a frame costs about what it
// shows, however many views it touches.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "format/coder/coding.h"
#include "format/pack/views.h"
#include "image/image/image.h"
#include "relight/frame/parts.h"
#include "relight/frame/relighter.h"
#include "relight/frame/renderer.h"
#include "relight/frame/renderer_views.h"
#include "relight/view/view.h"

#include <math.h>

// ---------------------------------------------------------------- rectangles

static int64_t area(struct relume_rect r)
{
    return (int64_t)r.width * r.height;
}

static struct relume_rect around(struct relume_rect a, struct relume_rect b)
{
    const int left = a.left < b.left ? a.left : b.left, top = a.top < b.top ? a.top : b.top;
    const int right = a.left + a.width > b.left + b.width ? a.left + a.width : b.left + b.width;
    const int bottom = a.top + a.height > b.top + b.height ? a.top + a.height : b.top + b.height;
    return (struct relume_rect){left, top, right - left, bottom - top};
}

// What is kept holds `wanted`; an eye that moves a little goes on with what it has.
static void hold(relume_renderer *r, int view, struct relume_rect wanted)
{
    struct relume_rect *at = &r->parts->at[view];
    const struct relume_rect both = area(*at) ? around(*at, wanted) : wanted;
    if (area(*at) && area(both) == area(*at))
        return;
    parts_forget(r->parts, view);
    *at = area(both) <= 2 * area(wanted) ? both : wanted;
}

// ---------------------------------------------------------------- what a view is asked for

// How near its surfaces are, which says how far a ray walks over its disparities. These are kept
// whole only while all that the frame needs are a small share of the memory.
static relume_status need_range(relume_renderer *r, int view, bool keep)
{
    if (!isnan(r->range[view][0]))
        return RELUME_OK;
    const relume_status status = renderer_need_disparity(r, view);
    if (!keep)
        relume_image_destroy(&r->disparity[view]);
    return status;
}

static relume_status need_disparity(relume_renderer *r, int view)
{
    struct relume_image *out = &r->parts->disparity[view];
    if (out->data)
        return RELUME_OK;
    relume_status status = renderer_need_disparity(r, view);
    if (!status)
        status = image_part(out, &r->disparity[view], &r->parts->at[view]);
    relume_image_destroy(&r->disparity[view]);
    return status;
}

static relume_status need_surface(relume_renderer *r, int view)
{
    struct part *p = &r->parts->part[view];
    struct relume_image whole = {0};
    relume_status status = p->surface.data ? RELUME_OK : renderer_surface(&whole, r, view);
    if (!status && whole.data)
        status = image_part(&p->surface, &whole, &r->parts->at[view]);
    relume_image_destroy(&whole);
    return status;
}

static relume_status need_light(relume_renderer *r, int view)
{
    struct part *p = &r->parts->part[view];
    if (p->lit == r->lighting)
        return RELUME_OK;
    renderer_save_memory(r, view);
    renderer_use(r, view);
    relume_status status =
        p->codes.memory ? RELUME_OK
                        : relume_pack_codes_part(&p->codes, r->pack, view, &r->parts->at[view]);
    if (!status)
        status = need_surface(r, view);
    struct relume_relit relit = {.view = view,
                                 .codes = &p->codes.codes,
                                 .surface = &p->surface,
                                 .lights = r->lights,
                                 .count = r->light_count,
                                 .log = r->said ? NULL : r->params.log,
                                 .left = r->parts->at[view].left,
                                 .top = r->parts->at[view].top};
    if (!status)
        status = renderer_shadows(&relit.shadows, r, view);
    if (!status)
        status = relume_relighter_relight(&r->parts->image[view], r->relighter, &relit);
    r->said |= !status;
    p->lit = status ? 0 : r->lighting;
    return status;
}

static relume_status need_part(relume_renderer *r, int view, struct relume_rect wanted,
                               bool by_depth)
{
    renderer_use(r, view);
    hold(r, view, wanted);
    const relume_status status = by_depth ? need_disparity(r, view) : RELUME_OK;
    return status ? status : need_light(r, view);
}

// ---------------------------------------------------------------- a frame

struct relume_view_params frame_parts_params(const relume_renderer *r, bool by_depth)
{
    struct relume_view_params params = r->view;
    params.part = r->parts->at;
    params.size[0] = r->info->width;
    params.size[1] = r->info->height;
    params.disparity = by_depth ? r->parts->disparity : NULL;
    params.range = by_depth ? (const double(*)[2])r->range : NULL;
    return params;
}

static relume_status need_ranges(relume_renderer *r)
{
    const size_t pixels = (size_t)r->info->width * (size_t)r->info->height;
    uint64_t bytes = 0;
    relume_status status = RELUME_OK;
    for (int v = 0; v < r->info->views; v++)
        bytes += r->needed[v] ? pixels * sizeof(float) : 0;
    for (int v = 0; !status && v < r->info->views; v++)
        if (r->needed[v])
            status = need_range(r, v, bytes <= renderer_memory(r) / 8);
    return status;
}

relume_status frame_parts(bool *whole, relume_renderer *r, vec3 eye, const int frame[2],
                          bool by_depth)
{
    relume_status status = r->parts ? RELUME_OK : parts_create(&r->parts, r->info->views);
    if (!status && by_depth)
        status = need_ranges(r);
    if (status)
        return status;
    struct relume_rect *wanted = mem_array((size_t)r->info->views, sizeof *wanted);
    const struct relume_view_params params = frame_parts_params(r, by_depth);
    int64_t texels = 0, all = 0;
    if (!wanted || relume_slab_parts(wanted, r->slab, eye, frame, &params) < 0) {
        mem_free(wanted);
        return RELUME_ENOMEM;
    }
    for (int v = 0; v < r->info->views; v++) {
        texels += area(wanted[v]);
        all += r->needed[v] ? (int64_t)r->info->width * r->info->height : 0;
    }
    *whole = 2 * texels > all;
    for (int v = 0; !status && !*whole && v < r->info->views; v++) {
        if (area(wanted[v]))
            status = need_part(r, v, wanted[v], by_depth);
        else
            parts_forget(r->parts, v);
        if (!status && !log_progress(r->params.log, "relighting", 1.0))
            status = RELUME_ECANCEL;
    }
    mem_free(wanted);
    return status;
}

// ---------------------------------------------------------------- a part of a view

relume_status frame_rows(struct relume_image *out, relume_renderer *r, int view, int level,
                         const struct relume_rect *rect)
{
    struct relume_codes_part part;
    struct relume_relit relit = {.view = view,
                                 .codes = &part.codes,
                                 .lights = r->lights,
                                 .count = r->light_count,
                                 .log = r->said ? NULL : r->params.log,
                                 .left = rect->left,
                                 .top = rect->top};
    relume_status status = relume_pack_codes_level(&part, r->pack, view, level, rect);
    if (!status)
        status = renderer_shadows(&relit.shadows, r, view);  // files with levels have none
    if (!status)
        status = relume_relighter_relight(out, r->relighter, &relit);
    relume_codes_part_destroy(&part);
    r->said |= !status;
    return status;
}

static relume_status check_part(const relume_renderer *r, int view, const struct relume_rect *rect)
{
    const int width = r->info->width, height = r->info->height;
    if (view < 0 || view >= r->info->views)
        return log_fail(r->params.log, RELUME_EINVAL, "view %d does not exist; expected 0 to %d",
                        view, r->info->views - 1);
    if (rect->left >= 0 && rect->top >= 0 && rect->width > 0 && rect->height > 0 &&
        rect->width <= width - rect->left && rect->height <= height - rect->top)
        return RELUME_OK;
    return log_fail(r->params.log, RELUME_EINVAL,
                    "no part %d x %d at %d,%d; expected one within the %d x %d pixels of the view",
                    rect->width, rect->height, rect->left, rect->top, width, height);
}

static relume_status part_by_itself(struct relume_image *out, relume_renderer *r, int view,
                                    const struct relume_rect *rect)
{
    relume_status status = r->parts ? RELUME_OK : parts_create(&r->parts, r->info->views);
    if (status)
        return status;
    hold(r, view, *rect);
    status = need_light(r, view);
    struct relume_rect at = *rect;
    at.left -= r->parts->at[view].left;
    at.top -= r->parts->at[view].top;
    return status ? status : image_part(out, &r->parts->image[view], &at);
}

relume_status relume_renderer_part(struct relume_image *out, relume_renderer *r, int view,
                                   const struct relume_rect *rect)
{
    *out = (struct relume_image){0};
    relume_status status = check_part(r, view, rect);
    if (status)
        return status;
    renderer_begin(r, SHOWN_LIGHT);
    if (renderer_goes_by_texels(r))
        return part_by_itself(out, r, view, rect);
    status = renderer_need(r, view);
    return status ? status : image_part(out, &r->image[SHOWN_LIGHT][view], rect);
}

relume_status relume_renderer_detail(struct relume_image *out, relume_renderer *r, int view,
                                     const struct relume_rect *rect, int width, int height)
{
    struct relume_image own = {0};
    *out = own;
    relume_status status = check_part(r, view, rect);
    if (status || width < 1 || height < 1)
        return status ? status : RELUME_EINVAL;
    if (width == rect->width && height == rect->height)
        return relume_renderer_part(out, r, view, rect);
    renderer_begin(r, SHOWN_LIGHT);
    if (frame_detail_suits(r, rect, width, height))
        return frame_detail(out, r, view, rect, width, height);
    status = relume_renderer_part(&own, r, view, rect);
    if (!status)
        status = relume_image_scale(
            out, &own, width, height,
            relume_scale_params(.threads = r->params.threads, .filter = r->params.filter));
    relume_image_destroy(&own);
    return status;
}
