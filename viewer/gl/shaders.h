// shaders.h - the shaders of viewer/shaders as strings, packed by scripts/embed.sh
#ifndef VIEWER_SHADERS_H
#define VIEWER_SHADERS_H

#include <stddef.h>

struct shader_source {
    const char *name;  // "slab.frag"
    const char *const *line;
    size_t lines;
};
// Ends with a NULL name.
extern const struct shader_source shader_sources[];

#endif
