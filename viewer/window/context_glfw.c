// context_glfw.c - OpenGL in a window; the only file that knows GLFW
#include "window/context.h"

#include "cli/program/say.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { QUEUE = 256 };

struct window {
    GLFWwindow *handle;
    struct context_event queue[QUEUE];
    int first, count;
    double cursor[2];  // window units, as of the last event: GLFW itself answers for right now
    char dropped[4096];
    int place[2], units[2];  // before the window filled the screen
};

// ---------------------------------------------------------------- events

// Events that nobody takes in time are lost; a queue of a frame's mouse moves is far shorter.
static void push(GLFWwindow *handle, struct context_event event)
{
    struct window *w = glfwGetWindowUserPointer(handle);
    if (w->count < QUEUE)
        w->queue[(w->first + w->count++) % QUEUE] = event;
}

static void push_input(GLFWwindow *handle, struct app_event input)
{
    push(handle, (struct context_event){.kind = CONTEXT_INPUT, .input = input});
}

static struct app_event at_cursor(GLFWwindow *handle, enum app_event_kind kind)
{
    const struct window *w = glfwGetWindowUserPointer(handle);
    struct app_event e = {.kind = kind};
    int units[2], pixels[2];
    glfwGetWindowSize(handle, &units[0], &units[1]);
    glfwGetFramebufferSize(handle, &pixels[0], &pixels[1]);
    e.x = context_pixels(w->cursor[0], units[0], pixels[0]);
    e.y = context_pixels(w->cursor[1], units[1], pixels[1]);
    return e;
}

static void on_move(GLFWwindow *handle, double x, double y)
{
    struct window *w = glfwGetWindowUserPointer(handle);
    w->cursor[0] = x;
    w->cursor[1] = y;
    push_input(handle, at_cursor(handle, APP_MOVE));
}

static void on_button(GLFWwindow *handle, int button, int action, int mods)
{
    (void)mods;
    if (button != GLFW_MOUSE_BUTTON_LEFT && button != GLFW_MOUSE_BUTTON_RIGHT)
        return;
    struct app_event e = at_cursor(handle, action == GLFW_PRESS ? APP_PRESS : APP_RELEASE);
    e.button = button == GLFW_MOUSE_BUTTON_LEFT ? APP_LEFT : APP_RIGHT;
    push_input(handle, e);
}

static void on_wheel(GLFWwindow *handle, double dx, double dy)
{
    (void)dx;
    struct app_event e = at_cursor(handle, APP_WHEEL);
    e.wheel = dy;
    push_input(handle, e);
}

// The letter on the key of this keyboard, so that R is where it is printed.
static int key_letter(int key, int scancode)
{
    static const int special[][2] = {
        {GLFW_KEY_ESCAPE, APP_KEY_ESCAPE},
        {GLFW_KEY_TAB, APP_KEY_TAB},
        {GLFW_KEY_ENTER, APP_KEY_ENTER},
        {GLFW_KEY_KP_ENTER, APP_KEY_ENTER},
        {GLFW_KEY_BACKSPACE, APP_KEY_BACKSPACE},
        {GLFW_KEY_DELETE, APP_KEY_DELETE},
        {GLFW_KEY_LEFT, APP_KEY_LEFT},
        {GLFW_KEY_RIGHT, APP_KEY_RIGHT},
        {GLFW_KEY_UP, APP_KEY_UP_ARROW},
        {GLFW_KEY_DOWN, APP_KEY_DOWN_ARROW},
        {GLFW_KEY_PAGE_UP, APP_KEY_PAGE_UP},
        {GLFW_KEY_PAGE_DOWN, APP_KEY_PAGE_DOWN},
        {GLFW_KEY_HOME, APP_KEY_HOME},
        {GLFW_KEY_END, APP_KEY_END},
        {GLFW_KEY_F1, '?'},
        {GLFW_KEY_F11, APP_KEY_F11},
        {GLFW_KEY_KP_ADD, '+'},
        {GLFW_KEY_KP_SUBTRACT, '-'},
        {GLFW_KEY_EQUAL, '+'},
        {GLFW_KEY_MINUS, '-'},
    };
    for (size_t i = 0; i < sizeof special / sizeof *special; i++)
        if (special[i][0] == key)
            return special[i][1];
    const char *name = glfwGetKeyName(key, scancode);
    return name && name[0] && !name[1] ? name[0] : 0;
}

static void on_key(GLFWwindow *handle, int key, int scancode, int action, int mods)
{
    struct app_event e = at_cursor(handle, action == GLFW_RELEASE ? APP_KEY_UP : APP_KEY_DOWN);
    e.key = key_letter(key, scancode);
    const bool letter = e.key >= 'a' && e.key <= 'z';
    const bool arrow = e.key >= APP_KEY_LEFT && e.key <= APP_KEY_DOWN_ARROW;
    if (mods & GLFW_MOD_CONTROL && (letter || arrow))
        e.key |= APP_CONTROL;
    e.repeat = action == GLFW_REPEAT;
    if (e.key)
        push_input(handle, e);
}

static void on_char(GLFWwindow *handle, unsigned code)
{
    struct app_event e = at_cursor(handle, APP_TEXT);
    e.key = (int)code;
    push_input(handle, e);
}

static void on_size(GLFWwindow *handle, int width, int height)
{
    push_input(handle, (struct app_event){.kind = APP_SIZE, .width = width, .height = height});
}

static void on_refresh(GLFWwindow *handle)
{
    int width, height;
    glfwGetFramebufferSize(handle, &width, &height);
    on_size(handle, width, height);
}

static void on_drop(GLFWwindow *handle, int count, const char **paths)
{
    struct window *w = glfwGetWindowUserPointer(handle);
    if (count < 1 || strlen(paths[0]) >= sizeof w->dropped)
        return;
    strcpy(w->dropped, paths[0]);
    push(handle, (struct context_event){.kind = CONTEXT_DROP, .dropped = w->dropped});
}

static void on_scale(GLFWwindow *handle, float across, float down)
{
    (void)down;
    push(handle, (struct context_event){.kind = CONTEXT_SCALE, .scale = (double)across});
}

static void on_close(GLFWwindow *handle)
{
    push(handle, (struct context_event){.kind = CONTEXT_CLOSE});
}

static void listen(GLFWwindow *handle)
{
    glfwSetCursorPosCallback(handle, on_move);
    glfwSetMouseButtonCallback(handle, on_button);
    glfwSetScrollCallback(handle, on_wheel);
    glfwSetKeyCallback(handle, on_key);
    glfwSetCharCallback(handle, on_char);
    glfwSetFramebufferSizeCallback(handle, on_size);
    glfwSetWindowRefreshCallback(handle, on_refresh);
    glfwSetDropCallback(handle, on_drop);
    glfwSetWindowContentScaleCallback(handle, on_scale);
    glfwSetWindowCloseCallback(handle, on_close);
}

// ---------------------------------------------------------------- backend

static void close_window(void *context)
{
    struct window *w = context;
    if (w->handle)
        glfwDestroyWindow(w->handle);
    glfwTerminate();
    free(w);
}

static relume_status no_window(const struct relume_log *log, const char *what)
{
    const char *why = NULL;
    glfwGetError(&why);
    return say(log, RELUME_ESYSTEM,
               "%s (%s); use --offscreen OUT.png, or start it on a desktop whose driver has "
               "OpenGL 3.3 (package libgl1-mesa-dri)",
               what, why ? why : "no reason given");
}

static relume_status open_window(void **out, int width, int height, const char *title,
                                 const struct relume_log *log)
{
    *out = NULL;
    struct window *w = calloc(1, sizeof *w);
    if (!w)
        return RELUME_ENOMEM;
    if (!glfwInit()) {
        free(w);
        return no_window(log, "no display to open a window on");
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
    w->handle = glfwCreateWindow(width, height, title, NULL, NULL);
    if (!w->handle) {
        const relume_status status = no_window(log, "no window with OpenGL 3.3");
        close_window(w);
        return status;
    }
    glfwMakeContextCurrent(w->handle);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(w->handle, w);
    glfwGetCursorPos(w->handle, &w->cursor[0], &w->cursor[1]);
    listen(w->handle);
    *out = w;
    return RELUME_OK;
}

static gl_proc get_proc(const char *name)
{
    return glfwGetProcAddress(name);
}

static void size(void *context, int *width, int *height)
{
    const struct window *w = context;
    glfwGetFramebufferSize(w->handle, width, height);
}

static double scale(void *context)
{
    const struct window *w = context;
    float across = 1.0f;
    glfwGetWindowContentScale(w->handle, &across, NULL);
    return (double)across;
}

static void show(void *context, const char *title)
{
    const struct window *w = context;
    glfwSetWindowTitle(w->handle, title);
    glfwSwapBuffers(w->handle);
}

static bool next(void *context, struct context_event *event, double wait_s)
{
    struct window *w = context;
    if (!w->count && isinf(wait_s))
        glfwWaitEvents();
    else if (!w->count && wait_s > 0)
        glfwWaitEventsTimeout(wait_s);
    else if (!w->count)
        glfwPollEvents();
    if (!w->count)
        return false;
    *event = w->queue[w->first];
    w->first = (w->first + 1) % QUEUE;
    w->count--;
    return true;
}

static void full_screen(void *context, bool fill)
{
    struct window *w = context;
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode *mode = monitor ? glfwGetVideoMode(monitor) : NULL;
    if (fill && mode) {
        glfwGetWindowPos(w->handle, &w->place[0], &w->place[1]);
        glfwGetWindowSize(w->handle, &w->units[0], &w->units[1]);
        glfwSetWindowMonitor(w->handle, monitor, 0, 0, mode->width, mode->height,
                             mode->refreshRate);
    } else if (!fill && w->units[0]) {
        glfwSetWindowMonitor(w->handle, NULL, w->place[0], w->place[1], w->units[0], w->units[1],
                             GLFW_DONT_CARE);
    }
}

static void copy(void *context, const char *text)
{
    glfwSetClipboardString(((struct window *)context)->handle, text);
}

const struct context_backend context_glfw = {
    "glfw", open_window, close_window, get_proc, size, scale, show, next, full_screen, copy,
};
