// loader.h - codes of views, read by a thread of its own while frames are drawn
#ifndef VIEWER_LOADER_H
#define VIEWER_LOADER_H

#include "format/coder/coding.h"
#include "relight/shadow/moving.h"

#include <relume/format/coder.h>

// Where codes come from: a pack, or a test. `drop` (may be NULL) hears that one who asked for a
// view's codes no longer looks at them. `surface` (may be NULL) gives the places of a view's
// pixels, for near lights; the caller destroys the image.
struct code_source {
    relume_status (*codes)(const struct relume_codes **out, void *user, int view);
    void (*drop)(void *user, int view);
    void *user;
    relume_status (*surface)(struct relume_image *out, void *user, int view);
    // For the caller to destroy; NULL where the file has none. May be NULL.
    relume_status (*shadows)(relume_shadows **out, void *user, int view);
};

// Codes of a rectangle of a view alone, for the caller to destroy; `part` NULL: there are none.
struct part_source {
    relume_status (*part)(struct relume_codes_part *out, void *user, int view,
                          const struct relume_rect *at);
    void *user;
};

struct loader;

// The source is used by the loader's thread as well from now on. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status loader_create(struct loader **out, const struct code_source *source, int views);
// Waits for the view that is being read; what was read and not taken is dropped.
void loader_destroy(struct loader **loader);

// Read `view` when those asked for before have been read. Asking again changes nothing.
void loader_ask(struct loader *loader, int view);
// Forget what was asked for and is not being read yet.
void loader_clear(struct loader *loader);

struct loaded {
    int view;
    relume_status status;
    const struct relume_codes *codes;  // to be dropped
};
// A view that has been read; false when there is none, with `wait` only when none is asked for.
bool loader_take(struct loaded *out, struct loader *loader, bool wait);

#endif
