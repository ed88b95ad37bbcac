// transport.h - how light goes between a captured scene and objects that stand in it
//
// A captured scene with depth is light for the objects in it: what a pixel shows leaves the place
// that it shows, in all directions alike. Objects stand in that light, throw it back onto the scene
// and keep it from there. A way of transport says which light arrives at a place, from where, with
// the objects and without them; what is done with it is the same for all:
//     an object shows it as its material throws it back;
//     a pixel of the scene is multiplied by what arrives with the objects over what arrives without
//     (differential rendering: Debevec 1998, "Rendering synthetic objects into real scenes", here
//     as a ratio, so that no reflectance of the scene need be known).
// Lamps are looked for by rays in all ways, and what is captured stands in their way.
#ifndef RELUME_TRANSPORT_H
#define RELUME_TRANSPORT_H

#include <relume/base.h>

#ifdef __cplusplus
extern "C" {
#endif

// Constant; a NULL-terminated list of all is relume_transports.
struct relume_transport;
// All ways; the first is "none": objects throw hard shadows, and no light goes between. NULL ends
// the list.
extern RELUME_API const struct relume_transport *const relume_transports[];
// NULL when there is none of that name.
RELUME_API const struct relume_transport *relume_transport_find(const char *name);
// As people write it; constant.
RELUME_API const char *relume_transport_name(const struct relume_transport *transport);
// Directions that light is gathered from at each pixel, where nothing else is asked for; 0: none.
RELUME_API int relume_transport_samples(const struct relume_transport *transport);
// Pixels from one that gathers to the next, where nothing else is asked for; 0: always each.
RELUME_API int relume_transport_spacing(const struct relume_transport *transport);
// Further cameras that look at the objects, where nothing else is asked for; -1: it has none.
RELUME_API int relume_transport_cameras(const struct relume_transport *transport);

#ifdef __cplusplus
}
#endif
#endif
