// session_actions.c - what keys and the panel ask for and the app cannot do
#include "session/session.h"

#include "app/keys.h"
#include "cli/program/state_line.h"
#include "common/vec.h"
#include "relight/view/slab_set.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// "NAME-0001.png" with the first number that is free.
static void free_name(char *path, size_t size, const struct session *s, const char *extension)
{
    const char *dot = strrchr(s->document.name, '.');
    const int stem = dot ? (int)(dot - s->document.name) : (int)strlen(s->document.name);
    for (int i = 1; i < 10000; i++) {
        snprintf(path, size, "%.*s-%04d%s", stem, s->document.name, i, extension);
        if (access(path, F_OK))
            return;
    }
}

static void say_saved(struct session *s, const char *path, relume_status status)
{
    if (status)
        session_say(s, "%.200s could not be saved", path);
    else
        session_say(s, "saved %.200s", path);
}

static relume_status save_picture(struct session *s, const char *extension)
{
    char path[SESSION_TEXT + 16];
    free_name(path, sizeof path, s, extension);
    const bool ball = s->app.now.ball;
    s->app.now.ball = false;
    const relume_status status = session_frame(s, path);
    s->app.now.ball = ball;
    say_saved(s, path, status);
    return RELUME_OK;
}

static relume_status save_png(struct session *s)
{
    return save_picture(s, ".png");
}

static relume_status save_exr(struct session *s)
{
    return save_picture(s, ".exr");
}

static relume_status begin_recording(struct session *s, enum record_kind kind, const char *ending)
{
    char path[SESSION_TEXT + 16];
    free_name(path, sizeof path, s, ending);
    if (session_record_begin(s, kind, path, RECORD_FRAMES))
        session_say(s, "%.200s could not be recorded", path);
    return RELUME_OK;
}

static relume_status record_sweep(struct session *s)
{
    return begin_recording(s, RECORD_SWEEP, "-sweep");
}

static relume_status record_turntable(struct session *s)
{
    return begin_recording(s, RECORD_TURNTABLE, "-turntable");
}

static relume_status save_rig(struct session *s)
{
    char path[SESSION_TEXT + 16];
    free_name(path, sizeof path, s, ".json");
    const relume_status status = session_save_rig(s, path);
    say_saved(s, path, status);
    return RELUME_OK;
}

// To whom it is shown may be the clipboard, or the terminal where there is none.
static relume_status copy_state(struct session *s)
{
    char line[STATE_LINE_MOST];
    const relume_status status = session_state_line(line, sizeof line, s);
    if (status == RELUME_ENOMEM)
        return status;
    if (!status && s->window.backend->copy)
        s->window.backend->copy(s->window.context, line);
    else if (!status)
        puts(line);
    session_say(s, status ? "this view is too long for a line; save its lights as a rig (W)"
                          : "copied: relume relight --state and published pages show this view");
    return RELUME_OK;
}

static relume_status add_light(struct session *s)
{
    const bool added = !session_light(s, s->app.spec, false);
    session_say(s, added ? "light added: %.200s" : "not a light: %.200s", s->app.spec);
    return RELUME_OK;
}

static relume_status use_map(struct session *s)
{
    const bool shown = !session_map(s, s->app.spec);
    session_say(s, shown ? "environment: %.200s" : "not an environment map: %.200s", s->app.spec);
    return RELUME_OK;
}

static relume_status toggle_full_screen(struct session *s)
{
    if (!s->window.backend->full_screen)
        return RELUME_OK;
    s->window.full_screen = !s->window.full_screen;
    s->window.backend->full_screen(s->window.context, s->window.full_screen);
    return RELUME_OK;
}

static relume_status browse_folder(struct session *s)
{
    return session_browse(s, s->app.spec);
}

static relume_status open_file(struct session *s)
{
    char path[APP_SPEC];
    snprintf(path, sizeof path, "%s", s->app.spec);
    return session_drop(s, path);
}

// What goes wrong is said in the panel.
static relume_status edit_in_words(struct session *s,
                                   relume_status (*act)(struct session *, const char *,
                                                        const struct relume_log *),
                                   const char *did, const char *did_not)
{
    char words[SESSION_TEXT];
    snprintf(words, sizeof words, "%.200s", s->app.spec);
    messages_listen(&s->messages);
    const bool done = !act(s, s->app.spec, s->log);
    messages_stop(&s->messages);
    if (!done)
        session_say(s, "%s: %.200s", did_not, s->messages.notice);
    else if (did)
        session_say(s, "%s: %s", did, words);
    return RELUME_OK;
}

static relume_status edit_document(struct session *s)
{
    const bool writes = !strncmp(s->app.spec, "write ", 6);
    return edit_in_words(s, session_edit, writes ? "done" : "edited",
                         writes ? "not written" : "not edited");
}

static relume_status edit_reflection(struct session *s)
{
    const relume_status status = edit_in_words(s, session_reflect, NULL, "not done");
    session_hear_handles(s);
    return status;
}

// For an eye that goes around, the plane in focus is given by its distance in front of the look-at
// point.
static double focus_at(const struct session *s, struct relume_vec3 p)
{
    struct relume_window w;
    if (!s->app.file.around || !app_window(&s->app, &w))
        return p.z;
    const struct relume_vec3 normal = vec3_unit(vec3_cross(w.right, w.down));
    return relume_window_distance(&w) - fabs(vec3_dot(vec3_sub(p, w.eye), normal));
}

// With a pinhole everything is sharp: it is opened.
static relume_status focus_at_cursor(struct session *s)
{
    struct app *app = &s->app;
    struct relume_vec3 p;
    const relume_status status = frame_request_make(&s->request, app);
    if (status)
        return status;
    const bool known =
        visible_surface(&p, &s->request, &s->renderer.backdrop, app->cursor[0], app->cursor[1]);
    if (!known && app->file.around) {
        session_say(s, "nothing to focus on there; click on the object");
        return RELUME_OK;
    }
    app->now.focus_z = known ? focus_at(s, p) : app->file.geometry.st_z;
    if (app->now.aperture <= 0)
        (void)keys_press(app, 'a', false);
    session_say(s,
                known ? "in focus: %.3g; aperture %.3g (A: next aperture)"
                      : "this file has no depth: the plane z = %.3g is in focus; aperture %.3g",
                app->now.focus_z, app->now.aperture);
    return RELUME_OK;
}

// An action is performed once; what fails is said in the panel and in the log.
relume_status session_perform_action(struct session *s)
{
    static relume_status (*const actions[])(struct session *) = {
        [APP_ACTION_PNG] = save_png,
        [APP_ACTION_EXR] = save_exr,
        [APP_ACTION_SAVE_RIG] = save_rig,
        [APP_ACTION_SWEEP] = record_sweep,
        [APP_ACTION_TURNTABLE] = record_turntable,
        [APP_ACTION_COPY] = copy_state,
        [APP_ACTION_NOTES] = session_notes_show,
        [APP_ACTION_NOTE] = session_notes_add,
        [APP_ACTION_NOTE_SAVE] = session_notes_save,
        [APP_ACTION_NOTE_BACK] = session_notes_back,
        [APP_ACTION_ADD_LIGHT] = add_light,
        [APP_ACTION_MAP] = use_map,
        [APP_ACTION_FULL_SCREEN] = toggle_full_screen,
        [APP_ACTION_FOLDER] = browse_folder,
        [APP_ACTION_OPEN] = open_file,
        [APP_ACTION_EDIT] = edit_document,
        [APP_ACTION_REFLECTION] = edit_reflection,
        [APP_ACTION_FOCUS] = focus_at_cursor,
    };
    const enum app_action action = s->app.action;
    s->app.action = APP_ACTION_NONE;
    if ((size_t)action >= sizeof actions / sizeof *actions || !actions[action])
        return RELUME_OK;
    return actions[action](s);
}
