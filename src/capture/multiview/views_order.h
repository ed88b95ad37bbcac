// views_order.h - which way the rows and columns of cameras run and how far apart they stand, from
// their photographs
#ifndef MULTIVIEW_VIEWS_ORDER_H
#define MULTIVIEW_VIEWS_ORDER_H

#include "capture/multiview/views.h"

// A grid of cameras: file[rows][columns] into the photo set, places ascending in u, rows from the
// top (v descending).
struct camera_grid {
    int rows, columns;
    const int *camera;    // [rows][columns]
    const double *u, *v;  // [columns], [rows]
};

struct grid_order {
    bool mixed;        // the cameras agree better when rows (or columns) run the other way
    double agreement;  // by how much: 0 nothing, 1 all
    double occlusion;  // how far near things hide far ones, rather than far ones near, with rows
                       // turned if mixed: -1 to 1
};

// Looks at nine cameras at most. With one row or column nothing is mixed.
relume_status grid_order(struct grid_order *out, const struct photo_set *set,
                         const struct camera_grid *grid, const struct relume_ingest_params *p);

struct grid_spacing {
    double ratio;  // of a unit of v in the world to one of u; 0: unknown
    double error;  // of the ratio, relative: how far parts of the picture disagree
    double share;  // of the pixels that show it, those that agree
};

// How a point moves from row to row, and how from column to column. Looks at five cameras at most.
relume_status grid_spacing(struct grid_spacing *out, const struct photo_set *set,
                           const struct camera_grid *grid, const struct relume_ingest_params *p);

#endif
