// painted_view.h - a planar view that a painter shows under lights, without codes
#ifndef VIEWER_PAINTED_VIEW_H
#define VIEWER_PAINTED_VIEW_H

#include "gl/target.h"

#include <relume/relight/relight.h>

// Paints the view; the caller destroys the image.
struct view_painter {
    void *user;
    relume_status (*paint)(struct relume_image *out, void *user, const struct relume_light *lights,
                           int n);
};

// Zeroed there is no painter.
struct painted_view {
    struct view_painter painter;
    struct target target;        // painted under ...
    struct relume_light *light;  // ... [lights]
    int lights;
    bool fresh;  // it shows them
};

void painted_view_use(struct painted_view *v, const struct view_painter *painter);
// Paints the view into v->target, unless it shows these lights. Errors of the painter,
// RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status painted_view_light(struct painted_view *v, const struct gl *gl,
                                 const struct relume_light *lights, int n,
                                 const struct relume_log *log);
void painted_view_destroy(struct painted_view *v, const struct gl *gl);

#endif
