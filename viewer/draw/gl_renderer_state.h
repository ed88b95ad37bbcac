// gl_renderer_state.h - what a renderer keeps from frame to frame
#ifndef VIEWER_GL_RENDERER_STATE_H
#define VIEWER_GL_RENDERER_STATE_H

#include "draw/between.h"
#include "draw/file_views.h"
#include "draw/frame_programs.h"
#include "draw/objects_drawer.h"
#include "draw/painted_view.h"
#include "draw/slab_drawer.h"
#include "draw/tile_layer.h"
#include "draw/view_parts.h"
#include "glare/glare.h"
#include "relit/enhancer.h"
#include "relit/exchanger.h"

// Objects and the scene around them (gl_renderer_objects.c). Targets are made when first needed.
struct scene_objects {
    struct objects_drawer drawer;         // empty: there are no objects
    struct depth_source position_source;  // world positions of the pixels of views ...
    struct target *position;              // ... [views]
    struct target scene;                  // world positions that the frame shows
    struct target lit;                    // the scene under one light
    double ms[2];  // time of the last frame's objects, and of them in another material
};

// Light between scene and objects, in one way or in two that are compared (gl_renderer_ways.c).
struct light_exchange {
    struct exchange_source source;  // file NULL: light does not go between
    struct exchanger *exchanger;    // made when first needed
    struct target way[EXCHANGER_SLOTS], beside;
    bool waits;                        // for finished pictures of it
    bool by_library;                   // all ways are the library's
    bool no_points;                    // those that gather from points are the library's, too
    bool with_depth;                   // a panorama with depth
    double draws_ms[EXCHANGER_SLOTS];  // time of a way's own draws in the last frame; 0: none
    struct between between;            // ways that are drawn; made when first needed
};

struct gl_renderer {
    const struct gl *gl;
    const struct relume_log *log;
    GLuint vertices;
    struct frame_programs programs;
    struct file_views views;
    struct gl_relighter relighter;
    struct view_parts parts;
    struct tile_layer tiles;
    struct painted_view painted;  // in place of codes
    struct enhancer enhancer;
    struct slab_drawer slabs;
    struct scene_objects objects;
    struct light_exchange exchange;
    struct hiding_scene backdrop;  // that hides lights
    struct glare glare;
    struct target frame;
    const struct target *shown;  // `frame`, or what an eye sees of it; NULL: nothing drawn yet
    struct target small;         // of the frame, to meter
    bool stage;                  // there is nothing but objects
    bool empty;                  // there is nothing at all
};

#endif
