// build.c - what a scene file uses to put its things on the stage
#include "world/stage/build.h"

#include <assert.h>

uint32_t build_material(struct relume_scene_builder *b, struct material material)
{
    assert(b->material_count < MAX_MATERIALS);
    b->materials[b->material_count] = material;
    return (uint32_t)b->material_count++;
}

struct material build_matte(float r, float g, float b)
{
    return (struct material){
        .texture = {.color = texture_plain, .a = {r, g, b}},
        .alpha = 1.0f,
    };
}

static vec3 random_place(struct relume_scene_builder *b)
{
    const double x = random_range(&b->random, -50.0, 50.0);
    const double y = random_range(&b->random, -3.0, 3.0);
    return vec3_of(x, y, random_range(&b->random, -3.0, 3.0));
}

void build_put(struct relume_scene_builder *b, struct mesh *part, uint32_t material)
{
    mesh_append(&b->mesh, part, &b->frame, material, random_place(b));
    mesh_free(part);
}

void build_put_exact(struct relume_scene_builder *b, struct mesh *part, uint32_t material)
{
    mesh_append(&b->mesh, part, &b->frame, material, vec3_of(0, 0, 0));
    mesh_free(part);
}

void build_lathe(struct relume_scene_builder *b, const struct lathe_point *profile, int points,
                 int steps, int sides, uint32_t material)
{
    struct mesh part = {0};
    shape_lathe(&part, profile, points, steps, sides);
    build_put(b, &part, material);
}

void build_box(struct relume_scene_builder *b, vec3 min, vec3 max, double edge, uint32_t material)
{
    struct mesh part = {0};
    shape_chamfered(&part, min, max, edge);
    build_put(b, &part, material);
}

void build_beam(struct relume_scene_builder *b, vec3 from, vec3 to, double width, double height,
                uint32_t material)
{
    const struct frame outer = b->frame;
    const vec3 along = vec3_sub(to, from);
    const double length = vec3_length(along);
    const vec3 x = vec3_scale(along, 1.0 / length);
    const vec3 up = fabs(x.y) < 0.99 ? vec3_of(0, 1, 0) : vec3_of(0, 0, 1);
    const vec3 z = vec3_unit(vec3_cross(x, up));
    b->frame = frame_compose(outer, (struct frame){x, vec3_cross(z, x), z, from});
    const double edge = 0.06 * fmin(width, height);
    build_box(b, vec3_of(0, -0.5 * height, -0.5 * width),
              vec3_of(length, 0.5 * height, 0.5 * width), edge, material);
    b->frame = outer;
}
