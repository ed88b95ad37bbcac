// context_offscreen.h - what contexts without a window have in common, and which of them to take
#ifndef VIEWER_CONTEXT_OFFSCREEN_H
#define VIEWER_CONTEXT_OFFSCREEN_H

#include "window/context.h"

// "osmesa", "egl", or "auto": a graphics card where there is one, else OSMesa. NULL: none of these.
const struct context_backend *context_offscreen(const char *name);

// A screen of one pixel, on which nothing happens.
void offscreen_size(void *context, int *width, int *height);
double offscreen_scale(void *context);
void offscreen_show(void *context, const char *title);
bool offscreen_next(void *context, struct context_event *event, double wait_s);

#endif
