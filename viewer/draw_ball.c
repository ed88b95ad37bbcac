#include "draw.h"

#include <math.h>

enum { BALL = DRAW_OWN, LIGHT, VALUE, COUNT };
static const char *const uniforms[] = {"rectangle", "frame_size", "ball", "light", "value"};

relume_status draw_ball_create(struct program *program, const struct gl *gl,
                               const struct relume_log *log)
{
    return program_create(program, gl, "ball.frag", uniforms, COUNT, log);
}

void draw_ball(const struct program *program, const struct gl *gl, const struct place *place,
               struct relume_vec3 light, const float rgb[3])
{
    const double radius = fmin(0.09 * fmin(place->width, place->height), 48.0);
    const double x = place->width - 1.4 * radius;
    const double y = place->height - 1.4 * radius;
    const float most = fmaxf(fmaxf(rgb[0], rgb[1]), fmaxf(rgb[2], 1e-6f));
    gl->UseProgram(program->id);
    gl->Uniform3f(program->at[BALL], (float)x, (float)y, (float)radius);
    gl->Uniform3f(program->at[LIGHT], (float)light.x, (float)light.y, (float)light.z);
    gl->Uniform3f(program->at[VALUE], rgb[0] / most, rgb[1] / most, rgb[2] / most);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    draw_rectangle(gl, program, place,
                   (struct app_rectangle){x - radius, y - radius, x + radius, y + radius});
    gl->Disable(GL_BLEND);
}
