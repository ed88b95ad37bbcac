// draw_present.c - draws the frame on the screen: exposure, tone and the sRGB curve
#include "draw/draw.h"

enum { FRAME = DRAW_OWN, TONE, WHITE, LEFT, COUNT };
static const char *const uniforms[] = {"rectangle", "frame_size", "frame", "tone", "white", "left"};

const struct fragment draw_present_fragment = {"present.frag", uniforms, COUNT};

void draw_present(const struct program *program, const struct gl *gl, const struct target *frame,
                  const struct window_place *window, int tone, double white, GLuint framebuffer)
{
    const struct frame_area area = {.width = frame->width, .height = frame->height};
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    if (window->width > frame->width) {
        gl->Viewport(0, 0, window->width, window->height);
        gl->ClearColor(0, 0, 0, 1);
        gl->Clear(GL_COLOR_BUFFER_BIT);
    }
    gl->Viewport(window->left, 0, frame->width, frame->height);
    texture_use(gl, 0, GL_TEXTURE_2D, frame->texture);
    gl->UseProgram(program->id);
    gl->Uniform1i(program->at[FRAME], 0);
    gl->Uniform1i(program->at[TONE], tone);
    gl->Uniform1f(program->at[WHITE], (float)white);
    gl->Uniform1f(program->at[LEFT], (float)window->left);
    draw_whole(gl, program, &area);
}
