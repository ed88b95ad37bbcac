// acquire_open.c - photographs that a list names become a capture without a folder
//
// They pass the steps of a capture that is made of them. A photograph that is as its file is stays
// there; one that was turned, brought to other colours or moved back is kept beside.
#include "capture/acquire/acquire.h"

#include "capture/acquire/object.h"
#include "capture/manifest/provenance.h"
#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/scratch.h"
#include "core/base/tree.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------- pictures

static bool is_changed(const struct acquisition *s, const struct shot *shot)
{
    const bool follows_profile = shot->notes.profile && s->p.transfer.curve == RELUME_CURVE_AUTO;
    const bool corrected = s->flats.count || s->out->target || s->p.align;
    return s->out->crop[2] || corrected || follows_profile || shot->notes.orientation > 1 ||
           s->orientation > 1 || shot->shift[0] != 0.0 || shot->shift[1] != 0.0;
}

relume_status acquire_keep(struct acquisition *s, struct shot *shot,
                           const struct relume_image *image)
{
    const size_t values = 3 * (size_t)image->width * (size_t)image->height;
    const size_t bytes = values * sizeof *shot->changed.halves;
    if (shot->changed.halves && !shot->changed.mapped)
        s->left_bytes += 3 * sizeof *shot->changed.halves * (size_t)s->width * (size_t)s->height;
    changed_picture_free(&shot->changed);
    if (!is_changed(s, shot))
        return RELUME_OK;
    if (bytes <= s->left_bytes) {
        shot->changed.halves = mem_large(bytes);
        s->left_bytes -= bytes;
    } else if ((shot->changed.halves = scratch_map(s->opening->scratch, bytes))) {
        shot->changed.mapped = bytes;
    } else {
        return log_fail(s->p.log, RELUME_EIO,
                        "%s: the turned or moved picture needs %.0f MB for a while: %s", shot->path,
                        (double)bytes * 1e-6, strerror(errno));
    }
    for (size_t i = 0; shot->changed.halves && i < values; i++)
        shot->changed.halves[i] = half_from_float(image->data[i]);
    return shot->changed.halves ? RELUME_OK : RELUME_ENOMEM;
}

relume_status acquire_kept(struct relume_image *out, const struct acquisition *s,
                           const struct shot *shot)
{
    const uint16_t *halves = shot->changed.halves;
    const relume_status status = halves ? relume_image_create(out, s->width, s->height, 3)
                                        : acquire_load(out, NULL, s, shot->path, s->p.transfer);
    const size_t values = status ? 0 : 3 * (size_t)out->width * (size_t)out->height;
    for (size_t i = 0; i < values; i++)
        out->data[i] = float_from_half(halves ? halves[i] : half_from_float(out->data[i]));
    return status;
}

// ---------------------------------------------------------------- the capture

struct opening {
    struct acquisition *s;
    struct draft draft;
};

// Reads the manifest from its text, in which numbers have nine digits.
static relume_status parse_manifest(void *context, const struct relume_manifest *m)
{
    struct opening *o = context;
    char *text = manifest_text(m);
    const relume_status status =
        text ? manifest_parse(&o->draft, text, o->s->p.lights, ".", o->s->opening) : RELUME_ENOMEM;
    mem_free(text);
    return status;
}

// The images of the draft are the photographs' own files.
static relume_status name_files(struct opening *o)
{
    struct relume_manifest_view *view = o->draft.view;
    const struct acquisition *s = o->s;
    bool good = true;
    for (int i = 0; good && i < s->shots; i++)
        good = (view->images[i] = arena_text(&o->draft.arena, s->shot[i].path)) != NULL;
    if (good && s->p.mask)
        good = (view->mask = arena_text(&o->draft.arena, s->p.mask)) != NULL;
    return good ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status load_mask(struct relume_image *out, const struct acquisition *s)
{
    const relume_status status = acquire_load_mask(out, s);
    const size_t values = out->data ? (size_t)out->width * (size_t)out->height : 0;
    for (size_t i = 0; i < values; i++)
        out->data[i] = float_from_half(half_from_float(out->data[i]));
    return status;
}

static relume_status make_capture(relume_capture **out, struct acquisition *s)
{
    struct opening o = {.s = s};
    struct capture_files files = {
        .draft = &o.draft, .width = s->width, .height = s->height, .path = s->p.lights};
    files.changed = mem_zeroed((size_t)s->shots, sizeof *files.changed);
    relume_status status = files.changed ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = load_mask(&files.mask, s);
    if (!status)
        status = acquire_describe(s, parse_manifest, &o);
    if (!status)
        status = name_files(&o);
    for (int i = 0; !status && i < s->shots; i++)
        files.changed[i] = s->shot[i].changed;
    if (!status)
        status = capture_of_files(out, &files, s->opening);
    for (int i = 0; !status && i < s->shots; i++)
        s->shot[i].changed = (struct changed_picture){0};
    if (status) {
        mem_free(files.changed);
        relume_image_destroy(&files.mask);
    }
    draft_free(&o.draft);
    return status;
}

static relume_status open_photographs(relume_capture **out, struct acquisition *s,
                                      const char *const *path, int count)
{
    relume_status status = acquire_begin(s, path, count);
    if (!status)
        status = acquire_look(s);
    if (!status)
        status = make_capture(out, s);
    if (!status)
        status = acquire_fit(s, *out);
    if (!status)
        acquire_say_alike(s);
    if (status)
        relume_capture_destroy(out);
    acquire_release(s);
    return status;
}

// ---------------------------------------------------------------- the list

struct named {
    const char *path;
    vec3 direction;
};

static int by_number(const void *a, const void *b)
{
    const struct named *one = a, *two = b;
    return strverscmp(one->path, two->path);
}

// The photographs of an opened list and their lights, in the order that acquire_begin gives them.
static relume_status sort_listed(const char ***path, vec3 **direction, const relume_capture *list)
{
    const struct relume_manifest *m = relume_capture_manifest(list);
    const size_t n = (size_t)m->lights;
    struct named *named = mem_array(n, sizeof *named);
    *path = mem_array(n, sizeof **path);
    *direction = mem_array(n, sizeof **direction);
    const bool good = named && *path && *direction;
    for (size_t i = 0; good && i < n; i++)
        named[i] = (struct named){m->view->images[i], m->directions[i]};
    if (good)
        qsort(named, n, sizeof *named, by_number);
    for (size_t i = 0; good && i < n; i++) {
        (*path)[i] = named[i].path;
        (*direction)[i] = named[i].direction;
    }
    mem_free(named);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// Returns the mask that lies with the photographs, to be freed, or NULL.
static char *find_mask(const relume_capture *list, const char *photograph)
{
    if (list->draft.m.view->mask)
        return mem_text(list->draft.m.view->mask);
    char *folder = tree_parent(photograph), *mask = NULL;
    const char *const where = folder;
    struct relume_photographs beside;
    if (folder &&
        !relume_photographs_list(&beside, &where, 1,
                                 relume_photographs_params(.quiet = true, .companions = true))) {
        mask = beside.mask ? mem_text(beside.mask) : NULL;
        relume_photographs_free(&beside);
    }
    mem_free(folder);
    return mask;
}

// Fewer than three photographs say nothing about each other.
static bool is_list(const relume_capture *capture)
{
    return capture->draft.listed && capture->draft.m.lights >= 3 &&
           (!capture->floats || path_ends(capture->path, ".lp"));
}

static relume_status open_listed(relume_capture **out, const relume_capture *list,
                                 const struct relume_capture_params *opening,
                                 const struct relume_acquire_params *params,
                                 struct relume_acquisition *report)
{
    const char **path;
    vec3 *direction;
    const int count = relume_capture_manifest(list)->lights;
    relume_status status = sort_listed(&path, &direction, list);
    const struct listed_lights lights = {direction, list->draft.turns};
    struct acquisition s = {.p = *params,
                            .out = report,
                            .listed = &lights,
                            .opening = opening,
                            .left_bytes = opening->keep_bytes};
    s.p.log = opening->log;
    s.p.limits = opening->limits;
    s.p.transfer = opening->transfer;
    s.p.lights = list->path;
    char *mask = status || s.p.mask ? NULL : find_mask(list, path[0]);
    s.p.mask = mask ? mask : s.p.mask;
    if (!status)
        status = open_photographs(out, &s, path, count);
    mem_free(mask);
    mem_free(path);
    mem_free(direction);
    return status;
}

// ---------------------------------------------------------------- a part of another capture

// Some of the pictures of a view, made small.
static relume_status shrink_view(struct relume_image *small, const struct relume_image **at,
                                 int count, const relume_capture *c, int view,
                                 const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < count; i++) {
        struct relume_image image;
        const int light = (int)((long long)i * c->draft.m.lights / count);
        status = relume_capture_image(&image, c, view, light, log);
        relume_image_destroy(&small[i]);
        if (!status)
            status = acquire_shrink(&small[i], &image);
        relume_image_destroy(&image);
        at[i] = &small[i];
    }
    return status;
}

static struct relume_rect around(struct relume_rect a, struct relume_rect b)
{
    if (!a.width || !b.width)
        return a.width ? a : b;
    const int left = a.left < b.left ? a.left : b.left, top = a.top < b.top ? a.top : b.top;
    const int right = a.left + a.width > b.left + b.width ? a.left + a.width : b.left + b.width;
    const int bottom = a.top + a.height > b.top + b.height ? a.top + a.height : b.top + b.height;
    return (struct relume_rect){left, top, right - left, bottom - top};
}

// Finds the object in some of the views; width 0: all, since it fills one or has no relief.
static relume_status find_object(struct relume_rect *out, const relume_capture *c,
                                 const struct relume_log *log)
{
    enum { LIGHTS = 24, VIEWS = 5 };
    struct relume_image small[LIGHTS] = {{.data = NULL}};
    const struct relume_image *at[LIGHTS];
    const struct relume_manifest *m = &c->draft.m;
    const int count = m->lights < LIGHTS ? m->lights : LIGHTS;
    const int views = m->views < VIEWS ? m->views : VIEWS;
    struct provenance from;
    struct relume_rect object = {.width = 1};
    bool relief = false;
    relume_status status = RELUME_OK;
    provenance_read(&from, m->provenance);
    const struct object_search search = {.small = at,
                                         .count = count,
                                         .step = acquire_small_step(c->width, c->height),
                                         .width = c->width,
                                         .height = c->height,
                                         .ball = from.ball,
                                         .balls = from.balls};
    *out = (struct relume_rect){.width = 0};
    for (int v = 0; !status && object.width && v < views; v++) {
        const int view = views > 1 ? (int)((long long)v * (m->views - 1) / (views - 1)) : 0;
        status = shrink_view(small, at, count, c, view, log);
        if (!status)
            status = object_find(&object, &relief, &search);
        *out = around(*out, object);
    }
    if (!object.width) {
        *out = object;
        acquire_say_no_object(relief, log);
    }
    for (int i = 0; i < count; i++)
        relume_image_destroy(&small[i]);
    return status;
}

static relume_status crop_capture(relume_capture *c, const struct relume_acquire_params *a,
                                  struct relume_acquisition *report, const struct relume_log *log)
{
    const int whole[2] = {c->width, c->height};
    struct relume_rect part = {a->crop[0], a->crop[1], a->crop[2], a->crop[3]};
    relume_status status = a->crop_auto ? find_object(&part, c, log) : RELUME_OK;
    if (status || (!part.width && !part.height))
        return status;
    status = capture_crop(c, &part, log);
    if (status)
        return status;
    memcpy(report->crop, (const int[]){part.left, part.top, part.width, part.height},
           sizeof report->crop);
    log_line(log, RELUME_NOTE, "cropped to %d,%d,%d,%d of %d x %d pixels", part.left, part.top,
             part.width, part.height, whole[0], whole[1]);
    return RELUME_OK;
}

relume_status relume_capture_open_photographs(relume_capture **out, const char *path,
                                              const struct relume_capture_params *params,
                                              const struct relume_acquire_params *acquire,
                                              struct relume_acquisition *report)
{
    struct relume_capture_params p = PARAMS(relume_capture_params, params);
    const struct relume_acquire_params a = PARAMS_WORK(relume_acquire_params, acquire);
    struct relume_acquisition own = {0}, *into = report ? report : &own;
    relume_capture *list;
    *into = (struct relume_acquisition){0};
    relume_status status = relume_capture_open(&list, path, params);
    *out = list;
    const bool photographs = !status && is_list(list) && !(p.repair && list->floats);
    if (!status && !photographs)
        status = crop_capture(list, &a, into, p.log);
    if (status && !photographs)
        relume_capture_destroy(out);
    if (!photographs)
        return status;
    p.limits = limits_of(p.limits, p.log);
    *out = NULL;
    status = open_listed(out, list, &p, &a, into);
    relume_capture_destroy(&list);
    if (status || !report)
        relume_acquisition_destroy(into);
    return status;
}
