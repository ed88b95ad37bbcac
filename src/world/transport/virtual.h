// virtual.h - virtual lights: points that stand for all that sends light (Keller 1997, "Instant
// radiosity")
#ifndef TRANSPORT_VIRTUAL_H
#define TRANSPORT_VIRTUAL_H

#include "world/transport/points.h"

struct virtual_light {
    vec3 place;   // just off its surface; of one that is far away nothing
    vec3 normal;  // unit, of the surface; of one that is far away the direction to it
    bool far;
    double size;       // of what it stands for: an area, of one that is far away a solid angle
    float without[3];  // radiance, in all directions alike, were there no objects
    float with[3];     // ... as it is
};

// `count` of them, drawn from what the scenery sends by what of that arrives about the objects: in
// strata, so that every n-th of them is a smaller drawing of its own. What the objects keep from a
// place is taken off. 0 where all is black. RELUME_ENOMEM.
relume_status virtual_of_scene(struct virtual_light *out, size_t *found, const struct world *w,
                               size_t count);

// A place of the objects that may become one.
struct sender {
    struct point point;  // `both` is for nothing: the other side is a sender of its own
    struct site site;
    float sent[3];
};
// The senders on the first `count` of those points. RELUME_ENOMEM; mem_free frees them.
relume_status virtual_senders(struct sender **out, size_t *found, const struct world *w,
                              const struct points *points, size_t count);
// `count` drawn by what senders send, which of them in `number`; `found` as above. RELUME_ENOMEM.
relume_status virtual_of_senders(struct virtual_light *out, size_t *number, size_t *found,
                                 const struct sender *senders, size_t n, size_t count);

// How a light is seen from a site: the direction, how far it is, and what share of what a white
// surface shows it has by its size and both cosines. False where one is turned away.
struct sight {
    vec3 towards;
    double distance, share;
};
bool virtual_sight(struct sight *out, const struct virtual_light *light, const struct site *site);

#endif
