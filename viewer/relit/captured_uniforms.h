// captured_uniforms.h - the captured lights as uniforms: the zone that they cover (captured.glsl)
// and the triangles between them (triangles.glsl)
#ifndef VIEWER_CAPTURED_UNIFORMS_H
#define VIEWER_CAPTURED_UNIFORMS_H

#include "gl/gl.h"
#include "relight/light/refit.h"

#include <relume/relight/relight.h>

// The uniforms of a zone, one after the other.
enum zone_uniform {
    ZONE_HEMISPHERE,
    ZONE_POLE_Y,
    ZONE_EVERYWHERE,
    ZONE_RIGHT,
    ZONE_UP,
    ZONE_FACING,
    ZONE_AXIS,
    ZONE_BORDER,
    ZONE_UNIFORMS
};
#define ZONE_NAMES                                                                                 \
    "hemisphere", "pole_y", "zone_everywhere", "zone_right", "zone_up", "zone_facing",             \
        "zone_axis", "zone_border"

// Fill `border`, a texture, by way of texture unit `unit`.
void zone_upload(const struct gl *gl, int unit, GLuint border, const relume_coder *coder);
// Set those of the program in use, `at` being where its list of them begins.
void zone_set(const struct gl *gl, const GLint *at, int unit, GLuint border,
              const relume_coder *coder);

// Rows of the texture of a grid's triangles.
int triangles_rows(const struct relume_weight_grid_info *grid);
// Fill `texture` by way of texture unit `unit`. RELUME_ENOMEM.
relume_status triangles_upload(const struct gl *gl, int unit, GLuint texture,
                               const struct relume_weight_grid_info *grid);

#endif
