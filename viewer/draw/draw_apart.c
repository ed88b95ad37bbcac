// draw_apart.c - draws how far two frames are from each other
#include "draw/draw.h"

enum { FRAME = DRAW_OWN, OTHER, COUNT };
static const char *const uniforms[] = {"rectangle", "frame_size", "frame", "other"};

const struct fragment draw_apart_fragment = {"between_apart.frag", uniforms, COUNT};

void draw_apart(const struct program *program, const struct gl *gl, const struct frame_area *area,
                const struct target *frame, const struct target *other)
{
    texture_use(gl, 0, GL_TEXTURE_2D, frame->texture);
    texture_use(gl, 1, GL_TEXTURE_2D, other->texture);
    gl->UseProgram(program->id);
    gl->Uniform1i(program->at[FRAME], 0);
    gl->Uniform1i(program->at[OTHER], 1);
    draw_whole(gl, program, area);
}
