// main.c - relume-view: a file in a window, or in pictures written without one
#include "app/events.h"
#include "app/script.h"
#include "cli/program/clock.h"
#include "cli/program/say.h"
#include "cli/program/stopping.h"
#include "session/options.h"
#include "session/session.h"
#include "session/settings.h"
#include "window/context_offscreen.h"

#include <math.h>
#include <relume/context.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

static void on_message(void *user, enum relume_level level, const char *text)
{
    struct session *s = user;
    char line[2048];
    if (messages_pass_on(&s->messages, level, text))
        return;
    snprintf(line, sizeof line, "%s", text);
    fprintf(stderr, "relume-view: %s%s\n", level == RELUME_WARNING ? "warning: " : "",
            relume_printable(line));
}

static bool on_progress(void *user, const char *what, double done)
{
    (void)user, (void)what, (void)done;
    return !stopping_asked();
}

static int exit_code(relume_status status)
{
    if (status == RELUME_ENOMEM)
        fputs("relume-view: out of memory\n", stderr);
    if (status == RELUME_ECANCEL) {
        fputs("relume-view: interrupted; what was unfinished is removed\n", stderr);
        return stopping_die();
    }
    return relume_status_exit(status);
}

// ---------------------------------------------------------------- frames

static relume_status show_frame(struct session *s)
{
    char title[640];
    const double start = 1e3 * now_s();
    const relume_status status = session_draw(s);
    if (status)
        return status;
    session_present(s, 0);
    s->window.gl.Finish();
    snprintf(title, sizeof title, "%s - %.1f ms%s%s - relume-view", s->document.name,
             1e3 * now_s() - start, s->messages.last[0] ? " - " : "", s->messages.last);
    s->window.backend->show(s->window.context, title);
    return RELUME_OK;
}

// ---------------------------------------------------------------- scripts

static void host_send(void *user, const struct app_event *event)
{
    (void)session_send(user, event);
}

// The listener hears of what it asked for, no more.
static relume_status end_listening(struct session *s, relume_status status)
{
    s->messages.listener = NULL;
    return status;
}

static relume_status host_light(void *user, const char *spec, bool replace,
                                const struct relume_log *log)
{
    struct session *s = user;
    s->messages.listener = log;
    return end_listening(s, session_light(s, spec, replace));
}

static relume_status host_rig(void *user, const char *path, const struct relume_log *log)
{
    struct session *s = user;
    s->messages.listener = log;
    return end_listening(s, session_load_rig(s, path));
}

static relume_status host_open(void *user, const char *path, const struct relume_log *log)
{
    struct session *s = user;
    s->messages.listener = log;
    return end_listening(s, session_show(s, path));
}

static relume_status host_edit(void *user, const char *words, const struct relume_log *log)
{
    struct session *s = user;
    s->messages.listener = log;
    return end_listening(s, session_edit(s, words, s->log));
}

static relume_status host_reflect(void *user, const char *words, const struct relume_log *log)
{
    struct session *s = user;
    s->messages.listener = log;
    const relume_status status = end_listening(s, session_reflect(s, words, s->log));
    session_hear_handles(s);
    return status;
}

static relume_status host_glare(void *user, const char *words, const char **expected)
{
    struct session *s = user;
    return observer_say(&s->app.now.observer, words, expected) ? RELUME_OK : RELUME_EFORMAT;
}

static const double frame_s = 1.0 / 60;  // between frames when time is played
static const double patience_s = 60;     // waiting for what never comes to rest

static relume_status host_wait(void *user, double seconds)
{
    struct session *s = user;
    const bool until_idle = seconds < 0;
    double left = until_idle ? patience_s : seconds;
    const double step = s->film ? 1.0 / RECORD_RATE : frame_s;
    bool moves = true;
    // a frame says what it moves towards: its exposure
    relume_status status = until_idle ? session_draw(s) : RELUME_OK;
    for (; !status && left > 1e-9 && (moves || !until_idle); left -= step) {
        moves = session_pass(s, fmin(left, step)) || gl_renderer_is_pending(&s->renderer);
        if (s->film)
            status = session_film(s);
        else if (moves || until_idle || observer_lives(&s->app.now.observer))
            status = (s->streams ? show_frame : session_draw)(s);
    }
    if (!status && until_idle && gl_renderer_expects(&s->renderer)) {
        status = gl_renderer_wait(&s->renderer);
        if (!status)
            status = show_frame(s);
    }
    return status;
}

static relume_status host_frame(void *user, const char *path)
{
    return session_frame(user, path);
}

static relume_status host_shot(void *user, const char *path)
{
    return session_shot(user, path);
}

static struct script_host host_of(struct session *s)
{
    return (struct script_host){s,          &s->app,   host_send,   host_light, host_rig,
                                host_open,  host_wait, host_frame,  host_shot,  s->log,
                                host_glare, host_edit, host_reflect};
}

// With all that the options ask for beside it.
static relume_status open_file(struct session *s, struct options *o, bool look_ahead)
{
    relume_status status = session_take_rig(s, &o->rig, &o->start);
    if (!status && o->capture)
        status = session_compare(s, o->capture);
    if (!status)
        status = object_set_open(&s->objects, &o->objects, s->settings.threads, s->log);
    return status ? status : session_open(s, o->file, &o->start, look_ahead);
}

// ---------------------------------------------------------------- without a window

static relume_status run_offscreen(struct session *s, struct options *o)
{
    const struct script_host host = host_of(s);
    const bool film = o->record && o->kind == RECORD_SCRIPT;
    o->start.ball |= film;
    relume_status status = open_file(s, o, film);
    if (!status)
        status = session_start(s, context_offscreen(o->gl), s->app.width, s->app.height);
    s->app.panel = o->panel;
    s->app.dock = o->dock;
    s->app.keep_lights = o->keep_lights;
    app_arrange(&s->app);
    if (!status && film)  // shows what a window would
        status = film_open(&s->film, o->output, RECORD_RATE, false, s->log);
    if (!status && o->script)
        status = script_play(o->script, &host);
    while (!status && session_is_busy(s))  // with what the script began
        status = session_draw(s);
    if (!status && film)
        status = film_close(&s->film, true);
    else if (!status && o->record)
        status = session_record(s, o->kind, o->output, o->frames);
    if (!status && o->offscreen)
        status = (o->panel ? session_shot : session_frame)(s, o->offscreen);
    return status;
}

// ---------------------------------------------------------------- in a window

// Without --size: the picture's own size, scaled to be neither a stamp nor larger than a desk.
static void choose_size(struct app *app, bool sized)
{
    const double least = 512;
    const double most[2] = {1280, 900};
    if (sized)
        return;
    double scale = fmax(1.0, least / fmax(app->width, app->height));
    scale = fmin(scale, fmin(most[0] / app->width, most[1] / app->height));
    app->width = (int)fmax(1.0, app->width * scale);
    app->height = (int)fmax(1.0, app->height * scale);
}

static relume_status take_event(struct session *s, const struct context_event *event, bool *changed)
{
    if (event->kind == CONTEXT_CLOSE)
        s->app.quit = true;
    if (event->kind == CONTEXT_INPUT)
        *changed |= session_send(s, &event->input);
    if (event->kind != CONTEXT_DROP && event->kind != CONTEXT_SCALE)
        return RELUME_OK;
    *changed = true;
    return event->kind == CONTEXT_DROP ? session_drop(s, event->dropped)
                                       : session_scale(s, event->scale);
}

// Time in seconds since the last call.
static double time_passed(double *then_ms)
{
    const double then = *then_ms;
    *then_ms = 1e3 * now_s();
    return 1e-3 * (*then_ms - then);
}

static bool is_over(const struct session *s)
{
    return s->app.quit || stopping_asked();
}

// How long nothing changes by itself, seconds: a picture that another thread makes is looked for
// now and then.
static double still_s(const struct session *s)
{
    const double LOOK_S = 0.05, steady = app_steady_s(&s->app);
    return gl_renderer_expects(&s->renderer) ? fmin(steady, LOOK_S) : steady;
}

static relume_status take_events(struct session *s, bool *changed, double *time_ms)
{
    relume_status status = RELUME_OK;
    struct context_event event;
    *changed |= session_pass(s, time_passed(time_ms));
    while (!status && !is_over(s) &&
           s->window.backend->next(s->window.context, &event, *changed ? 0 : still_s(s))) {
        *changed |= session_pass(s, time_passed(time_ms));
        status = take_event(s, &event, changed);
    }
    return status;
}

static relume_status play_window(struct session *s, struct script *script)
{
    relume_status status = RELUME_OK;
    bool more = script != NULL;
    bool changed = true;
    double time_ms = 1e3 * now_s();
    while (!status && !is_over(s)) {
        if (more)
            status = script_step(script, &more);
        if (script && !more && script_leaves(script))
            s->app.quit = true;
        changed |= more;
        if (!status)
            status = take_events(s, &changed, &time_ms);
        if (!status && changed && !is_over(s))
            status = show_frame(s);
        changed =
            !status && (gl_renderer_is_pending(&s->renderer) || session_is_busy(s) ||
                        gl_renderer_has_news(&s->renderer) || observer_lives(&s->app.now.observer));
    }
    return status || !stopping_asked() ? status : RELUME_ECANCEL;
}

static bool has_near_light(const relume_rig *rig)
{
    for (int i = 0; i < relume_rig_count(rig); i++)
        if (relume_light_is_near(relume_rig_entry(rig, i)->light.kind))
            return true;
    return false;
}

// The lights of the last time, where that was asked for and the command names none. Near ones
// belong to the scene that they stood in.
static void recall_rig(struct options *o, const struct settings *settings)
{
    if (o->rig || !(o->keep_lights || settings->keep_lights) || !settings->rig[0] ||
        relume_rig_load(&o->rig, settings->rig, NULL))
        return;
    if (has_near_light(o->rig) || relume_rig_count(o->rig) > APP_LIGHTS)
        relume_rig_destroy(&o->rig);
}

static void keep_settings(struct session *s, struct settings *settings)
{
    const struct relume_log *log = s->log;
    if (!s->window.full_screen) {
        settings->width = app_window_width(&s->app);
        settings->height = s->app.height;
    }
    settings->dock = s->app.dock;
    settings->keep_lights = s->app.keep_lights;
    settings->panel = s->app.panel;
    settings_save(settings);
    s->log = NULL;  // a rig that cannot be kept is no news
    if (settings->rig[0] && s->app.keep_lights)
        (void)session_save_rig(s, settings->rig);
    s->log = log;
}

static relume_status open_window(struct session *s, struct options *o,
                                 const struct settings *settings)
{
    o->start.ball = o->file || o->stage;
    relume_status status = open_file(s, o, true);
    if (status)
        return status;
    if (settings->width && !(o->size[0] || o->size[1])) {
        s->app.width = settings->width;
        s->app.height = settings->height;
    } else {
        choose_size(&s->app, o->size[0] || o->size[1]);
    }
    s->app.panel = o->panel || settings->panel;
    s->app.dock = o->docked ? o->dock : (enum app_dock)settings->dock;
    s->app.keep_lights = o->keep_lights || settings->keep_lights;
    s->app.hint_s = APP_HINT_S;
    status = session_start(s, &context_glfw, s->app.width, s->app.height);
    if (status)
        return status;
    struct app_event opened = {.kind = APP_SIZE};
    s->window.backend->size(s->window.context, &opened.width, &opened.height);
    (void)app_handle(&s->app, &opened);
    return RELUME_OK;
}

static relume_status run_window(struct session *s, struct options *o)
{
    const struct script_host host = host_of(s);
    struct settings settings = {0};
    struct script *script = NULL;
    s->streams = true;
    if (!o->no_config) {
        settings_load(&settings);
        recall_rig(o, &settings);
    }
    relume_status status = open_window(s, o, &settings);
    const bool opened = !status;
    if (!status && o->script)
        status = script_open(&script, o->script, &host);
    if (!status)
        status = play_window(s, script);
    script_close(&script);
    if (opened && !o->no_config)
        keep_settings(s, &settings);  // also when the graphics card went away
    return status;
}

int main(int argc, char **argv)
{
    static struct session session;
    struct options options;
    struct relume_log log = {.message = on_message, .progress = on_progress, .user = &session};
    session.log = &log;
    stopping_listen("relume-view", NULL);
    signal(SIGXFSZ, SIG_IGN);  // a file size limit is a write error, not a death
    signal(SIGPIPE, SIG_IGN);
    relume_status status = relume_context_create(
        &log.context, relume_context_params(.limits = &options.limits, .keep_inputs = true));
    if (status)
        return exit_code(status);
    status = options_parse(&options, argc, argv, &log);
    session.settings = (struct session_settings){
        .threads = options.threads,
        .vram_bytes = (size_t)(options.vram_mb * 1048576.0),
        .relight = options.relight,
        .glare = options.glare,
        .glare_size = options.glare_size,
        .subject = &options.subject,
        .ui_scale = options.ui_scale,
    };
    const bool offscreen =
        options.offscreen || options.record || (options.script && !options.window);
    if (!status && options.help)
        options_help();
    else if (!status)
        status = (offscreen ? run_offscreen : run_window)(&session, &options);
    session_close(&session);
    options_release(&options);
    relume_context_destroy(&log.context);
    return exit_code(status);
}
