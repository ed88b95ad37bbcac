// shapes.h - simple solids as meshes, in their own coordinates; texture place = position
#ifndef SCENE_SHAPES_H
#define SCENE_SHAPES_H

#include "shape/mesh/mesh.h"

// A parallelogram from `corner` along `u` and `v`, facing u x v; texture (u, v) from 0 to 1.
void shape_quad(struct mesh *out, vec3 corner, vec3 u, vec3 v);
// An upright box between two corners with sharp edges.
void shape_box(struct mesh *out, vec3 min, vec3 max);
// The same with edges chamfered by `edge`, so that they catch the light.
void shape_chamfered(struct mesh *out, vec3 min, vec3 max, double edge);
void shape_sphere(struct mesh *out, vec3 center, double radius, int segments);
// A round plate on y = `height` facing +y.
void shape_disc(struct mesh *out, double radius, double height, int segments);

struct lathe_point {
    double radius, height;
    bool sharp;  // a crease instead of a smooth turn
};
// The profile turned about the y axis, listed from the bottom up for normals that point outwards;
// smooth stretches between creases are rounded by a Catmull-Rom spline of `steps` pieces.
void shape_lathe(struct mesh *out, const struct lathe_point *profile, int points, int steps,
                 int segments);

// The Utah teapot (Newell 1975), y up, standing on y = 0, radius 2 and height 3.15 as designed,
// spout towards +x; each of the 32 patches in `steps` x `steps` pieces.
void shape_teapot(struct mesh *out, int steps);

// A stylised head, about 1.3 high around the origin, looking along +z; its normals are made from
// the whole mesh, so `out` must be empty.
void shape_head(struct mesh *out, int steps);

#endif
