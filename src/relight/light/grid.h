// grid.h - weight grids, one direction at a time
#ifndef RELIGHT_GRID_H
#define RELIGHT_GRID_H

#include <relume/relight/relight.h>

// The node values of relume_weight_grid_info at a unit direction: out[stride].
void grid_blend(float *out, const relume_weight_grid *grid, struct relume_vec3 direction);

// The one whose weights may be summed over many lights: nowhere negative where the coder
// interpolates. It belongs to `grid`, or is it.
const relume_weight_grid *grid_for_sums(const relume_weight_grid *grid);

// What a matte surface takes light from `direction` for: the sum of the lights that represent it,
// each by its share. Shorter than `direction` over a flat triangle; the direction itself where no
// triangles are.
struct relume_vec3 grid_shown(const relume_weight_grid *grid, struct relume_vec3 direction);

// That of a refit's coder; belongs to the refit, or to the one it is like.
const relume_weight_grid *refit_grid(const relume_refit *refit);

// An environment as the captured lights of a coder that it shines by, those of no light left out:
// appended to `out`, where *count are. RELUME_ENOMEM.
relume_status environment_on_lights(struct relume_light *out, int *count, const relume_coder *coder,
                                    const struct relume_light *light, int threads);

#endif
