// scene_teapot.c - the Utah teapot, glazed, on a checkered board tilted towards the viewer
//
// The board leans so far that every camera of the slab, down to v = -1, looks at it from above.
#include "world/stage/scene.h"

static const double TILT_RAD = 0.60;

static void add_board(struct relume_scene_builder *b)
{
    struct mesh part = {0};
    const struct material rim = {
        .texture = {.color = texture_wood,
                    .a = {0.30f, 0.14f, 0.06f},
                    .b = {0.11f, 0.04f, 0.02f},
                    .scale = 2.0f},
        .f0 = {0.04f, 0.04f, 0.04f},
        .alpha = 0.2f,
    };
    build_box(b, vec3_of(-4.35, -0.4, -4.35), vec3_of(4.35, -0.04, 4.35), 0.06,
              build_material(b, rim));
    const struct material squares = {
        .texture = {.color = texture_checker,
                    .a = {0.78f, 0.74f, 0.66f},
                    .b = {0.10f, 0.13f, 0.16f},
                    .scale = 1.0f},
        .f0 = {0.04f, 0.04f, 0.04f},
        .alpha = 0.25f,
    };
    shape_box(&part, vec3_of(-4, -0.04, -4), vec3_of(4, 0, 4));
    // Only the top is checkered along two axes: lift the solid checks off the third.
    for (size_t i = 0; i < part.vertex_count; i++)
        part.vertices[i].texture[1] = 0.5f;
    build_put_exact(b, &part, build_material(b, squares));
}

static relume_status build(struct relume_scene_builder *b)
{
    struct mesh part = {0};
    const struct frame tilt = frame_compose(frame_move(0.04, -0.30, 0), frame_turn_x(TILT_RAD));
    b->frame = frame_compose(tilt, frame_scale(0.262, 0.262, 0.262));
    add_board(b);

    const struct material glaze = {
        .texture = {.color = texture_plain, .a = {0.05f, 0.30f, 0.33f}},
        .f0 = {0.07f, 0.07f, 0.07f},
        .alpha = 0.12f,
        .mirror = 0.4f,
    };
    b->frame = frame_compose(b->frame, frame_turn_y(0.45));
    shape_teapot(&part, 16);
    build_put(b, &part, build_material(b, glaze));
    return RELUME_OK;
}

const struct relume_scene_kind scene_teapot = {
    .name = "teapot",
    .summary = "the glossy Utah teapot on a checkered board, for light slabs",
    .projection = RELUME_SLAB,
    .build = build,
};
