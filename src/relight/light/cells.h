// cells.h - which cells of a grid are divided, since what the grid holds bends inside them
#ifndef RELIGHT_CELLS_H
#define RELIGHT_CELLS_H

#include <relume/base.h>

struct cell {
    double row, column, size;  // the upper left corner in nodes of the grid; 1: a cell of the grid
};

// A divided cell is a tile of 3 x 3 nodes.
struct cells {
    int count;
    struct cell *tile;  // [count]
    int (*child)[4];    // [count]: the tiles of its four cells, row by row; -1: not divided
    int *of;            // [rows - 1][columns - 1]: the tile of a cell of the grid, or -1
    double *value;      // [count][9][values]: at a tile's nodes
};

struct cells_params {
    const void *context;
    void (*evaluate)(const void *context, double row, double column, double *value);
    int values;         // that are interpolated: weights, which values in [0, 1] are multiplied by
    int rows, columns;  // nodes of the grid; the first and the last column are one
    int seam;           // a row of cells without height, which nothing lies in; none: -2
    const int (*start)[2];  // [starts]: cells (row, column) where it may bend most; others are
    int starts;             // looked at when a neighbour is divided
    double tolerance;       // by which such a sum may be off
    int most;               // tiles
    int threads;
};
// Tiles are the same for any number of threads. RELUME_ENOMEM.
relume_status cells_create(struct cells *out, const struct cells_params *params);
void cells_destroy(struct cells *cells);

// From cell (*row, *column) of the grid and a place (*x, *y) in it, each in [0, 1], into the
// smallest cell around that place. Returns its tile, in which it is cell (*row, *column) then, and
// the place in it; or -1, all as it was.
int cells_find(const struct cells *cells, int columns, int *row, int *column, double *x, double *y);

#endif
