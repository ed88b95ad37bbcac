// passes.h - how often a transport method repeats
#ifndef TRANSPORT_PASSES_H
#define TRANSPORT_PASSES_H

#include <relume/world/transport.h>

// The version of OpenGL, times ten, with which relume-view gathers this way by passes over each
// frame of a panorama with depth; 0: it has none for it.
int relume_transport_passes(const struct relume_transport *transport);

#endif
