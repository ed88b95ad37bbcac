// between.h - light between a captured panorama and the objects in it, by draws over the frame:
// the ways of world/transport/screen.c on the graphics card
//
// They differ from that file in this: all directions are spread as the cosine (none by what is
// bright), rays end in the panorama where a march through its depth finds a surface, what is
// captured throws shadows by maps of the ball about the objects and a little more, and objects
// return light as their material shows a white sky. Ways that gather from points do so in
// transport/; lamps, and what becomes of what is gathered, are the same.
#ifndef VIEWER_BETWEEN_H
#define VIEWER_BETWEEN_H

#include "draw/between_frame.h"
#include "draw/between_points.h"
#include "draw/between_programs.h"
#include "draw/between_white.h"

// Zeroed it holds nothing.
struct between {
    const struct gl *gl;
    const struct relume_log *log;
    GLuint array;
    struct between_programs programs;
    struct light_uniforms uniforms;
    struct captured_mesh mesh;
    struct shadow_map captured;  // of a light sample, of the mesh
    struct between_white white;
    struct between_frame frame;
    struct between_points points;
};

// What all draws of a frame know.
struct between_view {
    const struct relume_geometry *geometry;
    const struct target *panorama_places;
    const struct target *scene;  // places in the frame
    const struct frame_projection *projection;
    int width, height;
    enum between_way way;
    int bounces;  // of light off objects
    int samples, pattern;
    int spacing;  // of ways that gather from points
    float sends;  // of what objects send of their own, under each light
};

// RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status between_create(struct between *b, const struct gl *gl,
                             const struct relume_geometry *geometry, const struct target *places,
                             const struct relume_log *log);
void between_destroy(struct between *b);
// What a way needs besides, of objects in the panorama that sees `places`. RELUME_ESYSTEM,
// RELUME_ENOMEM.
relume_status between_need(struct between *b, const struct objects_drawer *drawer,
                           const struct relume_geometry *geometry, const struct target *places,
                           enum between_way way, int samples);

// A frame: between_begin, for each light between_light, between_end. `drawer` has the surface of
// the objects when it has begun; what it has shaded in the end are all lights.
relume_status between_begin(struct between *b, struct objects_drawer *drawer,
                            const struct between_view *view);
// The scene alone shows `lone` under the light, the panorama `panorama`. Adds the scene as it is
// with the objects to `lit`.
relume_status between_light(struct between *b, struct objects_drawer *drawer,
                            const struct between_view *view, const struct relume_light *light,
                            const struct target *panorama, const struct target *lone,
                            const struct target *lit, float exposure);
void between_end(struct between *b, struct objects_drawer *drawer);

#endif
