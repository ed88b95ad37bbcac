// context_osmesa.c - OpenGL in memory by Mesa's software renderer; the only file that knows OSMesa
#include "window/context_offscreen.h"

#include "cli/program/say.h"

#include <GL/osmesa.h>
#include <stdlib.h>

struct offscreen {
    OSMesaContext context;
    unsigned char pixel[4];  // OSMesa wants a buffer; all drawing goes into targets
};

static void close_offscreen(void *context)
{
    struct offscreen *o = context;
    if (o->context)
        OSMesaDestroyContext(o->context);
    free(o);
}

static relume_status open_offscreen(void **out, int width, int height, const char *title,
                                    const struct relume_log *log)
{
    static const int wanted[] = {
        OSMESA_FORMAT,
        OSMESA_RGBA,
        OSMESA_PROFILE,
        OSMESA_CORE_PROFILE,
        OSMESA_CONTEXT_MAJOR_VERSION,
        3,
        OSMESA_CONTEXT_MINOR_VERSION,
        3,
        0,
    };
    (void)width, (void)height, (void)title;
    *out = NULL;
    struct offscreen *o = calloc(1, sizeof *o);
    if (!o)
        return RELUME_ENOMEM;
    o->context = OSMesaCreateContextAttribs(wanted, NULL);
    if (o->context && OSMesaMakeCurrent(o->context, o->pixel, GL_UNSIGNED_BYTE, 1, 1)) {
        *out = o;
        return RELUME_OK;
    }
    close_offscreen(o);
    return say(log, RELUME_ESYSTEM,
               "no OpenGL 3.3 in memory; expected Mesa's OSMesa with llvmpipe; install libosmesa6");
}

static gl_proc get_proc(const char *name)
{
    return OSMesaGetProcAddress(name);
}

const struct context_backend context_osmesa = {
    "osmesa",        open_offscreen, close_offscreen, get_proc, offscreen_size,
    offscreen_scale, offscreen_show, offscreen_next,  NULL,     NULL,
};
