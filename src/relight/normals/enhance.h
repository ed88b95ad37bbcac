// enhance.h - the steps of passes that show relief
#ifndef NORMALS_ENHANCE_H
#define NORMALS_ENHANCE_H

#include <relume/relight/enhance.h>

// Whether the pass needs to know normals.
bool relume_pass_needs_normals(enum relume_pass pass);
// Whether the pass is scaled to the picture.
bool relume_pass_needs_range(enum relume_pass pass);

// The default of `gain`.
#define RELUME_PASS_GAIN 2.0f

// Replace `image`, a view relit by `lights`, by what `pass` shows of it; linear, three channels.
// `normals` may be NULL where the pass needs none. Only directional lights are enhanced; what
// others add stays as it is. RELUME_EINVAL for sizes that disagree, RELUME_ENOMEM.
relume_status relume_pass_apply(struct relume_image *image, enum relume_pass pass,
                                const struct relume_normals *normals,
                                const struct relume_light *lights, int n,
                                const struct relume_pass_params *params);

// Every so many pixels of a picture of that size, along and down, are measured.
int relume_pass_step(int width, int height);
// What `pass` would scale of `image`, relit by `lights`, whose normals' albedo is given (NULL where
// the pass needs none). A picture of every relume_pass_step-th pixel alone has the same range.
// RELUME_ENOMEM.
relume_status relume_pass_measure(struct relume_pass_range *out, const struct relume_image *image,
                                  enum relume_pass pass, const struct relume_image *albedo,
                                  const struct relume_light *lights, int n, float gain);

#endif
