// blocks.h - the nodes of hierarchical macroblocks, level by level
#ifndef HDR_BLOCKS_H
#define HDR_BLOCKS_H

#include <relume/base.h>

struct node {
    double d[2];   // pixels of level 0
    double score;  // the reference for the children's
    bool trusted;  // it matched by detail of its own
};

// One level: a centred square of count x count blocks of `side` pixels.
struct grid {
    int count, side;
    double origin[2];  // of block (0, 0)
    struct node *node;
};

struct node *grid_node(const struct grid *grid, int column, int row);
// Bilinear between the nodes, which lie in the middle of their blocks.
void grid_interpolate(const struct grid *grid, double x, double y, double d[2], double *score);
// Blocks without detail follow the trusted ones around them: an affine map fitted with weights that
// fall with the distance.
void grid_fill(struct grid *grid, int threads);
// The affine map of the plane that trusted nodes amount to, wrong ones left aside: rows 0 and 1 of
// `m` take a place to where it is displaced. False: too few of them.
bool grid_affine(double m[3][3], const struct grid *grid);
// Each displacement becomes the median of the 3 x 3 around it: single wrong matches vanish, shifts,
// rolls and edges of motion stay. Returns false when memory is short.
bool grid_median(struct grid *grid);

#endif
