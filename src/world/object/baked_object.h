// baked_object.h - baked objects among others
#ifndef OBJECT_BAKED_OBJECT_H
#define OBJECT_BAKED_OBJECT_H

#include <relume/world/bake.h>

// The arrays of a baked material of objects, for other renderers; they belong to it. A texel of the
// atlas, whose places are the objects' texture coordinates, shows from the view j of the map
//     sum over i of weight_i colour[((b clusters + cluster) (1 + components) + i) views + j']
// weight_0 being 1; all views are in one block, b = 0 and j' = j, or each in its own, b = j, j' =
// 0. The view (x, y, z) in the texel's frame lies at ((x, y) / (1 + z) + 1) / 2 (side - 1) on the
// map; the four views around it are interpolated, then the four texels that hold something.
struct relume_baked_arrays {
    const uint16_t *cluster;  // [blocks][height][width]; 65535: the texel holds nothing
    const float *weight;      // [blocks][height][width][components]
    const float (*frame)[6];  // [height][width]: normal and tangent; the third axis is their cross
    size_t vectors;           // colours
    int blocks, views;        // views of one block
    struct relume_vec3 axis[3];  // of the object in the world, unit: frames and views are in these
};
// False where the material is not baked.
bool relume_objects_baked(struct relume_baked_arrays *out, const relume_objects *objects,
                          int material);
// Its colours [vectors] under lights; near ones shine as from the middle of the objects on all of
// it. Free `*out` with relume_free(). RELUME_ENOMEM, RELUME_EINVAL where it is not baked.
relume_status relume_objects_baked_colours(float (**out)[3], const relume_objects *objects,
                                           int material, const struct relume_light *lights, int n);

#endif
