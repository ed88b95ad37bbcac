// gl_renderer_parts.h - what the files of the renderer know of each other
#ifndef VIEWER_GL_RENDERER_PARTS_H
#define VIEWER_GL_RENDERER_PARTS_H

#include "draw/gl_renderer_state.h"

// Makes a target as large as the frame where it was not: it is empty then. RELUME_ESYSTEM.
relume_status gl_renderer_need(struct target *target, const struct gl_renderer *r,
                               const struct frame_area *area);
// The views that are needed, relit.
relume_status gl_renderer_relight_views(struct gl_renderer *r, const struct frame_request *request,
                                        const struct relume_light *lights, int count);
// The relit views as the framing shows them, into r->frame.
relume_status gl_renderer_frame(struct gl_renderer *r, const struct frame_request *request,
                                const struct frame_area *area);

// The frame with objects, into r->frame.
relume_status gl_renderer_draw_objects(struct gl_renderer *r, const struct frame_request *request,
                                       const struct frame_area *area,
                                       const struct relume_light *lights, int count);
void gl_renderer_objects_destroy(struct gl_renderer *r);

// The same with light between the scene and them, in the ways that the frame asks for.
relume_status gl_renderer_draw_ways(struct gl_renderer *r, const struct frame_request *request,
                                    const struct frame_area *area,
                                    const struct relume_light *lights, int count);
void gl_renderer_ways_destroy(struct gl_renderer *r);
// What they are drawn with, of a panorama with depth. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status gl_renderer_need_between(struct gl_renderer *r, const struct frame_request *request,
                                       const struct frame_area *area);
// What a way needs besides. Likewise.
relume_status gl_renderer_need_points(struct gl_renderer *r, const struct frame_request *request,
                                      enum between_way way);
// Draws in that way; false in *drawn where there are none for it.
relume_status gl_renderer_draw_between(bool *drawn, struct gl_renderer *r,
                                       const struct frame_request *request,
                                       const struct frame_area *area,
                                       const struct relume_light *lights, int count,
                                       enum between_way way);
// How objects appear in the frame; false where it is not flat.
bool gl_renderer_projection(struct frame_projection *out, const struct gl_renderer *r,
                            const struct frame_request *request, const struct frame_area *area);
// Where the frame sees the scene, into r->objects.scene.
relume_status gl_renderer_find_scene(struct gl_renderer *r, const struct frame_request *request,
                                     struct frame_area area);

#endif
