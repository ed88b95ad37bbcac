// maps.h - what the steps of a fit hand on
#ifndef APPEARANCE_MAPS_H
#define APPEARANCE_MAPS_H

#include "material/maps/photos.h"

#include <relume/material/maps.h>

// The maps under one light of value 1 from `direction` (any length but 0), linear, of the
// photographs' brightness: what a viewer of glTF shows. Three channels, the caller destroys it.
// RELUME_EINVAL, RELUME_ENOMEM.
relume_status relume_maps_relight(struct relume_image *out, const struct relume_maps *maps,
                                  struct relume_vec3 direction, int threads);

// Ambient occlusion of a height map whose pixels are `pixel` wide, both in the same unit: the
// cosine-weighted share of the hemisphere over the surface that the relief within an eighth of the
// picture's longer side leaves free (Jimenez et al. 2016, Eq. 7, horizons in 16 half planes). One
// channel; the caller destroys it. RELUME_EINVAL, RELUME_ENOMEM.
relume_status relume_height_occlusion(struct relume_image *out, const struct relume_image *height,
                                      double pixel, int threads);

// As relume_maps_relight, under a light of the capture as each pixel sees it: near ones by `near`.
struct maps_light {
    const struct near_view *near;  // NULL: distant
    int light;                     // of `near`
    vec3 direction;
};
relume_status maps_relight(struct relume_image *out, const struct relume_maps *maps,
                           const struct maps_light *light, int threads);

// Compare the maps with the photographs under `light[lights]`.
relume_status maps_judge(struct relume_maps_quality *out, const struct relume_maps *maps,
                         const relume_capture *capture, int view, const int *light, int lights,
                         int threads, const struct relume_log *log);

#endif
