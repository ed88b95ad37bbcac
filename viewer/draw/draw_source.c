// draw_source.c - draws the lights that are in view as small bright points
#include "draw/draw.h"
#include "relight/frame/viewport.h"

#include <math.h>

enum { MIDDLE = DRAW_OWN, VALUE, COUNT };
static const char *const uniforms[] = {"rectangle", "frame_size", "middle", "value"};

const struct fragment draw_source_fragment = {"source.frag", uniforms, COUNT};

void draw_sources(const struct program *program, const struct gl *gl, const struct frame_area *area,
                  const struct relume_visible_light *sources, int n)
{
    gl->UseProgram(program->id);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    for (int i = 0; i < n; i++) {
        const struct relume_visible_light *s = &sources[i];
        const double left = floor(s->x - 0.5), top = floor(s->y - 0.5);
        const float e = area->exposure;
        gl->Uniform2f(program->at[MIDDLE], (float)s->x, (float)s->y);
        gl->Uniform3f(program->at[VALUE], e * s->rgb[0], e * s->rgb[1], e * s->rgb[2]);
        draw_rectangle(gl, program, area, (struct app_rectangle){left, top, left + 2, top + 2});
    }
    gl->Disable(GL_BLEND);
}
