// scene_colonnade.c - in the aisle of a stoa: a wall with niches, two rows of fluted columns, a
// coffered ceiling; a panorama of 270,000 triangles
//
// The eye is in the aisle, 1.6 above the floor, the wall at -x, the open side at +x. The sun falls
// in between the columns and throws their shadows over floor and wall; the aisle behind them is lit
// by what floor and wall send back.
#include "world/stage/scene.h"

static const double FLOOR = -1.6, WALL = -2.6, CEILING = 4.1;
static const double ROWS[2] = {1.9, 5.1};  // x of the columns
static const double LENGTH = 14.0;         // half length of the hall

enum { COLUMNS = 10 };  // of each row
static const double SPACING = 2.8;

static double column_z(int i)
{
    return SPACING * (i - 0.5 * (COLUMNS - 1));
}

// ---------------------------------------------------------------- columns

// Twenty flutes, which meet in sharp edges; a little thicker below the middle (entasis).
static void add_shaft(struct relume_scene_builder *b, double height, uint32_t material)
{
    enum { FLUTES = 20, EACH = 8, SIDES = FLUTES * EACH, RINGS = 40 };
    const double RADIUS = 0.40, TAPER = 0.085, SWELLING = 0.012, DEPTH = 0.028;
    struct mesh part = {0};
    for (int k = 0; k <= RINGS; k++) {
        const double t = (double)k / RINGS;
        const double radius = RADIUS - TAPER * t + SWELLING * sin(M_PI * t);
        for (int i = 0; i < SIDES; i++) {
            const double angle_rad = 2.0 * M_PI * i / SIDES;
            const double r = radius - DEPTH * fabs(sin(0.5 * FLUTES * angle_rad));
            const vec3 p = vec3_of(r * sin(angle_rad), t * height, r * cos(angle_rad));
            mesh_vertex(&part, p, vec3_of(0, 0, 0), p);
        }
    }
    for (uint32_t k = 0; k < RINGS; k++)
        for (uint32_t i = 0; i < SIDES; i++) {
            const uint32_t a = k * SIDES + i, beside = k * SIDES + (i + 1) % SIDES;
            mesh_triangle(&part, a, beside, beside + SIDES, 0);
            mesh_triangle(&part, a, beside + SIDES, a + SIDES, 0);
        }
    if (!part.failed)
        mesh_smooth(&part);
    build_put(b, &part, material);
}

static void add_column(struct relume_scene_builder *b, double x, double z, uint32_t material)
{
    static const struct lathe_point foot[] = {
        {0.0, 0.0, true},    {0.56, 0.0, true},   {0.56, 0.10, true},
        {0.54, 0.12, true},  {0.57, 0.17, false}, {0.52, 0.23, true},
        {0.45, 0.26, false}, {0.46, 0.30, false}, {0.42, 0.34, true},
    };
    static const struct lathe_point head[] = {
        {0.31, 0.0, true},   {0.34, 0.02, false}, {0.34, 0.05, false}, {0.32, 0.07, true},
        {0.36, 0.12, false}, {0.47, 0.24, false}, {0.50, 0.30, true},
    };
    const double HEAD = 0.46, FOOT = 0.34, height = CEILING - 0.75 - FLOOR;
    const double shaft = height - FOOT - HEAD;
    b->frame = frame_move(x, FLOOR, z);
    build_lathe(b, foot, sizeof foot / sizeof *foot, 6, 64, material);
    b->frame = frame_move(x, FLOOR + FOOT, z);
    add_shaft(b, shaft, material);
    b->frame = frame_move(x, FLOOR + FOOT + shaft, z);
    build_lathe(b, head, sizeof head / sizeof *head, 6, 64, material);
    build_box(b, vec3_of(-0.54, 0.30, -0.54), vec3_of(0.54, HEAD, 0.54), 0.01, material);
    b->frame = frame_world;
}

// ---------------------------------------------------------------- above and below

// Beams along the rows and across, with boards over the square coffers between them; those of the
// outer aisle are gone, and light falls through.
static void add_ceiling(struct relume_scene_builder *b, uint32_t stone, uint32_t boards)
{
    for (int row = 0; row < 2; row++)
        build_box(b, vec3_of(ROWS[row] - 0.42, CEILING - 0.75, -LENGTH),
                  vec3_of(ROWS[row] + 0.42, CEILING - 0.1, LENGTH), 0.015, stone);
    for (double z = -LENGTH; z <= LENGTH; z += 0.5 * SPACING)
        build_box(b, vec3_of(WALL, CEILING - 0.3, z - 0.14), vec3_of(ROWS[1], CEILING, z + 0.14),
                  0.01, stone);
    for (double x = WALL + 1.1; x < ROWS[1] - 0.5; x += 1.1)
        build_box(b, vec3_of(x - 0.1, CEILING - 0.22, -LENGTH), vec3_of(x + 0.1, CEILING, LENGTH),
                  0.01, stone);
    build_box(b, vec3_of(WALL - 0.4, CEILING, -LENGTH),
              vec3_of(ROWS[0] + 0.42, CEILING + 0.12, LENGTH), 0.01, boards);
}

static void add_floor(struct relume_scene_builder *b, uint32_t paving, uint32_t stone)
{
    const double EDGE = ROWS[1] + 0.75, STEP = 0.32, RISE = 0.17;
    struct mesh part = {0};
    shape_quad(&part, vec3_of(WALL, FLOOR, LENGTH), vec3_of(EDGE - WALL, 0, 0),
               vec3_of(0, 0, -2.0 * LENGTH));
    for (size_t i = 0; i < part.vertex_count; i++) {
        part.vertices[i].texture[0] *= (float)(EDGE - WALL);
        part.vertices[i].texture[1] *= (float)(2.0 * LENGTH);
        part.vertices[i].texture[2] = 0.5f;
    }
    build_put_exact(b, &part, paving);
    for (int i = 0; i < 3; i++)
        build_box(b, vec3_of(EDGE, FLOOR - RISE * (i + 1) - 0.4, -LENGTH),
                  vec3_of(EDGE + STEP * (i + 1), FLOOR - RISE * i, LENGTH), 0.01, stone);
    shape_quad(&part, vec3_of(EDGE, FLOOR - 0.52, 30), vec3_of(40, 0, 0), vec3_of(0, 0, -60));
    build_put_exact(b, &part, build_material(b, build_matte(0.42f, 0.36f, 0.26f)));
}

// ---------------------------------------------------------------- the wall

static void add_statue(struct relume_scene_builder *b, uint32_t marble, uint32_t stone)
{
    const struct frame place = b->frame;
    struct mesh part = {0};
    build_box(b, vec3_of(-0.28, 0, -0.28), vec3_of(0.28, 0.95, 0.28), 0.02, stone);
    b->frame = frame_compose(
        place, frame_compose(frame_move(0, 1.42, 0),
                             frame_compose(frame_turn_y(0.5 * M_PI), frame_scale(0.7, 0.7, 0.7))));
    shape_head(&part, 48);
    build_put(b, &part, marble);
    b->frame = place;
}

// Piers with panels between them; every other panel is painted, the others have a bust before them.
static void add_wall(struct relume_scene_builder *b, uint32_t plaster, uint32_t stone,
                     uint32_t marble)
{
    const uint32_t paint[3] = {
        build_material(b, build_matte(0.52f, 0.10f, 0.06f)),
        build_material(b, build_matte(0.62f, 0.42f, 0.10f)),
        build_material(b, build_matte(0.08f, 0.20f, 0.30f)),
    };
    build_box(b, vec3_of(WALL - 0.4, FLOOR, -LENGTH), vec3_of(WALL, CEILING, LENGTH), 0.01,
              plaster);
    for (int end = -1; end <= 1; end += 2)
        build_box(b, vec3_of(WALL, FLOOR, fmin(end * LENGTH, end * (LENGTH + 0.4))),
                  vec3_of(ROWS[0], CEILING, fmax(end * LENGTH, end * (LENGTH + 0.4))), 0.01,
                  plaster);
    for (int i = 0; i <= COLUMNS; i++) {
        const double z = column_z(i) - 0.5 * SPACING;
        build_box(b, vec3_of(WALL, FLOOR, z - 0.22), vec3_of(WALL + 0.14, CEILING - 0.3, z + 0.22),
                  0.015, stone);
    }
    for (int i = 0; i < COLUMNS; i++) {
        const double z = column_z(i);
        build_box(b, vec3_of(WALL, FLOOR + 0.5, z - 0.85),
                  vec3_of(WALL + 0.03, CEILING - 1.0, z + 0.85), 0.005, paint[i % 3]);
        b->frame = frame_move(WALL + 0.55, FLOOR, z);
        if (i % 2)
            add_statue(b, marble, stone);
        else
            build_box(b, vec3_of(-0.25, 0, -0.8), vec3_of(0.25, 0.45, 0.8), 0.02, stone);
        b->frame = frame_world;
    }
}

static relume_status build(struct relume_scene_builder *b)
{
    const struct material marble = {
        .texture = {.color = texture_marble,
                    .a = {0.78f, 0.75f, 0.70f},
                    .b = {0.55f, 0.52f, 0.50f},
                    .scale = 1.5f},
        .f0 = {0.04f, 0.04f, 0.04f},
        .alpha = 0.3f,
    };
    struct material limestone = build_matte(0.70f, 0.64f, 0.52f), plaster = limestone,
                    paving = marble, boards = limestone;
    limestone.texture = (struct texture){.color = texture_plaster,
                                         .a = {0.74f, 0.67f, 0.54f},
                                         .b = {0.62f, 0.54f, 0.42f},
                                         .scale = 1.7f};
    plaster.texture = (struct texture){.color = texture_plaster,
                                       .a = {0.76f, 0.72f, 0.64f},
                                       .b = {0.66f, 0.60f, 0.50f},
                                       .scale = 1.1f};
    paving.texture = (struct texture){.color = texture_checker,
                                      .a = {0.66f, 0.62f, 0.55f},
                                      .b = {0.30f, 0.27f, 0.25f},
                                      .scale = 1.0f};
    boards.texture = (struct texture){.color = texture_wood,
                                      .a = {0.50f, 0.33f, 0.19f},
                                      .b = {0.28f, 0.17f, 0.09f},
                                      .scale = 1.5f};
    const uint32_t stone = build_material(b, limestone), white = build_material(b, marble);
    for (int row = 0; row < 2; row++)
        for (int i = 0; i < COLUMNS; i++)
            add_column(b, ROWS[row], column_z(i), white);
    add_ceiling(b, stone, build_material(b, boards));
    add_floor(b, build_material(b, paving), stone);
    add_wall(b, build_material(b, plaster), stone, white);
    return RELUME_OK;
}

const struct relume_scene_kind scene_colonnade = {
    .name = "colonnade",
    .summary = "a stoa of fluted columns with painted walls, 270,000 triangles: a panorama",
    .projection = RELUME_SPHERICAL,
    .build = build,
};
