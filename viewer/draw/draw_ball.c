// draw_ball.c - draws the ball that shows where the light comes from
#include "draw/draw.h"

#include <math.h>

enum { BALL = DRAW_OWN, LIGHT, VALUE, COUNT };
static const char *const uniforms[] = {"rectangle", "frame_size", "ball", "light", "value"};

const struct fragment draw_ball_fragment = {"ball.frag", uniforms, COUNT};

void draw_ball(const struct program *program, const struct gl *gl, const struct frame_area *area,
               struct gizmo_circle ball, struct relume_vec3 light, const float rgb[3])
{
    const float most = fmaxf(fmaxf(rgb[0], rgb[1]), fmaxf(rgb[2], 1e-6f));
    gl->UseProgram(program->id);
    gl->Uniform3f(program->at[BALL], (float)ball.x, (float)ball.y, (float)ball.radius);
    gl->Uniform3f(program->at[LIGHT], (float)light.x, (float)light.y, (float)light.z);
    gl->Uniform3f(program->at[VALUE], rgb[0] / most, rgb[1] / most, rgb[2] / most);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    draw_rectangle(gl, program, area,
                   (struct app_rectangle){ball.x - ball.radius, ball.y - ball.radius,
                                          ball.x + ball.radius, ball.y + ball.radius});
    gl->Disable(GL_BLEND);
}
