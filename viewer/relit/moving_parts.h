// moving_parts.h - what the files of moving.h know of each other
#ifndef VIEWER_MOVING_PARTS_H
#define VIEWER_MOVING_PARTS_H

#include "relit/moving_state.h"

// The uniforms of stage.glsl, one after the other.
enum stage_uniform {
    STAGE_SURFACE,
    STAGE_SPAN,
    STAGE_FRONT,
    STAGE_WINDOW,
    STAGE_AXIS,
    STAGE_PIXEL,
    STAGE_LEAST,
    STAGE_LOW,
    STAGE_HIGH,
    STAGE_UNIFORMS
};
#define STAGE_NAMES                                                                                \
    "surface", "span", "front", "window", "axis", "pixel_side", "least_side", "low", "high"
// Those of shown.glsl, of the rectangle and of the view's model.
enum shown_uniform {
    SHOWN_RECTANGLE,
    SHOWN_SIZE,
    SHOWN_CODED,
    SHOWN_CODING_CURVE,
    SHOWN_CODING_GAMMA,
    SHOWN_TIMES,
    SHOWN_DISPLAY_CURVE,
    SHOWN_DISPLAY_GAMMA,
    SHOWN_RGB,
    SHOWN_ORIGIN,
    SHOWN_EXCHANGES,
    SHOWN_WHOLE,
    SHOWN_COLOURS,
    SHOWN_MATTE,
    SHOWN_UNIFORMS
};
#define SHOWN_NAMES                                                                                \
    "rectangle", "frame_size", "coded", "coding.curve", "coding.gamma", "times", "display.curve",  \
        "display.gamma", "rgb", "origin", "exchanges", "whole", "colours", "matte"
// Texture units of the latter, then of a draw's own.
enum { MOVING_UNIT_CODED, MOVING_UNIT_WHOLE, MOVING_UNIT_COLOURS, MOVING_UNIT_MATTE, MOVING_UNITS };

// Set those of the program in use, `at` being where its list of them begins; three textures are
// bound to units from `unit` on.
enum { STAGE_UNITS = 3 };
void moving_set_stage(const struct gl *gl, const GLint *at, int unit, const struct moving_view *v);
// Use a program whose list begins with them, to draw into `into`.
void moving_set_shown(const struct gl *gl, const struct program *p, const struct moving_view *v,
                      const struct moving_picture *picture, const struct target *into);
void moving_draw_all(const struct gl *gl, const struct program *p, const struct target *into);
// Shaders that trace rays are variants by the kind of these.
enum { MOVING_DEFINES = 32 };
void moving_defines(char text[MOVING_DEFINES], const struct moving_view *v);

void moving_near_destroy(struct moving_near *near, const struct gl *gl);

#endif
