// relief_hard.c - stone, leather, wallpaper, brushed aluminium
#include "world/stage/relief.h"

#include "core/math/scalar.h"

#include <math.h>

// ---------------------------------------------------------------- stone: broken, with cracks

static void stone(double u, double v, int extent, uint64_t seed, struct relief_point *out)
{
    static const float dark[3] = {0.20f, 0.18f, 0.16f}, light[3] = {0.62f, 0.58f, 0.52f};
    double d[2];
    const double rough = relief_sum(u, v, 4 * extent, 6, seed);
    const double warp = 0.03 / extent * relief_sum(u, v, 8 * extent, 3, seed + 20);
    const double own = relief_scatter(u - floor(u) + warp, v + warp, 5 * extent, seed + 31, d);
    const double crack = 1.0 - smoothstep(0.02, 0.16, d[1] - d[0]);
    const double grain = relief_sum(u, v, 32 * extent, 3, seed + 47);
    const double tone = smoothstep(-0.6, 0.6, 0.5 * rough + 0.6 * grain + own - 0.5);
    float color[3];
    for (int c = 0; c < 3; c++)
        color[c] = (float)relief_mix(dark[c], light[c], tone);
    out->height = 0.03 * rough + 0.02 * own - 0.035 * crack + 0.002 * grain;
    out->layer = 0;
    relief_color(out->color, color, 1.0 - 0.5 * crack);
}

const struct relume_btf_material material_stone = {
    .name = "stone",
    .summary = "broken stone with cracks and polished faces",
    .at = stone,
    .gloss = {{{0.05f, 0.05f, 0.05f}, 0.25f}},
};

// ---------------------------------------------------------------- leather: cushions and creases

static void leather(double u, double v, int extent, uint64_t seed, struct relief_point *out)
{
    static const float brown[3] = {0.20f, 0.085f, 0.045f};
    double d[2];
    const double warp = 0.02 / extent * relief_sum(u, v, 6 * extent, 2, seed + 5);
    const double own = relief_scatter(u + warp, v - warp, 11 * extent, seed, d);
    const double cushion = smoothstep(0.0, 0.45, d[1] - d[0]);
    const double pores = relief_sum(u, v, 64 * extent, 2, seed + 9);
    out->height = 0.016 * cushion + 0.004 * own +
                  0.012 * relief_noise(u, v, 3 * extent, 3 * extent, seed + 7) + 0.0006 * pores;
    out->layer = 0;
    relief_color(out->color, brown, (0.55 + 0.5 * cushion) * (1.0 + 0.1 * pores));
}

const struct relume_btf_material material_leather = {
    .name = "leather",
    .summary = "brown grained leather with a soft gloss",
    .at = leather,
    .gloss = {{{0.045f, 0.045f, 0.045f}, 0.3f}},
};

// ---------------------------------------------------------------- wallpaper: an embossed pattern

static void wallpaper(double u, double v, int extent, uint64_t seed, struct relief_point *out)
{
    static const float paper[3] = {0.68f, 0.64f, 0.54f}, print[3] = {0.42f, 0.28f, 0.12f};
    const int across = 3 * extent;
    const double row = floor(across * v);
    const double x = across * u + (fmod(row, 2.0) != 0.0 ? 0.5 : 0.0), y = across * v - row - 0.5;
    const double cx = x - floor(x) - 0.5;
    const double petals = 0.30 + 0.11 * cos(6.0 * atan2(y, cx));
    const double inside = smoothstep(-0.02, 0.04, petals - sqrt(cx * cx + y * y));
    const double grain = relief_sum(u, v, 40 * extent, 2, seed);
    out->layer = inside > 0.5;
    out->height = 0.006 * inside + 0.0008 * grain;
    relief_color(out->color, out->layer ? print : paper, 1.0 + 0.08 * grain);
}

const struct relume_btf_material material_wallpaper = {
    .name = "wallpaper",
    .summary = "matte paper with glossy embossed flowers",
    .at = wallpaper,
    .gloss = {{{0.02f, 0.02f, 0.02f}, 0.6f}, {{0.12f, 0.10f, 0.06f}, 0.22f}},
};

// ---------------------------------------------------------------- aluminium: brushed along x

static void aluminium(double u, double v, int extent, uint64_t seed, struct relief_point *out)
{
    static const float grey[3] = {0.06f, 0.06f, 0.06f};
    const double brush = relief_noise(u, v, 3 * extent, 60 * extent, seed) +
                         0.6 * relief_noise(u, v, 5 * extent, 120 * extent, seed + 1);
    out->height = 0.0009 * brush;
    out->layer = 0;
    relief_color(out->color, grey, 1.0 + 0.3 * brush);
}

const struct relume_btf_material material_aluminium = {
    .name = "aluminium",
    .summary = "brushed metal, flat and glossy",
    .at = aluminium,
    .gloss = {{{0.58f, 0.59f, 0.60f}, 0.3f}},
};
