// draw.c - one function for each thing that can be drawn; each is a program and can be called alone
#include "draw/draw.h"

void draw_rectangle(const struct gl *gl, const struct program *program,
                    const struct frame_area *area, struct app_rectangle rectangle)
{
    gl->Uniform4f(program->at[DRAW_RECTANGLE], (float)rectangle.left, (float)rectangle.top,
                  (float)rectangle.right, (float)rectangle.bottom);
    gl->Uniform2f(program->at[DRAW_SIZE], (float)area->width, (float)area->height);
    gl->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void draw_whole(const struct gl *gl, const struct program *program, const struct frame_area *area)
{
    draw_rectangle(gl, program, area, (struct app_rectangle){0, 0, area->width, area->height});
}
