// crash.c - a capture whose coder crashed: what is said, and how it is encoded once more
#include "encode/encode/crash.h"

#include "encode/encode/request.h"

#include <stdio.h>
#include <string.h>

static void keep_error(void *user, enum relume_level level, const char *text)
{
    struct crash_watch *w = user;
    bool kept = false;
    if (level == RELUME_ERROR) {
        pthread_mutex_lock(&w->lock);
        kept = !w->error[0] || !strncmp(w->error, text, CRASH_TEXT - 1);
        if (kept)
            snprintf(w->error, sizeof w->error, "%s", text);
        pthread_mutex_unlock(&w->lock);
    }
    if (!kept)
        log_line(w->to, level, "%s", text);
}

static bool go_on(void *user, const char *what, double done)
{
    const struct crash_watch *w = user;
    return log_progress(w->to, what, done);
}

const struct relume_log *crash_watch_begin(struct crash_watch *out, const struct relume_log *to)
{
    out->to = to;
    out->error[0] = '\0';
    out->log = to ? *to : (struct relume_log){0};
    out->log.message = keep_error;
    out->log.progress = go_on;
    out->log.user = out;
    pthread_mutex_init(&out->lock, NULL);
    return &out->log;
}

void crash_watch_end(struct crash_watch *w, bool tell)
{
    if (tell && w->error[0])
        log_line(w->to, RELUME_ERROR, "%s", w->error);
    pthread_mutex_destroy(&w->lock);
}

void crash_say(const struct crash_watch *w, const struct relume_encode_capture_params *p,
               const relume_capture *capture)
{
    struct encode_request r;
    request_make(&r, NULL, capture, p);
    log_line(p->log, RELUME_WARNING, "%s: %s; %s; encode again for the file that was asked for",
             p->name ? p->name : "the capture", w->error,
             request_is_lossy(&r) ? "the file is lossless, and larger"
                                  : "shadows and highlights fade in the file");
}

struct relume_encode_capture_params crash_params(const struct relume_encode_capture_params *p)
{
    struct relume_encode_capture_params out = *p;
    out.psnr_db = out.bytes_per_pixel = out.jnd = 0.0;
    out.effort = RELUME_EFFORT_DEFAULT;
    out.lossless = true;
    out.shadows = out.highlights = RELUME_MOVING_NO;
    return out;
}
