// session.c - an open file, what is drawn of it, and the panel over it
#include "session/session.h"

#include "app/events.h"
#include "app/light_list.h"
#include "app/way.h"
#include "cli/program/say.h"
#include "relight/view/slab_set.h"
#include "relight/view/view.h"

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
    vsnprintf(s->messages.last, sizeof s->messages.last, format, args);
    va_end(args);
    s->app.toast_s = APP_TOAST_S;
}

relume_status session_compare(struct session *s, const char *capture)
{
    return relume_capture_open(&s->capture, capture, relume_capture_params(.log = s->log));
}

// ---------------------------------------------------------------- documents

// The renderer first: its thread may be reading.
static void close_document(struct session *s)
{
    gl_renderer_destroy(&s->renderer);
    document_close(&s->document);
}

static void give_up(struct opening *o, const struct session *s)
{
    app_release(&o->app);
    document_close(&o->document);
    if (o->objects.objects != s->objects.objects)
        relume_objects_destroy(&o->objects.objects);
}

static void take_over(struct session *s, struct opening *o)
{
    close_document(s);
    app_release(&s->app);
    if (o->objects.objects != s->objects.objects)
        relume_objects_destroy(&s->objects.objects);
    s->document = o->document;
    s->app = o->app;
    s->objects = o->objects;
}

relume_status session_open(struct session *s, const char *path, const struct app_state *start,
                           bool look_ahead)
{
    const struct document_kind *kind = document_kind_of(path, &s->objects);
    struct opening opening = {.document = {.kind = kind}, .objects = s->objects};
    memcpy(opening.document.folder, s->document.folder, sizeof opening.document.folder);
    const relume_status status = kind->open(&opening, s, path, start, look_ahead);
    if (status) {
        give_up(&opening, s);
        return status;
    }
    take_over(s, &opening);
    if (kind->describe)
        kind->describe(s);
    return RELUME_OK;
}

bool session_can_edit(const struct session *s)
{
    const struct document_kind *kind = s->document.kind;
    return kind->can_edit && kind->can_edit(s);
}

relume_status session_edit(struct session *s, const char *words, const struct relume_log *log)
{
    if (!session_can_edit(s))
        return say(log, RELUME_EUNFIT,
                   "edit: expected a g-BRDF to be shown alone, or a folder of maps");
    return s->document.kind->edit(s, words, log);
}

// ---------------------------------------------------------------- renderers

bool session_by_library(enum session_relight by, const struct gl *gl)
{
    return by == SESSION_LIBRARY || (by == SESSION_AUTO && gl->software);
}

relume_status session_make_bare(struct session *s)
{
    const struct code_source nothing = {.user = NULL};
    return gl_renderer_create(&s->renderer, &s->window.gl, &nothing, &s->app.file.geometry, NULL, 1,
                              s->log);
}

relume_status session_make_stage(struct session *s)
{
    static const double uv[1][2] = {{0.0, 0.0}};
    const relume_status status = session_make_bare(s);
    if (!status)
        gl_renderer_use_slabs(&s->renderer, s->document.slabs, uv, NULL);
    return status;
}

// ---------------------------------------------------------------- windows

static relume_status make_renderer(struct session *s)
{
    return s->document.kind->make(s);
}

// The panel's width is known.
static void arrange_panel(struct session *s)
{
    s->app.dock_width = panel_width(s->panel.panel);
    app_arrange(&s->app);
}

static double panel_scale(const struct session *s, double screen)
{
    return s->settings.ui_scale > 0 ? s->settings.ui_scale : screen;
}

relume_status session_start(struct session *s, const struct context_backend *backend, int width,
                            int height)
{
    struct session_window *w = &s->window;
    relume_status status = session_window_open(w, backend, width, height, s->document.name, s->log);
    if (!status)
        status = make_renderer(s);
    if (!status)
        status = session_panel_create(&s->panel, &w->gl, panel_scale(s, backend->scale(w->context)),
                                      s->log);
    if (!status)
        arrange_panel(s);
    return status;
}

relume_status session_scale(struct session *s, double scale)
{
    const relume_status status =
        session_panel_resize(&s->panel, &s->window.gl, panel_scale(s, scale), s->log);
    if (!status)
        arrange_panel(s);
    return status;
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
    to->capacity = state.capacity;
    to->selected = state.selected;
    return RELUME_OK;
}

static relume_status replace_document(struct session *s, const char *path, bool *opened)
{
    session_record_stop(s);
    const struct app was = s->app;
    inspect_destroy(&s->panel.inspector);
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
    messages_listen(&s->messages);
    *opened = !status && !session_open(s, path, &start, true);
    messages_stop(&s->messages);
    light_list_release(&start);
    if (s->messages.notice[0])
        session_say(s, "%s", s->messages.notice);
    if (!*opened)
        return status;
    if (!s->app.near_lights) {
        // It is not known where they would stand.
        light_list_drop_near(&s->app.start);
        light_list_drop_near(&s->app.now);
    }
    const double toast_s = s->messages.notice[0] ? APP_TOAST_S : 0;
    keep_window(&s->app, &was);
    s->app.toast_s = toast_s;
    relume_capture_destroy(&s->capture);
    s->app.compared = false;
    return make_renderer(s);
}

relume_status session_drop(struct session *s, const char *path)
{
    bool opened;
    return replace_document(s, path, &opened);
}

relume_status session_show(struct session *s, const char *path)
{
    bool opened;
    const relume_status status = replace_document(s, path, &opened);
    return status || opened ? status : RELUME_EUNFIT;
}

void session_close(struct session *s)
{
    session_record_stop(s);
    (void)!film_close(&s->film, false);
    session_window_forget_screen(&s->window);
    session_panel_destroy(&s->panel, &s->window.gl);
    close_document(s);
    relume_objects_destroy(&s->objects.objects);
    session_window_close(&s->window);
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
    if (s->document.beside_warned || !s->document.pack)
        return;
    const double share = share_beside(&s->request, s->renderer.views.grid, s->document.slabs);
    if (share < 0.01)
        return;
    snprintf(text, sizeof text,
             "%.0f %% of the picture lies beyond the cameras: shown as the nearest of them see it, "
             "black where none does",
             100.0 * share);
    s->log->message(s->log->user, RELUME_NOTE, text);
    s->document.beside_warned = true;
}

relume_status session_render(struct session *s)
{
    relume_status status = frame_request_make(&s->request, &s->app);
    s->renderer.exchange.waits = !s->streams || s->finishes || session_records(s);
    if (!status)
        status = gl_renderer_draw(&s->renderer, &s->request);
    if (!status)
        warn_beside(s);
    return status;
}

// The first frame is drawn once more, with the exposure that it asks for.
static relume_status meter_frame(struct session *s)
{
    const double before = app_exposure_ev(&s->app);
    double ev;
    const relume_status status =
        gl_renderer_meter(&ev, &s->renderer, relume_tones[s->app.now.tone]);
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
    if ((shown || event->kind == APP_RELEASE) && panel_takes(s->panel.panel, event))
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
    return changed || shown || s->app.action;
}

relume_status session_draw(struct session *s)
{
    relume_status status = panel_shown(&s->app) ? session_build_panel(s, false) : RELUME_OK;
    const bool acted = s->app.action;
    if (!status)
        status = session_perform_action(s);
    if (!status && acted && panel_shown(&s->app))
        status = session_build_panel(s, false);  // with what is said of it
    const bool recorded = !status && session_records(s) && !session_record_step(s);
    if (!status && !recorded)
        status = session_render(s);
    if (!status && !recorded && s->app.now.auto_exposure)
        status = meter_frame(s);
    return status ? status : session_add_histogram(s);
}

bool session_is_busy(const struct session *s)
{
    return s->app.action || session_records(s);
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
        draw_panel(&s->panel.drawing, &s->window.gl, s->panel.panel, app_window_width(&s->app),
                   s->app.height);
}
