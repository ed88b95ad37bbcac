// light_uniforms.h - a light as uniforms of light.glsl, and the pictures that some lights need as
// textures
#ifndef VIEWER_LIGHT_UNIFORMS_H
#define VIEWER_LIGHT_UNIFORMS_H

#include "gl/gl.h"

#include <relume/light.h>

struct light_uniforms_picture;

// Zeroed but for these two, which must outlive it, it holds nothing.
struct light_uniforms {
    const struct gl *gl;
    const struct relume_log *log;
    struct light_uniforms_picture
        *picture;  // what slides and photometric lights need, by their pointers
};

// The uniforms of a light, one after the other.
enum light_uniforms_uniform {
    LIGHT_KIND,
    LIGHT_RGB,
    LIGHT_NOFALL,
    LIGHT_POSITION,
    LIGHT_AXIS,
    LIGHT_RIGHT,
    LIGHT_UP,
    LIGHT_HALF_ANGLE,
    LIGHT_UNIFORMS
};
#define LIGHT_NAMES                                                                                \
    "light.kind", "light.rgb", "light.nofall", "light.position", "light.axis", "light.right",      \
        "light.up", "light.half_angle"

// Set those of the program in use, `at` being where its list of them begins; its picture is bound
// to texture unit `unit`. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status light_uniforms_set(struct light_uniforms *s, const GLint *at, int unit,
                                 const struct relume_light *light);
// Pictures and photometric files may have gone: forget what was kept of them.
void light_uniforms_forget(struct light_uniforms *s);

// Fill a texture with the side x side patches of an area light, a column each (light_patches.glsl),
// and leave it bound to texture unit `unit`. RELUME_ENOMEM.
relume_status light_uniforms_patches(const struct gl *gl, int unit, GLuint texture,
                                     const struct relume_light *area, int side);

// Fill a texture with floats, by way of texture unit `unit`.
void light_uniforms_upload(const struct gl *gl, int unit, GLuint texture, GLint internal,
                           GLenum format, int width, int height, const float *values);

#endif
