// baked.h - the inside of relume_baked
#ifndef BAKED_BAKED_H
#define BAKED_BAKED_H

#include "image/geometry/frame.h"
#include "shape/atlas/atlas.h"

#include <relume/world/bake.h>

enum { BAKED_NONE = 0xffff };  // the cluster of a texel that holds nothing

// What a light becomes: `count` weights for each of R, G, B.
struct baked_basis {
    int count;
    int cube;             // texels a side of its faces; 0: `coder`, or fixed where that is NULL
    relume_coder *coder;  // of any light
    vec3 *direction;      // [directions]: where any light is sampled
    int directions;
};
// Of `kept` parameters; nothing where they ask for fixed light. Errors of relume_coder_create,
// RELUME_EINVAL with a sentence.
relume_status basis_make(struct baked_basis *out, const struct relume_basis *basis, int count,
                         int cube, int directions, const struct relume_log *log);
void basis_free(struct baked_basis *b);
// Coefficients out[views][count][3] of samples[directions][views][3], which are spoilt.
// RELUME_ENOMEM.
relume_status basis_analyse(float *out, const struct baked_basis *b, float *samples, int views);
// Light that arrives from a unit direction is added to weights[3][count]; all of it then becomes
// weights of what basis_analyse has found.
void basis_add(float *weights, const struct baked_basis *b, vec3 direction, const float rgb[3]);
void basis_finish(float *weights, const struct baked_basis *b);

struct relume_baked {
    struct relume_baked_info info;
    struct baked_basis basis;
    struct atlas_corner (*triangle)[3];
    int blocks, views;  // clusters and components of their own, each of `views` views
    uint16_t *cluster;  // [blocks][texels]
    float *weight;      // [blocks][texels][components]
    float (*frame)[6];  // [texels]: unit normal and tangent
    // [blocks][clusters][1 + components][views]: means and components, of each `kept` values
    size_t vectors;
    int kept;         // the basis's count, or of a cube 6 times those of a face
    uint16_t *place;  // [vectors][kept]: of a cube, which weight a value belongs to; else NULL
    float *value;     // [vectors][kept][3]
};
// Memory for all arrays once the numbers of `info`, the basis and `kept` are set; without limits
// those of the log's context. RELUME_ENOMEM, RELUME_ELIMIT with a sentence.
relume_status baked_make(relume_baked *b, const struct relume_limits *limits,
                         const struct relume_log *log);
// Whether a file can hold it, of which these numbers are known. RELUME_ELIMIT with a sentence.
relume_status baked_check_file(const relume_baked *b, const struct relume_log *log);
// The first of the vectors of a block's cluster.
static inline size_t baked_vector(const relume_baked *b, int block, int cluster)
{
    return ((size_t)block * (size_t)b->info.clusters + (size_t)cluster) *
           (size_t)(1 + b->info.components) * (size_t)b->views;
}

// ---------------------------------------------------------------- views

// A direction of a texel's frame on the map of views, and a place of the map as one: unit,
// z > 0, at its rim beyond the disc.
void view_place(double place[2], int side, vec3 view);
vec3 view_direction(int side, int number);

// ---------------------------------------------------------------- under lights

// What all vectors show under lights that are far away, or under the fixed one.
typedef struct baked_lit baked_lit;
// `stands`: how the object stands in the world, turned and scaled evenly. Near lights do not count.
// RELUME_ENOMEM.
relume_status lit_create(baked_lit **out, const relume_baked *b, const struct frame *stands,
                         const struct relume_light *lights, int n, int threads);
void lit_destroy(baked_lit **lit);
// Its colours [vectors], for mem_free; it is no more.
float (*lit_take(baked_lit **lit))[3];

// Where a baked object is looked at: a place of the atlas, and the unit direction to the eye in the
// object's own axes.
struct baked_look {
    double place[2];
    vec3 view;
};
void lit_colour(float rgb[3], const relume_baked *b, const baked_lit *lit,
                const struct baked_look *look);
// The same under light that arrives there from a unit direction, in the object's own axes; of a
// fixed one nothing. Black where memory is short.
void baked_lamp(float rgb[3], const relume_baked *b, const struct baked_look *look, vec3 direction,
                const float light[3]);

#endif
