// draw.h - one function for each thing that can be drawn; each is a program and can be called alone
//
// All draw linear light into the target in use (present: onto the screen).
#ifndef VIEWER_DRAW_H
#define VIEWER_DRAW_H

#include "app/gizmo.h"
#include "app/view_geometry.h"
#include "draw/visible_lights.h"
#include "gl/program.h"
#include "gl/target.h"
#include "relight/frame/viewport.h"
#include "relight/view/view.h"

#include <relume/relight/slab_set.h>
#include <relume/relight/view.h>

// Where and how bright; pixels from the frame's top left corner.
struct frame_area {
    int width, height;             // of the frame
    struct app_rectangle picture;  // the whole picture, which may reach beyond the frame
    float exposure;                // factor
};

// The first two uniforms of every program.
enum { DRAW_RECTANGLE, DRAW_SIZE, DRAW_OWN };
// Draw with the program in use, only within `rectangle`.
void draw_rectangle(const struct gl *gl, const struct program *program,
                    const struct frame_area *area, struct app_rectangle rectangle);

// The same, within the whole frame.
void draw_whole(const struct gl *gl, const struct program *program, const struct frame_area *area);

// A view as it was captured.
extern const struct fragment draw_picture_fragment;
void draw_picture(const struct program *program, const struct gl *gl, const struct frame_area *area,
                  const struct target *view);
// The same, only within a rectangle of the frame.
void draw_picture_within(const struct program *program, const struct gl *gl,
                         const struct frame_area *area, const struct target *view,
                         struct app_rectangle within);

// A slab from an eye.
struct slab_inputs {
    const relume_slab *slab;
    const struct relume_geometry *geometry;
    struct relume_vec3 eye;
    const struct target *const *views;  // relit, by view number; NULL where they have no weight
    const struct relume_rect *part;     // by view number, where they are parts ...
    int size[2];                        // ... of views of this size; NULL: they are whole
};
// The quadralinear basis, or the nearest camera.
extern const struct fragment draw_slab_fragment;
void draw_slab(const struct program *program, const struct gl *gl, const struct frame_area *area,
               const struct slab_inputs *in, bool nearest);
// Each camera where it sees the surface: `disparity` are textures by view number, of the views that
// are there, `range` the least and the greatest value in any of them.
extern const struct fragment draw_slab_depth_fragment;
void draw_slab_depth(const struct program *program, const struct gl *gl,
                     const struct frame_area *area, const struct slab_inputs *in,
                     const GLuint *disparity, const double range[2]);
// Make four views between which a cell lies, and their disparities if there are any, samplers 0 to
// 3 and 4 to 7. Views of weight 0 were not relit: another one of the cell stands in. False when
// none was.
bool draw_use_cell(const struct gl *gl, const struct target *const *views, const GLuint *disparity,
                   const int cell[4]);

// What slab_window.glsl and its shaders know of the window: `at` are picture, st and eye.
void draw_use_window(const struct gl *gl, const struct frame_area *area,
                     const struct slab_inputs *in, const GLint at[3]);

// Several slabs through a window of the world, which the place's picture shows.
struct slabs_inputs {
    const relume_slab_set *slabs;
    const struct relume_window *window;
    const struct target *const *views;  // relit, by view number; NULL where they have no weight
    const GLuint *disparity;            // by depth: textures by view number, else NULL ...
    const double (*range)[2];           // ... and the least and the greatest value of each
    bool others;                        // there are rays that pass the cameras of no slab ...
    const struct target *passed;        // ... which are drawn where this has none; NULL: the rest
};
// Both add weighted values and their weights (alpha) to a black target, which draw_mean then
// divides.
extern const struct fragment draw_slabs_fragment;
void draw_slabs(const struct program *program, const struct gl *gl, const struct frame_area *area,
                const struct slabs_inputs *in, bool nearest);
extern const struct fragment draw_slabs_depth_fragment;
void draw_slabs_depth(const struct program *program, const struct gl *gl,
                      const struct frame_area *area, const struct slabs_inputs *in);

// Through an aperture: adds weighted values and their weights (alpha) to a black target, which
// draw_mean then divides. `aperture` and `focus` as relume_view_params.
extern const struct fragment draw_slab_lens_fragment;
void draw_slab_lens(const struct program *program, const struct gl *gl,
                    const struct frame_area *area, const struct slab_inputs *in, double aperture,
                    double focus);
extern const struct fragment draw_mean_fragment;
void draw_mean(const struct program *program, const struct gl *gl, const struct frame_area *area,
               const struct target *sum);

// How far a frame is from another one of its size, absolute.
extern const struct fragment draw_apart_fragment;
void draw_apart(const struct program *program, const struct gl *gl, const struct frame_area *area,
                const struct target *frame, const struct target *other);

// The shader that knows how a panorama is laid out.
const char *draw_panorama_shader(const struct relume_geometry *geometry);
// A perspective look into a panorama.
relume_status draw_panorama_create(struct program *program, const struct gl *gl,
                                   const struct relume_geometry *geometry,
                                   const struct relume_log *log);
void draw_panorama(const struct program *program, const struct gl *gl,
                   const struct frame_area *area, const struct relume_geometry *geometry,
                   struct relume_pan_tilt look, const struct target *view);

// The ball of gizmo_ball, lit from `light` (as the viewer sees it).
extern const struct fragment draw_ball_fragment;
void draw_ball(const struct program *program, const struct gl *gl, const struct frame_area *area,
               struct gizmo_circle ball, struct relume_vec3 light, const float rgb[3]);

// Lights that are in view, added to the frame.
extern const struct fragment draw_source_fragment;
void draw_sources(const struct program *program, const struct gl *gl, const struct frame_area *area,
                  const struct relume_visible_light *sources, int n);

// Where a frame lies in a window: so many pixels from its left edge.
struct window_place {
    int left, width, height;
};
// A linear frame onto a framebuffer whose first row is the lowest (0: the screen), through
// relume_tones[tone], coded as sRGB; `white` > 0.
extern const struct fragment draw_present_fragment;
void draw_present(const struct program *program, const struct gl *gl, const struct target *frame,
                  const struct window_place *window, int tone, double white, GLuint framebuffer);

#endif
