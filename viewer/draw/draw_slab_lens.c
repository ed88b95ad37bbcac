// draw_slab_lens.c - a slab through an aperture: cameras are added one by one, then divided
#include "draw/draw.h"
#include "relight/view/view.h"

enum { VIEW = DRAW_OWN, PICTURE, ST, EYE, PLACE, STEPS, GRID, LENS, COUNT };
static const char *const uniforms[] = {
    "rectangle", "frame_size", "view", "picture", "st", "eye", "camera", "steps", "grid", "lens",
};
enum { SUM = DRAW_OWN, EXPOSURE, MEAN_COUNT };
static const char *const mean_uniforms[] = {"rectangle", "frame_size", "sum", "exposure"};

const struct fragment draw_slab_lens_fragment = {"slab_lens.frag", uniforms, COUNT};
const struct fragment draw_mean_fragment = {"mean.frag", mean_uniforms, MEAN_COUNT};

static void set_uniforms(const struct program *program, const struct gl *gl,
                         const struct frame_area *area, const struct slab_inputs *in,
                         double aperture, double focus)
{
    const struct relume_geometry *g = in->geometry;
    const struct relume_slab_grid grid = relume_slab_grid(in->slab);
    const double disparity = relume_slab_plane_disparity(in->slab, g->st_z + focus);
    const GLint *at = program->at;
    gl->UseProgram(program->id);
    gl->Uniform1i(at[VIEW], 0);
    draw_use_window(gl, area, in, at + PICTURE);
    gl->Uniform4f(at[GRID], (float)grid.u[0], (float)grid.v[0], (float)grid.u[grid.columns - 1],
                  (float)grid.v[grid.rows - 1]);
    gl->Uniform2f(at[LENS], (float)(0.5 * aperture), (float)disparity);
}

void draw_slab_lens(const struct program *program, const struct gl *gl,
                    const struct frame_area *area, const struct slab_inputs *in, double aperture,
                    double focus)
{
    const struct relume_slab_grid grid = relume_slab_grid(in->slab);
    const GLint *at = program->at;
    set_uniforms(program, gl, area, in, aperture, focus);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    for (int row = 0; row < grid.rows; row++)
        for (int column = 0; column < grid.columns; column++) {
            const int view = grid.view[(size_t)row * (size_t)grid.columns + (size_t)column];
            const struct relume_slab_lens lens = relume_slab_lens(in->slab, column, row);
            if (!in->views[view])
                continue;
            texture_use(gl, 0, GL_TEXTURE_2D, in->views[view]->texture);
            gl->Uniform2f(at[PLACE], (float)lens.place[0], (float)lens.place[1]);
            gl->Uniform4f(at[STEPS], (float)lens.step[0][0], (float)lens.step[0][1],
                          (float)lens.step[1][0], (float)lens.step[1][1]);
            draw_rectangle(gl, program, area, area->picture);
        }
    gl->Disable(GL_BLEND);
}

void draw_mean(const struct program *program, const struct gl *gl, const struct frame_area *area,
               const struct target *sum)
{
    texture_use(gl, 0, GL_TEXTURE_2D, sum->texture);
    gl->UseProgram(program->id);
    gl->Uniform1i(program->at[SUM], 0);
    gl->Uniform1f(program->at[EXPOSURE], area->exposure);
    draw_whole(gl, program, area);
}
