// document_pack.c - relume files, and all that opens as one: views of a capture under its lights
#include "session/session.h"

#include "app/way.h"
#include "cli/program/say.h"
#include "format/coder/coding.h"

#include <relume/exchange.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// Every path: relume_open says what is wrong with it.
static bool is_pack(const char *path, const struct object_set *objects)
{
    (void)objects;
    return path != NULL;
}

// ---------------------------------------------------------------- opening

static struct app_file file_of(const relume_pack *pack)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct app_file file = {
        .geometry = info->geometry,
        .width = info->width,
        .height = info->height,
        .views = info->views,
        .zone = relume_coder_region(info->coder),
    };
    for (int axis = 0; axis < 2; axis++)
        file.uv_min[axis] = file.uv_max[axis] = info->uv ? info->uv[0][axis] : 0.0;
    for (int i = 1; info->uv && i < info->views; i++)
        for (int axis = 0; axis < 2; axis++) {
            file.uv_min[axis] = fmin(file.uv_min[axis], info->uv[i][axis]);
            file.uv_max[axis] = fmax(file.uv_max[axis], info->uv[i][axis]);
        }
    return file;
}

// Several slabs, or one for a free eye.
static relume_status find_slabs(relume_slab_set **around, const relume_pack *pack, bool free_eye,
                                const struct relume_log *log)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    *around = NULL;
    if (!info->slabs && !(free_eye && info->geometry.projection == RELUME_SLAB))
        return RELUME_OK;
    const relume_status status =
        relume_slab_set_create(around, info->slabs ? info->slab : &info->geometry,
                               info->slabs ? info->slabs : 1, info->uv, info->slab_of, info->views);
    if (status == RELUME_EINVAL)
        return say(log, RELUME_EUNFIT, "the cameras of a slab do not stand on a grid");
    return status;
}

// As relume_relight says it; only for lights that were asked for, not for each one dragged there.
static void warn_below_horizon(const relume_pack *pack, const struct app_state *start,
                               const struct relume_log *log)
{
    const struct relume_coder_info *info = relume_coder_info(relume_pack_info(pack)->coder);
    for (int i = 0; info->hemispherical && i < start->lights; i++) {
        const struct relume_vec3 d = start->light[i].direction;
        char text[128];
        if (start->light[i].kind != RELUME_LIGHT_DIRECTIONAL || (info->pole_y ? d.y : d.z) >= 0.0)
            continue;
        snprintf(text, sizeof text,
                 "light %d lies below the horizon, where nothing was photographed; light from the "
                 "horizon is shown instead",
                 i + 1);
        log->message(log->user, RELUME_WARNING, text);
        return;
    }
}

// Planar files without depth lie on z = 0.
static bool has_surface(const relume_pack *pack)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    return info->has_depth || info->geometry.projection == RELUME_PLANAR;
}

// What light goes to and from may be far away on all sides.
static bool may_be_far(const relume_pack *pack, const struct app_state *start)
{
    return way_gathers(start->way) &&
           relume_pack_info(pack)->geometry.projection >= RELUME_CYLINDRICAL;
}

static relume_status check_depth(const relume_pack *pack, const struct app_state *start,
                                 const relume_objects *objects, const struct relume_log *log)
{
    if (objects && !has_surface(pack) && !may_be_far(pack, start))
        return say(log, RELUME_EUNFIT,
                   "objects need to know how far the scene is; open a file with depth");
    if (start->interpolation != RELUME_INTERPOLATE_DEPTH || relume_pack_info(pack)->has_depth)
        return RELUME_OK;
    return say(log, RELUME_EUNFIT,
               "interpolation by depth needs a file with depth; use --interpolate linear");
}

// Ignores damage, which drawing reports.
static relume_status find_relief(struct document *d, const struct session_settings *settings)
{
    const struct relume_pack_info *info = relume_pack_info(d->pack);
    struct relume_relief *relief = calloc(1, sizeof *relief);
    if (!relief)
        return RELUME_ENOMEM;
    d->relief = relief;
    const relume_status status =
        relume_relief_find(relief, d->pack, relume_relief_params(.threads = settings->threads));
    if (info->views > 1 || info->levels)
        relume_pack_drop(d->pack, info->views / 2);
    return status == RELUME_ENOMEM ? status : RELUME_OK;
}

static relume_status start_app(struct opening *out, struct session *s,
                               const struct app_state *start, bool look_ahead)
{
    struct document *d = &out->document;
    struct app_file file = file_of(d->pack);
    relume_status status =
        find_slabs(&d->slabs, d->pack, relume_look_at_given(&start->camera.look_at), s->log);
    if (!status)
        status = find_relief(d, &s->settings);
    file.relief = d->relief;
    file.around = d->slabs;
    file.objects = out->objects.objects;
    file.between = file.objects != NULL;
    if (!status)
        status = app_start(&out->app, &file, start, look_ahead, s->log);
    if (!status)
        status = check_depth(d->pack, start, file.objects, s->log);
    out->app.compared = s->capture != NULL;
    out->app.near_lights = has_surface(d->pack);
    return status;
}

static relume_status open_pack(struct opening *out, struct session *s, const char *path,
                               const struct app_state *start, bool look_ahead)
{
    struct document *d = &out->document;
    d->as_panorama = start->camera.framing == RELUME_FRAME_LOOK;
    relume_status status =
        relume_open(&d->pack, path,
                    relume_open_params(.log = s->log, .threads = s->settings.threads,
                                       .sphere = d->as_panorama));
    if (!status)
        status = start_app(out, s, start, look_ahead);
    if (status)
        return status;
    document_set_path(d, path);
    warn_below_horizon(d->pack, &out->app.start, s->log);
    return RELUME_OK;
}

static void describe_pack(struct session *s)
{
    struct document *d = &s->document;
    const struct relume_pack_info *info = relume_pack_info(d->pack);
    const struct relume_coder_info *coder = relume_coder_info(info->coder);
    document_add_line(d, "%s, %d x %d", relume_projection_name(info->geometry.projection),
                      info->width, info->height);
    if (info->slabs)
        document_add_line(d, "%d slab%s, %d view%s", info->slabs, relume_plural(info->slabs),
                          info->views, relume_plural(info->views));
    else if (info->views > 1)
        document_add_line(d, "%d views", info->views);
    document_add_line(d, "%s, %d coefficient%s, %d light%s", coder->basis->name, info->coefficients,
                      relume_plural(info->coefficients), coder->lights,
                      relume_plural(coder->lights));
    document_add_line(d, "%s domain%s", relume_domain_name(info->domain, info->display),
                      info->has_depth ? ", with depth" : "");
    if (info->books)
        document_add_line(d, "%d codebook%s, the first of %d", info->books,
                          relume_plural(info->books), info->codes);
    else
        document_add_line(d, "%s bits, %s", relume_storage_name(info->storage), info->compression);
    document_add_line(d, "%.3f MB, %.2f bits per pixel", (double)info->file_bytes * 1e-6,
                      8.0 * (double)info->file_bytes /
                          ((double)info->views * (double)info->width * (double)info->height));
}

// ---------------------------------------------------------------- drawing

static relume_status create_renderer(struct session *s)
{
    const struct document *d = &s->document;
    const struct relume_pack_info *info = relume_pack_info(d->pack);
    const struct code_source source = pack_source_codes(d->source);
    const struct part_source parts = pack_source_parts(d->source);
    const relume_status status =
        gl_renderer_create(&s->renderer, &s->window.gl, &source, &info->geometry,
                           d->slabs ? NULL : info->uv, info->views, s->log);
    if (status)
        return status;
    if (d->slabs)
        gl_renderer_use_slabs(&s->renderer, d->slabs, info->uv, info->slab_of);
    gl_renderer_use_parts(&s->renderer, &parts, info);
    gl_renderer_use_capture(&s->renderer, s->capture);
    return RELUME_OK;
}

static void apply_settings(struct gl_renderer *r, const struct session_settings *settings)
{
    r->relighter.memory.most = settings->vram_bytes;
    r->relighter.threads = settings->threads;
    r->relighter.by_library = session_by_library(settings->relight, r->gl);
    r->glare.subject = settings->subject;
    r->glare.threads = settings->threads;
    r->glare.size = settings->glare_size;
    r->glare.by_library = session_by_library(settings->glare, r->gl);
}

static relume_status add_objects(struct session *s)
{
    const struct depth_source places = pack_source_places(s->document.source);
    session_add_ways(s);
    return gl_renderer_use_objects(&s->renderer, s->objects.objects, &places);
}

static relume_status make_pack(struct session *s)
{
    struct document *d = &s->document;
    relume_status status = pack_source_create(&d->source, d->pack, s->settings.vram_bytes);
    if (!status)
        status = create_renderer(s);
    if (status)
        return status;
    apply_settings(&s->renderer, &s->settings);
    const struct code_source tiles = pack_source_tiles(d->source);
    const struct depth_source depth = pack_source_depth(d->source);
    status = gl_renderer_use_tiles(&s->renderer, &tiles, pack_source_map(d->source));
    if (!status && relume_pack_info(d->pack)->has_depth)
        status = gl_renderer_use_depth(&s->renderer, &depth);
    if (!status && s->objects.objects)
        return add_objects(s);
    return status || !s->streams ? status : gl_renderer_stream(&s->renderer);
}

const struct document_kind document_pack = {
    .is = is_pack,
    .open = open_pack,
    .make = make_pack,
    .describe = describe_pack,
};
