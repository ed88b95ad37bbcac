// maps.h - what the steps of a fit hand on
#ifndef APPEARANCE_MAPS_H
#define APPEARANCE_MAPS_H

#include "material/maps/photos.h"

#include <relume/material/maps.h>

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
