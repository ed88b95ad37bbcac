// joined.h - targets that are drawn at once
#ifndef VIEWER_JOINED_H
#define VIEWER_JOINED_H

#include "gl/target.h"

enum { JOINED_MAX = 4 };

// Zeroed it holds nothing.
struct joined {
    struct target target[JOINED_MAX];
    int count;
    GLuint framebuffer;
};

// Makes `count` targets and frees the old ones. RELUME_ESYSTEM.
relume_status joined_create(struct joined *j, const struct gl *gl, int count, int width, int height,
                            const struct relume_log *log);
void joined_destroy(struct joined *j, const struct gl *gl);
// Later draws go into all of them, on top of what they hold; and black to begin with.
void joined_resume(const struct joined *j, const struct gl *gl);
void joined_begin(const struct joined *j, const struct gl *gl);

#endif
