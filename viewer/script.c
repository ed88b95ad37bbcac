#include "script.h"

#include "options.h"
#include "say.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

enum { LINE = 4096 };

struct player {
    struct app *app;
    script_frame *frame;
    void *user;
    const struct relume_log *log;
    const char *path;
    int line;
};

struct word {
    const char *name;
    relume_status (*play)(struct player *p, char *rest);
};

static relume_status wrong(const struct player *p, const char *expected, const char *found)
{
    return say(p->log, RELUME_EDATA, "%s: line %d; expected %s; found '%s'", p->path, p->line,
               expected, found);
}

static void send(struct player *p, struct app_event event)
{
    (void)app_handle(p->app, &event);
}

// Removes quotes around the rest of a line.
static char *unquoted(char *text)
{
    const size_t n = strlen(text);
    if (n < 2 || text[0] != '"' || text[n - 1] != '"')
        return text;
    text[n - 1] = '\0';
    return text + 1;
}

static relume_status play_size(struct player *p, char *rest)
{
    double n[2];
    if (!options_numbers(rest, n, 2) || n[0] < 1 || n[1] < 1 || n[0] > 65536 || n[1] > 65536)
        return wrong(p, "size W H", rest);
    send(p, (struct app_event){.kind = APP_SIZE, .width = (int)n[0], .height = (int)n[1]});
    return RELUME_OK;
}

static relume_status play_drag(struct player *p, char *rest)
{
    double n[4];
    const bool right = !strncmp(rest, "right ", 6);
    if ((!right && strncmp(rest, "left ", 5)) || !options_numbers(rest + 5 + right, n, 4))
        return wrong(p, "drag left|right x0 y0 x1 y1", rest);
    const enum app_button button = right ? APP_RIGHT : APP_LEFT;
    send(p, (struct app_event){.kind = APP_PRESS, .button = button, .x = n[0], .y = n[1]});
    send(p, (struct app_event){.kind = APP_MOVE, .x = n[2], .y = n[3]});
    send(p, (struct app_event){.kind = APP_RELEASE, .button = button, .x = n[2], .y = n[3]});
    return RELUME_OK;
}

static relume_status play_wheel(struct player *p, char *rest)
{
    double n[3] = {0, 0.5 * p->app->width, 0.5 * p->app->height};
    if (!options_numbers(rest, n, 1) && !options_numbers(rest, n, 3))
        return wrong(p, "wheel STEPS [x y]", rest);
    send(p, (struct app_event){.kind = APP_WHEEL, .wheel = n[0], .x = n[1], .y = n[2]});
    return RELUME_OK;
}

static relume_status play_key(struct player *p, char *rest)
{
    const bool escape = !strcmp(rest, "esc");
    if (!escape && strlen(rest) != 1)
        return wrong(p, "key K, one letter or sign, or esc", rest);
    const int key = escape ? APP_KEY_ESCAPE : rest[0];
    send(p, (struct app_event){.kind = APP_KEY_DOWN, .key = key});
    send(p, (struct app_event){.kind = APP_KEY_UP, .key = key});
    return RELUME_OK;
}

// One light in place of all.
static relume_status play_light(struct player *p, char *rest)
{
    struct relume_light light;
    const char *spec = unquoted(rest);
    if (options_light(&light, spec, p->log))
        return wrong(p, "light \"dir x y z [rgb r g b]\"", spec);
    p->app->now.light[0] = light;
    p->app->now.lights = 1;
    return RELUME_OK;
}

static relume_status play_frame(struct player *p, char *rest)
{
    const char *path = unquoted(rest);
    return path[0] ? p->frame(p->user, p->app, path) : wrong(p, "frame FILE", path);
}

static const struct word words[] = {
    {"size", play_size}, {"drag", play_drag},   {"wheel", play_wheel},
    {"key", play_key},   {"light", play_light}, {"frame", play_frame},
};

static relume_status play_line(struct player *p, char *line)
{
    line += strspn(line, " \t");
    line[strcspn(line, "\r\n")] = '\0';
    if (!line[0] || line[0] == '#')
        return RELUME_OK;
    const size_t length = strcspn(line, " \t");
    char *rest = line + length + strspn(line + length, " \t");
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strlen(words[i].name) == length && !strncmp(words[i].name, line, length))
            return words[i].play(p, rest);
    return wrong(p, "size, drag, wheel, key, light or frame", line);
}

relume_status script_play(struct app *app, const char *path, script_frame *frame, void *user,
                          const struct relume_log *log)
{
    struct player player = {app, frame, user, log, path, 0};
    FILE *file = fopen(path, "r");
    if (!file)
        return say(log, RELUME_EDATA, "%s: cannot be read; %s", path, strerror(errno));
    char line[LINE];
    relume_status status = RELUME_OK;
    while (!status && !app->quit && fgets(line, sizeof line, file)) {
        player.line++;
        status = play_line(&player, line);
    }
    fclose(file);
    return status;
}
