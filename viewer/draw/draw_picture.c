// draw_picture.c - draws one relit view, moved and zoomed
#include "draw/draw.h"

enum { VIEW = DRAW_OWN, PICTURE, EXPOSURE, COUNT };
static const char *const uniforms[] = {"rectangle", "frame_size", "view", "picture", "exposure"};

const struct fragment draw_picture_fragment = {"picture.frag", uniforms, COUNT};

void draw_picture_within(const struct program *program, const struct gl *gl,
                         const struct frame_area *area, const struct target *view,
                         struct app_rectangle within)
{
    const struct app_rectangle *p = &area->picture;
    texture_use(gl, 0, GL_TEXTURE_2D, view->texture);
    gl->UseProgram(program->id);
    gl->Uniform1i(program->at[VIEW], 0);
    gl->Uniform4f(program->at[PICTURE], (float)p->left, (float)p->top, (float)p->right,
                  (float)p->bottom);
    gl->Uniform1f(program->at[EXPOSURE], area->exposure);
    draw_rectangle(gl, program, area, within);
}

void draw_picture(const struct program *program, const struct gl *gl, const struct frame_area *area,
                  const struct target *view)
{
    draw_picture_within(program, gl, area, view, area->picture);
}
