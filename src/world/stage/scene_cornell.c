// scene_cornell.c - the box of Goral, Torrance, Greenberg and Battaile (1984), "Modeling the
// interaction of light between diffuse surfaces", as measured at Cornell: a panorama from its
// middle
//
// The eye is just inside the open side, half way up. A red wall at the left, a green one at the
// right, two white blocks; 1 is half the width of the box, the open side is at +z. In place of the
// lamp there is a square hole in the ceiling, through which the light of lamps above falls;
// reflectances are those of its paints in red, green and blue.
#include "world/stage/scene.h"

static const double HALF = 1.0, HOLE = 0.3, AHEAD = -0.9;  // z of the middle

static void add_wall(struct relume_scene_builder *b, vec3 corner, vec3 u, vec3 v, uint32_t material)
{
    struct mesh part = {0};
    shape_quad(&part, vec3_add(corner, vec3_of(0, 0, AHEAD)), u, v);
    build_put_exact(b, &part, material);
}

// Around the hole.
static void add_ceiling(struct relume_scene_builder *b, uint32_t white)
{
    const double rim = HALF - HOLE;
    const vec3 along = vec3_of(2.0 * HALF, 0, 0), deep = vec3_of(0, 0, 2.0 * HOLE);
    add_wall(b, vec3_of(-HALF, HALF, -HALF), along, vec3_of(0, 0, rim), white);
    add_wall(b, vec3_of(-HALF, HALF, HOLE), along, vec3_of(0, 0, rim), white);
    add_wall(b, vec3_of(-HALF, HALF, -HOLE), vec3_of(rim, 0, 0), deep, white);
    add_wall(b, vec3_of(HOLE, HALF, -HOLE), vec3_of(rim, 0, 0), deep, white);
}

static void add_block(struct relume_scene_builder *b, double x, double z, double turn_rad,
                      double width, double height, uint32_t material)
{
    struct mesh part = {0};
    b->frame = frame_compose(frame_move(x, -HALF, z + AHEAD), frame_turn_y(turn_rad));
    shape_box(&part, vec3_of(-0.5 * width, 0, -0.5 * width),
              vec3_of(0.5 * width, height, 0.5 * width));
    build_put_exact(b, &part, material);
    b->frame = frame_world;
}

static relume_status build(struct relume_scene_builder *b)
{
    const uint32_t white = build_material(b, build_matte(0.74f, 0.74f, 0.72f)),
                   red = build_material(b, build_matte(0.57f, 0.05f, 0.04f)),
                   green = build_material(b, build_matte(0.12f, 0.43f, 0.13f));
    const vec3 across = vec3_of(2.0 * HALF, 0, 0), up = vec3_of(0, 2.0 * HALF, 0),
               back = vec3_of(0, 0, -2.0 * HALF);
    add_wall(b, vec3_of(-HALF, -HALF, HALF), across, back, white);
    add_wall(b, vec3_of(-HALF, -HALF, -HALF), across, up, white);
    add_wall(b, vec3_of(-HALF, -HALF, HALF), back, up, red);
    add_wall(b, vec3_of(HALF, -HALF, -HALF), vec3_scale(back, -1.0), up, green);
    add_ceiling(b, white);
    add_block(b, 0.34, 0.36, -0.29, 0.58, 0.59, white);
    add_block(b, -0.33, -0.30, 0.30, 0.58, 1.19, white);
    return RELUME_OK;
}

const struct relume_scene_kind scene_cornell = {
    .name = "cornell",
    .summary = "the Cornell box, lit through a hole in its ceiling: a panorama",
    .projection = RELUME_SPHERICAL,
    .build = build,
};
