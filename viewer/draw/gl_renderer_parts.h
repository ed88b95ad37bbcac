// gl_renderer_parts.h - what the files of the renderer know of each other
#ifndef VIEWER_GL_RENDERER_PARTS_H
#define VIEWER_GL_RENDERER_PARTS_H

#include "draw/gl_renderer_state.h"

// A target of that size, made anew where it had another.
relume_status renderer_prepare(struct target *target, const struct renderer *r, int width,
                               int height);
// The views that are needed, relit.
relume_status renderer_relight_views(struct renderer *r, const struct frame_request *request,
                                     const struct relume_light *lights, int count);
// r->relit as the framing shows them, into r->frame.
relume_status renderer_frame(struct renderer *r, const struct frame_request *request,
                             const struct place *place);

// The tiles of a large view that a frame shows finer than the view as a whole, relit; and both
// drawn.
relume_status renderer_relight_tiles(struct renderer *r, const struct frame_request *request,
                                     const struct relume_light *lights, int count);
void renderer_draw_tiles(struct renderer *r, const struct place *place, const struct target *view);
void renderer_tiles_destroy(struct renderer *r);

// The frame with objects, into r->frame.
relume_status renderer_draw_objects(struct renderer *r, const struct frame_request *request,
                                    const struct place *place, const struct relume_light *lights,
                                    int count);
void renderer_objects_destroy(struct renderer *r);

// The same with light between the scene and them, in the ways that the frame asks for.
relume_status renderer_draw_ways(struct renderer *r, const struct frame_request *request,
                                 const struct place *place, const struct relume_light *lights,
                                 int count);
void renderer_ways_destroy(struct renderer *r);
// What they are drawn with, of a panorama with depth. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status renderer_need_between(struct renderer *r, const struct frame_request *request,
                                    const struct place *place);
// What a way needs besides. Likewise.
relume_status renderer_need_points(struct renderer *r, const struct frame_request *request,
                                   enum between_way way);
// By passes, in that way; false in *drawn where there are none for it.
relume_status renderer_draw_between(bool *drawn, struct renderer *r,
                                    const struct frame_request *request, const struct place *place,
                                    const struct relume_light *lights, int count,
                                    enum between_way way);
// How objects appear in the frame; false where it is not flat.
bool renderer_projection(struct frame_projection *out, const struct renderer *r,
                         const struct frame_request *request, const struct place *place);
// Where the frame sees the scene, into r->scene.
relume_status renderer_find_scene(struct renderer *r, const struct frame_request *request,
                                  struct place place);

#endif
