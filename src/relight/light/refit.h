// refit.h - weights of lights that stand near, and codes fitted again in linear light
#ifndef LIGHT_REFIT_H
#define LIGHT_REFIT_H

#include <relume/relight/relight.h>

// A triangle between nodes.
struct relume_weight_triangle {
    int node[3];          // -1: has no say; one at least has
    int across[3];        // the triangle beyond the edge opposite to the corner
    float inverse[3][3];  // row i times a direction of the pole's frame: w_i of corner i, all >= 0
                          // within the triangle; shares are w_i over the sum of those with a say
};
// Rows and columns of an octahedral map of the pole's frame: (x, y) / (|x| + |y| + |z|), the lower
// half folded outwards, from (-1, -1).
enum { RELUME_WEIGHT_STARTS = 32 };

// Pointers belong to the grid.
struct relume_weight_grid_info {
    const relume_coder *coder;
    int rows, columns;  // nodes. A hemisphere has rows from the pole to the horizon, a sphere as
                        // many again from the horizon down; the last column is the first
    int sets;           // 1: the weights of the three channels are equal; 3: they are not
    int coefficients;   // K
    int stride;         // floats from node to node
    const float *data;  // [rows][columns][stride]: the weights [sets][K], then the constants
                        // [3] where sets is 3 (else they are 0); then the tiles
    int tiles;          // divided cells, as 3 x 3 nodes: tile t begins (t / n * 3) rows below the
                        // grid's, at column t % n * 3, n being columns / 3
    const int *tile;    // [rows - 1][columns - 1]: the tile of a cell, or -1
    const int (*child)[4];  // [tiles]: those of a tile's own cells, row by row, or -1
    int triangles;          // 0: a grid as above. Else nodes are the columns of a single row, ...
    const struct relume_weight_triangle *triangle;  // [triangles]
    const int *start;  // ... found by walking from this triangle over edges behind which w < 0
};
// It belongs to the grid.
const struct relume_weight_grid_info *relume_weight_grid_info(const relume_weight_grid *grid);

// Of `data`: the grid's and those of the tiles.
static inline int relume_weight_grid_rows(const struct relume_weight_grid_info *info)
{
    const int across = info->columns / 3;
    return info->rows + (info->tiles ? (info->tiles + across - 1) / across * 3 : 0);
}

// Where a unit direction (world) lies, from node to node: column x in [0, columns - 1], row y in
// [0, rows - 1]. With phi and theta in the pole's frame (0 <= theta <= 90 degrees from the nearer
// pole) and m cells from pole to horizon: x = (phi + 180) (columns - 1) / 360 and
// y = m (1 - sqrt(1 - theta / 90)), counted from the last row below the horizon. Below the horizon
// of a hemispherical capture: at the horizon. Only of a grid without triangles.
void relume_weight_grid_place(double xy[2], const relume_weight_grid *grid,
                              struct relume_vec3 direction);

// Add value[c] times the basis at a unit direction to weights[3][K] and constant[3].
void relume_weight_grid_add(float *weights, float constant[3], const relume_weight_grid *grid,
                            struct relume_vec3 direction, const float value[3]);

// How codes are fitted again in linear light. `like` must outlive the refit; the rest is borrowed
// during the call.
struct relume_refit_params {
    size_t struct_size;            // filled by the macro (base.h)
    const struct relume_log *log;  // gets the loss as a note
    int coefficients;              // default: twice those of the codes, at most 3 x lights
    const relume_refit *like;      // take over what this one learned from another view of the same
                                   // file; it must outlive the new one
    unsigned cpu_off;              // as relume_relight_params
    int threads;                   // default: all cores
};
#define relume_refit_params(...)                                                                   \
    (&(const struct relume_refit_params){RELUME_SIZED(relume_refit_params), __VA_ARGS__})

// RELUME_ENOMEM; what relume_coder_create says.
relume_status relume_refit_create(relume_refit **out, const struct relume_codes *codes,
                                  const struct relume_refit_params *params);
void relume_refit_destroy(relume_refit **refit);
// Forget the codes; what was learned stays, for `like` and for what uses the codes' coder.
void relume_refit_forget(relume_refit *refit);
// Linear codes of the same size; they belong to the refit.
const struct relume_codes *relume_refit_codes(const relume_refit *refit);
// Root mean square difference at the captured directions, linear, 1 = white.
double relume_refit_loss(const relume_refit *refit);

// What code vector v of codebook `book` adds to a pixel: rgb[v][3], for clients that look up pixels
// themselves. Sums over books are in the file's domain: linear under all `n` lights, or display
// under one directional light whose colour is left out. A single codebook gives linear values under
// all lights in either domain. Near lights are left out. RELUME_EINVAL when there is no such book
// or when there are several books in the display domain and anything but one directional light;
// RELUME_ENOMEM.
relume_status relume_relight_book(float *rgb, const struct relume_codes *codes, int book,
                                  const struct relume_light *lights, int n,
                                  const struct relume_relight_params *params);

// The same at one pixel under directional lights, in double precision: the slow reference.
void relume_relight_pixel(double rgb[3], const struct relume_codes *codes, int x, int y,
                          const struct relume_light *lights, int n);

#endif
