// object_points.h - surfaces as points that gather and send light, for those who do with them what
// ways of transport do (transport.h), as the viewer does on the graphics card
//
// A tree of balls stands for all points in it (QSplat: Rusinkiewicz and Levoy 2000; Ritschel,
// Engelhardt, Grosch, Seidel, Kautz, Dachsbacher 2009, "Micro-rendering for scalable, parallel
// final gathering"). Beside it there are points spread evenly by area: any run of them that follow
// one another is, so that each of many users can take a run of its own (Ritschel, Grosch, Kim,
// Seidel, Dachsbacher, Kautz 2008, "Imperfect shadow maps for efficient computation of indirect
// illumination").
//
// Lengths are in the unit of the world. What points send under some light is not here: that is for
// who gathers. Thread-safety: plain data; the calls may be made from any thread.
#ifndef OBJECT_OBJECT_POINTS_H
#define OBJECT_OBJECT_POINTS_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/image.h>
#include <relume/world/object.h>

enum { RELUME_POINTS_WAYS = 8, RELUME_POINTS_LEVELS = 8 };

// A ball. Seen along the unit direction `d` the area of what is in it is about |facing . d| +
// turned, exactly so for planes and spheres.
struct relume_points_node {
    float middle[3], radius;  // the middle by area; radius below 0: there is no such node
    float facing[3], turned;  // the sum of areas times normals; half of what cancels in it
    // From where a step to the middle goes along `facing` by more than cone times its length +
    // edge, only backs are seen. `cone` may be infinite.
    float cone, edge;
    float area;
    int32_t child;  // node of the first of RELUME_POINTS_WAYS children; -1: it is a leaf
};

// A leaf of the tree of points: a small piece of a surface.
struct relume_points_leaf {
    float place[3], normal[3];  // somewhere in it; unit, on the side that light gets to
    bool is_far;                // background: only `normal` counts, which is the way it sends
    float returned[3];          // of objects: of even light; a white matte surface has 1
    float emitted[3];           // of objects: what it sends of its own
};

// What a leaf of a scene sends is the sum of what blocks of its pixels show, each times a weight;
// weights add up to 1.
struct relume_points_block {
    uint32_t block;
    float weight;
};

// Of a piece of surface that each of them stands for.
struct relume_points_spot {
    float place[3];
    float normal[3];  // unit, on the side that light gets to
    bool both;        // it gets to the other side, too
};

// Zeroed it is none. relume_points_free empties it.
struct relume_points {
    struct relume_points_node *node;  // [nodes]: the root's children first, level by level
    size_t nodes;
    size_t first[RELUME_POINTS_LEVELS + 1];  // node of each level, and behind the last
    int levels;                              // 0: there is nothing
    struct relume_points_leaf *leaf;         // [leaves]: node first[levels - 1] and so on
    size_t leaves;
    uint32_t *begins;                   // [leaves + 1] in `block`; of objects NULL
    struct relume_points_block *block;  // [begins[leaves]]
    int across, side;  // blocks in a row of the scene's picture, and their side in pixels
    struct relume_points_spot *spot;  // [spots]
    size_t spots;
    double area;  // that each of them stands for
};

// Parameters of relume_points_of_scene and relume_points_of_objects; 0 is the default of each
// field.
struct relume_points_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;  // default: all cores
    int leaves;   // of objects, at most; a power of two, [64, 65536]; default 4096
};
#define relume_points_params(...)                                                                  \
    (&(const struct relume_points_params){RELUME_SIZED(relume_points_params), __VA_ARGS__})

// Of a captured view of that geometry, whose pixels show `places` (three channels; NaN: nothing) to
// the geometry's eye; `objects` (NULL: none) stand in it, so that its background lies behind them.
// RELUME_EINVAL (channels), RELUME_ENOMEM, RELUME_ESYSTEM when Embree is missing.
relume_status relume_points_of_scene(struct relume_points *out,
                                     const struct relume_geometry *geometry,
                                     const struct relume_image *places,
                                     const relume_objects *objects,
                                     const struct relume_points_params *params);
// Of objects in the materials that they show: out[0] as light gets to them, out[1] the backs of
// what it gets to from both sides. RELUME_EINVAL (leaves), RELUME_ENOMEM.
relume_status relume_points_of_objects(struct relume_points out[2], const relume_objects *objects,
                                       const struct relume_points_params *params);
void relume_points_free(struct relume_points *points);

#endif
