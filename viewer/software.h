// software.h - a view relit by the library: where OpenGL is software and no faster, and where the
// codes do not suit a near light's shader
//
// Lights stand in groups, each with the picture it gives: a light that moves relights its group
// alone. Distant lights that cost one pass together are one group; near ones, and those that the
// display domain decodes one by one, have groups of their own as far as there are groups.
#ifndef VIEWER_SOFTWARE_H
#define VIEWER_SOFTWARE_H

#include "loader.h"

#include <relume/relight.h>

enum { SOFTWARE_GROUPS = 17 };

// What all views of a file share. All zero to begin with.
struct software {
    relume_weight_grid *grid;  // of the coder; NULL: not made yet
    relume_refit *refit;       // the first: all others learned from it
    int threads;               // 0: all cores
};
void software_destroy(struct software *software);

struct software_group {
    struct relume_light *light;  // that `image` was relit under
    int lights;
    struct relume_image image;
};

// All zero: not there.
struct software_view {
    const struct relume_codes *codes;  // lent by the source, until software_view_destroy
    int view;
    struct relume_image surface;  // empty: not known yet
    relume_refit *refit;          // or NULL: the shared one, or none
    struct software_group group[SOFTWARE_GROUPS];
    struct relume_image sum;  // of the groups, where there are several
};

// Borrow `codes` of `view` until it is destroyed.
void software_view_begin(struct software_view *v, const struct relume_codes *codes, int view);
// The codes are dropped at their source.
void software_view_destroy(struct software_view *v, const struct code_source *source);
// What was kept for lights may belong to others.
void software_view_forget(struct software_view *v);

// Of the pictures that it keeps.
size_t software_view_bytes(const struct software_view *v);

// The view under `lights`, linear, three channels; valid until the next call. RELUME_EDATA (a near
// light and no surface), RELUME_ENOMEM.
relume_status software_view_relight(const struct relume_image **out, struct software_view *v,
                                    struct software *shared, const struct code_source *source,
                                    const struct relume_light *lights, int n,
                                    const struct relume_log *log);

#endif
