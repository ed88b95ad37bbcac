// field.h - the normals of many pixels: first what they are made of, then each of them
//
// Some of the pixels are shown to the field first, those for which stereo_field_next says so; it
// learns their material, or that they are matte. Then every pixel is solved, by several workers.
#ifndef STEREO_FIELD_H
#define STEREO_FIELD_H

#include "capture/stereo/stereo.h"

struct stereo_field {
    int lights, stride, threads;
    bool is_matte;                   // no more than Lambert's law can be asked of it
    bool is_shared;                  // all pixels see the same lights from the same side
    struct stereo_scratch *scratch;  // [threads]
    struct reflect_lights *around;   // [threads]; shared: all the same
    float *around_floats;            // of `around`
    float *value;                    // [threads][stride]
    struct stereo_material material;
    struct stereo_table table;
    struct stereo_pixel *learner;  // [STEREO_LEARNERS]
    struct reflect_lights *learner_lights;
    float *learner_floats;
    int learners;
    size_t seen, every;  // one pixel in so many learns
};

// `direction[lights]` and the side from which it is seen are shared by all pixels, or NULL; one
// pixel in `every` learns. RELUME_ENOMEM; `out` may be destroyed in any case.
relume_status stereo_field_create(struct stereo_field *out, int lights, int threads,
                                  const vec3 *direction, vec3 eye, size_t every);
void stereo_field_destroy(struct stereo_field *field);

// Whether the next pixel learns. One that is known is then added by its normal as a matte
// surface's, its lights where they are not shared; the answer holds its values, 0 or more,
// or below 0 where they are not known. When there are too many every second is forgotten.
bool stereo_field_next(struct stereo_field *field);
float *stereo_field_add(struct stereo_field *field, vec3 normal, const vec3 *direction, vec3 eye);
// From those that were added.
relume_status stereo_field_learn(struct stereo_field *field);

// The values of a worker's pixel are set here, as above; those behind the last light are below 0.
float *stereo_field_values(struct stereo_field *field, int worker);
// Improve a matte surface's normal, of few lights a part of the way; how sure it is, 0 where the
// pixel is too dark.
float stereo_field_solve(struct stereo_field *field, int worker, const vec3 *direction, vec3 eye,
                         vec3 *normal);

#endif
