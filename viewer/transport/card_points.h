// card_points.h - surfaces of a captured panorama and of the objects in it as trees of points, in
// buffers of the graphics card
#ifndef VIEWER_CARD_POINTS_H
#define VIEWER_CARD_POINTS_H

#include "gl/program.h"
#include "gl/target.h"
#include "world/object/object_points.h"

// Of the scene, of the objects, and of the backs of what is lit from both sides.
enum { CARD_SCENE, CARD_OBJECTS, CARD_BACKS, CARD_TREES };

// Buffers that shaders see, by binding.
enum { CARD_NODES, CARD_SENTS, CARD_LEAVES, CARD_BLOCKS };

// Zeroed it is nothing.
struct card_points {
    const struct gl *gl;
    const struct relume_log *log;
    struct relume_points tree[CARD_TREES];
    uint64_t of;                      // materials that objects show
    GLuint node, sent, leaf, block;   // of all trees, one behind the other
    GLuint node_texels, sent_texels;  // the same as textures: three texels for each, two
    GLuint spot[2], spot_texels[2];   // of the scene and the objects: place and normal, two texels
    int first[CARD_TREES];            // node of each
    int leaves, of_scene;             // of which so many are the scene's, which come first
    struct target leaf_place, leaf_facing;  // a texel for each leaf; alpha 1 the scene, 2 objects
};

// Made anew where `of` is another than it was; the panorama's pixels see `places`. RELUME_ESYSTEM
// (there is no memory for them), RELUME_ENOMEM.
relume_status card_points_need(struct card_points *c, const struct gl *gl,
                               const struct relume_geometry *geometry, const struct target *places,
                               const relume_objects *objects, uint64_t of,
                               const struct relume_log *log);
void card_points_destroy(struct card_points *c);

#endif
