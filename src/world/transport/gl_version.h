// gl_version.h - which OpenGL a transport method needs in relume-view
#ifndef TRANSPORT_GL_VERSION_H
#define TRANSPORT_GL_VERSION_H

#include <relume/world/transport.h>

// The version of OpenGL, times ten, with which relume-view draws this method over each frame
// of a panorama with depth; 0: it cannot.
int relume_transport_gl_version(const struct relume_transport *transport);

#endif
