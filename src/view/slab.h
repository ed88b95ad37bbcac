// slab.h - what slab.c and slab_frame.c share
#ifndef VIEW_SLAB_H
#define VIEW_SLAB_H

#include <relume/view.h>

struct relume_slab {
    struct relume_geometry geometry;
    int columns, rows;
    double slack;  // ON_LINE in world units
    double *u;
    double *v;
    int *view;
};

// Up to two neighbours on a line with their weights, none of them 0.
struct neighbours {
    int count;
    int index[2];
    double weight[2];
};

// How far along the way from the eye (0) to the st plane (1) the uv plane lies; false when the eye
// sees nothing of the slab from there.
bool slab_reach(double *reach, const relume_slab *slab, struct relume_vec3 eye);
// u (or v) of the ray from `eye` through `st`. Exact for a reach of 0, monotone in `st`, rounding
// included.
double slab_hit(double eye, double st, double reach);

// The cameras around a point of the uv plane, by column and by row; none outside the grid.
struct neighbours slab_columns_at(const relume_slab *slab, bool constant, double u);
struct neighbours slab_rows_at(const relume_slab *slab, bool constant, double v);

// All the weight on one of them.
static inline struct neighbours one_neighbour(int index)
{
    return (struct neighbours){1, {index, index}, {1.0, 0.0}};
}

#endif
