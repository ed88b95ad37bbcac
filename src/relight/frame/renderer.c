// renderer.c - a file under lights: what frames share, and how long it is kept
#include "relight/frame/renderer.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "format/coder/coding.h"
#include "image/image/image.h"
#include "relight/frame/parts.h"
#include "relight/frame/passes.h"
#include "relight/frame/relighter.h"
#include "relight/shadow/moving.h"
#include "relight/view/slab_set.h"
#include "relight/view/view.h"

#include <stdarg.h>
#include <stdio.h>
#include <math.h>
#include <string.h>

static const uint64_t DEFAULT_MEMORY = (uint64_t)1 << 30;

// ---------------------------------------------------------------- what is kept

static uint64_t view_bytes(const relume_renderer *r, int view)
{
    const struct kept *k = &r->kept[view];
    uint64_t bytes = relume_relighter_bytes(r->relighter, view) + image_bytes(&k->surface) +
                     image_bytes(&r->disparity[view]);
    for (int i = 0; i < SHOWN; i++)
        bytes += image_bytes(&r->image[i][view]);
    if (k->shadows)
        bytes += relume_shadows_bytes(k->shadows);
    if (k->texel)
        bytes += sizeof *k->texel * (uint64_t)r->info->width * (uint64_t)r->info->height;
    return bytes + k->code_bytes + parts_bytes(r->parts, view);
}

uint64_t relume_renderer_bytes(const relume_renderer *r)
{
    uint64_t bytes = r->memory.bytes;
    for (int i = 0; i < r->changes; i++)
        bytes += view_bytes(r, r->changed[i]) - r->memory.item[r->changed[i]].bytes;
    return bytes;
}

// A view of which more or less is kept from now on: count its bytes again.
static void change(relume_renderer *r, int view)
{
    struct kept *k = &r->kept[view];
    if (!k->changed)
        r->changed[r->changes++] = view;
    k->changed = true;
}

static void settle(relume_renderer *r)
{
    while (r->changes) {
        const int view = r->changed[--r->changes];
        budget_set(&r->memory, view, view_bytes(r, view));
        r->kept[view].changed = false;
    }
}

void renderer_use(relume_renderer *r, int view)
{
    budget_use(&r->memory, view);
    change(r, view);
}

// Positions, which the assumed depth changes.
static void forget_places(relume_renderer *r, int view)
{
    change(r, view);
    parts_forget(r->parts, view);
    relume_image_destroy(&r->kept[view].surface);
    relume_image_destroy(&r->image[SHOWN_PLACES][view]);
}

static void drop_codes(relume_renderer *r, int view)
{
    parts_drop_codes(r->parts, view);
    if (r->kept[view].code_bytes)
        relume_pack_drop(r->pack, view);
    r->kept[view].code_bytes = 0;
}

static void forget(relume_renderer *r, int view)
{
    struct kept *k = &r->kept[view];
    forget_places(r, view);
    relume_image_destroy(&r->image[SHOWN_LIGHT][view]);
    relume_image_destroy(&r->disparity[view]);
    relume_relighter_drop(r->relighter, view);
    relume_shadows_destroy(&k->shadows);
    mem_free(k->texel);
    drop_codes(r, view);
    *k = (struct kept){.changed = true};
    budget_forget(&r->memory, view);
}

void relume_renderer_forget(relume_renderer *r)
{
    for (int i = 0; i < r->info->views; i++)
        forget(r, i);
}

uint64_t renderer_memory(const relume_renderer *r)
{
    return r->memory.most;
}

void renderer_save_memory(relume_renderer *r, int view)
{
    settle(r);
    for (int i = 0; i < r->info->views && r->memory.bytes > r->memory.most; i++) {
        if (i == view || !r->memory.item[i].used)
            continue;
        change(r, i);
        drop_codes(r, i);
        settle(r);
    }
}

// Forgets the least recently used views until the rest fits. Views of the last frame stay for the
// next one.
static void trim(relume_renderer *r)
{
    int oldest;
    settle(r);
    while ((oldest = budget_excess(&r->memory, 0)) >= 0) {
        forget(r, oldest);
        settle(r);
    }
}

void renderer_begin(relume_renderer *r, enum shown shown)
{
    const struct relume_frame_params *p = &r->params;
    trim(r);
    r->memory.round++;
    r->shown = shown;
    r->view = (struct relume_view_params){.threads = p->threads,
                                          .interpolation = p->interpolation,
                                          .aperture = p->aperture,
                                          .focus = p->focus,
                                          .filter = p->filter,
                                          .one = shown == SHOWN_PLACES,
                                          .nothing = shown == SHOWN_PLACES ? NAN : 0.0f};
    memset(r->needed, 0, (size_t)r->info->views * sizeof *r->needed);
}

void renderer_note(relume_renderer *r, enum note note, const char *format, ...)
{
    char text[sizeof *r->note];
    va_list args;
    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (!strcmp(text, r->note[note]))
        return;
    memcpy(r->note[note], text, sizeof text);
    log_line(r->params.log, RELUME_NOTE, "%s", text);
}

// ---------------------------------------------------------------- life

static void set_memory(relume_renderer *r)
{
    r->memory.most = r->params.memory ? r->params.memory : DEFAULT_MEMORY;
}

static bool create_arrays(relume_renderer *r)
{
    const size_t views = (size_t)r->info->views;
    r->kept = mem_zeroed(views, sizeof *r->kept);
    r->disparity = mem_zeroed(views, sizeof *r->disparity);
    r->range = mem_array(views, sizeof *r->range);
    for (size_t i = 0; r->range && i < views; i++)
        r->range[i][0] = r->range[i][1] = NAN;
    r->needed = mem_zeroed(views, sizeof *r->needed);
    r->changed = mem_zeroed(views, sizeof *r->changed);
    for (int i = 0; i < SHOWN; i++)
        r->image[i] = mem_zeroed(views, sizeof *r->image[i]);
    return budget_create(&r->memory, r->info->views, 0) && r->kept && r->disparity && r->range &&
           r->needed && r->changed && r->image[SHOWN_LIGHT] && r->image[SHOWN_PLACES];
}

relume_status relume_renderer_create(relume_renderer **out, relume_pack *pack,
                                     const struct relume_frame_params *params)
{
    relume_renderer *r = *out = mem_zeroed(1, sizeof *r);
    if (!r)
        return RELUME_ENOMEM;
    r->pack = pack;
    r->info = relume_pack_info(pack);
    r->params = PARAMS_WORK(relume_frame_params, params);
    r->lighting = 1;
    relume_status status = create_arrays(r) ? RELUME_OK : RELUME_ENOMEM;
    set_memory(r);
    if (!status)  // last: who is there has the arrays
        status = relume_relighter_create(&r->relighter, r->info->views,
                                         relume_relighter_params(.cpu_off = r->params.cpu_off,
                                                                 .threads = r->params.threads,
                                                                 .once = r->params.once));
    if (status)
        relume_renderer_destroy(out);
    return status;
}

void relume_renderer_destroy(relume_renderer **renderer)
{
    relume_renderer *r = *renderer;
    *renderer = NULL;
    if (!r)
        return;
    for (int i = 0; r->relighter && i < r->info->views; i++) {
        r->kept[i].code_bytes = 0;  // the pack keeps its codes for others
        forget(r, i);
    }
    parts_destroy(&r->parts);
    relume_relighter_destroy(&r->relighter);
    relume_slab_destroy(&r->slab);
    relume_slab_set_destroy(&r->slabs);
    for (int i = 0; i < SHOWN; i++)
        mem_free(r->image[i]);
    budget_destroy(&r->memory);
    mem_free(r->kept);
    mem_free(r->disparity);
    mem_free(r->range);
    mem_free(r->needed);
    mem_free(r->changed);
    mem_free(r->lights);
    if (r->free_over)
        r->free_over(r->over);
    mem_free(r);
}

relume_pack *relume_renderer_pack(const relume_renderer *r)
{
    return r->pack;
}

void relume_renderer_set(relume_renderer *r, const struct relume_frame_params *params)
{
    const struct relume_frame_params old = r->params;
    r->params = PARAMS_WORK(relume_frame_params, params);
    r->params.log = old.log;
    r->params.threads = old.threads;
    r->params.cpu_off = old.cpu_off;
    r->params.once = old.once;
    set_memory(r);
    const bool moved = r->params.assume_depth != old.assume_depth;
    for (int i = 0; moved && i < r->info->views; i++)
        forget_places(r, i);
    if (moved || r->params.pass != old.pass || r->params.capture != old.capture)
        r->lighting++;
}

relume_status relume_renderer_set_lights(relume_renderer *r, const struct relume_light *lights,
                                         int n)
{
    if (n < 0)
        return RELUME_EINVAL;
    struct relume_light *copy = mem_array((size_t)n, sizeof *copy);
    if (!copy)
        return RELUME_ENOMEM;
    if (n)
        memcpy(copy, lights, (size_t)n * sizeof *copy);
    mem_free(r->lights);
    r->lights = copy;
    r->light_count = n;
    r->lighting++;
    r->said = false;
    return RELUME_OK;
}

const struct relume_light *relume_renderer_lights(int *n, const relume_renderer *r)
{
    *n = r->light_count;
    return r->lights;
}

relume_status relume_renderer_set_rig(relume_renderer *r, relume_rig *rig)
{
    const struct relume_light *lights;
    int n;
    const relume_status status = relume_rig_lights(&lights, &n, rig);
    return status ? status : relume_renderer_set_lights(r, lights, n);
}

// ---------------------------------------------------------------- cameras

relume_status renderer_check_depth(const relume_renderer *r)
{
    if (r->view.interpolation == RELUME_INTERPOLATE_DEPTH && !r->info->has_depth)
        return log_fail(r->params.log, RELUME_EUNFIT,
                        "interpolation by depth needs a file with depth; use --interpolate linear");
    return RELUME_OK;
}

bool renderer_may_take_depth(const relume_renderer *r)
{
    const struct relume_view_params *v = &r->view;
    return r->info->has_depth && (v->interpolation == RELUME_INTERPOLATE_DEFAULT ||
                                  v->interpolation == RELUME_INTERPOLATE_DEPTH);
}

bool renderer_takes_depth(const relume_renderer *r)
{
    return r->view.aperture == 0.0 && r->view.focus == 0.0 && renderer_may_take_depth(r);
}

static relume_status no_grid(const relume_renderer *r, relume_status status, const char *slab)
{
    return status == RELUME_EINVAL ? log_fail(r->params.log, RELUME_EUNFIT,
                                              "the cameras of %s do not form a grid", slab)
                                   : status;
}

relume_status renderer_need_slab(relume_renderer *r)
{
    return r->slab ? RELUME_OK
                   : no_grid(r,
                             relume_slab_create(&r->slab, &r->info->geometry, r->info->uv,
                                                r->info->views),
                             "the slab");
}

relume_status renderer_need_slabs(relume_renderer *r)
{
    const struct relume_pack_info *info = r->info;
    return r->slabs
               ? RELUME_OK
               : no_grid(r,
                         relume_slab_set_create(
                             &r->slabs, info->slabs ? info->slab : &info->geometry,
                             info->slabs ? info->slabs : 1, info->uv, info->slab_of, info->views),
                         "a slab");
}

// ---------------------------------------------------------------- where pixels lie

static relume_status assume_depth(const relume_renderer *r, struct relume_image *depth)
{
    const size_t n = (size_t)r->info->width * (size_t)r->info->height;
    const relume_status status = relume_image_create(depth, r->info->width, r->info->height, 1);
    for (size_t i = 0; !status && i < n; i++)
        depth->data[i] = (float)r->params.assume_depth;
    return status;
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

// What `asks` says needs to know where the pixels lie.
static relume_status find_positions(relume_renderer *r, int view, bool background,
                                    struct relume_image *out, const char *asks)
{
    struct relume_image depth;
    relume_status status = relume_pack_depth(&depth, r->pack, view);
    if (!status && depth.data && background)
        fill_background(&depth);
    if (!status && !depth.data && r->params.assume_depth > 0.0)
        status = assume_depth(r, &depth);
    if (!status)
        status = relume_view_positions(out, relume_pack_geometry(r->pack, view), r->info->uv[view],
                                       depth.data ? &depth : NULL, r->info->width, r->info->height);
    if (status == RELUME_EINVAL)
        status = log_fail(r->params.log, RELUME_EUNFIT,
                          "%s; use a file with depth, or "
                          "--assume-depth D",
                          asks);
    relume_image_destroy(&depth);
    return status;
}

static relume_status need_places(relume_renderer *r, int view)
{
    struct relume_image *out = &r->image[SHOWN_PLACES][view];
    return out->data
               ? RELUME_OK
               : find_positions(r, view, true, out, "objects need to know how far the scene is");
}

relume_status renderer_surface(struct relume_image *out, relume_renderer *r, int view)
{
    const struct relume_light *near = NULL;
    for (int i = 0; i < r->light_count && !near; i++)
        if (relume_light_is_near(r->lights[i].kind))
            near = &r->lights[i];
    if (!near || out->data)
        return RELUME_OK;
    char asks[80];
    (void)snprintf(asks, sizeof asks, "a near light (%s) needs to know how far the surface is",
                   relume_light_kind_name(near->kind));
    return find_positions(r, view, false, out, asks);
}

relume_status renderer_need_disparity(relume_renderer *r, int view)
{
    if (r->disparity[view].data)
        return RELUME_OK;
    change(r, view);
    const relume_slab *slab =
        r->slabs ? relume_slab_set_slab(r->slabs, r->info->slab_of ? r->info->slab_of[view] : 0)
                 : r->slab;
    struct relume_image depth = {0};
    relume_status status = relume_pack_depth(&depth, r->pack, view);
    if (!status)
        status = relume_slab_disparity(&r->disparity[view], slab, r->info->uv[view], &depth);
    if (!status && isnan(r->range[view][0]))
        (void)relume_slab_range(r->range[view], &r->disparity[view]);
    if (status == RELUME_EINVAL)
        status = log_fail(r->params.log, RELUME_EUNFIT,
                          "view %d has no depth; expected depth in all views or in none", view);
    relume_image_destroy(&depth);
    return status;
}

// ---------------------------------------------------------------- light

relume_status renderer_shadows(relume_shadows **out, relume_renderer *r, int view)
{
    struct kept *k = &r->kept[view];
    *out = NULL;
    if (!(r->info->has_shadow || r->info->has_gloss))
        return RELUME_OK;
    const relume_status status =
        k->shadows ? RELUME_OK : relume_shadows_open(&k->shadows, r->pack, view);
    *out = k->shadows;
    return status;
}

relume_status renderer_relit(struct relume_relit *relit, relume_renderer *r, int view)
{
    struct kept *k = &r->kept[view];
    *relit = (struct relume_relit){.view = view,
                                   .surface = &k->surface,
                                   .lights = r->lights,
                                   .count = r->light_count,
                                   .log = r->said ? NULL : r->params.log};
    renderer_save_memory(r, view);
    renderer_use(r, view);
    relume_status status = relume_pack_codes(&relit->codes, r->pack, view);
    if (!status)
        status = renderer_shadows(&relit->shadows, r, view);
    if (status)
        return status;
    k->code_bytes = parts_codes_bytes(relit->codes);
    return renderer_surface(&k->surface, r, view);
}

relume_status renderer_relight(relume_renderer *r, int view, struct relume_image *out)
{
    struct relume_relit relit;
    struct relume_frame_params params = r->params;
    relume_status status = renderer_relit(&relit, r, view);
    if (!status)
        status = relume_relighter_relight(out, r->relighter, &relit);
    params.log = relit.log;
    if (!status)
        status = passes_apply(out, r->pack, view, relit.codes, r->lights, r->light_count, &params);
    if (!status && !log_progress(r->params.log, "relighting", 1.0))
        status = RELUME_ECANCEL;
    r->said |= !status;
    return status;
}

relume_status renderer_need(relume_renderer *r, int view)
{
    struct kept *k = &r->kept[view];
    renderer_use(r, view);
    if (r->shown == SHOWN_PLACES)
        return need_places(r, view);
    if (k->lit == r->lighting)
        return RELUME_OK;
    const relume_status status = renderer_relight(r, view, &r->image[SHOWN_LIGHT][view]);
    k->lit = status ? 0 : r->lighting;
    return status;
}

// Passes look around a texel, refits at all of them.
bool renderer_goes_by_texels(const relume_renderer *r)
{
    bool environment = false;
    for (int i = 0; i < r->light_count; i++)
        environment |= r->lights[i].kind == RELUME_LIGHT_ENVIRONMENT;
    return r->params.pass == RELUME_PASS_COLOUR &&
           !(environment && r->info->domain == RELUME_DOMAIN_DISPLAY && !r->params.once);
}

relume_status renderer_need_partly(relume_renderer *r, int view)
{
    struct kept *k = &r->kept[view];
    const size_t texels = (size_t)r->info->width * (size_t)r->info->height;
    struct relume_image *image = &r->image[SHOWN_LIGHT][view];
    if (!renderer_goes_by_texels(r))
        return renderer_need(r, view);
    renderer_use(r, view);
    if (k->lit == r->lighting || k->partly == r->lighting)
        return RELUME_OK;
    k->lit = k->partly = 0;
    if (!k->texel)
        k->texel = mem_zeroed(texels, sizeof *k->texel);
    relume_status status = k->texel ? RELUME_OK : RELUME_ENOMEM;
    if (!status && !image->data)
        status = relume_image_create(image, r->info->width, r->info->height, 3);
    k->partly = status ? 0 : r->lighting;
    return status;
}

static relume_status relight_run(relume_renderer *r, int view, size_t first, size_t n)
{
    struct relume_relit relit;
    struct relume_codes_part part = {.memory = NULL};
    float *to = r->image[SHOWN_LIGHT][view].data + 3 * first;
    struct relume_image run = {(int)n, 1, 3, .data = to}, surface = {(int)n, 1, 3, .data = NULL};
    relume_status status = renderer_relit(&relit, r, view);
    if (!status)
        status = relume_codes_pick(&part, relit.codes, first, 1, n);
    if (!status && relit.surface->data) {
        surface.data = relit.surface->data + 3 * first;
        relit.surface = &surface;
    }
    relit.codes = &part.codes;
    relit.left = (int)(first % (size_t)r->info->width);
    relit.top = (int)(first / (size_t)r->info->width);
    if (!status)
        status = relume_relighter_relight(&run, r->relighter, &relit);
    relume_codes_part_destroy(&part);
    r->said |= !status;
    for (size_t i = 0; !status && i < n; i++)
        r->kept[view].texel[first + i] = (uint32_t)r->lighting;
    return status;
}

void renderer_texels(void *renderer, int view, int x, int y)
{
    relume_renderer *r = renderer;
    const struct kept *k = &r->kept[view];
    const int width = r->info->width, height = r->info->height;
    const int left = x < 0 ? 0 : x < width ? x : width - 1;
    const int right = x + 1 < 0 ? 0 : x + 1 < width ? x + 1 : width - 1;
    for (int j = 0; k->lit != r->lighting && !r->texels && j < 2; j++) {
        const int row = y + j < 0 ? 0 : y + j < height ? y + j : height - 1;
        const size_t first = (size_t)row * (size_t)width + (size_t)left;
        const size_t n = (size_t)(right - left + 1);
        const uint32_t now = (uint32_t)r->lighting;
        if (k->texel[first] != now || k->texel[first + n - 1] != now)
            r->texels = relight_run(r, view, first, n);
    }
}

relume_status renderer_need_all(relume_renderer *r, bool by_depth)
{
    relume_status status = RELUME_OK;
    for (int v = 0; !status && v < r->info->views; v++) {
        if (!r->needed[v])
            continue;
        status = renderer_need(r, v);
        if (!status && by_depth)
            status = renderer_need_disparity(r, v);
    }
    r->view.disparity = by_depth ? r->disparity : NULL;
    r->view.range = by_depth ? (const double(*)[2])r->range : NULL;
    return status;
}
