// texture.h - colours that vary over a surface: solid procedures and pictures
#ifndef SCENE_TEXTURE_H
#define SCENE_TEXTURE_H

#include <relume/image.h>

struct texture;
// The linear colour at the texture place `at` (see struct vertex).
typedef void texture_color(const struct texture *texture, const float at[3], float out[3]);

struct texture {
    texture_color *color;              // one of the functions below
    float a[3], b[3];                  // its two colours
    float scale;                       // features per unit of texture place
    const struct relume_image *image;  // only texture_image
};

texture_color texture_plain;    // a everywhere
texture_color texture_checker;  // a and b in cubes of edge 1/scale
texture_color texture_wood;     // rings about the x axis: a early wood, b late wood
texture_color texture_marble;   // a crossed by veins of b
texture_color texture_plaster;  // a with cloudy patches of b
texture_color texture_bricks;   // b bricks in a mortar, rows along y
texture_color texture_image;    // the picture, repeated, v upwards

// Gradient noise in about [-1, 1], and a sum of `octaves` of it.
float noise_at(float x, float y, float z);
float noise_sum(float x, float y, float z, int octaves);

#endif
