// exchanger.h - light between a scene and the objects in it, by the library, in a thread of its own
// while frames are drawn: first a rough picture, then a fine one
//
// Any way of relume_transports will do. The library draws the file by a pack of its own, so that
// nobody waits for anybody; only the objects are shared (exchanger_rest), which belong to a scene
// file where that is drawn.
#ifndef VIEWER_EXCHANGER_H
#define VIEWER_EXCHANGER_H

#include "relit/exchange_drawer.h"

// How a picture fits what was asked for last.
enum exchange_fit {
    EXCHANGE_NONE,       // there is none, or of something else
    EXCHANGE_ELSEWHERE,  // of a scene file: from another eye or in another way
    EXCHANGE_OLDER,      // from the same eye in the same way, under other lights
    EXCHANGE_ROUGH,      // as asked for, with fewer pixels
    EXCHANGE_FINE
};

// Thread-safety: one thread at a time.
struct exchanger;

// The source's objects must not change but after exchanger_rest. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status exchanger_create(struct exchanger **out, const struct exchange_source *source);
// Waits for what is being drawn, which is cancelled.
void exchanger_destroy(struct exchanger **exchanger);

// A slot's picture is this from now on (NULL: none). What was begun for another is cancelled, but
// for rough pictures under other lights alone (of a scene file, from another eye, too): who drags
// sees them. RELUME_ENOMEM.
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
