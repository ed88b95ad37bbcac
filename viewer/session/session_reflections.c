// session_reflections.c - reflections edited by hand: what the handles must know of the scene, and
// the file that edits are saved to
#include "session/edits_text.h"
#include "session/session.h"

#include "app/handles.h"
#include "app/handles_say.h"
#include "cli/program/say.h"
#include "common/vec.h"
#include "world/object/drawn_objects.h"

#include <stdio.h>
#include <string.h>

// ---------------------------------------------------------------- the scene

static bool find_surface(void *user, struct relume_vec3 *out, double x, double y)
{
    struct session *s = user;
    return !frame_request_make(&s->request, &s->app) &&
           visible_surface(out, &s->request, &s->renderer.backdrop, x, y);
}

static bool find_reflected(void *user, struct relume_vec3 *out, struct relume_vec3 from,
                           struct relume_vec3 direction)
{
    struct session *s = user;
    const struct relume_image *places =
        app_is_panorama(&s->app.file) ? visible_places(&s->renderer.backdrop, 0) : NULL;
    return places &&
           relume_objects_reflected_place(out, &s->app.file.geometry, places, from, direction);
}

void session_lend_scene(struct session *s)
{
    if (s->document.pack)
        s->app.scene = (struct app_scene){s, find_surface, find_reflected};
}

// ---------------------------------------------------------------- the file

// Where edits were read or last saved, else beside the description.
void session_name_reflections(char path[APP_SPEC], const struct session *s)
{
    const char *description = s->objects.described, *dot = strrchr(description, '.');
    const int stem = dot && !strchr(dot, '/') ? (int)(dot - description) : -1;
    if (s->objects.reflections[0])
        snprintf(path, APP_SPEC, "%s", s->objects.reflections);
    else
        snprintf(path, APP_SPEC, "%.*s.reflections.json", stem, description);
}

// The list that was read may be replaced, which the log's context would not have.
static relume_status save_edits(struct session *s, const char *name, const struct relume_log *log)
{
    const struct relume_log bare = {.message = log ? log->message : NULL,
                                    .user = log ? log->user : NULL};
    char path[APP_SPEC];
    if (name[0])
        snprintf(path, sizeof path, "%s", name);
    else
        session_name_reflections(path, s);
    const relume_status status = relume_objects_save_reflections(s->objects.objects, path, &bare);
    if (status)
        return status;
    memcpy(s->objects.reflections, path, sizeof path);
    if (s->app.handles)
        s->app.handles->unsaved = false;
    session_say(s, "saved %.200s", path);
    return RELUME_OK;
}

relume_status session_reflect(struct session *s, const char *words, const struct relume_log *log)
{
    session_lend_scene(s);
    gl_renderer_let_go(&s->renderer);
    if (strncmp(words, "save", 4) || (words[4] && words[4] != ' '))
        return handles_say(&s->app, words, log);
    if (!handles_turn_on(&s->app, true))
        return handles_say(&s->app, "on", log);
    char name[APP_SPEC];
    snprintf(name, sizeof name, "%s", words + 4 + strspn(words + 4, " "));
    return save_edits(s, edits_unquote(name), log);
}

void session_hear_handles(struct session *s)
{
    if (!s->app.handles || !s->app.handles->said[0])
        return;
    session_say(s, "%.200s", s->app.handles->said);
    s->app.handles->said[0] = '\0';
}
