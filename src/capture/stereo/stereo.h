// stereo.h - normals of surfaces that are not matte, from their brightness under many lights
//
// What a surface reflects is found together with where it faces, as Hui and Sankaranarayanan
// (2017) do it: for a candidate normal the sum of parts (reflect.h) that is nearest to the samples
// is a linear problem, and the normal that leaves least wins. But where no highlight is seen many
// reflectances fit. So some hundred pixels are searched with every part free; those whose normal
// is surest teach what the object is made of, a material; then every pixel is searched with that
// material, bright and glossy as it wants to be.
//
// Cast shadows and light from other parts of the surface obey no reflectance: samples count by how
// well they fit (Cauchy weights), and dark ones count little.
#ifndef STEREO_STEREO_H
#define STEREO_STEREO_H

#include "capture/stereo/pixel.h"

// Fewer lights leave nothing to learn from.
enum { STEREO_LEAST_LIGHTS = 6, STEREO_LEARNERS = 400 };

// What an object is made of.
struct stereo_material {
    unsigned which;  // the parts that are not 0
    float part[REFLECT_PARTS];
};

// From pixels spread over the object, which change; each with scratch for its weights. False where
// it is matte, or none of them is bright enough.
bool stereo_learn(struct stereo_material *out, struct stereo_pixel *pixel, int n,
                  struct stereo_scratch *scratch, int threads);

// What the material shows under shared lights at normals all around, so that pixels need not find
// out one by one. Empty where lights are not shared.
struct stereo_table {
    float *matte, *gloss;  // [normals][stride]
};
relume_status stereo_table_create(struct stereo_table *out, const struct stereo_material *material,
                                  const struct reflect_lights *lights,
                                  struct stereo_scratch *scratch);
void stereo_table_destroy(struct stereo_table *table);

// Find the normal; `table` may be NULL. False where it is too dark.
bool stereo_solve(struct stereo_pixel *pixel, const struct stereo_material *material,
                  const struct stereo_table *table, struct stereo_scratch *scratch);

#endif
