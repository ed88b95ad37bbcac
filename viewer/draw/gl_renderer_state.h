// gl_renderer_state.h - what a renderer keeps from frame to frame
#ifndef VIEWER_GL_RENDERER_STATE_H
#define VIEWER_GL_RENDERER_STATE_H

#include "app/frame_request.h"
#include "draw/between.h"
#include "draw/draw.h"
#include "draw/objects_drawer.h"
#include "glare/glare.h"
#include "relit/depths.h"
#include "relit/enhancer.h"
#include "relit/exchanger.h"
#include "relit/gl_relighter.h"
#include "relit/tile_map.h"

// Who shows a planar view under lights in place of codes.
struct view_painter {
    void *user;
    relume_status (*paint)(struct relume_image *out, void *user, const struct relume_light *lights,
                           int n);
};

struct gl_renderer {
    const struct gl *gl;
    const struct relume_log *log;
    struct gl_relighter relighter;
    struct gl_relighter tiles;   // of a large view, which the other knows smaller; empty: none ...
    const struct tile_map *map;  // ... by number; NULL: none
    const struct target **tile;  // [tiles]: relit; NULL where not needed or not there yet
    struct enhancer enhancer;
    struct glare glare;
    struct program picture, slab, slab_depth, slab_lens, slabs, slabs_depth, mean, panorama, ball,
        source, present, apart;
    GLuint vertices;
    struct target frame;
    const struct target *shown;  // `frame`, or what an eye sees of it; NULL: nothing drawn yet
    struct target small;         // of the frame, to meter
    struct target sum;       // of an aperture's cameras, of several slabs; made when first needed
    struct target beside;    // of several slabs, of rays that pass none's cameras; likewise
    struct target pinholes;  // of a lens before several slabs, their sum; likewise
    relume_slab *grid;       // NULL: not a slab, or several
    const relume_slab_set *around;  // several; else NULL
    const int *slab_of;             // of several: [views]
    struct depths depths;           // empty: not a slab, or without depth
    struct relume_geometry geometry;
    int views;
    double (*uv)[2];  // [views]
    bool *needed;     // [views]
    // Of a slab whose needed views are too much for the graphics memory: what is here of each.
    struct relume_rect *part;  // [views]
    bool by_parts;
    int size[2];                   // of views; 0: they are not read by parts
    size_t view_bytes;             // of a whole one there
    bool display;                  // environments are refitted
    const struct target **relit;   // [views]; NULL where not needed
    struct objects_drawer drawer;  // objects; empty: none
    bool stage;                    // there is nothing but objects
    bool empty;                    // there is nothing at all
    struct view_painter painter;   // none: codes
    struct target painted;         // by it, under
    struct relume_light *painted_light;
    int painted_lights;
    bool is_painted;
    // Of a scene with objects: where it is, what one light shows of it, and of each view what its
    // pixels see; made when first needed.
    struct depth_source place_source;
    struct target scene, lit, *place;
    double
        objects_drawer_ms[2];  // what the objects took in the last frame, and in another material
    struct hiding_scene backdrop;  // that hides lights
    // Light between scene and objects, of two ways that are compared; made when first needed.
    struct exchange_source exchange;  // file NULL: it does not go between
    struct exchanger *exchanger;
    struct target way[EXCHANGER_SLOTS], beside_way;
    bool waits;                         // for finished pictures of it
    bool ways_by_library;               // all of them
    bool no_points;                     // those that gather from points are the library's, too
    bool with_depth;                    // a panorama
    double passes_ms[EXCHANGER_SLOTS];  // that own passes of a way took in the last frame; 0: there
                                        // are none
    struct between between;             // those that are passes; made when first needed
};

#endif
