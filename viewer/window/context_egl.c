// context_egl.c - OpenGL without a display by EGL: graphics cards of servers first, Mesa's software
// last; the only file that knows EGL
#include "window/context_offscreen.h"

#include "cli/program/say.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_DEVICES = 16 };

struct offscreen {
    EGLDisplay display;
    EGLContext context;
};

static bool has_word(const char *words, const char *word)
{
    const size_t n = strlen(word);
    for (const char *at = words; at && (at = strstr(at, word)); at += n)
        if ((at == words || at[-1] == ' ') && (at[n] == ' ' || !at[n]))
            return true;
    return false;
}

static void close_offscreen(void *context)
{
    struct offscreen *o = context;
    if (o->display != EGL_NO_DISPLAY) {
        eglMakeCurrent(o->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (o->context != EGL_NO_CONTEXT)
            eglDestroyContext(o->display, o->context);
        eglTerminate(o->display);
    }
    eglReleaseThread();
    free(o);
}

// A context of 3.3 core that needs no surface; all drawing goes into targets.
static bool make_current(struct offscreen *o, EGLDisplay display)
{
    static const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE,
                                    EGL_PBUFFER_BIT, EGL_NONE};
    static const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     3,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     3,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_NONE};
    EGLConfig config;
    EGLint found = 0;
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL))
        return false;
    if (eglBindAPI(EGL_OPENGL_API) && eglChooseConfig(display, wanted, &config, 1, &found) &&
        found) {
        o->context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
        if (o->context != EGL_NO_CONTEXT &&
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, o->context)) {
            o->display = display;
            return true;
        }
    }
    if (o->context != EGL_NO_CONTEXT)
        eglDestroyContext(display, o->context);
    o->context = EGL_NO_CONTEXT;
    eglTerminate(display);
    return false;
}

static bool open_devices(struct offscreen *o, bool software)
{
    const PFNEGLQUERYDEVICESEXTPROC devices_of =
        (PFNEGLQUERYDEVICESEXTPROC)eglGetProcAddress("eglQueryDevicesEXT");
    const PFNEGLQUERYDEVICESTRINGEXTPROC words_of =
        (PFNEGLQUERYDEVICESTRINGEXTPROC)eglGetProcAddress("eglQueryDeviceStringEXT");
    EGLDeviceEXT device[MOST_DEVICES];
    EGLint devices = 0;
    if (!devices_of || !words_of || !devices_of(MOST_DEVICES, device, &devices))
        return false;
    for (int i = 0; i < devices; i++) {
        const char *words = words_of(device[i], EGL_EXTENSIONS);
        if (has_word(words, "EGL_MESA_device_software") == software &&
            make_current(o, eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device[i], NULL)))
            return true;
    }
    return false;
}

static relume_status open_first(void **out, bool software, const struct relume_log *log)
{
    const char *client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    *out = NULL;
    struct offscreen *o = calloc(1, sizeof *o);
    if (!o)
        return RELUME_ENOMEM;
    const bool devices = has_word(client, "EGL_EXT_platform_device");
    const bool open = (devices && open_devices(o, false)) ||
                      (software && devices && open_devices(o, true)) ||
                      (software && has_word(client, "EGL_MESA_platform_surfaceless") &&
                       make_current(o, eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA,
                                                             (void *)EGL_DEFAULT_DISPLAY, NULL)));
    if (open) {
        *out = o;
        return RELUME_OK;
    }
    free(o);
    return say(log, RELUME_ESYSTEM,
               "no OpenGL 3.3 by EGL; expected the driver of a graphics card or Mesa; install "
               "libegl-mesa0 or that driver");
}

static relume_status open_any(void **out, int width, int height, const char *title,
                              const struct relume_log *log)
{
    (void)width, (void)height, (void)title;
    return open_first(out, true, log);
}

static relume_status open_card(void **out, int width, int height, const char *title,
                               const struct relume_log *log)
{
    (void)width, (void)height, (void)title;
    return open_first(out, false, log);
}

static gl_proc get_proc(const char *name)
{
    return (gl_proc)eglGetProcAddress(name);
}

const struct context_backend context_egl = {
    "egl",           open_any,       close_offscreen, get_proc, offscreen_size,
    offscreen_scale, offscreen_show, offscreen_next,  NULL,     NULL,
};

const struct context_backend context_egl_card = {
    "egl, graphics card", open_card,      close_offscreen, get_proc, offscreen_size,
    offscreen_scale,      offscreen_show, offscreen_next,  NULL,     NULL,
};
