// renderer.h - what the app says becomes a frame: relit views, then the drawing of the framing
#ifndef VIEWER_RENDERER_H
#define VIEWER_RENDERER_H

#include "app/app.h"
#include "draw/draw.h"
#include "draw/things.h"
#include "glare/glare.h"
#include "relit/depths.h"
#include "relit/enhancer.h"
#include "relit/relighter.h"

struct renderer {
    const struct gl *gl;
    const struct relume_log *log;
    struct relighter relighter;
    struct enhancer enhancer;
    struct glare glare;
    struct program picture, slab, slab_depth, slab_lens, slabs, slabs_depth, mean, panorama, ball,
        source, present;
    GLuint vertices;
    struct target frame;
    const struct target *shown;  // `frame`, or what an eye sees of it; NULL: nothing drawn yet
    struct target small;         // of the frame, to meter
    struct target sum;       // of an aperture's cameras, of several slabs; made when first needed
    struct target pinholes;  // of a lens before several slabs, their sum; likewise
    relume_slab *grid;       // NULL: not a slab, or several
    const relume_slabs *around;  // several; else NULL
    const int *slab_of;          // of several: [views]
    struct depths depths;        // empty: not a slab, or without depth
    struct relume_geometry geometry;
    int views;
    double (*uv)[2];              // [views]
    bool *needed;                 // [views]
    const struct target **relit;  // [views]; NULL where not needed
    struct relume_light *light;   // that shine; room for `room`
    int lights, room;
    struct things things;  // objects; empty: none
    bool stage;            // there is nothing but objects
    bool empty;            // there is nothing at all
    // Of a scene with objects: where it is, what one light shows of it, and of each view what its
    // pixels see; made when first needed.
    struct depth_source place_source;
    struct target scene, lit, *place;
    double things_ms[2];         // what the objects took in the last frame, and in another material
    struct lamp_scene backdrop;  // that hides lights
};

// `uv` [views] places the cameras of a slab; NULL: there is none, or renderer_use_slabs tells.
// RELUME_ESYSTEM, RELUME_ENOMEM, RELUME_EDATA.
relume_status renderer_create(struct renderer *renderer, const struct gl *gl,
                              const struct code_source *source,
                              const struct relume_geometry *geometry, const double (*uv)[2],
                              int views, const struct relume_log *log);
void renderer_destroy(struct renderer *renderer);

// Several slabs; all of it must outlive the renderer.
void renderer_use_slabs(struct renderer *renderer, const relume_slabs *slabs, const double (*uv)[2],
                        const int *slab_of);

// The views of a slab, or of several, have depth. RELUME_ENOMEM.
relume_status renderer_use_depth(struct renderer *renderer, const struct depth_source *source);

// A capture of the file to compare with, for RELUME_PASS_DIFFERENCE; it must outlive the renderer.
void renderer_use_capture(struct renderer *renderer, const relume_capture *capture);

// Objects covered with measured materials, which must outlive the renderer: into the scene whose
// views' places `places` tells (three channels), or alone on a stage when that is NULL.
// RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status renderer_use_objects(struct renderer *renderer, relume_objects *objects,
                                   const struct depth_source *places);

// Draw the frame that `app` describes, linear, into renderer->frame. After renderer_stream, views
// that are still being read are stood in for by their nearest neighbours, and renderer_is_pending
// tells that another frame would be better.
relume_status renderer_stream(struct renderer *renderer);
bool renderer_is_pending(const struct renderer *renderer);
relume_status renderer_draw(struct renderer *renderer, const struct app *app);
// The last frame as an image, linear; the caller destroys it.
relume_status renderer_read(struct relume_image *out, const struct renderer *renderer);
// What relume_tone_meter says of the last frame, seen through a small copy of it.
relume_status renderer_meter(double *ev, struct renderer *renderer);
// The last frame by the app's tone onto a framebuffer of its size, coded for the screen (0: the
// screen).
void renderer_present(const struct renderer *renderer, const struct app *app, GLuint framebuffer);

#endif
