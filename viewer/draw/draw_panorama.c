// draw_panorama.c - draws a look into a panorama
#include "draw/draw.h"

#include <math.h>

enum { VIEW = DRAW_OWN, ELEVATION, LOOK, STEREOGRAPHIC, LOOK_SIZE, EXPOSURE, DISC, COUNT };
static const char *const uniforms[] = {
    "rectangle",     "frame_size", "view",     "elevation", "look",
    "stereographic", "look_size",  "exposure", "disc",
};

const char *draw_panorama_shader(const struct relume_geometry *geometry)
{
    return geometry->projection == RELUME_CUBE        ? "panorama_cube.frag"
           : geometry->projection == RELUME_SPHERICAL ? "panorama_sphere.frag"
           : geometry->disc                           ? "panorama_discs.frag"
                                                      : "panorama_cylinder.frag";
}

relume_status draw_panorama_create(struct program *program, const struct gl *gl,
                                   const struct relume_geometry *geometry,
                                   const struct relume_log *log)
{
    return program_create(program, gl, draw_panorama_shader(geometry), uniforms, COUNT, log);
}

void draw_panorama(const struct program *program, const struct gl *gl,
                   const struct frame_area *area, const struct relume_geometry *geometry,
                   struct relume_pan_tilt look, const struct target *view)
{
    const GLint *at = program->at;
    texture_use(gl, 0, GL_TEXTURE_2D, view->texture);
    gl->UseProgram(program->id);
    gl->Uniform1i(at[VIEW], 0);
    gl->Uniform2f(at[ELEVATION], (float)geometry->v_min, (float)geometry->v_max);
    gl->Uniform3f(at[LOOK], (float)(look.pan_deg * M_PI / 180), (float)(look.tilt_deg * M_PI / 180),
                  (float)(1.0 / look.zoom));
    gl->Uniform1i(at[STEREOGRAPHIC], look.stereographic);
    gl->Uniform2f(at[LOOK_SIZE], (float)area->width, (float)area->height);
    gl->Uniform1f(at[EXPOSURE], area->exposure);
    gl->Uniform1f(at[DISC], (float)geometry->disc);
    draw_whole(gl, program, area);
}
