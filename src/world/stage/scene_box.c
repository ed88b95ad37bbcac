// scene_box.c - a box and a sphere on a white plane seen from straight above: the hard-shadow test
//
// Everything is matte and of simple form, so that depth, shading and the place of every shadow edge
// can be computed by hand: the plane is z = 0, the box stands on it, the sphere rests on it.
#include "world/stage/scene.h"

static relume_status build(struct relume_scene_builder *b)
{
    struct mesh part = {0};
    shape_quad(&part, vec3_of(-4, -4, 0), vec3_of(8, 0, 0), vec3_of(0, 8, 0));
    build_put_exact(b, &part, build_material(b, build_matte(0.8f, 0.8f, 0.8f)));

    shape_box(&part, vec3_of(-0.7, -0.35, 0.0), vec3_of(-0.1, 0.25, 0.5));
    build_put_exact(b, &part, build_material(b, build_matte(0.75f, 0.25f, 0.12f)));

    shape_sphere(&part, vec3_of(0.4, 0.1, 0.35), 0.35, 192);
    build_put_exact(b, &part, build_material(b, build_matte(0.15f, 0.4f, 0.75f)));
    return RELUME_OK;
}

const struct relume_scene_kind scene_box = {
    .name = "box",
    .summary = "a box and a sphere on a plane, seen from above: hard shadows",
    .projection = RELUME_PLANAR,
    .build = build,
};
