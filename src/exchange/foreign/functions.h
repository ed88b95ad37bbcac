// functions.h - the functions of the light that other formats are written in
//
// Sources: Malzbender and Gelb 2001 (ptm); Gautron et al. 2004 as the HSH files have it (hsh); real
// spherical harmonics (sh); interpolation among the lights by Gaussians, and bilinear interpolation
// in a square onto which the octahedron maps the hemisphere (grid).
#ifndef FOREIGN_FUNCTIONS_H
#define FOREIGN_FUNCTIONS_H

#include <relume/base.h>

enum function_kind { FUNCTIONS_PTM, FUNCTIONS_HSH, FUNCTIONS_SH, FUNCTIONS_GAUSS, FUNCTIONS_GRID };

// Of any kind; of the kinds with functions of their own.
enum { FUNCTIONS_MOST = 4096, FUNCTIONS_MOST_OWN = 16 };

struct functions {
    enum function_kind kind;
    int count;       // ptm 3 or 6, hsh 1, 4, 9 or 16, sh 1, 4 or 9, else lights or side^2
    int resolution;  // grid: the side
    double sigma;    // gauss
    const struct relume_vec3 *lights;  // gauss: [count], unit; borrowed
};

// Whether the kind has that many functions.
bool functions_has_count(enum function_kind kind, int count);
// values[count] at a unit direction.
void functions_at(const struct functions *f, struct relume_vec3 light, double *values);
// Where on the hemisphere node `i` of a grid lies.
struct relume_vec3 functions_grid_node(int resolution, int i);

#endif
