// distant.h - values under near lights become those under distant ones, pixel by pixel
#ifndef CAPTURE_DISTANT_H
#define CAPTURE_DISTANT_H

#include "capture/manifest/near_view.h"

// Thread-safety: one thread at a time.
struct distant;

// `near` is borrowed; `direction[lights]` are the distant lights' directions. RELUME_ENOMEM.
relume_status distant_create(struct distant **out, const struct near_view *near,
                             const vec3 *direction, int threads);
void distant_destroy(struct distant **distant);

// `band` as relume_table_read fills it, from row `row` of the view, levelled (near_view.h); in
// place. RELUME_ENOMEM.
relume_status distant_resample(struct distant *distant, int row, int rows, float *band);

#endif
