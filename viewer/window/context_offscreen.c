// context_offscreen.c - what contexts without a window have in common, and which of them to take
#include "window/context_offscreen.h"

#include <string.h>

static const struct context_backend *choose(void)
{
    void *context;
    if (context_egl_card.open(&context, 1, 1, "", NULL))
        return &context_osmesa;
    context_egl_card.close(context);
    return &context_egl_card;
}

const struct context_backend *context_offscreen(const char *name)
{
    return !strcmp(name, "osmesa") ? &context_osmesa
           : !strcmp(name, "egl")  ? &context_egl
           : !strcmp(name, "auto") ? choose()
                                   : NULL;
}

void offscreen_size(void *context, int *width, int *height)
{
    (void)context;
    *width = *height = 1;
}

double offscreen_scale(void *context)
{
    (void)context;
    return 1.0;
}

void offscreen_show(void *context, const char *title)
{
    (void)context, (void)title;
}

bool offscreen_next(void *context, struct context_event *event, double wait_s)
{
    (void)context, (void)wait_s;
    event->kind = CONTEXT_CLOSE;
    return false;
}
