// exhibit.h - a captured file as one thing of a scene: where it stands, what an eye sees of it
#ifndef TABLEAU_EXHIBIT_H
#define TABLEAU_EXHIBIT_H

#include "image/geometry/frame.h"
#include "world/transport/scenery.h"

#include <relume/relight/viewport.h>
#include <relume/renderer.h>
#include <relume/world/tableau.h>

struct exhibit {
    const char *name;  // for sentences; borrowed
    relume_pack *pack;
    relume_renderer *renderer;
    struct frame pose;           // of its own world in the scene's: turned, moved, scaled evenly
    double scale;                // of the pose
    bool turned_aside;           // about another axis than y
    struct scenery *scenery;     // of `whole`, in the scene's world
    struct relume_camera whole;  // the view that stands for all of it
    struct relume_viewport viewport;  // ... in its own world
    struct relume_image relit;     // that view, under the last light; of slabs only for transport
    struct relume_light relit_by;  // in its own world
};

// A file at a pose. Errors of relume_open, RELUME_EUNFIT with a sentence (a slab without depth).
// The caller destroys what is in `out`, whatever is returned.
relume_status exhibit_open(struct exhibit *out, const char *path, const struct frame *pose,
                           const struct relume_tableau_params *params);
void exhibit_destroy(struct exhibit *c);

// From where and how it is looked at when nobody says it, in its own world.
struct relume_camera exhibit_camera(const struct exhibit *c);

// The places of its whole view, in its own world: `*out` is created.
relume_status exhibit_whole_places(struct relume_image *out, struct exhibit *c);

// The place in the scene that each pixel of a frame shows, NaN where it shows none of its surface:
// `*out` is created. The camera's size, eye, place looked at and field of view are given, and make
// that window.
relume_status exhibit_places(struct relume_image *out, const struct exhibit *c,
                             const struct relume_camera *camera, const struct relume_window *window,
                             int threads);
// What that frame shows under one light, at `places`, and elsewhere what is far away, where it is
// all around: `*out` is created. RELUME_EUNFIT with a sentence where it cannot take the light.
relume_status exhibit_light(struct relume_image *out, struct exhibit *c,
                            const struct relume_camera *camera, const struct relume_window *window,
                            const struct relume_image *places, const struct relume_light *light,
                            const struct relume_render_params *params);

#endif
