// target.h - a float texture that can be drawn into; row 0 is the top of the picture
#ifndef VIEWER_TARGET_H
#define VIEWER_TARGET_H

#include "gl/gl.h"

#include <relume/image.h>

struct target {
    int width, height;
    GLuint texture;  // RGBA32F
    GLuint framebuffer;
};

// RELUME_ESYSTEM when the machine cannot draw into such a texture.
relume_status target_create(struct target *target, const struct gl *gl, int width, int height,
                            const struct relume_log *log);
void target_destroy(struct target *target, const struct gl *gl);
// Makes it that large where it was not: it is empty then. RELUME_ESYSTEM.
relume_status target_need(struct target *target, const struct gl *gl, int width, int height,
                          const struct relume_log *log);
static inline void target_swap(struct target *a, struct target *b)
{
    const struct target was = *a;
    *a = *b;
    *b = was;
}

// Later draws go into all of it, black to begin with.
void target_begin(const struct target *target, const struct gl *gl);
// The same on top of what it holds.
void target_resume(const struct target *target, const struct gl *gl);
// Makes a framebuffer that draws into `n` of them at once, TARGET_JOINED at most, with a texture of
// depths (0: none), and uses it. False where OpenGL cannot.
enum { TARGET_JOINED = 6 };
bool target_join(GLuint *framebuffer, const struct gl *gl, const struct target *const *target,
                 int n, GLuint depth);
// Its first three channels as a new image. RELUME_ENOMEM.
relume_status target_read(struct relume_image *out, const struct target *target,
                          const struct gl *gl);

// Replace its pixels; `image` has three channels and its size.
void target_write(const struct target *target, const struct gl *gl,
                  const struct relume_image *image);

// Settings that every texture of the viewer has: no filter, no wrap, no mip levels. Shaders fetch
// texels and weigh them themselves, as the library does.
void texture_settings(const struct gl *gl, GLenum kind);
// Make `texture` the one that sampler number `unit` reads.
void texture_use(const struct gl *gl, int unit, GLenum kind, GLuint texture);

#endif
