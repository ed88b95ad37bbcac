// relighter.h - the views of a file, relit again and again: what one call has worked out, the next
// uses
//
// Kept for all views: the weight grid of the coder, and what the first refit learned. Kept for each
// view: its refit and the pictures that its lights gave. A light that is the same as in the call
// before is not relit where its picture is kept.
#ifndef FRAME_RELIGHTER_H
#define FRAME_RELIGHTER_H

#include "relight/shadow/moving.h"

#include <relume/base.h>
#include <relume/format/coder.h>
#include <relume/image.h>
#include <relume/light.h>

// Thread-safety: one thread at a time.
typedef struct relume_relighter relume_relighter;

enum { RELUME_RELIGHTER_GROUPS = 17 };  // at most

struct relume_relighter_params {
    size_t struct_size;  // filled by the macro (base.h)
    int groups;  // pictures kept of each view, [1, RELUME_RELIGHTER_GROUPS]; default 1, of all
                 // lights. With more of them the first is of the distant lights that cost one loop
                 // together, the others are each of one light, near or decoded on its own, as far
                 // as they go: one that moves is relit alone. Their sum is rounded otherwise
    unsigned cpu_off;  // as relume_relight_params
    int threads;       // default: all cores
    bool once;  // environments on codes of the display domain are summed over the captured lights,
                // in place of a refit, which pays from the second picture of a view on
};
#define relume_relighter_params(...)                                                               \
    (&(const struct relume_relighter_params){RELUME_SIZED(relume_relighter_params), __VA_ARGS__})

// For views 0 to views - 1 of one file. RELUME_EINVAL, RELUME_ENOMEM.
relume_status relume_relighter_create(relume_relighter **out, int views,
                                      const struct relume_relighter_params *params);
void relume_relighter_destroy(relume_relighter **relighter);

// One view of the file under lights. Everything is borrowed for the call; `codes` of one view are
// the same in every call until relume_relighter_drop.
struct relume_relit {
    int view;  // its number
    const struct relume_codes *codes;
    const struct relume_image *surface;  // as relume_relight_params; NULL: no near lights
    const struct relume_light *lights;
    int count;
    const struct relume_log *log;  // may be NULL
    relume_shadows *shadows;       // of the whole view; NULL: none
    int left, top;                 // with these: where in the view the codes are
};

// The picture of relume_relight in `*out`; it belongs to the relighter and holds until the next
// call for that view. Errors of relume_relight.
relume_status relume_relighter_picture(const struct relume_image **out, relume_relighter *relighter,
                                       const struct relume_relit *relit);
// The same into the caller's image, as relume_relight, and nothing of the picture is kept.
relume_status relume_relighter_relight(struct relume_image *out, relume_relighter *relighter,
                                       const struct relume_relit *relit);
// The same as relume_relight_rgba8.
relume_status relume_relighter_rgba8(uint8_t *out, relume_relighter *relighter,
                                     const struct relume_relit *relit, double exposure_ev);

// Forget a view: its pictures and its refit.
void relume_relighter_drop(relume_relighter *relighter, int view);
// Forget the pictures of all views: what a light points at has changed or is gone.
void relume_relighter_forget(relume_relighter *relighter);
// What is kept of a view, bytes.
uint64_t relume_relighter_bytes(const relume_relighter *relighter, int view);

#endif
