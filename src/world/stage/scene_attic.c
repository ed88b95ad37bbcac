// scene_attic.c - under a gable roof: beams, boards, a window, old furniture; a panorama
//
// The eye is in the middle of the room, 1.5 above the floor; the ridge runs along z, the window
// gable is at -z, the loft door at +z. The tiles are off: one slope is bare battens, the other is
// boarded below with two roof lights, so that light from nearly everywhere draws its own pattern.
#include "world/stage/scene.h"

static const double FLOOR = -1.5, LENGTH = 3.6;   // half length of the room
static const double EAVE_X = 2.8, EAVE_Y = -0.7;  // where the slopes start
static const double RIDGE_Y = 1.95;

struct wood {
    uint32_t floor, board, beam, furniture, pale;
};

static struct material wood(float r, float g, float b, float scale, float alpha)
{
    return (struct material){
        .texture = {.color = texture_wood,
                    .a = {r, g, b},
                    .b = {0.52f * r, 0.46f * g, 0.42f * b},
                    .scale = scale},
        .f0 = {0.035f, 0.035f, 0.035f},
        .alpha = alpha,
    };
}

static struct material glossy(float r, float g, float b, float alpha)
{
    struct material m = build_matte(r, g, b);
    m.f0[0] = m.f0[1] = m.f0[2] = 0.05f;
    m.alpha = alpha;
    return m;
}

static struct wood woods(struct relume_scene_builder *b)
{
    return (struct wood){
        .floor = build_material(b, wood(0.66f, 0.46f, 0.28f, 1.6f, 0.35f)),
        .board = build_material(b, wood(0.72f, 0.57f, 0.40f, 1.8f, 0.6f)),
        .beam = build_material(b, wood(0.52f, 0.36f, 0.22f, 2.2f, 0.6f)),
        .furniture = build_material(b, wood(0.50f, 0.25f, 0.11f, 2.5f, 0.2f)),
        .pale = build_material(b, wood(0.80f, 0.64f, 0.42f, 2.5f, 0.3f)),
    };
}

static void add_floor(struct relume_scene_builder *b, uint32_t material)
{
    const double width = 0.235;
    for (double x = -EAVE_X; x < EAVE_X; x += width) {
        const double joint = random_range(&b->random, -2.0, 2.0);
        const double right = x + width - 0.008;
        build_beam(b, vec3_of(0.5 * (x + right), FLOOR - 0.03, -LENGTH),
                   vec3_of(0.5 * (x + right), FLOOR - 0.03, joint), right - x, 0.06, material);
        build_beam(b, vec3_of(0.5 * (x + right), FLOOR - 0.03, joint + 0.006),
                   vec3_of(0.5 * (x + right), FLOOR - 0.03, LENGTH), right - x, 0.06, material);
    }
}

// ---------------------------------------------------------------- roof

// A hole in a slope: from `low` to `high` along the slope, from z0 to z1 along the ridge.
struct hole {
    int side;
    double low, high, z0, z1;
};

static const struct hole holes[] = {
    {-1, 1.10, 2.25, -2.25, -0.85},
    {-1, 1.10, 2.25, 0.75, 2.15},
    {-1, 0.40, 0.58, 1.3, 3.2},
    {-1, 0.60, 0.77, -0.4, 0.5},
    {0, 0, 0, 0, 0},
};

// The frame of a slope: x towards the ridge, y outwards, z along the ridge; origin at the eave.
static struct frame slope(int side)
{
    const vec3 x = vec3_unit(vec3_of(-side * EAVE_X, RIDGE_Y - EAVE_Y, 0));
    const vec3 z = vec3_of(0, 0, 1);
    const vec3 y = vec3_scale(vec3_cross(z, x), -side);
    return (struct frame){x, y, z, vec3_of(side * EAVE_X, EAVE_Y, 0)};
}

static void add_board(struct relume_scene_builder *b, double low, double high, double z0, double z1,
                      uint32_t material)
{
    if (z1 - z0 > 0.02)
        build_beam(b, vec3_of(0.5 * (low + high), 0.015, z0),
                   vec3_of(0.5 * (low + high), 0.015, z1), high - low, 0.03, material);
}

// One row of boards, cut where holes are; the holes of a side are listed by growing z.
static void add_row(struct relume_scene_builder *b, int side, double low, double high,
                    uint32_t material)
{
    double z = -LENGTH - 0.2;
    for (const struct hole *h = holes; h->side; h++) {
        const double middle = 0.5 * (low + high);
        if (h->side != side || middle < h->low || middle > h->high)
            continue;
        add_board(b, low, high, z, h->z0, material);
        z = h->z1;
    }
    add_board(b, low, high, z, LENGTH + 0.2, material);
}

static void add_roof_window(struct relume_scene_builder *b, const struct hole *h, uint32_t material)
{
    const double y = -0.02, thick = 0.07;
    build_beam(b, vec3_of(h->low, y, h->z0), vec3_of(h->low, y, h->z1), thick, 0.12, material);
    build_beam(b, vec3_of(h->high, y, h->z0), vec3_of(h->high, y, h->z1), thick, 0.12, material);
    for (int i = 0; i <= 2; i++) {
        const double z = h->z0 + 0.5 * i * (h->z1 - h->z0);
        build_beam(b, vec3_of(h->low, y, z), vec3_of(h->high, y, z), i == 1 ? 0.04 : thick,
                   i == 1 ? 0.05 : 0.12, material);
    }
}

static void add_slope(struct relume_scene_builder *b, int side, const struct wood *w)
{
    const double length = hypot(EAVE_X, RIDGE_Y - EAVE_Y), width = 0.19;
    b->frame = slope(side);
    const double boarded = side < 0 ? 2.5 : 0.0;
    for (double s = -0.15; s < boarded; s += width)
        add_row(b, side, s, s + width - 0.002, w->board);
    for (double s = boarded + 0.1; s < length; s += 0.37)
        add_row(b, side, s, s + 0.075, w->board);
    for (int i = 0; i < 9; i++) {
        const double z = -LENGTH + 0.1 + i * (2.0 * LENGTH - 0.2) / 8.0;
        build_beam(b, vec3_of(-0.1, -0.09, z), vec3_of(length, -0.09, z), 0.09, 0.17, w->beam);
    }
    build_beam(b, vec3_of(1.2, -0.24, -LENGTH), vec3_of(1.2, -0.24, LENGTH), 0.14, 0.16, w->beam);
    for (const struct hole *h = holes; h->side; h++)
        if (h->side == side && h->high - h->low > 0.5)
            add_roof_window(b, h, w->pale);
    b->frame = frame_world;
}

static void add_frame_timber(struct relume_scene_builder *b, const struct wood *w)
{
    build_beam(b, vec3_of(0, RIDGE_Y - 0.2, -LENGTH), vec3_of(0, RIDGE_Y - 0.2, LENGTH), 0.12, 0.22,
               w->beam);
    for (int i = -1; i <= 1; i++) {
        const double z = 2.35 * i - 0.05;
        build_beam(b, vec3_of(-1.42, 0.92, z), vec3_of(1.42, 0.92, z), 0.12, 0.18, w->beam);
        for (int side = -1; side <= 1; side += 2) {
            build_beam(b, vec3_of(1.72 * side, FLOOR, z), vec3_of(1.72 * side, 0.22, z), 0.13, 0.13,
                       w->beam);
            build_beam(b, vec3_of(1.70 * side, -0.35, z), vec3_of(1.16 * side, 0.45, z), 0.08, 0.1,
                       w->beam);
        }
    }
}

// ---------------------------------------------------------------- walls

struct opening {
    double x0, x1, y0, y1;
};

static void add_wall_piece(struct relume_scene_builder *b, double x0, double x1, double y0,
                           double y1, double z, uint32_t material)
{
    struct mesh part = {0};
    if (y1 - y0 < 1e-6)
        return;
    shape_box(&part, vec3_of(x0, y0, z), vec3_of(x1, y1, z + 0.22));
    build_put_exact(b, &part, material);
}

// A gable in narrow columns up to `most` or just through the roof, with an opening left free.
static void add_gable(struct relume_scene_builder *b, double z, struct opening o, double most,
                      uint32_t material)
{
    const double step = 0.1;
    for (int i = -28; i < 28; i++) {
        const double x0 = i * step, x1 = x0 + step, middle = 0.5 * (x0 + x1);
        const double top =
            fmin(EAVE_Y + (RIDGE_Y - EAVE_Y) * (1.0 - fabs(middle) / EAVE_X) + 0.02, most);
        const bool open = middle > o.x0 && middle < o.x1;
        add_wall_piece(b, x0, x1, FLOOR - 0.1, open ? o.y0 : top, z, material);
        if (open)
            add_wall_piece(b, x0, x1, o.y1, top, z, material);
    }
}

static void add_window(struct relume_scene_builder *b, double z, struct opening o,
                       uint32_t material)
{
    const double middle_y = o.y0 + 0.64 * (o.y1 - o.y0);
    for (int i = 0; i <= 3; i++) {
        const double x = o.x0 + i * (o.x1 - o.x0) / 3.0;
        const double thick = i % 3 ? 0.045 : 0.09;
        build_beam(b, vec3_of(x, o.y0, z), vec3_of(x, o.y1, z), thick, thick, material);
    }
    const double bars[4] = {o.y0, 0.5 * (o.y0 + middle_y), middle_y, o.y1};
    for (int i = 0; i < 4; i++) {
        const double thick = i % 3 ? 0.045 : 0.09;
        build_beam(b, vec3_of(o.x0, bars[i], z), vec3_of(o.x1, bars[i], z), thick, thick, material);
    }
    build_beam(b, vec3_of(o.x0 - 0.12, o.y0 - 0.03, z + 0.2),
               vec3_of(o.x1 + 0.12, o.y0 - 0.03, z + 0.2), 0.3, 0.05, material);
}

static void add_walls(struct relume_scene_builder *b, const struct wood *w)
{
    struct material plaster = build_matte(0.74f, 0.70f, 0.62f);
    plaster.texture = (struct texture){.color = texture_plaster,
                                       .a = {0.76f, 0.72f, 0.64f},
                                       .b = {0.62f, 0.56f, 0.47f},
                                       .scale = 1.6f};
    struct material brick = build_matte(0.5f, 0.25f, 0.2f);
    brick.texture = (struct texture){.color = texture_bricks,
                                     .a = {0.55f, 0.52f, 0.47f},
                                     .b = {0.50f, 0.22f, 0.15f},
                                     .scale = 3.6f};
    const struct opening window = {-1.05, 1.05, -0.72, 0.80}, door = {-1.25, -0.25, FLOOR, 0.42};
    add_gable(b, -LENGTH - 0.2, window, RIDGE_Y + 1.0, build_material(b, plaster));
    add_window(b, -LENGTH - 0.1, window, w->pale);
    add_gable(b, LENGTH, door, 0.6, build_material(b, brick));
    for (int side = -1; side <= 1; side += 2)
        for (int i = 0; i < 4; i++) {
            const double y = FLOOR + 0.11 + 0.225 * i;
            build_beam(b, vec3_of(2.62 * side, y, -LENGTH), vec3_of(2.62 * side, y, LENGTH), 0.03,
                       0.22, w->board);
        }
    // The door leaf stands open inwards.
    b->frame = frame_compose(frame_move(-0.25, FLOOR, LENGTH), frame_turn_y(-1.9));
    for (int i = 0; i < 5; i++)
        build_beam(b, vec3_of(-0.1 - 0.2 * i, 0.02, 0), vec3_of(-0.1 - 0.2 * i, 1.9, 0), 0.03,
                   0.195, w->beam);
    b->frame = frame_world;
}

// ---------------------------------------------------------------- furniture

static void add_table(struct relume_scene_builder *b, uint32_t material)
{
    static const struct lathe_point leg[] = {
        {0.0, 0.0, true},     {0.025, 0.0, true},  {0.035, 0.05, false}, {0.022, 0.12, false},
        {0.045, 0.28, false}, {0.03, 0.45, false}, {0.045, 0.52, true},  {0.045, 0.70, true},
    };
    const struct frame place = b->frame;
    for (int i = 0; i < 4; i++) {
        b->frame = frame_compose(place, frame_move(i & 1 ? 0.6 : -0.6, 0, i & 2 ? 0.3 : -0.3));
        build_lathe(b, leg, sizeof leg / sizeof *leg, 8, 64, material);
    }
    b->frame = place;
    build_box(b, vec3_of(-0.62, 0.60, -0.32), vec3_of(0.62, 0.70, 0.32), 0.01, material);
    build_box(b, vec3_of(-0.72, 0.70, -0.40), vec3_of(0.72, 0.74, 0.40), 0.012, material);
}

static void add_globe(struct relume_scene_builder *b, uint32_t material, uint32_t brass)
{
    static const struct lathe_point foot[] = {
        {0.0, 0.0, true},    {0.10, 0.0, true},   {0.10, 0.015, true},
        {0.03, 0.04, false}, {0.015, 0.08, true}, {0.0, 0.09, true},
    };
    struct mesh part = {0};
    build_lathe(b, foot, sizeof foot / sizeof *foot, 8, 64, brass);
    shape_sphere(&part, vec3_of(0, 0.24, 0), 0.15, 96);
    build_put(b, &part, material);
}

static void add_vase(struct relume_scene_builder *b, uint32_t material)
{
    static const struct lathe_point vase[] = {
        {0.0, 0.0, true},    {0.07, 0.0, true},   {0.11, 0.10, false},
        {0.12, 0.18, false}, {0.06, 0.30, false}, {0.045, 0.36, false},
        {0.075, 0.40, true}, {0.065, 0.40, true}, {0.035, 0.35, true},
    };
    build_lathe(b, vase, sizeof vase / sizeof *vase, 8, 64, material);
}

static void add_books(struct relume_scene_builder *b, const uint32_t *covers, int count,
                      double length)
{
    for (double x = 0.0; x < length;) {
        const double thick = random_range(&b->random, 0.022, 0.06);
        const double high = random_range(&b->random, 0.19, 0.29);
        const double deep = random_range(&b->random, 0.15, 0.19);
        const int cover = (int)random_range(&b->random, 0.0, count);
        build_box(b, vec3_of(x, 0, -0.5 * deep), vec3_of(x + thick - 0.002, high, 0.5 * deep),
                  0.004, covers[cover]);
        x += thick;
    }
}

// Low shelves against the knee wall; open towards -z of the current frame.
static void add_shelves(struct relume_scene_builder *b, const uint32_t *covers, int count,
                        uint32_t material)
{
    const struct frame place = b->frame;
    for (int i = 0; i < 4; i++)
        build_box(b, vec3_of(-0.8, 0.36 * i, -0.15), vec3_of(0.8, 0.36 * i + 0.03, 0.15), 0.005,
                  material);
    build_box(b, vec3_of(-0.83, 0, -0.15), vec3_of(-0.8, 1.11, 0.15), 0.005, material);
    build_box(b, vec3_of(0.8, 0, -0.15), vec3_of(0.83, 1.11, 0.15), 0.005, material);
    build_box(b, vec3_of(-0.8, 0, 0.13), vec3_of(0.8, 1.11, 0.15), 0.005, material);
    for (int i = 0; i < 3; i++) {
        b->frame = frame_compose(place, frame_move(-0.77, 0.36 * i + 0.03, 0.0));
        add_books(b, covers, count, i == 1 ? 1.0 : 1.45);
    }
    b->frame = place;
}

static void add_trunk(struct relume_scene_builder *b, uint32_t body, uint32_t bands)
{
    build_box(b, vec3_of(-0.5, 0, -0.3), vec3_of(0.5, 0.36, 0.3), 0.015, body);
    const struct frame place = b->frame;
    static const struct lathe_point lid[] = {
        {0.0, -0.5, true}, {0.3, -0.5, true}, {0.3, 0.5, true}, {0.0, 0.5, true}};
    b->frame = frame_compose(
        place, frame_compose(frame_move(0, 0.36, 0),
                             frame_compose(frame_scale(1, 0.55, 1), frame_turn_z(0.5 * M_PI))));
    build_lathe(b, lid, 4, 8, 64, body);
    b->frame = place;
    for (int i = -1; i <= 1; i++)
        build_box(b, vec3_of(0.4 * i - 0.03, 0, -0.315), vec3_of(0.4 * i + 0.03, 0.37, 0.315),
                  0.004, bands);
}

static void add_barrel(struct relume_scene_builder *b, uint32_t material, uint32_t iron)
{
    static const struct lathe_point barrel[] = {
        {0.0, 0.0, true},    {0.26, 0.0, true},   {0.33, 0.22, false},
        {0.35, 0.42, false}, {0.33, 0.62, false}, {0.26, 0.84, true},
        {0.24, 0.84, true},  {0.24, 0.80, true},  {0.0, 0.80, true},
    };
    static const double hoops[4][2] = {{0.06, 0.288}, {0.25, 0.339}, {0.58, 0.341}, {0.76, 0.294}};
    build_lathe(b, barrel, sizeof barrel / sizeof *barrel, 8, 64, material);
    for (int i = 0; i < 4; i++) {
        const double y = hoops[i][0], r = hoops[i][1];
        const struct lathe_point hoop[] = {{r, y - 0.02, true},
                                           {r + 0.006, y - 0.02, true},
                                           {r + 0.006, y + 0.02, true},
                                           {r, y + 0.02, true}};
        build_lathe(b, hoop, 4, 8, 64, iron);
    }
}

static void add_chair(struct relume_scene_builder *b, uint32_t material, uint32_t seat)
{
    for (int i = 0; i < 4; i++) {
        const double x = i & 1 ? 0.2 : -0.2, z = i & 2 ? 0.2 : -0.2;
        build_beam(b, vec3_of(x, 0, z), vec3_of(x, z > 0 ? 0.98 : 0.45, z), 0.04, 0.04, material);
    }
    for (int i = 0; i < 3; i++)
        build_beam(b, vec3_of(-0.2, 0.6 + 0.15 * i, 0.2), vec3_of(0.2, 0.6 + 0.15 * i, 0.2), 0.02,
                   0.06, material);
    for (int side = -1; side <= 1; side += 2)
        build_beam(b, vec3_of(0.2 * side, 0.2, -0.2), vec3_of(0.2 * side, 0.2, 0.2), 0.025, 0.025,
                   material);
    build_box(b, vec3_of(-0.24, 0.43, -0.24), vec3_of(0.24, 0.49, 0.24), 0.02, seat);
}

// A tall looking glass in a frame, leaning back.
static void add_looking_glass(struct relume_scene_builder *b, uint32_t material)
{
    const struct material silver = {
        .texture = {.color = texture_plain},
        .f0 = {0.90f, 0.91f, 0.90f},
        .alpha = 0.05f,
        .mirror = 1.0f,
    };
    struct mesh part = {0};
    shape_quad(&part, vec3_of(-0.35, 0.06, 0), vec3_of(0.7, 0, 0), vec3_of(0, 1.28, 0));
    build_put_exact(b, &part, build_material(b, silver));
    build_beam(b, vec3_of(-0.44, 0.04, 0), vec3_of(0.44, 0.04, 0), 0.07, 0.08, material);
    build_beam(b, vec3_of(-0.44, 1.36, 0), vec3_of(0.44, 1.36, 0), 0.07, 0.08, material);
    for (int side = -1; side <= 1; side += 2)
        build_beam(b, vec3_of(0.39 * side, 0.0, 0), vec3_of(0.39 * side, 1.4, 0), 0.08, 0.07,
                   material);
}

static void add_rug(struct relume_scene_builder *b)
{
    struct material m = build_matte(0.4f, 0.06f, 0.05f);
    m.texture = (struct texture){.color = texture_checker,
                                 .a = {0.42f, 0.06f, 0.05f},
                                 .b = {0.60f, 0.42f, 0.18f},
                                 .scale = 9.0f};
    struct mesh part = {0};
    shape_quad(&part, vec3_of(-1.0, 0.012, 0.7), vec3_of(2.0, 0, 0), vec3_of(0, 0, -1.4));
    build_put_exact(b, &part, build_material(b, m));
}

static struct frame standing(double x, double z, double turn_rad)
{
    return frame_compose(frame_move(x, FLOOR, z), frame_turn_y(turn_rad));
}

static void furnish(struct relume_scene_builder *b, const struct wood *w)
{
    const uint32_t covers[] = {
        build_material(b, glossy(0.42f, 0.08f, 0.06f, 0.4f)),
        build_material(b, glossy(0.08f, 0.20f, 0.14f, 0.4f)),
        build_material(b, glossy(0.09f, 0.13f, 0.30f, 0.4f)),
        build_material(b, glossy(0.50f, 0.36f, 0.14f, 0.4f)),
        build_material(b, glossy(0.62f, 0.56f, 0.44f, 0.5f)),
    };
    const uint32_t brass = build_material(b, (struct material){.texture = {.color = texture_plain},
                                                               .f0 = {0.80f, 0.58f, 0.25f},
                                                               .alpha = 0.25f});
    const uint32_t iron = build_material(b, glossy(0.12f, 0.11f, 0.11f, 0.3f));
    const uint32_t blue =
        build_material(b, (struct material){.texture = {.color = texture_plaster,
                                                        .a = {0.10f, 0.28f, 0.48f},
                                                        .b = {0.55f, 0.45f, 0.24f},
                                                        .scale = 9.0f},
                                            .f0 = {0.05f, 0.05f, 0.05f},
                                            .alpha = 0.12f});
    const uint32_t carton = build_material(b, build_matte(0.50f, 0.36f, 0.22f));
    const uint32_t china = build_material(b, glossy(0.70f, 0.72f, 0.74f, 0.08f));

    b->frame = standing(0.15, -2.75, 0.06);
    add_table(b, w->furniture);
    const struct frame table = frame_compose(b->frame, frame_move(0, 0.74, 0));
    b->frame = frame_compose(table, frame_move(-0.42, 0, 0.05));
    add_globe(b, blue, brass);
    b->frame = frame_compose(table, frame_move(0.48, 0, -0.1));
    add_vase(b, china);
    b->frame = frame_compose(table, frame_compose(frame_move(0.05, 0, 0.05), frame_turn_y(0.4)));
    build_box(b, vec3_of(-0.15, 0, -0.1), vec3_of(0.15, 0.04, 0.1), 0.004, covers[0]);
    build_box(b, vec3_of(-0.13, 0.04, -0.09), vec3_of(0.14, 0.075, 0.1), 0.004, covers[3]);
    b->frame = standing(0.55, -1.75, 2.7);
    add_chair(b, w->pale, covers[1]);

    b->frame = standing(1.95, -0.85, 0.5 * M_PI);
    add_shelves(b, covers, 5, w->furniture);
    b->frame = standing(2.0, 1.0, 0.0);
    add_barrel(b, w->pale, iron);
    b->frame = standing(1.55, 1.85, 0.4);
    add_barrel(b, w->pale, iron);

    b->frame = standing(-1.75, -0.75, 1.45);
    add_trunk(b, w->furniture, iron);
    b->frame = standing(-1.9, 0.75, 0.2);
    build_box(b, vec3_of(-0.35, 0, -0.3), vec3_of(0.35, 0.5, 0.3), 0.006, carton);
    b->frame = frame_compose(standing(-1.93, 0.8, 0.65), frame_move(0, 0.5, 0));
    build_box(b, vec3_of(-0.24, 0, -0.2), vec3_of(0.24, 0.32, 0.2), 0.006, carton);
    b->frame = standing(-1.6, 1.5, -0.3);
    build_box(b, vec3_of(-0.25, 0, -0.25), vec3_of(0.25, 0.38, 0.25), 0.006, carton);
    b->frame = frame_compose(standing(0.85, 3.2, M_PI + 0.25), frame_turn_x(-0.16));
    add_looking_glass(b, w->furniture);
    b->frame = standing(0.0, -0.3, 0.1);
    add_rug(b);
    b->frame = frame_world;
}

static relume_status build(struct relume_scene_builder *b)
{
    const struct wood w = woods(b);
    add_floor(b, w.floor);
    add_slope(b, -1, &w);
    add_slope(b, 1, &w);
    add_frame_timber(b, &w);
    add_walls(b, &w);
    furnish(b, &w);
    return RELUME_OK;
}

const struct relume_scene_kind scene_attic = {
    .name = "attic",
    .summary = "an attic with beams, boards, a window and furniture: a panorama",
    .projection = RELUME_CYLINDRICAL,
    .build = build,
};
