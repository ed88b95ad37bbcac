// context.h - where OpenGL comes from: a window, or memory alone
#ifndef VIEWER_CONTEXT_H
#define VIEWER_CONTEXT_H

#include "app/app.h"
#include "gl/gl.h"

// What the user did; `dropped` is a file put onto the window, valid until the next call.
struct context_event {
    enum { CONTEXT_INPUT, CONTEXT_DROP, CONTEXT_SCALE, CONTEXT_CLOSE } kind;
    struct app_event input;
    const char *dropped;
    double scale;  // SCALE: as context_backend.scale from now on
};

// Screens may have more pixels than window units: a place along one axis of a window, in pixels of
// its picture. A window without extent (minimised) maps one to one.
static inline double context_pixels(double at, int units, int pixels)
{
    return units > 0 && pixels > 0 ? at * pixels / units : at;
}

// A source of contexts. Thread-safety: main thread only; one open context at a time.
struct context_backend {
    const char *name;
    // Make a context of OpenGL 3.3 core and make it current. RELUME_ESYSTEM says what to install.
    relume_status (*open)(void **out, int width, int height, const char *title,
                          const struct relume_log *log);
    void (*close)(void *context);
    gl_proc (*get_proc)(const char *name);
    // Pixels of the picture that `show` shows.
    void (*size)(void *context, int *width, int *height);
    // How many pixels are as large as one on ordinary screens: for letters.
    double (*scale)(void *context);
    void (*show)(void *context, const char *title);
    // The next event; false when there is none within `wait_s` seconds, which may be INFINITY.
    bool (*next)(void *context, struct context_event *event, double wait_s);
    // Fill the screen, or be a window again as before. NULL: there is no window.
    void (*full_screen)(void *context, bool fill);
    // Put a text into the clipboard. NULL: there is none.
    void (*copy)(void *context, const char *text);
};
extern const struct context_backend context_glfw;  // a window
// No display needed, draw into targets:
extern const struct context_backend context_osmesa;
extern const struct context_backend context_egl;       // a graphics card, else Mesa's software
extern const struct context_backend context_egl_card;  // fails without a card

#endif
