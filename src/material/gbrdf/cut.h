// cut.h - a surface through a volume of costs, by the least cut of a graph
#ifndef GBRDF_CUT_H
#define GBRDF_CUT_H

#include <relume/base.h>

// For each of width x height columns the layer whose costs, together with what neighbours of unlike
// layers cost, are least: label[height][width] in [0, layers). cost[layers][height][width] >= 0, at
// most 1000; between neighbours stands `smooth` times the mean of their costs in each layer that
// lies between theirs. The grid is repeated without end. RELUME_ENOMEM.
relume_status cut_volume(int *label, const float *cost, int width, int height, int layers,
                         double smooth);

#endif
