// draw_panel.c - the panel's triangles onto the screen, by the viewer's own OpenGL
#include "panel/draw_panel.h"

#include "gl/target.h"

#include <math.h>
#include <stddef.h>

enum { SIZE, TEXTURE, COLOURED, COUNT };
static const char *const uniforms[] = {"frame_size", "texels", "coloured"};

relume_status draw_panel_create(struct panel_drawing *d, const struct gl *gl,
                                const struct panel *panel, const struct relume_log *log)
{
    *d = (struct panel_drawing){0};
    const relume_status status =
        program_create_with(&d->program, gl, "panel.vert", "panel.frag", uniforms, COUNT, log);
    if (status)
        return status;
    const struct panel_letters letters = panel_font(panel);
    gl->GenVertexArrays(1, &d->array);
    gl->GenBuffers(1, &d->vertices);
    gl->GenBuffers(1, &d->indices);
    gl->GenTextures(1, &d->letters);
    gl->GenTextures(1, &d->plot);
    texture_use(gl, 0, GL_TEXTURE_2D, d->letters);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_R8, letters.width, letters.height, 0, GL_RED,
                   GL_UNSIGNED_BYTE, letters.alpha);
    texture_settings(gl, GL_TEXTURE_2D);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return gl_check(gl, "panel", log);
}

void draw_panel_destroy(struct panel_drawing *d, const struct gl *gl)
{
    if (!d->array)
        return;
    program_destroy(&d->program, gl);
    gl->DeleteVertexArrays(1, &d->array);
    gl->DeleteBuffers(1, &d->vertices);
    gl->DeleteBuffers(1, &d->indices);
    gl->DeleteTextures(1, &d->letters);
    gl->DeleteTextures(1, &d->plot);
    *d = (struct panel_drawing){0};
}

void draw_panel_plot(const struct panel_drawing *d, const struct gl *gl,
                     const struct relume_image *plot)
{
    texture_use(gl, 0, GL_TEXTURE_2D, d->plot);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, plot->width, plot->height, 0, GL_RGB, GL_FLOAT,
                   plot->data);
    texture_settings(gl, GL_TEXTURE_2D);
}

static void upload(const struct panel_drawing *d, const struct gl *gl, const struct panel_run *run)
{
    gl->BindBuffer(GL_ARRAY_BUFFER, d->vertices);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)((size_t)run->vertices * sizeof *run->vertex),
                   run->vertex, GL_STREAM_DRAW);
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, d->indices);
    gl->BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)((size_t)run->indices * sizeof *run->index),
                   run->index, GL_STREAM_DRAW);
    const GLsizei stride = sizeof *run->vertex;
    gl->VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride,
                            (const void *)offsetof(struct panel_vertex, x));
    gl->VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, stride,
                            (const void *)offsetof(struct panel_vertex, u));
    gl->VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride,
                            (const void *)offsetof(struct panel_vertex, rgba));
}

static void draw_run(const struct panel_drawing *d, const struct gl *gl,
                     const struct panel_run *run, int height)
{
    const int left = relume_whole(floorf(fmaxf(run->clip[0], 0)));
    const int top = relume_whole(floorf(fmaxf(run->clip[1], 0)));
    const int right = relume_whole(ceilf(run->clip[2]));
    const int bottom = relume_whole(ceilf(run->clip[3]));
    if (right <= left || bottom <= top)
        return;
    const bool plot = run->texture == PANEL_PLOT;
    gl->Scissor(left, height - bottom, right - left, bottom - top);
    texture_use(gl, 0, GL_TEXTURE_2D, plot ? d->plot : d->letters);
    gl->Uniform1i(d->program.at[COLOURED], plot);
    gl->DrawElements(GL_TRIANGLES, run->count, GL_UNSIGNED_SHORT,
                     (const void *)((size_t)run->first * sizeof *run->index));
}

void draw_panel(const struct panel_drawing *d, const struct gl *gl, const struct panel *panel,
                int width, int height)
{
    const struct panel_vertex *uploaded = NULL;
    struct panel_run run;
    gl->Viewport(0, 0, width, height);
    gl->UseProgram(d->program.id);
    gl->Uniform2f(d->program.at[SIZE], (float)width, (float)height);
    gl->Uniform1i(d->program.at[TEXTURE], 0);
    gl->BindVertexArray(d->array);
    for (GLuint i = 0; i < 3; i++)
        gl->EnableVertexAttribArray(i);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    gl->Enable(GL_SCISSOR_TEST);
    for (int i = 0; panel_run_at(&run, panel, i); i++) {
        if (run.vertex != uploaded)
            upload(d, gl, &run);
        uploaded = run.vertex;
        draw_run(d, gl, &run, height);
    }
    gl->Disable(GL_SCISSOR_TEST);
    gl->Disable(GL_BLEND);
}
