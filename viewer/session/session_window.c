// session_window.c - the window of a session, on the screen or in memory
#include "session/session_window.h"

relume_status session_window_open(struct session_window *w, const struct context_backend *backend,
                                  int width, int height, const char *title,
                                  const struct relume_log *log)
{
    w->backend = backend;
    const relume_status status = backend->open(&w->context, width, height, title, log);
    return status ? status : gl_load(&w->gl, backend->get_proc, log);
}

void session_window_close(struct session_window *w)
{
    if (w->context)
        w->backend->close(w->context);
    *w = (struct session_window){.context = NULL};
}

relume_status session_window_need_screen(struct session_window *w, int width, int height,
                                         const struct relume_log *log)
{
    return target_need(&w->screen, &w->gl, width, height, log);
}

void session_window_forget_screen(struct session_window *w)
{
    if (w->screen.texture)
        target_destroy(&w->screen, &w->gl);
}
