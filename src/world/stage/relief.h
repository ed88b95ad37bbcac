// relief.h - surfaces of materials: height and colour over a periodic unit square
#ifndef SCENE_RELIEF_H
#define SCENE_RELIEF_H

#include "world/stage/material.h"

#include <relume/world/scene.h>

enum { RELIEF_LAYERS = 2 };

struct relief_point {
    double height;  // over some plane, in widths of the sample
    float color[3];
    int layer;  // which of the materials
};

struct relume_btf_material {
    const char *name;
    const char *summary;
    // Periodic in u and v, both in [0, 1); `extent` times as many of everything along each, heights
    // in widths of one of these parts.
    void (*at)(double u, double v, int extent, uint64_t seed, struct relief_point *out);
    struct relief_gloss {
        float f0[3], alpha;  // as in struct material
    } gloss[RELIEF_LAYERS];
};

extern const struct relume_btf_material material_stone, material_corduroy, material_leather,
    material_weave, material_wallpaper, material_aluminium, material_knit;

// Gradient noise in about [-1, 1] with `across` x `along` cells on the square; and a sum of octaves
// of it, each of half the size and height.
double relief_noise(double u, double v, int across, int along, uint64_t seed);
double relief_sum(double u, double v, int cells, int octaves, uint64_t seed);
// Distances to the nearest and second nearest of scattered points, one in each of cells^2 cells, in
// cells; returns a number in [0, 1) that is the nearest one's own (Worley 1996).
double relief_scatter(double u, double v, int cells, uint64_t seed, double distance[2]);

double relief_mix(double a, double b, double t);
// The upper half of an ellipse of height 1 over [-half, half].
double relief_round(double x, double half);
void relief_color(float out[3], const float color[3], double tone);

#endif
