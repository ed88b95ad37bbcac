// draw_panel.h - the panel's triangles onto the screen, by the viewer's own OpenGL
#ifndef VIEWER_DRAW_PANEL_H
#define VIEWER_DRAW_PANEL_H

#include "gl/program.h"
#include "panel/panel.h"

struct panel_drawing {
    struct program program;
    GLuint array, vertices, indices;
    GLuint letters, plot;
};

relume_status draw_panel_create(struct panel_drawing *drawing, const struct gl *gl,
                                const struct panel *panel, const struct relume_log *log);
void draw_panel_destroy(struct panel_drawing *drawing, const struct gl *gl);

// The picture of the inspector, display values of three channels.
void draw_panel_plot(const struct panel_drawing *drawing, const struct gl *gl,
                     const struct relume_image *plot);

// Into the framebuffer in use, `width` x `height` pixels whose first row is the lowest, as on the
// screen.
void draw_panel(const struct panel_drawing *drawing, const struct gl *gl, const struct panel *panel,
                int width, int height);

#endif
