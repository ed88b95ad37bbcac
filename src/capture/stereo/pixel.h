// pixel.h - what is known and found of one pixel, and scratch memory to find it
#ifndef STEREO_PIXEL_H
#define STEREO_PIXEL_H

#include "capture/stereo/reflect.h"

// One pixel.
struct stereo_pixel {
    const struct reflect_lights *lights;
    const float *value;  // [lights->stride]; below 0: not known, as behind the last light
    // learning: the first guess, what a free reflectance leads to, the best material so far
    vec3 guess, free, kept;
    vec3 normal;                // a first guess; then what was found
    float part[REFLECT_PARTS];  // of its reflectance
    float *weight;              // [lights->stride], or NULL: what each sample counts
    float middle;               // its brightness: how bright 0.7 of its samples are at most
    float matte, gloss;         // how much of the material's
    float miss;                 // what does not fit, 0 to 1
    float sure;                 // 0 to 1: how narrowly the samples determine the normal
};

// Scratch memory of one worker.
struct stereo_scratch {
    int stride;
    float *memory;
    float *parts, *matte, *gloss, *expected, *base, *weight, *spare, *cosines;
};
relume_status stereo_scratch_create(struct stereo_scratch *scratch, int lights);
void stereo_scratch_destroy(struct stereo_scratch *scratch);

#endif
