// relief_cloth.c - corduroy, plain weave, knitted wool
#include "world/stage/relief.h"

#include <math.h>

static double part(double x)
{
    return x - floor(x);
}

// ---------------------------------------------------------------- corduroy: piled wales

static void corduroy(double u, double v, int extent, uint64_t seed, struct relief_point *out)
{
    enum { WALES = 8 };
    static const float brown[3] = {0.46f, 0.27f, 0.13f};
    const double bend = 0.12 * relief_noise(u, v, 4 * extent, 6 * extent, seed);
    const double pile = relief_sum(u, v, 48 * extent, 2, seed + 11);
    const double rib = relief_round(part(WALES * extent * u + bend) - 0.5, 0.46);
    out->height = 0.055 * rib + 0.004 * pile * (0.4 + rib);
    out->layer = 0;
    relief_color(out->color, brown, (0.65 + 0.35 * rib) * (1.0 + 0.25 * pile));
}

const struct relume_btf_material material_corduroy = {
    .name = "corduroy",
    .summary = "deep ribs of brown pile",
    .at = corduroy,
    .gloss = {{{0.0f, 0.0f, 0.0f}, 1.0f}},
};

// ---------------------------------------------------------------- weave: threads over and under

// A thread across a cell: its height at `side` of its axis, wound along `along`.
static double thread(double side, double along, int number, double sign)
{
    const double wave = cos(M_PI * (along - 0.5)) * (number & 1 ? -1.0 : 1.0) * sign;
    return 0.016 * wave + 0.03 * relief_round(part(side) - 0.5, 0.47);
}

static void weave(double u, double v, int extent, uint64_t seed, struct relief_point *out)
{
    enum { THREADS = 10 };
    static const float color[2][3] = {{0.10f, 0.16f, 0.36f}, {0.62f, 0.55f, 0.42f}};
    const double x = THREADS * extent * u, y = THREADS * extent * v;
    const double warp = thread(x, y, (int)floor(x), 1.0);
    const double weft = thread(y, x, (int)floor(y), -1.0);
    out->layer = weft > warp;
    // fibres run along the thread, slightly twisted
    const double fibre = out->layer ? relief_noise(u, part(v + u), 20 * extent, 120 * extent, seed)
                                    : relief_noise(part(u + v), v, 120 * extent, 20 * extent, seed);
    out->height = fmax(warp, weft) + 0.0015 * fibre;
    relief_color(out->color, color[out->layer], 1.0 + 0.2 * fibre);
}

const struct relume_btf_material material_weave = {
    .name = "weave",
    .summary = "blue and ecru threads, plain weave, with a sheen",
    .at = weave,
    .gloss = {{{0.05f, 0.05f, 0.05f}, 0.35f}, {{0.04f, 0.04f, 0.04f}, 0.45f}},
};

// ---------------------------------------------------------------- knit: two legs a stitch

static void knit(double u, double v, int extent, uint64_t seed, struct relief_point *out)
{
    enum { COLUMNS = 7, ROWS = 9 };
    static const float wool[3] = {0.58f, 0.20f, 0.16f};
    const double fx = part(COLUMNS * extent * u);
    const double leg = 1.0 - fabs(2.0 * fx - 1.0);  // 0 between columns, 1 in their middle
    const double along = part(ROWS * extent * v + 0.75 * leg) - 0.5, side = leg - 0.5;
    const double yarn = sqrt(fmax(0.0, 1.0 - side * side / 0.27 - along * along / 0.30));
    const double fuzz = relief_sum(u, v, 40 * extent, 3, seed);
    out->height = 0.06 * yarn + 0.005 * fuzz;
    out->layer = 0;
    relief_color(out->color, wool, (0.55 + 0.45 * yarn) * (1.0 + 0.2 * fuzz));
}

const struct relume_btf_material material_knit = {
    .name = "knit",
    .summary = "red knitted wool",
    .at = knit,
    .gloss = {{{0.0f, 0.0f, 0.0f}, 1.0f}},
};
