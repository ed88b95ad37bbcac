// exchange_drawer.h - the library draws what was asked for: a file with objects in it, or a scene
// file
#ifndef VIEWER_EXCHANGE_DRAWER_H
#define VIEWER_EXCHANGE_DRAWER_H

#include "relit/exchange_request.h"

#include <relume/renderer.h>
#include <relume/world/tableau.h>

enum { EXCHANGER_SLOTS = 2 };  // pictures that are compared

// What is drawn, all of it borrowed. `objects` must not change meanwhile.
struct exchange_source {
    const char *file;  // as it was opened
    bool sphere;       // as relume_open_params
    bool scene;        // it is a scene file, which has objects of its own
    const relume_objects *objects;
    const struct relume_log *log;
    int threads;
};

enum exchange_step { EXCHANGE_STEP_ROUGH, EXCHANGE_STEP_FINE, EXCHANGE_STEPS };

// Thread-safety: one thread at a time.
struct exchange_drawer {
    struct exchange_source source;
    const struct relume_log *log;  // of what is drawn
    relume_pack *pack;
    relume_tableau *tableau;  // of a scene file, in place of `pack` and renderers
    bool opens;               // what there is to note was noted when the viewer opened the file
    struct exchange_drawn {
        relume_renderer *renderer;
        struct exchange_request set;  // what its objects are drawn by; transport NULL: not yet ...
        enum exchange_step step;      // ... and how finely
    } slot[EXCHANGER_SLOTS];
};

// `*out` is created; files are opened when first needed. Errors of relume_open, relume_renderer,
// relume_tableau.
relume_status exchange_draw(struct relume_image *out, struct exchange_drawer *d, int slot,
                            const struct exchange_request *q, enum exchange_step step);
void exchange_drawer_release(struct exchange_drawer *d);

#endif
