// session.c - an open file, what is drawn of it, and the panel over it
#include "session/session.h"

#include "app/events.h"
#include "app/light_list.h"
#include "app/way.h"
#include "cli/program/say.h"

#include <math.h>
#include <relume/exchange.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

void session_say(struct session *s, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(s->message, sizeof s->message, format, args);
    va_end(args);
    s->app.toast_s = APP_TOAST_S;
}

// ---------------------------------------------------------------- file

static struct app_file describe(const relume_pack *pack)
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

void session_set_name(struct session *s, const char *path)
{
    const char *slash = strrchr(path, '/');
    snprintf(s->name, sizeof s->name, "%s", slash ? slash + 1 : path);
    snprintf(s->folder, sizeof s->folder, "%.*s", slash && slash > path ? (int)(slash - path) : 1,
             slash ? path : ".");
}

// As relume_relight says it; only for lights that were asked for, not for each one dragged there.
static void warn_below_horizon(const struct session *s)
{
    const struct relume_coder_info *info = relume_coder_info(relume_pack_info(s->pack)->coder);
    for (int i = 0; info->hemispherical && i < s->app.start.lights; i++) {
        const struct relume_vec3 d = s->app.start.light[i].direction;
        char text[128];
        if (s->app.start.light[i].kind != RELUME_LIGHT_DIRECTIONAL ||
            (info->pole_y ? d.y : d.z) >= 0.0)
            continue;
        snprintf(text, sizeof text,
                 "light %d lies below the horizon, where nothing was photographed; light from the "
                 "horizon is shown instead",
                 i + 1);
        s->log->message(s->log->user, RELUME_WARNING, text);
        return;
    }
}

// What the panel says of the file.
static void describe_lines(struct session *s)
{
    const struct relume_pack_info *info = relume_pack_info(s->pack);
    const struct relume_coder_info *coder = relume_coder_info(info->coder);
    int n = 0;
    snprintf(s->line[n++], SESSION_TEXT, "%s, %d x %d",
             relume_projection_name(info->geometry.projection), info->width, info->height);
    if (info->slabs)
        snprintf(s->line[n++], SESSION_TEXT, "%d slab%s, %d view%s", info->slabs,
                 relume_plural(info->slabs), info->views, relume_plural(info->views));
    else if (info->views > 1)
        snprintf(s->line[n++], SESSION_TEXT, "%d views", info->views);
    snprintf(s->line[n++], SESSION_TEXT, "%s, %d coefficient%s, %d light%s", coder->basis->name,
             info->coefficients, relume_plural(info->coefficients), coder->lights,
             relume_plural(coder->lights));
    snprintf(s->line[n++], SESSION_TEXT, "%s domain%s",
             relume_domain_name(info->domain, info->display),
             info->has_depth ? ", with depth" : "");
    if (info->books)
        snprintf(s->line[n++], SESSION_TEXT, "%d codebook%s, the first of %d", info->books,
                 relume_plural(info->books), info->codes);
    else
        snprintf(s->line[n++], SESSION_TEXT, "%s bits, %s", relume_storage_name(info->storage),
                 info->compression);
    snprintf(s->line[n++], SESSION_TEXT, "%.3f MB, %.2f bits per pixel",
             (double)info->file_bytes * 1e-6,
             8.0 * (double)info->file_bytes /
                 ((double)info->views * (double)info->width * (double)info->height));
    for (int i = 0; i < n; i++)
        s->lines[i] = s->line[i];
    s->lines[n] = NULL;
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

relume_status session_compare(struct session *s, const char *capture)
{
    return relume_capture_open(&s->capture, capture, relume_capture_params(.log = s->log));
}

// The renderer first: its thread may be reading.
void session_close_file(struct session *s)
{
    gl_renderer_destroy(&s->renderer);
    pack_source_destroy(&s->source);
    relume_pack_destroy(&s->pack);
    relume_slab_set_destroy(&s->around);
    relume_slab_set_destroy(&s->stage);
    relume_maps_destroy(&s->found);
    s->beside_warned = false;
    s->scene = false;
}

relume_status session_open(struct session *s, const char *path, const struct app_state *start,
                           bool look_ahead)
{
    relume_pack *pack;
    relume_slab_set *around;
    struct app app;
    if (!path)
        return s->objects ? session_open_stage(s, start) : session_open_nothing(s, start);
    if (session_is_scene(path))
        return session_open_scene(s, path, start);
    if (session_is_maps(path))
        return session_open_maps(s, path, start);
    if (session_is_objects(path))
        return session_open_objects(s, path, start);
    relume_status status =
        relume_open(&pack, path,
                    relume_open_params(.log = s->log, .threads = s->threads,
                                       .sphere = start->camera.framing == RELUME_FRAME_LOOK));
    if (status)
        return status;
    struct app_file file = describe(pack);
    status = find_slabs(&around, pack, relume_look_at_given(&start->camera.look_at), s->log);
    file.around = around;
    file.objects = s->objects;
    file.between = s->objects != NULL;
    if (!status)
        status = app_start(&app, &file, start, look_ahead, s->log);
    if (!status)
        status = check_depth(pack, start, s->objects, s->log);
    if (status) {
        app_release(&app);
        relume_pack_destroy(&pack);
        relume_slab_set_destroy(&around);
        return status;
    }
    session_close_file(s);
    app_release(&s->app);
    s->pack = pack;
    s->around = around;
    s->app = app;
    s->app.compared = s->capture != NULL;
    s->app.near_lights = has_surface(pack);
    s->sphere = start->camera.framing == RELUME_FRAME_LOOK;
    snprintf(s->file, sizeof s->file, "%s", path);
    session_set_name(s, path);
    describe_lines(s);
    warn_below_horizon(s);
    return RELUME_OK;
}

relume_status session_open_nothing(struct session *s, const struct app_state *start)
{
    const struct app_file file = {
        .geometry = {.projection = RELUME_PLANAR, .window_min = {-1, -1}, .window_max = {1, 1}},
        .width = 960,
        .height = 600,
        .views = 1,
        .empty = true,
    };
    const relume_status status = app_start(&s->app, &file, start, true, s->log);
    session_set_name(s, "no file");
    return status;
}

// ---------------------------------------------------------------- drawing

static relume_status make_renderer(struct session *s)
{
    if (s->app.file.empty) {
        const struct code_source nothing = {.user = NULL};
        const relume_status status = gl_renderer_create(&s->renderer, &s->gl, &nothing,
                                                        &s->app.file.geometry, NULL, 1, s->log);
        s->renderer.empty = true;
        return status;
    }
    if (s->found.width)
        return session_make_maps(s);
    if (s->scene)
        return session_make_scene(s);
    if (!s->pack)
        return session_make_stage(s);
    const struct relume_pack_info *info = relume_pack_info(s->pack);
    relume_status status = pack_source_create(&s->source, s->pack, s->vram_bytes);
    if (status)
        return status;
    const struct code_source source = pack_source_codes(s->source);
    const struct part_source parts = pack_source_parts(s->source);
    const struct depth_source depth = pack_source_depth(s->source);
    status = gl_renderer_create(&s->renderer, &s->gl, &source, &info->geometry,
                                s->around ? NULL : info->uv, info->views, s->log);
    if (status)
        return status;
    if (s->around)
        gl_renderer_use_slabs(&s->renderer, s->around, info->uv, info->slab_of);
    gl_renderer_use_parts(&s->renderer, &parts, info);
    s->renderer.relighter.budget = s->vram_bytes;
    s->renderer.relighter.threads = s->threads;
    s->renderer.relighter.by_library =
        s->relight == SESSION_LIBRARY || (s->relight == SESSION_AUTO && s->gl.software);
    s->renderer.glare.subject = s->subject;
    s->renderer.glare.threads = s->threads;
    s->renderer.glare.size = s->glare_size;
    s->renderer.glare.by_library =
        s->glare == SESSION_LIBRARY || (s->glare == SESSION_AUTO && s->gl.software);
    gl_renderer_use_capture(&s->renderer, s->capture);
    const struct code_source tiles = pack_source_tiles(s->source);
    status = gl_renderer_use_tiles(&s->renderer, &tiles, pack_source_map(s->source));
    if (!status && info->has_depth)
        status = gl_renderer_use_depth(&s->renderer, &depth);
    if (!status && s->objects)
        status = session_add_objects(s);
    return status || !s->streams || s->objects ? status : gl_renderer_stream(&s->renderer);
}

// Beside the program, else where its package puts it.
static void find_font(char path[PATH_MAX])
{
    static const char name[] = "DejaVuSans.ttf";
    const ssize_t n = readlink("/proc/self/exe", path, PATH_MAX - sizeof name);
    path[n > 0 ? n : 0] = '\0';
    char *slash = strrchr(path, '/');
    if (slash) {
        strcpy(slash + 1, name);
        if (!access(path, R_OK))
            return;
    }
    strcat(strcpy(path, "/usr/share/fonts/truetype/dejavu/"), name);
}

static relume_status make_panel(struct session *s, double scale)
{
    find_font(s->font);
    const relume_status status =
        panel_create(&s->panel, s->ui_scale > 0 ? s->ui_scale : scale, s->font);
    if (status)
        return status;
    s->app.dock_width = panel_width(s->panel);
    app_arrange(&s->app);
    return draw_panel_create(&s->drawing, &s->gl, s->panel, s->log);
}

relume_status session_start(struct session *s, const struct context_backend *backend, int width,
                            int height)
{
    s->backend = backend;
    relume_status status = backend->open(&s->context, width, height, s->name, s->log);
    if (!status)
        status = gl_load(&s->gl, backend->get_proc, s->log);
    if (!status)
        status = make_renderer(s);
    return status ? status : make_panel(s, backend->scale(s->context));
}

relume_status session_scale(struct session *s, double scale)
{
    draw_panel_destroy(&s->drawing, &s->gl);
    panel_destroy(&s->panel);
    return make_panel(s, scale);
}

// What belongs to the window, not to the file.
static void keep_window(struct app *app, const struct app *was)
{
    app->width = was->width;
    app->height = was->height;
    memcpy(app->beside, was->beside, sizeof app->beside);
    app->dock = was->dock;
    app->dock_width = was->dock_width;
    app->panel = was->panel;
    app->gizmos = was->gizmos;
    app->keep_lights = was->keep_lights;
    app->recording = false;
}

// A copy of the lists alone.
static relume_status keep_lights(struct app_state *to, const struct app_state *from)
{
    struct app_state state = {0};
    if (!light_list_copy(&state, from))
        return RELUME_ENOMEM;
    to->light = state.light;
    to->light_state = state.light_state;
    to->lights = state.lights;
    to->room = state.room;
    to->selected = state.selected;
    return RELUME_OK;
}

static relume_status replace(struct session *s, const char *path, bool *opened)
{
    session_record_stop(s);
    const struct app was = s->app;
    inspect_destroy(&s->inspector);
    struct app_state start = {
        .ball = was.now.ball || was.file.empty,
        .auto_exposure = was.now.auto_exposure,
        .tone = was.now.tone,
        .white = was.now.white,
        .observer = was.now.observer,
        .way = was.now.way,
        .way_samples = was.now.way_samples,
        .bounces = was.now.bounces,
    };
    relume_status status = was.keep_lights ? keep_lights(&start, &was.now) : RELUME_OK;
    s->notice[0] = '\0';
    s->listens = true;
    *opened = !status && !session_open(s, path, &start, true);
    s->listens = false;
    light_list_release(&start);
    if (s->notice[0])
        session_say(s, "%s", s->notice);
    if (!*opened)
        return status;
    if (!s->app.near_lights) {
        // It is not known where they would stand.
        light_list_drop_near(&s->app.start);
        light_list_drop_near(&s->app.now);
    }
    const double toast_s = s->notice[0] ? APP_TOAST_S : 0;
    keep_window(&s->app, &was);
    s->app.toast_s = toast_s;
    relume_capture_destroy(&s->capture);
    s->app.compared = false;
    return make_renderer(s);
}

relume_status session_drop(struct session *s, const char *path)
{
    bool opened;
    return replace(s, path, &opened);
}

relume_status session_show(struct session *s, const char *path)
{
    bool opened;
    const relume_status status = replace(s, path, &opened);
    return status || opened ? status : RELUME_EUNFIT;
}

void session_close(struct session *s)
{
    session_record_stop(s);
    (void)!film_close(&s->film, false);
    if (s->screen.texture)
        target_destroy(&s->screen, &s->gl);
    maps_destroy(&s->maps);
    browse_destroy(&s->browser);
    inspect_destroy(&s->inspector);
    draw_panel_destroy(&s->drawing, &s->gl);
    panel_destroy(&s->panel);
    session_close_file(s);
    relume_objects_destroy(&s->objects);
    if (s->context)
        s->backend->close(s->context);
    relume_capture_destroy(&s->capture);
    relume_rig_destroy(&s->rig);
    frame_request_free(&s->request);
    app_release(&s->app);
}

// Of the picture, by a lattice of its rays: the part that passes no camera grid.
static double share_beside(const struct frame_request *q, const relume_slab *slab,
                           const relume_slab_set *slabs)
{
    enum { SIDE = 24 };
    int n = 0;
    if (slab)
        return q->camera.framing == RELUME_FRAME_EYE ? 1.0 - relume_slab_share(slab, q->camera.eye)
                                                     : 0.0;
    for (int i = 0; q->has_window && i < SIDE * SIDE; i++)
        n += !relume_slab_set_passes(slabs, &q->window, (i % SIDE + 0.5) / SIDE,
                                     (i / SIDE + 0.5) / SIDE);
    return n / (double)(SIDE * SIDE);
}

// Once, not for each step of an eye that goes there.
static void warn_beside(struct session *s)
{
    char text[160];
    if (s->beside_warned || !s->pack)
        return;
    const double share = share_beside(&s->request, s->renderer.grid, s->around);
    if (share < 0.01)
        return;
    snprintf(text, sizeof text,
             "%.0f %% of the picture lies beyond the cameras: shown as the nearest of them see it, "
             "black where none does",
             100.0 * share);
    s->log->message(s->log->user, RELUME_NOTE, text);
    s->beside_warned = true;
}

relume_status session_render(struct session *s)
{
    relume_status status = frame_request_make(&s->request, &s->app);
    s->renderer.waits = !s->streams || s->finishes || session_records(s);
    if (!status)
        status = gl_renderer_draw(&s->renderer, &s->request);
    if (!status)
        warn_beside(s);
    return status;
}

// The first frame is drawn once more, with the exposure that it asks for.
static relume_status meter(struct session *s)
{
    const double before = app_exposure_ev(&s->app);
    double ev;
    const relume_status status = gl_renderer_meter(&ev, &s->renderer);
    if (status)
        return status;
    app_meter(&s->app, ev);
    return app_exposure_ev(&s->app) == before ? RELUME_OK : session_render(s);
}

// Whether an event is for those that hear of it when nothing is recorded.
static bool passes_recording(struct session *s, const struct app_event *event)
{
    const bool escape = event->kind == APP_KEY_DOWN && event->key == APP_KEY_ESCAPE;
    if (escape || event->kind == APP_SIZE)
        session_record_stop(s);
    return event->kind == APP_SIZE || event->kind == APP_RELEASE || event->kind == APP_KEY_UP;
}

static bool may_edit_reflections(const struct app *app, const struct app_event *event)
{
    return app->reflects && (app->drag == APP_DRAG_HANDLE || event->kind != APP_MOVE);
}

// A panel that has just appeared is made at once, so that the next click finds it. One that has
// gone still hears of releases: it may have had the press.
bool session_send(struct session *s, const struct app_event *event)
{
    const bool shown = panel_shown(&s->app);
    if (session_records(s) && !passes_recording(s, event))
        return true;
    if ((shown || event->kind == APP_RELEASE) && panel_takes(s->panel, event))
        return true;
    session_lend_scene(s);
    const struct app_state before = s->app.now;
    if (may_edit_reflections(&s->app, event))
        gl_renderer_let_go(&s->renderer);
    const bool changed = app_handle(&s->app, event);
    session_hear_handles(s);
    session_hear_ways(s, &before);
    if (!shown && panel_shown(&s->app) && session_build_panel(s, false))
        return true;  // what went wrong goes wrong again when it is drawn, and is reported there
    return changed || shown || s->app.wish;
}

relume_status session_draw(struct session *s)
{
    relume_status status = panel_shown(&s->app) ? session_build_panel(s, false) : RELUME_OK;
    const bool wished = s->app.wish;
    if (!status)
        status = session_grant_wish(s);
    if (!status && wished && panel_shown(&s->app))
        status = session_build_panel(s, false);  // with what is said of it
    const bool recorded = !status && session_records(s) && !session_record_step(s);
    if (!status && !recorded)
        status = session_render(s);
    if (!status && !recorded && s->app.now.auto_exposure)
        status = meter(s);
    return status ? status : session_add_histogram(s);
}

bool session_is_busy(const struct session *s)
{
    return s->app.wish || session_records(s);
}

bool session_pass(struct session *s, double seconds)
{
    const bool moved = !session_records(s) && app_advance(&s->app, seconds);
    return app_fade(&s->app, seconds) || moved || session_is_busy(s);
}

void session_present(struct session *s, GLuint framebuffer)
{
    const struct window_place window = {s->app.beside[0], app_window_width(&s->app), s->app.height};
    gl_renderer_present(&s->renderer, &window, s->app.now.tone, s->app.now.white, framebuffer);
    if (panel_shown(&s->app))
        draw_panel(&s->drawing, &s->gl, s->panel, app_window_width(&s->app), s->app.height);
}
