// exchanger.h - light between a scene and the objects in it, by the library, in a thread of its own
// while frames are drawn: first a rough picture, then a fine one
//
// Any way of relume_transports will do. The library draws the file by a pack of its own, so that
// nobody waits for anybody; only the objects are shared (exchanger_rest).
#ifndef VIEWER_EXCHANGER_H
#define VIEWER_EXCHANGER_H

#include <relume/frame.h>
#include <relume/object.h>

enum { EXCHANGER_SLOTS = 2 };  // pictures that are compared

// What is drawn, all of it borrowed. `objects` must not change but after exchanger_rest.
struct exchange_source {
    const char *file;  // as it was opened
    bool sphere;       // as relume_open_params
    const relume_objects *objects;
    const struct relume_log *log;
    int threads;
};

// A picture.
struct exchange_request {
    const struct relume_transport *transport;
    int samples, bounces;         // as relume_render_params
    struct relume_camera camera;  // with a width and a height
    enum relume_interpolation interpolation;
    double aperture, focus;             // as relume_frame_params
    const struct relume_light *lights;  // borrowed during the call; what they point at stays
    int count;                          // of lights
    bool moves;                         // under the hand: a rough picture will do
    bool waits;                         // for the fine one: there need be no rough one
};

// How a picture fits what was asked for last.
enum exchange_fit {
    EXCHANGE_NONE,   // there is none, or of something else
    EXCHANGE_OLDER,  // from the same eye in the same way, under other lights
    EXCHANGE_ROUGH,  // as asked for, with fewer pixels
    EXCHANGE_FINE
};

// Thread-safety: one thread at a time.
struct exchanger;

// RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status exchanger_create(struct exchanger **out, const struct exchange_source *source);
// Waits for what is being drawn, which is cancelled.
void exchanger_destroy(struct exchanger **exchanger);

// A slot's picture is this from now on (NULL: none). What was begun for another is cancelled, but
// for rough pictures under other lights alone: who drags a lamp sees them. RELUME_ENOMEM.
relume_status exchanger_ask(struct exchanger *e, int slot, const struct exchange_request *request);
// The newest picture of a slot, which belongs to the exchanger until the next call; `*fresh`: it is
// another one than the last time. NULL where it fits nothing.
enum exchange_fit exchanger_show(const struct relume_image **image, bool *fresh,
                                 struct exchanger *e, int slot);
// Whether something is still to be drawn; and whether exchanger_show has something new to show.
bool exchanger_is_busy(struct exchanger *e);
bool exchanger_has_news(struct exchanger *e);
// Until nothing is to be drawn. RELUME_ECANCEL when the log's progress asks for it.
relume_status exchanger_wait(struct exchanger *e);
// Stop, wait until nobody looks at the objects, and forget all pictures. The next exchanger_ask
// begins anew.
void exchanger_rest(struct exchanger *e);

// What is known of a slot, for people.
struct exchange_state {
    bool works;            // on the slot
    double done;           // of that, 0 to 1
    int width, height;     // of the newest picture; 0: there is none
    double seconds;        // that it took
    relume_status status;  // of the request: it cannot be drawn
};
void exchanger_state(struct exchange_state *out, struct exchanger *e, int slot);
// Pass on what the library had to say, each sentence once.
void exchanger_speak(struct exchanger *e);

#endif
