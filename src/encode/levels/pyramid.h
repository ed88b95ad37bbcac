// pyramid.h - which views have reduced levels
#ifndef ENCODE_PYRAMID_H
#define ENCODE_PYRAMID_H

#include <relume/encode/pack_encode.h>

// Whether a view of that size is to have them; some cannot.
bool pyramid_is_wanted(enum relume_pyramid pyramid, int width, int height);
// Whether views of such a file can have them.
bool pyramid_is_possible(const struct relume_pack_contents *contents);

#endif
