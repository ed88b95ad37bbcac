// grid.h - weight grids, one direction at a time
#ifndef RELIGHT_GRID_H
#define RELIGHT_GRID_H

#include <relume/relight.h>

// The node values of relume_weight_grid_info at a unit direction: out[stride].
void grid_blend(float *out, const relume_weight_grid *grid, struct relume_vec3 direction);

#endif
