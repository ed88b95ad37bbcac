// pyramid.h - which views have reduced levels
#ifndef ENCODE_PYRAMID_H
#define ENCODE_PYRAMID_H

#include "format/pack/pack_write.h"

#include <relume/encode/pack_encode.h>

// The middle view relit from the front, panoramas from above: hand it in as `preview`, the contents
// themselves (struct relume_pack_contents) as its user. Always in plain C, so that files do not
// depend on the processor. RELUME_EIO, RELUME_ENOMEM.
relume_status relume_pack_preview(void *contents, int row, int rows, float *rgb);

// The reduced levels of `view`, made of its coefficients, for its `levels`; none where `pyramid`
// asks for none. What is used of `contents` is what all of a file has in common, and of `params`
// log, step, threads and scratch. RELUME_EUNFIT with a sentence where YES cannot be had: slabs,
// luminance coefficients. RELUME_EIO, RELUME_ENOMEM. End with
// relume_pack_levels_destroy.
relume_status relume_pack_reduce(struct relume_pack_levels *out,
                                 const struct relume_pack_contents *contents,
                                 const struct relume_pack_view *view, enum relume_pyramid pyramid,
                                 const struct relume_project_params *params);
void relume_pack_levels_destroy(struct relume_pack_levels *levels);

// Whether a view of that size is to have them; some cannot.
bool pyramid_is_wanted(enum relume_pyramid pyramid, int width, int height);
// Whether views of such a file can have them.
bool pyramid_is_possible(const struct relume_pack_contents *contents);

#endif
