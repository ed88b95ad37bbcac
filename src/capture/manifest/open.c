// open.c - a capture is opened: every promise of the manifest checked against the files
#include "capture/manifest/near_view.h"
#include "core/base/context.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/tree.h"
#include "image/image/photograph.h"
#include "image/geometry/geometry.h"
#include "image/image/picture_kind.h"

#include <string.h>
#include <unistd.h>

// The description in a folder: its capture.json, else its only .lp file; `*out` NULL: none.
static relume_status own_description(char **out, const char *folder, const struct relume_log *log)
{
    char *path = *out = mem_format("%s/capture.json", folder);
    if (!path)
        return RELUME_ENOMEM;
    if (input_exists(path, log))
        return RELUME_OK;
    mem_free(path);
    *out = tree_only(folder, ".lp");
    return RELUME_OK;
}

// The only .lp file in one of its folders: this one is a project.
static relume_status project_description(char **out, const char *folder,
                                         const struct relume_log *log)
{
    const char *q = relume_name_quotes(folder);
    *out = tree_only_below(folder, ".lp");
    if (*out)
        return RELUME_OK;
    const relume_status status = photographs_refuse_tiles(folder, log);
    if (status)
        return status;
    return log_fail(log, RELUME_EFORMAT,
                    "%s: no capture.json and no single .lp file in this folder; give the .lp file, "
                    "or make a capture of photographs first: relume capture %s%s%s -o DIR",
                    folder, q, folder, q);
}

static relume_status read_description(relume_capture *c, const char *path,
                                      const struct relume_capture_params *p)
{
    const bool folder = input_kind(path, p->log) == INPUT_FOLDER;
    relume_status status = RELUME_OK;
    if (folder)
        status = own_description(&c->path, path, p->log);
    else if (!(c->path = mem_text(path)))
        status = RELUME_ENOMEM;
    if (!status && !c->path && olat_is_folder(path, p->log))
        return olat_read_folder(&c->draft, &c->path, path, p);
    if (!status && !c->path)
        status = project_description(&c->path, path, p->log);
    if (!status && !picture_has_extension(c->path, ".lp"))
        return manifest_read(&c->draft, c->path, p);
    return status ? status : lp_open(&c->draft, c->path, folder, p);
}

// Keep only the lights for which `keep` holds, in every array that is indexed by light.
static void keep_lights(struct draft *d, const bool *keep)
{
    int n = 0;
    for (int i = 0; i < d->m.lights; i++) {
        if (!keep[i])
            continue;
        d->directions[n] = d->directions[i];
        if (d->positions)
            d->positions[n] = d->positions[i];
        if (d->intensities)
            memcpy(d->intensities[n], d->intensities[i], sizeof *d->intensities);
        for (int v = 0; v < d->m.views; v++)
            d->view[v].images[n] = d->view[v].images[i];
        n++;
    }
    d->m.lights = n;
}

// The first image of a light that does not exist; NULL when all do.
static const char *missing_image(const struct draft *d, int light, const struct relume_log *log)
{
    for (int v = 0; v < d->m.views; v++)
        if (!input_exists(d->view[v].images[light], log))
            return d->view[v].images[light];
    return NULL;
}

static relume_status skip_missing(relume_capture *c, const struct relume_log *log)
{
    struct draft *d = &c->draft;
    const int before = d->m.lights;
    const char *first = NULL;
    int missing = 0;
    bool *keep = mem_array((size_t)before, sizeof *keep);
    if (!keep)
        return RELUME_ENOMEM;
    for (int i = 0; i < before; i++) {
        const char *image = missing_image(d, i, log);
        keep[i] = !image;
        missing += !!image;
        first = first ? first : image;
    }
    if (missing == before)
        log_fail(log, RELUME_ENOTFOUND, "%s: no image exists; expected %d", c->path, before);
    else if (missing == 1)
        log_line(log, RELUME_WARNING, "%s: image '%s' does not exist; its light is left out",
                 c->path, first);
    else if (missing)
        log_line(log, RELUME_WARNING,
                 "%s: image '%s' and those of %d other lights do not exist; these %d of %d lights "
                 "are left out",
                 c->path, first, missing - 1, missing, before);
    keep_lights(d, keep);
    mem_free(keep);
    return missing == before ? RELUME_ENOTFOUND : RELUME_OK;
}

// Before images are looked at one by one.
static relume_status count_missing(const relume_capture *c, const struct relume_log *log)
{
    const struct relume_manifest *m = &c->draft.m;
    const char *first = NULL;
    int missing = 0;
    for (int v = 0; v < m->views; v++)
        for (int i = 0; i < m->lights; i++)
            if (!input_exists(m->view[v].images[i], log) && missing++ == 0)
                first = m->view[v].images[i];
    if (!missing)
        return RELUME_OK;
    return log_fail(
        log, RELUME_ENOTFOUND,
        "%s: no such file; %d of %d images %s missing; --skip-missing continues without "
        "%s",
        first, missing, m->views * m->lights, missing == 1 ? "is" : "are",
        missing == 1 ? "its light" : "their lights");
}

static relume_status check_image(relume_capture *c, int view, int light,
                                 const struct relume_capture_params *p)
{
    const char *path = c->draft.m.view[view].images[light];
    picture_reader *reader;
    relume_status status = capture_picture(&reader, c, view, light, p->limits, p->log);
    if (!status)
        status = picture_need_colour(reader, path, p->log);
    struct picture_info info = {0};
    if (!status)
        info = *picture_info_of(reader);
    picture_close(&reader);
    if (status)
        return status;
    c->floats |= info.floats;
    if (c->width == 0) {
        c->width = info.width;
        c->height = info.height;
        c->x = info.x;
        c->y = info.y;
        c->stated = c->draft.m.transfer;
        c->transfer = image_transfer(c->draft.m.transfer, &info);
        return RELUME_OK;
    }
    if (info.width != c->width || info.height != c->height)
        return log_fail(
            p->log, RELUME_EUNFIT, "%s: %d x %d pixels; expected %d x %d as in the other images%s",
            path, info.width, info.height, c->width, c->height,
            info.width == c->height && info.height == c->width ? ": it is turned on its side" : "");
    if (info.x != c->x || info.y != c->y)
        return log_fail(p->log, RELUME_EUNFIT,
                        "%s: its data window begins at (%d, %d); expected (%d, %d) as in the other "
                        "images",
                        path, info.x, info.y, c->x, c->y);
    return RELUME_OK;
}

static relume_status check_images(relume_capture *c, const struct relume_capture_params *p)
{
    const struct relume_manifest *m = &c->draft.m;
    for (int v = 0; v < m->views; v++)
        for (int i = 0; i < m->lights; i++) {
            const relume_status status = check_image(c, v, i, p);
            if (status)
                return status;
            if (!log_progress(p->log, "checking", (v + (i + 1.0) / m->lights) / (double)m->views))
                return RELUME_ECANCEL;
        }
    return RELUME_OK;
}

static relume_status check_discs(const relume_capture *c, const struct relume_log *log)
{
    const struct relume_geometry *g = &c->draft.m.geometry;
    if (relume_geometry_fits(g, c->width, c->height))
        return RELUME_OK;
    return log_fail(log, RELUME_EFORMAT,
                    "%s: panorama.discs; expected at most half of the %d columns and fewer than "
                    "the %d rows; found %d",
                    c->path, c->width, c->height, g->disc);
}

// Fills what follows from the images, whose size and transfer are known.
static relume_status settle(relume_capture *c, const struct relume_capture_params *p)
{
    relume_status status = draft_state_at_origin(&c->draft);
    if (!status)
        status = check_discs(c, p->log);
    if (!status)
        status = image_cache_create(&c->cache, c->draft.m.views * c->draft.m.lights, p->keep_bytes,
                                    p->scratch && p->keep_bytes ? c->limits.max_memory / 2 : 0,
                                    c->scratch);
    if (status)
        return status;
    struct relume_geometry *g = &c->draft.m.geometry;
    if (g->projection == RELUME_PLANAR && !c->draft.has_window) {
        const struct relume_geometry d =
            relume_geometry_default(RELUME_PLANAR, c->width, c->height);
        memcpy(g->window_min, d.window_min, sizeof g->window_min);
        memcpy(g->window_max, d.window_max, sizeof g->window_max);
    }
    c->draft.m.transfer = c->transfer;
    near_view_warn(c, p->log);
    return RELUME_OK;
}

static relume_status take_params(relume_capture *c, const struct relume_capture_params *p)
{
    c->repair = p->repair;
    c->assume_depth = p->assume_depth;
    c->scratch = p->scratch ? arena_format(&c->draft.arena, "%s", p->scratch) : NULL;
    c->limits = limits_or_default(p->limits);
    c->context = context_of(p->log);
    return p->scratch && !c->scratch ? RELUME_ENOMEM : RELUME_OK;
}

relume_status capture_finish(relume_capture **out, relume_capture *c,
                             const struct relume_capture_params *p)
{
    relume_status status = take_params(c, p);
    if (p->transfer.curve != RELUME_CURVE_AUTO)
        c->draft.m.transfer = p->transfer;
    if (!status)
        status = check_images(c, p);
    if (!status)
        status = settle(c, p);
    if (status)
        relume_capture_destroy(&c);
    *out = c;
    return status;
}

static void take_files(relume_capture *c, const struct capture_files *files)
{
    c->changed = c->owned_changed = files->changed;
    c->owned_mask = files->mask;
    c->pictures.mask = files->mask.data;
}

relume_status capture_of_files(relume_capture **out, const struct capture_files *files,
                               const struct relume_capture_params *p)
{
    relume_capture *c = mem_zeroed(1, sizeof *c);
    *out = NULL;
    if (!c)
        return RELUME_ENOMEM;
    c->draft = *files->draft;
    *files->draft = (struct draft){0};
    c->pictured = c->draft.m.lights;
    c->width = files->width;
    c->height = files->height;
    c->floats = true;  // as the folder's images are
    c->rounded = true;
    c->stated = p->transfer;
    c->transfer = c->draft.m.transfer;
    c->path = mem_text(files->path);
    relume_status status = c->path ? take_params(c, p) : RELUME_ENOMEM;
    if (!status)
        status = settle(c, p);
    if (!status)
        take_files(c, files);
    else
        relume_capture_destroy(&c);
    *out = c;
    return status;
}

relume_status relume_capture_open(relume_capture **out, const char *path,
                                  const struct relume_capture_params *params)
{
    struct relume_capture_params p = PARAMS(relume_capture_params, params);
    *out = NULL;
    relume_capture *c = mem_zeroed(1, sizeof *c);
    if (!c)
        return RELUME_ENOMEM;
    p.limits = limits_of(p.limits, p.log);
    if (olat_is_stage(path, p.log)) {
        mem_free(c);
        return olat_open(out, path, &p);
    }
    relume_status status = read_description(c, path, &p);
    if (!status)
        status = p.skip_missing ? skip_missing(c, p.log) : count_missing(c, p.log);
    if (!status)
        return capture_finish(out, c, &p);
    relume_capture_destroy(&c);
    return status;
}
