// ggx.h - the reflectance of glTF 2.0, appendix B, for one pixel under many lights
//
//     value(L) = n.L (1 - F) c + pi F D V n.L         F = f0 + (f90 - f0) (1 - v.h)^5
// under a light of value 1, with D of GGX and the separable V of Smith. A metal has c = 0. As in
// KHR_materials_specular f90 is 1, and less where f0 is below that of common glass, so that f0 = 0
// is a matte surface.
#ifndef APPEARANCE_GGX_H
#define APPEARANCE_GGX_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

static const float GGX_COMMON_F0 = 0.04f;
static const float GGX_LEAST_ROUGHNESS = 0.05f;

// What a pixel shines like.
struct gloss {
    bool metal;
    float f0;  // of a metal its base colour is
    float roughness;
};

// One pixel: where its lights stand and what it shows under them. Arrays are [lights]; those from
// `cosine` on are made of the others.
struct look {
    int lights;            // a multiple of LOOK_LANES; those added are black and shine from nowhere
    int known;             // that are the pixel's
    float view[3];         // unit, to the eye
    float *towards[3];     // unit, to the lights
    float *half[3];        // unit, between both
    float *fifth;          // (1 - v.h)^5
    float *value[3];       // linear
    float *coded[3];       // the same, display-like
    float *clipped;        // 1: the value is at least this; else 0
    float *cosine, *lobe;  // n.L, and pi D V n.L, of the last normal and roughness
    float *base, *slope;   // what the pixel shows = base + colour x slope, of the last gloss
    float *aside[8];       // two more of cosine, lobe, base, slope
};
enum { LOOK_LANES = 8, LOOK_ARRAYS = 26 };

// How many floats the arrays of so many lights take.
size_t look_size(int lights);
// Points the arrays into that memory, and clears what is added.
void look_place(struct look *k, float *memory, int lights);

// Equal steps are about equally visible, and it is cheap: sRGB's curve to 0.02 above black.
static const float CODE_TOE = 0.04f;
static inline float code_of(float v)
{
    return sqrtf((v > 0.0f ? v : 0.0f) + CODE_TOE * CODE_TOE) - CODE_TOE;
}

static inline float gloss_f90(float f0)
{
    return f0 < GGX_COMMON_F0 ? f0 / GGX_COMMON_F0 : 1.0f;
}

// Fills half and fifth from view and towards.
void look_halve(const struct look *k);
// Fills cosine and lobe.
void look_turn(const struct look *k, const float normal[3], float roughness);

// After look_turn: fills base and slope.
void look_gloss(const struct look *k, const struct gloss *g);

#endif
