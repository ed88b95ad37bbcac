// session_window.h - the window of a session, on the screen or in memory
#ifndef VIEWER_SESSION_WINDOW_H
#define VIEWER_SESSION_WINDOW_H

#include "gl/target.h"
#include "window/context.h"

// Zeroed it is closed.
struct session_window {
    const struct context_backend *backend;
    void *context;
    struct gl gl;
    struct target screen;  // of shots without a window
    bool full_screen;
};

// Opens a window and its OpenGL. RELUME_ESYSTEM, RELUME_ENOMEM, RELUME_EUNFIT.
relume_status session_window_open(struct session_window *w, const struct context_backend *backend,
                                  int width, int height, const char *title,
                                  const struct relume_log *log);
// Nothing of OpenGL may be used afterwards.
void session_window_close(struct session_window *w);
// Makes the screen that large. RELUME_ESYSTEM.
relume_status session_window_need_screen(struct session_window *w, int width, int height,
                                         const struct relume_log *log);
void session_window_forget_screen(struct session_window *w);

#endif
