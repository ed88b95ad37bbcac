// session_record.c - a recording, picture by picture: every drawn frame is one of it
#include "app/events.h"
#include "session/session.h"

#include "app/light_list.h"

#include <stdio.h>

relume_status session_film_add(struct session *s, struct film *film, struct relume_image *image)
{
    const bool go_on = s->log->progress(s->log->user, "recording", 0);
    const relume_status status = go_on ? film_add(film, image) : RELUME_ECANCEL;
    relume_image_destroy(image);
    return status;
}

bool session_records(const struct session *s)
{
    return s->recording.film != NULL;
}

relume_status session_record_begin(struct session *s, enum record_kind kind, const char *path,
                                   int frames)
{
    struct recording *r = &s->recording;
    struct recording made = {.kind = kind, .frames = frames};
    if (!light_list_copy(&made.before, &s->app.now))
        return RELUME_ENOMEM;
    const relume_status status = film_open(&made.film, path, RECORD_RATE, false, s->log);
    if (status) {
        light_list_release(&made.before);
        return status;
    }
    snprintf(made.path, sizeof made.path, "%s", path);
    *r = made;
    s->app.now.ball = false;
    s->app.recording = true;
    return RELUME_OK;
}

static void restore_app(struct session *s)
{
    light_list_release(&s->app.now);
    s->app.now = s->recording.before;
    s->app.recording = false;
    s->recording = (struct recording){.film = NULL};
}

// What was recorded so far becomes the recording; none is left when that is nothing.
static relume_status finish_recording(struct session *s)
{
    struct recording *r = &s->recording;
    const relume_status status = film_close(&r->film, r->frame > 0);
    if (r->frame && !status)
        session_say(s, "recorded %.200s, %d picture%s", r->path, r->frame, relume_plural(r->frame));
    else
        session_say(s, "%.200s was not recorded", r->path);
    restore_app(s);
    return status;
}

void session_record_stop(struct session *s)
{
    if (session_records(s))
        (void)finish_recording(s);
}

static relume_status fail_recording(struct session *s, relume_status status)
{
    struct recording *r = &s->recording;
    (void)!film_close(&r->film, false);
    session_say(s, "%.200s was not recorded", r->path);
    restore_app(s);
    return status;
}

relume_status session_record_step(struct session *s)
{
    struct recording *r = &s->recording;
    struct relume_image image = {0};
    if (r->frame != r->posed)
        app_live(&s->app, 1.0 / RECORD_RATE);
    r->posed = r->frame;
    relume_status status = record_pose(&s->app, r->kind, (double)r->frame / r->frames, s->log);
    if (!status)
        status = session_render(s);
    if (!status && gl_renderer_is_pending(&s->renderer))
        return RELUME_OK;  // the same picture again, when all of it is there
    if (!status)
        status = session_read(&image, s, false);
    if (!status)
        status = session_film_add(s, r->film, &image);
    if (status)
        return fail_recording(s, status);
    r->frame++;
    return r->frame == r->frames ? finish_recording(s) : RELUME_OK;
}

relume_status session_record(struct session *s, enum record_kind kind, const char *path, int frames)
{
    relume_status status = session_record_begin(s, kind, path, frames);
    while (!status && session_records(s))
        status = session_record_step(s);
    return status;
}
