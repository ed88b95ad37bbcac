// scene_chessboard.c - among the pieces of a game on a polished board, inside a ring of columns
//
// The eye floats over the middle of the board at the height of the pawns' heads. Squares have edge
// 1; White stands towards +z, Black towards -z.
#include "world/stage/scene.h"

static const double BOARD = -1.15;

static const struct lathe_point pawn[] = {
    {0.0, 0.0, true},     {0.30, 0.0, true},    {0.30, 0.05, true},   {0.285, 0.10, false},
    {0.30, 0.14, false},  {0.25, 0.20, true},   {0.23, 0.22, true},   {0.17, 0.30, false},
    {0.115, 0.48, false}, {0.10, 0.62, true},   {0.17, 0.645, false}, {0.17, 0.67, false},
    {0.10, 0.70, true},   {0.155, 0.76, false}, {0.175, 0.84, false}, {0.155, 0.93, false},
    {0.09, 0.99, false},  {0.0, 1.01, false},
};
static const struct lathe_point rook[] = {
    {0.0, 0.0, true},     {0.34, 0.0, true},  {0.34, 0.06, true},  {0.32, 0.12, false},
    {0.335, 0.17, false}, {0.28, 0.24, true}, {0.26, 0.26, true},  {0.20, 0.38, false},
    {0.17, 0.62, false},  {0.18, 0.80, true}, {0.25, 0.84, false}, {0.25, 0.88, true},
    {0.24, 0.90, true},   {0.25, 1.15, true}, {0.18, 1.15, true},  {0.18, 1.02, true},
    {0.0, 1.02, true},
};
static const struct lathe_point bishop[] = {
    {0.0, 0.0, true},     {0.33, 0.0, true},   {0.33, 0.06, true},  {0.31, 0.12, false},
    {0.325, 0.17, false}, {0.27, 0.24, true},  {0.25, 0.26, true},  {0.17, 0.42, false},
    {0.115, 0.70, false}, {0.105, 0.95, true}, {0.21, 0.98, false}, {0.21, 1.01, false},
    {0.11, 1.04, true},   {0.15, 1.06, true},  {0.14, 1.09, true},  {0.185, 1.18, false},
    {0.18, 1.29, false},  {0.12, 1.43, false}, {0.045, 1.53, true}, {0.065, 1.56, false},
    {0.065, 1.60, false}, {0.0, 1.635, false},
};
static const struct lathe_point queen[] = {
    {0.0, 0.0, true},     {0.37, 0.0, true},    {0.37, 0.07, true},  {0.35, 0.14, false},
    {0.365, 0.20, false}, {0.30, 0.28, true},   {0.28, 0.30, true},  {0.19, 0.50, false},
    {0.13, 0.85, false},  {0.12, 1.20, true},   {0.24, 1.23, false}, {0.24, 1.27, false},
    {0.13, 1.30, true},   {0.17, 1.32, true},   {0.15, 1.35, true},  {0.17, 1.50, false},
    {0.25, 1.74, true},   {0.21, 1.76, true},   {0.17, 1.72, true},  {0.10, 1.80, false},
    {0.05, 1.83, true},   {0.075, 1.87, false}, {0.06, 1.93, false}, {0.0, 1.95, false},
};
static const struct lathe_point king[] = {
    {0.0, 0.0, true},     {0.38, 0.0, true},  {0.38, 0.07, true},  {0.36, 0.14, false},
    {0.375, 0.20, false}, {0.31, 0.28, true}, {0.29, 0.30, true},  {0.20, 0.52, false},
    {0.14, 0.90, false},  {0.13, 1.30, true}, {0.25, 1.33, false}, {0.25, 1.38, false},
    {0.14, 1.41, true},   {0.18, 1.43, true}, {0.16, 1.46, true},  {0.18, 1.62, false},
    {0.25, 1.86, true},   {0.23, 1.90, true}, {0.12, 1.96, false}, {0.0, 1.98, false},
};
static const struct lathe_point knight_foot[] = {
    {0.0, 0.0, true},     {0.34, 0.0, true},  {0.34, 0.06, true}, {0.32, 0.12, false},
    {0.335, 0.17, false}, {0.28, 0.24, true}, {0.26, 0.26, true}, {0.23, 0.36, false},
    {0.25, 0.42, true},   {0.0, 0.44, true},
};

// The horse's head from the side, looking along +x; counterclockwise from the front of the neck.
static const double knight_side[][2] = {
    {0.20, 0.42},  {0.19, 0.55},  {0.12, 0.68},  {0.10, 0.80},  {0.17, 0.84},
    {0.28, 0.78},  {0.37, 0.80},  {0.40, 0.90},  {0.33, 1.02},  {0.22, 1.13},
    {0.13, 1.24},  {0.10, 1.36},  {0.03, 1.27},  {-0.08, 1.24}, {-0.20, 1.12},
    {-0.27, 0.94}, {-0.28, 0.74}, {-0.25, 0.56}, {-0.22, 0.42},
};
enum { KNIGHT_POINTS = sizeof knight_side / sizeof *knight_side };

struct set {
    uint32_t material;
    double facing_rad;
};

// Rings of the outline, drawn in towards a middle line as they leave the centre plane.
static void add_knight_head(struct relume_scene_builder *b, uint32_t material)
{
    static const double layers[7][2] = {{-0.16, 0.55}, {-0.145, 0.80}, {-0.10, 0.94}, {0.0, 1.0},
                                        {0.10, 0.94},  {0.145, 0.80},  {0.16, 0.55}};
    struct mesh part = {0};
    const vec3 zero = vec3_of(0, 0, 0);
    for (int k = 0; k < 7; k++)
        for (int i = 0; i < KNIGHT_POINTS; i++) {
            const double middle_x = 0.02 + 0.10 * (knight_side[i][1] - 0.8);
            const double middle_y = fmin(fmax(knight_side[i][1], 0.62), 1.02);
            const double x = middle_x + layers[k][1] * (knight_side[i][0] - middle_x);
            const double y = middle_y + layers[k][1] * (knight_side[i][1] - middle_y);
            const vec3 p = vec3_of(x, y, layers[k][0]);
            mesh_vertex(&part, p, zero, p);
        }
    const uint32_t n = KNIGHT_POINTS;
    for (uint32_t k = 0; k < 6; k++)
        for (uint32_t i = 0; i < n; i++) {
            const uint32_t a = k * n + i, c = k * n + (i + 1) % n;
            mesh_triangle(&part, a, c, c + n, 0);
            mesh_triangle(&part, a, c + n, a + n, 0);
        }
    for (uint32_t side = 0; side < 2; side++) {
        const vec3 p = vec3_of(0.03, 0.85, side ? 0.165 : -0.165);
        const uint32_t middle = mesh_vertex(&part, p, zero, p), first = side ? 6 * n : 0;
        for (uint32_t i = 0; i < n; i++) {
            const uint32_t a = first + i, c = first + (i + 1) % n;
            mesh_triangle(&part, middle, side ? a : c, side ? c : a, 0);
        }
    }
    if (!part.failed)
        mesh_smooth(&part);
    build_put(b, &part, material);
}

static void add_merlons(struct relume_scene_builder *b, uint32_t material)
{
    const struct frame place = b->frame;
    for (int i = 0; i < 6; i++) {
        b->frame = frame_compose(place, frame_turn_y(i * M_PI / 3.0));
        build_box(b, vec3_of(-0.075, 1.12, 0.17), vec3_of(0.075, 1.27, 0.25), 0.012, material);
    }
    b->frame = place;
}

static void add_piece(struct relume_scene_builder *b, char kind, uint32_t material)
{
#define LATHE(profile) build_lathe(b, profile, sizeof profile / sizeof *profile, 6, 72, material)
    switch (kind) {
    case 'P': LATHE(pawn); break;
    case 'B': LATHE(bishop); break;
    case 'Q': LATHE(queen); break;
    case 'R':
        LATHE(rook);
        add_merlons(b, material);
        break;
    case 'K':
        LATHE(king);
        build_box(b, vec3_of(-0.035, 1.96, -0.035), vec3_of(0.035, 2.24, 0.035), 0.01, material);
        build_box(b, vec3_of(-0.10, 2.08, -0.03), vec3_of(0.10, 2.15, 0.03), 0.01, material);
        break;
    case 'N':
        LATHE(knight_foot);
        add_knight_head(b, material);
        break;
    default: break;
    }
#undef LATHE
}

// Capitals are White, small letters Black; the first row is Black's own. The four squares around
// the eye stay empty.
static const char position[8][9] = {
    "r..qkb.r", "pp.n.pp.", "..p..n.p", "b....p..", ".P....B.", "..N..N.P", "P.PQ.PP.", "R...KB.R",
};

static void add_pieces(struct relume_scene_builder *b, uint32_t white, uint32_t black)
{
    for (int row = 0; row < 8; row++)
        for (int column = 0; column < 8; column++) {
            const char letter = position[row][column];
            const bool small = letter >= 'a' && letter <= 'z';
            const double turn_rad = small ? -0.5 * M_PI : 0.5 * M_PI;
            b->frame =
                frame_compose(frame_move(column - 3.5, BOARD, row - 3.5),
                              frame_turn_y(turn_rad + random_range(&b->random, -0.25, 0.25)));
            add_piece(b, small ? (char)(letter - 'a' + 'A') : letter, small ? black : white);
        }
    b->frame = frame_world;
}

static struct material stone(float r, float g, float b, float vein, float scale, float mirror)
{
    return (struct material){
        .texture = {.color = texture_marble,
                    .a = {r, g, b},
                    .b = {vein * r, vein * g, vein * b},
                    .scale = scale},
        .f0 = {0.045f, 0.045f, 0.045f},
        .alpha = 0.12f,
        .mirror = mirror,
    };
}

static void add_board(struct relume_scene_builder *b, uint32_t rim)
{
    const uint32_t light = build_material(b, stone(0.80f, 0.76f, 0.66f, 0.72f, 1.2f, 0.7f));
    const uint32_t dark = build_material(b, stone(0.07f, 0.085f, 0.08f, 4.0f, 1.5f, 0.7f));
    b->frame = frame_move(0, BOARD, 0);
    for (int row = 0; row < 8; row++)
        for (int column = 0; column < 8; column++)
            build_box(b, vec3_of(column - 4, -0.1, row - 4), vec3_of(column - 3, 0, row - 3), 0.004,
                      (row + column) & 1 ? dark : light);
    for (int side = 0; side < 4; side++) {
        b->frame = frame_compose(frame_move(0, BOARD, 0), frame_turn_y(0.5 * M_PI * side));
        build_box(b, vec3_of(-4.5, -0.25, 4.0), vec3_of(4.0, 0.04, 4.5), 0.03, rim);
    }
    b->frame = frame_world;
}

static void add_columns(struct relume_scene_builder *b, uint32_t material)
{
    static const struct lathe_point column[] = {
        {0.62, 0.0, true},  {0.62, 0.18, true},  {0.60, 0.20, true},  {0.64, 0.28, false},
        {0.58, 0.36, true}, {0.50, 0.40, true},  {0.51, 1.2, false},  {0.47, 2.6, false},
        {0.41, 3.8, true},  {0.47, 3.84, false}, {0.47, 3.92, false}, {0.41, 3.96, true},
        {0.42, 4.05, true}, {0.60, 4.25, true},  {0.60, 4.32, true},
    };
    static const struct lathe_point ring[] = {
        {7.95, 4.32, true}, {9.05, 4.32, true}, {9.05, 4.62, true},
        {9.25, 4.72, true}, {9.25, 4.86, true}, {7.75, 4.86, true},
        {7.75, 4.72, true}, {7.95, 4.62, true}, {7.95, 4.32, true},
    };
    for (int i = 0; i < 16; i++) {
        const double angle_rad = 2.0 * M_PI * (i + 0.5) / 16.0;
        b->frame = frame_move(8.5 * sin(angle_rad), BOARD - 0.25, 8.5 * cos(angle_rad));
        build_lathe(b, column, sizeof column / sizeof *column, 6, 72, material);
    }
    b->frame = frame_move(0, BOARD - 0.25, 0);
    build_lathe(b, ring, sizeof ring / sizeof *ring, 1, 192, material);
    b->frame = frame_world;
}

static relume_status build(struct relume_scene_builder *b)
{
    const struct material walnut = {
        .texture = {.color = texture_wood,
                    .a = {0.30f, 0.15f, 0.07f},
                    .b = {0.12f, 0.055f, 0.03f},
                    .scale = 1.5f},
        .f0 = {0.04f, 0.04f, 0.04f},
        .alpha = 0.15f,
        .mirror = 0.3f,
    };
    struct material sandstone = build_matte(0.7f, 0.6f, 0.45f);
    sandstone.texture = (struct texture){.color = texture_plaster,
                                         .a = {0.74f, 0.64f, 0.50f},
                                         .b = {0.62f, 0.50f, 0.36f},
                                         .scale = 1.3f};
    struct material paving = sandstone;
    paving.texture.color = texture_checker;
    paving.texture.scale = 0.8f;
    const uint32_t stones = build_material(b, sandstone);

    add_board(b, build_material(b, walnut));
    add_pieces(b, build_material(b, stone(0.82f, 0.74f, 0.58f, 0.80f, 2.5f, 0.4f)),
               build_material(b, stone(0.10f, 0.045f, 0.035f, 2.2f, 2.5f, 0.4f)));
    add_columns(b, stones);
    struct mesh part = {0};
    shape_disc(&part, 10.5, BOARD - 0.25, 128);
    for (size_t i = 0; i < part.vertex_count; i++)
        part.vertices[i].texture[1] = 0.5f;
    build_put_exact(b, &part, build_material(b, paving));
    return RELUME_OK;
}

const struct relume_scene_kind scene_chessboard = {
    .name = "chessboard",
    .summary = "lathe-turned chessmen seen from the middle of the board: a panorama",
    .projection = RELUME_CYLINDRICAL,
    .build = build,
};
