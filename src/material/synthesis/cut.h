// cut.h - the cheapest closed line through a grid that separates what must be on either side
// (Kwatra, Schoedl, Essa, Turk, Bobick, "Graphcut Textures", 2003)
#ifndef SYNTHESIS_CUT_H
#define SYNTHESIS_CUT_H

#include <relume/base.h>

enum cut_side { CUT_EITHER, CUT_OLD, CUT_NEW };

// A grid whose cells may be on either side; `right` and `down` are what it costs to separate a cell
// from its neighbour, at least 0. side[height][width] holds what is wanted and then what came out:
// CUT_OLD or CUT_NEW. Nothing separates the edges of the grid. RELUME_ENOMEM.
relume_status cut_grid(unsigned char *side, int width, int height, const int *right,
                       const int *down);

#endif
