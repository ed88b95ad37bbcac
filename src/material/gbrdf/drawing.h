// drawing.h - drawings and masks: as files keep them, and laid on a sample
#ifndef EDIT_DRAWING_H
#define EDIT_DRAWING_H

#include <relume/material/edit.h>

// A copy of at most RELUME_EDIT_MOST_SIDE a side and 256 levels from 0 to 1; empty of an empty one.
// RELUME_ENOMEM.
relume_status drawing_keep(struct relume_image *out, const struct relume_image *picture);

// Its levels as text for JSON, to be freed: runs of bytes (PackBits) in base 64. NULL: no memory.
char *drawing_text(const struct relume_image *picture);
// The inverse: false for a text that is no picture of width x height. RELUME_ENOMEM is `*status`.
bool drawing_from_text(struct relume_image *out, int width, int height, const char *text,
                       relume_status *status);

// The drawing of emboss and engrave on a sample of width x height: values of all texels, 0 beside
// it, which goes on at the other side where `wraps`. RELUME_EUNFIT with a sentence for one that is
// higher than the sample, RELUME_ENOMEM.
relume_status drawing_lay(struct relume_image *out, const struct relume_edit *edit, int width,
                          int height, bool wraps, const struct relume_log *log);
// The mask stretched over the sample, all 1 where there is none. RELUME_ENOMEM.
relume_status mask_lay(struct relume_image *out, const struct relume_edit *edit, int width,
                       int height);

#endif
