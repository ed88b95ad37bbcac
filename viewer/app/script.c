// script.c - a text file of events, played as if a user made them
#include "app/script.h"

#include "app/adjust.h"
#include "app/app.h"
#include "app/way.h"
#include "cli/program/say.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 4096 };

struct script {
    struct script_host host;
    FILE *file;
    char path[LINE];
    char text[LINE];
    const char *at;  // in `text`: what is read next
    int line;
    bool leaves;  // the last event was Esc
};

// ---------------------------------------------------------------- words of a line

static void skip_blanks(struct script *s)
{
    s->at += strspn(s->at, " \t");
}

static bool at_end(struct script *s)
{
    skip_blanks(s);
    return !*s->at;
}

static relume_status refuse_line(struct script *s, const char *expected)
{
    skip_blanks(s);
    return say(s->host.log, RELUME_EFORMAT, "%s: line %d, column %d; expected %s; found '%s'",
               s->path, s->line, (int)(s->at - s->text) + 1, expected,
               *s->at ? s->at : "end of line");
}

static bool take_word(struct script *s, const char *word)
{
    const size_t n = strlen(word);
    skip_blanks(s);
    if (strncmp(s->at, word, n) || (s->at[n] && !strchr(" \t", s->at[n])))
        return false;
    s->at += n;
    return true;
}

static bool take_numbers(struct script *s, double *out, int count)
{
    for (int i = 0; i < count; i++) {
        char *end;
        skip_blanks(s);
        out[i] = strtod(s->at, &end);
        if (end == s->at || !isfinite(out[i]) || (*end && !strchr(" \t", *end)))
            return false;
        s->at = end;
    }
    return true;
}

static bool take_button(struct script *s, enum app_button *out)
{
    *out = take_word(s, "right") ? APP_RIGHT : APP_LEFT;
    return *out == APP_RIGHT || take_word(s, "left");
}

// The rest of the line without the quotes around it; NULL when nothing is left.
static const char *take_rest(struct script *s, char copy[LINE])
{
    if (at_end(s))
        return NULL;
    strcpy(copy, s->at);
    size_t n = strlen(copy);
    while (n && strchr(" \t", copy[n - 1]))
        copy[--n] = '\0';
    if (n < 2 || copy[0] != '"' || copy[n - 1] != '"')
        return copy;
    copy[n - 1] = '\0';
    return copy + 1;
}

static bool take_key(struct script *s, int *out)
{
    static const struct {
        const char *name;
        int key;
    } names[] = {
        {"esc", APP_KEY_ESCAPE},
        {"tab", APP_KEY_TAB},
        {"enter", APP_KEY_ENTER},
        {"backspace", APP_KEY_BACKSPACE},
        {"delete", APP_KEY_DELETE},
        {"left", APP_KEY_LEFT},
        {"right", APP_KEY_RIGHT},
        {"up", APP_KEY_UP_ARROW},
        {"down", APP_KEY_DOWN_ARROW},
        {"pageup", APP_KEY_PAGE_UP},
        {"pagedown", APP_KEY_PAGE_DOWN},
        {"home", APP_KEY_HOME},
        {"end", APP_KEY_END},
        {"f11", APP_KEY_F11},
    };
    skip_blanks(s);
    const bool control = !strncmp(s->at, "ctrl+", 5);
    const char *sign = s->at + (control ? 5 : 0);
    const char *const from = s->at;
    s->at = sign;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (take_word(s, names[i].name)) {
            *out = names[i].key | (control ? APP_CONTROL : 0);
            return true;
        }
    s->at = from;
    if (sign[0] <= ' ' || sign[0] > '~' || (sign[1] && !strchr(" \t", sign[1])))
        return false;
    *out = sign[0] | (control ? APP_CONTROL : 0);
    s->at = sign + 1;
    return true;
}

// ---------------------------------------------------------------- events

static void send(struct script *s, struct app_event event)
{
    event.unasked = true;
    if (event.kind != APP_KEY_UP)
        s->leaves = event.kind == APP_KEY_DOWN && event.key == APP_KEY_ESCAPE;
    s->host.send(s->host.user, &event);
}

static relume_status play_size(struct script *s)
{
    double n[2];
    const char *at = s->at;
    if (!take_numbers(s, n, 2))
        return refuse_line(s, "size W H");
    if (n[0] < 1 || n[1] < 1 || n[0] > 65536 || n[1] > 65536) {
        s->at = at;
        return refuse_line(s, "a width and a height from 1 to 65536");
    }
    send(s, (struct app_event){.kind = APP_SIZE, .width = (int)n[0], .height = (int)n[1]});
    return RELUME_OK;
}

static relume_status play_drag(struct script *s)
{
    double n[5] = {0};
    enum app_button button;
    relume_status status = RELUME_OK;
    if (!take_button(s, &button) || !take_numbers(s, n, 4) ||
        (!at_end(s) && (!take_numbers(s, n + 4, 1) || n[4] < 0 || n[4] > 3600)))
        return refuse_line(s, "drag left|right x0 y0 x1 y1 [SECONDS]");
    const int moves = n[4] > 0 ? (int)fmax(8, 25 * n[4]) : 1;  // as a film has pictures
    send(s, (struct app_event){.kind = APP_MOVE, .x = n[0], .y = n[1]});
    send(s, (struct app_event){.kind = APP_PRESS, .button = button, .x = n[0], .y = n[1]});
    for (int i = 1; !status && i <= moves; i++) {
        const double part = (double)i / moves;
        send(s, (struct app_event){.kind = APP_MOVE,
                                   .x = n[0] + part * (n[2] - n[0]),
                                   .y = n[1] + part * (n[3] - n[1])});
        if (n[4] > 0)
            status = s->host.wait(s->host.user, n[4] / moves);
    }
    send(s, (struct app_event){.kind = APP_RELEASE, .button = button, .x = n[2], .y = n[3]});
    return status;
}

static relume_status play_click(struct script *s)
{
    double n[2];
    if (!take_numbers(s, n, 2))
        return refuse_line(s, "click x y");
    send(s, (struct app_event){.kind = APP_MOVE, .x = n[0], .y = n[1]});
    send(s, (struct app_event){.kind = APP_PRESS, .x = n[0], .y = n[1]});
    send(s, (struct app_event){.kind = APP_RELEASE, .x = n[0], .y = n[1]});
    return RELUME_OK;
}

static relume_status play_press(struct script *s)
{
    double n[2];
    enum app_button button;
    if (!take_button(s, &button) || !take_numbers(s, n, 2))
        return refuse_line(s, "press left|right x y");
    send(s, (struct app_event){.kind = APP_MOVE, .x = n[0], .y = n[1]});
    send(s, (struct app_event){.kind = APP_PRESS, .button = button, .x = n[0], .y = n[1]});
    return RELUME_OK;
}

static relume_status play_release(struct script *s)
{
    double n[2];
    enum app_button button;
    if (!take_button(s, &button) || !take_numbers(s, n, 2))
        return refuse_line(s, "release left|right x y");
    send(s, (struct app_event){.kind = APP_RELEASE, .button = button, .x = n[0], .y = n[1]});
    return RELUME_OK;
}

static relume_status play_move(struct script *s)
{
    double n[2];
    if (!take_numbers(s, n, 2))
        return refuse_line(s, "move x y");
    send(s, (struct app_event){.kind = APP_MOVE, .x = n[0], .y = n[1]});
    return RELUME_OK;
}

static relume_status play_wheel(struct script *s)
{
    double n[3] = {0, 0.5 * s->host.app->width, 0.5 * s->host.app->height};
    if (!take_numbers(s, n, 1) || (!at_end(s) && !take_numbers(s, n + 1, 2)))
        return refuse_line(s, "wheel STEPS [x y]");
    send(s, (struct app_event){.kind = APP_WHEEL, .wheel = n[0], .x = n[1], .y = n[2]});
    return RELUME_OK;
}

static void press_key(struct script *s, int key)
{
    send(s, (struct app_event){.kind = APP_KEY_DOWN, .key = key});
    send(s, (struct app_event){.kind = APP_KEY_UP, .key = key});
}

static relume_status play_key(struct script *s)
{
    int key;
    if (!take_key(s, &key))
        return refuse_line(
            s, "key K: one letter or sign, esc, tab, enter, left, right, up, down, ..., "
               "ctrl+ a letter");
    press_key(s, key);
    return RELUME_OK;
}

static relume_status play_hold(struct script *s)
{
    int key;
    if (!take_key(s, &key))
        return refuse_line(s, "hold K");
    send(s, (struct app_event){.kind = APP_KEY_DOWN, .key = key});
    return RELUME_OK;
}

static relume_status play_let(struct script *s)
{
    int key;
    if (!take_key(s, &key))
        return refuse_line(s, "let K");
    send(s, (struct app_event){.kind = APP_KEY_UP, .key = key});
    return RELUME_OK;
}

static relume_status play_type(struct script *s)
{
    char copy[LINE];
    const char *text = take_rest(s, copy);
    if (!text)
        return refuse_line(s, "type TEXT");
    for (; *text; text++)
        send(s, (struct app_event){.kind = APP_TEXT, .key = (unsigned char)*text});
    return RELUME_OK;
}

// ---------------------------------------------------------------- beyond events

// Says where in the script it happened.
static void say_place(void *user, enum relume_level level, const char *text)
{
    const struct script *s = user;
    char line[2 * LINE];
    if (!s->host.log || !s->host.log->message)
        return;
    snprintf(line, sizeof line, "%s: line %d, column %d; %s", s->path, s->line,
             (int)(s->at - s->text) + 1, text);
    s->host.log->message(s->host.log->user, level, line);
}

// What is wrong with a light or a rig is the script's fault.
static relume_status blame_script(struct script *s, relume_status status)
{
    s->at += strlen(s->at);
    return status == RELUME_EINVAL ? RELUME_EFORMAT : status;
}

static relume_status set_light(struct script *s, bool replace)
{
    const struct relume_log log = {
        .message = say_place, .user = s, .context = s->host.log ? s->host.log->context : NULL};
    char copy[LINE];
    const char *spec = take_rest(s, copy);
    if (!spec)
        return refuse_line(s, "a light, as in \"dir 0 0 1\"");
    return blame_script(s, s->host.light(s->host.user, spec, replace, &log));
}

static relume_status play_light(struct script *s)
{
    return set_light(s, true);
}

static relume_status play_add(struct script *s)
{
    return set_light(s, false);
}

static relume_status with_path(struct script *s, relume_status (*act)(void *, const char *),
                               const char *expected)
{
    char copy[LINE];
    const char *path = take_rest(s, copy);
    s->at += strlen(s->at);
    return path ? act(s->host.user, path) : refuse_line(s, expected);
}

static relume_status with_file(struct script *s,
                               relume_status (*act)(void *, const char *,
                                                    const struct relume_log *),
                               const char *expected)
{
    const struct relume_log log = {.message = say_place, .user = s};
    char copy[LINE];
    const char *path = take_rest(s, copy);
    return path ? blame_script(s, act(s->host.user, path, &log)) : refuse_line(s, expected);
}

static relume_status play_rig(struct script *s)
{
    return with_file(s, s->host.rig, "rig FILE");
}

static relume_status play_open(struct script *s)
{
    return with_file(s, s->host.open, "open FILE");
}

static relume_status play_edit(struct script *s)
{
    return with_file(s, s->host.edit, "edit OPERATION VALUE ..., edit undo or edit redo");
}

static relume_status play_reflection(struct script *s)
{
    return with_file(
        s, s->host.reflect,
        "reflection on, off, tool, choose, delete, undo, redo, freeze, unfreeze, view, "
        "distance, radius, border or save");
}

static relume_status play_glare(struct script *s)
{
    char copy[LINE];
    const char *words = take_rest(s, copy), *expected = "glare on|off|...";
    const relume_status status = s->host.glare(s->host.user, words ? words : "", &expected);
    return status ? refuse_line(s, expected) : RELUME_OK;
}

static relume_status play_frame(struct script *s)
{
    return with_path(s, s->host.frame, "frame FILE");
}

static relume_status play_shot(struct script *s)
{
    return with_path(s, s->host.shot, "shot FILE");
}

static relume_status play_hint(struct script *s)
{
    s->host.app->hint_s = APP_HINT_S;
    return RELUME_OK;
}

static relume_status play_set(struct script *s)
{
    char copy[LINE];
    const char *words = take_rest(s, copy), *expected;
    return adjust_say(&s->host.app->now, words ? words : "", &expected) ? RELUME_OK
                                                                        : refuse_line(s, expected);
}

static relume_status play_transport(struct script *s)
{
    char copy[LINE], expected[WAY_WORDS];
    const char *words = take_rest(s, copy);
    return way_say(s->host.app, words ? words : "", expected) ? RELUME_OK
                                                              : refuse_line(s, expected);
}

static relume_status play_pass(struct script *s)
{
    char copy[LINE];
    const char *name = take_rest(s, copy);
    const enum relume_pass was = s->host.app->now.pass;
    if (!name || relume_pass_parse(&s->host.app->now.pass, name) ||
        (int)s->host.app->now.pass >= app_passes(s->host.app)) {
        s->host.app->now.pass = was;
        return refuse_line(s, "pass colour, normals, specular, diffuse-gain, unsharp, luminance, "
                              "false-colour, or difference beside --capture; of maps colour alone");
    }
    return RELUME_OK;
}

static relume_status play_dock(struct script *s)
{
    struct app *app = s->host.app;
    for (int i = 0; i < APP_DOCKS; i++)
        if (take_word(s, app_dock_names[i])) {
            if (app->panel)
                press_key(s, APP_KEY_TAB);
            app->dock = (enum app_dock)i;
            press_key(s, APP_KEY_TAB);  // whoever hears of it makes the panel at once
            return RELUME_OK;
        }
    return refuse_line(s, "dock over|left|right");
}

static relume_status play_quit(struct script *s)
{
    s->host.app->quit = true;
    return RELUME_OK;
}

static relume_status play_wait(struct script *s)
{
    double seconds = -1;
    const char *at = s->at;
    if (!at_end(s) && (!take_numbers(s, &seconds, 1) || seconds < 0 || seconds > 3600)) {
        s->at = at;
        return refuse_line(s, "wait [SECONDS], at most 3600");
    }
    return s->host.wait(s->host.user, seconds);
}

// ---------------------------------------------------------------- lines

static const struct word {
    const char *name;
    relume_status (*play)(struct script *s);
    bool whole;  // takes the rest of the line
} words[] = {
    {"size", play_size, false},
    {"drag", play_drag, false},
    {"click", play_click, false},
    {"press", play_press, false},
    {"move", play_move, false},
    {"release", play_release, false},
    {"wheel", play_wheel, false},
    {"key", play_key, false},
    {"hold", play_hold, false},
    {"let", play_let, false},
    {"type", play_type, true},
    {"light", play_light, true},
    {"add", play_add, true},
    {"rig", play_rig, true},
    {"wait", play_wait, false},
    {"frame", play_frame, true},
    {"shot", play_shot, true},
    {"open", play_open, true},
    {"glare", play_glare, true},
    {"hint", play_hint, false},
    {"quit", play_quit, false},
    {"dock", play_dock, false},
    {"set", play_set, true},
    {"pass", play_pass, true},
    {"edit", play_edit, true},
    {"reflection", play_reflection, true},
    {"transport", play_transport, true},
};

static relume_status play_line(struct script *s)
{
    s->text[strcspn(s->text, "\r\n")] = '\0';
    s->at = s->text;
    if (at_end(s) || *s->at == '#')
        return RELUME_OK;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (!take_word(s, words[i].name))
            continue;
        const relume_status status = words[i].play(s);
        return status || words[i].whole || at_end(s) ? status
                                                     : refuse_line(s, "the end of the line");
    }
    return refuse_line(
        s,
        "size, drag, click, press, move, release, wheel, key, hold, let, type, light, "
        "add, rig, open, edit, reflection, transport, glare, dock, hint, set, pass, wait, frame, "
        "shot or quit");
}

relume_status script_open(struct script **out, const char *path, const struct script_host *host)
{
    struct script *s = *out = calloc(1, sizeof *s);
    if (!s)
        return RELUME_ENOMEM;
    s->host = *host;
    snprintf(s->path, sizeof s->path, "%s", path);
    s->file = fopen(path, "r");
    if (s->file)
        return RELUME_OK;
    const int why = errno;
    script_close(out);
    return say(host->log, RELUME_ENOTFOUND, "%s: cannot be read; %s", path, strerror(why));
}

relume_status script_step(struct script *s, bool *more)
{
    *more = fgets(s->text, sizeof s->text, s->file) != NULL;
    if (ferror(s->file))
        return say(s->host.log, RELUME_ENOTFOUND, "%s: cannot be read; %s", s->path,
                   strerror(errno));
    if (!*more)
        return RELUME_OK;
    s->line++;
    if (!strchr(s->text, '\n') && !feof(s->file))
        return say(
            s->host.log, RELUME_EFORMAT,
            "%s: line %d, column %d; expected lines of at most %d characters; found a longer one",
            s->path, s->line, LINE - 1, LINE - 2);
    return play_line(s);
}

bool script_leaves(const struct script *s)
{
    return s->leaves;
}

void script_close(struct script **script)
{
    if (!*script)
        return;
    if ((*script)->file)
        fclose((*script)->file);
    free(*script);
    *script = NULL;
}

relume_status script_play(const char *path, const struct script_host *host)
{
    struct script *script;
    bool more = true;
    relume_status status = script_open(&script, path, host);
    while (!status && more && !host->app->quit)
        status = script_step(script, &more);
    script_close(&script);
    return status;
}
