// relight.h - lights become weights, weights and codes become a linear image (Wong 1998, Eq. 7.6)
#ifndef RELUME_RELIGHT_H
#define RELUME_RELIGHT_H

#include <relume/base.h>
#include <relume/format/coder.h>
#include <relume/image.h>
#include <relume/light.h>

#ifdef __cplusplus
extern "C" {
#endif

// ------------------------------------------------------------------ weight grid
// The basis of a coder at a grid of directions, between which it is bilinear: near lights and
// environments ask for thousands of directions a pixel. Rows go by the angle from the pole, columns
// by azimuth, so that no crease of the map cuts a cell. A full sphere has two rows at the horizon,
// for bases that jump there. Interpolants have cusps at the lights: there cells are divided until
// values in [0, 1] agree to 1/255, whatever they are. What is linear over triangles of lights
// (`delaunay`) has creases everywhere and no grid: its nodes are the lights, between which it is
// exact. Never changes. Thread-safety: safe.
typedef struct relume_weight_grid relume_weight_grid;

struct relume_weight_grid_params {
    size_t struct_size;  // filled by the macro (base.h)
    int steps;  // a grid, with so many columns in 90 degrees, [2, 1024]; default: triangles where
                // the basis has them, else 96, fewer where that takes more than 256 MB. Then
                // reflectance of smooth bases agrees to 1e-3 of white
    bool sums;  // for environments alone: where the basis interpolates, only the triangles between
                // lights that relume_environment_weights goes by, at no cost
    int threads;  // default: all cores
};
#define relume_weight_grid_params(...)                                                             \
    (&(const struct relume_weight_grid_params){RELUME_SIZED(relume_weight_grid_params),            \
                                               __VA_ARGS__})

// RELUME_EINVAL (steps), RELUME_ENOMEM. `coder` must live as long as the grid.
RELUME_RESULT relume_status
relume_weight_grid_create(relume_weight_grid **out, const relume_coder *coder,
                          const struct relume_weight_grid_params *params);
RELUME_API void relume_weight_grid_destroy(relume_weight_grid **grid);

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
RELUME_API const struct relume_weight_grid_info *relume_weight_grid_info(
    const relume_weight_grid *grid);

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
RELUME_API void relume_weight_grid_place(double xy[2], const relume_weight_grid *grid,
                                         struct relume_vec3 direction);

// Add value[c] times the basis at a unit direction to weights[3][K] and constant[3].
RELUME_API void relume_weight_grid_add(float *weights, float constant[3],
                                       const relume_weight_grid *grid, struct relume_vec3 direction,
                                       const float value[3]);

// ------------------------------------------------------------------ environment
// Add an environment light to weights[3][K] and constant[3]: sum over the map of E dw / pi times
// the basis (Wong 1998, Eq. 7.6). Bases that interpolate are asked over flat triangles of the
// lights, whatever their interpolant, so that no weight of a captured value is negative. Directions
// below the horizon of a hemispherical capture are 0. For codes of the linear domain.
RELUME_API void relume_environment_weights(float *weights, float constant[3],
                                           const relume_weight_grid *grid,
                                           const struct relume_light *light);

// ------------------------------------------------------------------ refit
// Codes of the display domain once more in linear light, so that an environment is one weight
// vector there too: decoded at the captured directions, made linear, learned by `pca`. One codebook
// becomes one codebook, other codes become planes of half floats. Never changes. Thread-safety:
// safe.
typedef struct relume_refit relume_refit;

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
RELUME_RESULT relume_status relume_refit_create(relume_refit **out,
                                                const struct relume_codes *codes,
                                                const struct relume_refit_params *params);
RELUME_API void relume_refit_destroy(relume_refit **refit);
// Forget the codes; what was learned stays, for `like` and for what uses the codes' coder.
RELUME_API void relume_refit_forget(relume_refit *refit);
// Linear codes of the same size; they belong to the refit.
RELUME_API const struct relume_codes *relume_refit_codes(const relume_refit *refit);
// Root mean square difference at the captured directions, linear, 1 = white.
RELUME_API double relume_refit_loss(const relume_refit *refit);

// ------------------------------------------------------------------ relighting
struct relume_relight_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    unsigned cpu_off;  // RELUME_CPU_* features not to use; ~0u runs the plain C reference
    int threads;       // default: all cores
    // Three channels of the size of the codes: the world position that each pixel sees, not
    // finite for background. Only near lights read it.
    const struct relume_image *surface;
    const relume_weight_grid *grid;  // of the codes' coder, for near lights and environments, or of
                                     // the refit's, for environments; default: made for the call
    const relume_refit *refit;       // of display-domain codes, for environments; default: these
                                     // are summed over the captured lights, at a cost for each
    float exposure_ev;               // relume_relight_rgba8: multiply by 2^EV before coding
};
#define relume_relight_params(...)                                                                 \
    (&(const struct relume_relight_params){RELUME_SIZED(relume_relight_params), __VA_ARGS__})

// The value of every pixel under the sum of `n` lights, linear, three channels; values below zero
// (ringing of the basis) are kept. Linear-domain codes fold all lights into one weight vector;
// display-domain codes are decoded light by light, linearised, then summed.
// A light below the horizon of a hemispherical capture is a warning (once) in the log.
// `out` is created when its data is NULL, else it must have the size of `codes`.
// Near lights evaluate the basis at every pixel's own direction and add nothing to background; from
// below the horizon of a hemispherical capture areas add nothing, others are taken at the horizon.
// Returns RELUME_EINVAL (a light that relume_light_check refuses, a near light without a surface),
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_relight(struct relume_image *out,
                                           const struct relume_codes *codes,
                                           const struct relume_light *lights, int n,
                                           const struct relume_relight_params *params);

// The same as a picture for the screen: out[height][width][4], sRGB-coded, clipped, alpha 255;
// aligned to 4 bytes.
// Codes of one codebook are relit and coded once, and a pixel is one look-up. Same errors.
RELUME_RESULT relume_status relume_relight_rgba8(uint8_t *out, const struct relume_codes *codes,
                                                 const struct relume_light *lights, int n,
                                                 const struct relume_relight_params *params);

// What code vector v of codebook `book` adds to a pixel: rgb[v][3], for clients that look up pixels
// themselves. Sums over books are in the file's domain: linear under all `n` lights, or display
// under one directional light whose colour is left out. A single codebook gives linear values under
// all lights in either domain. Near lights are left out. RELUME_EINVAL when there is no such book
// or when there are several books in the display domain and anything but one directional light;
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_relight_book(float *rgb, const struct relume_codes *codes,
                                                int book, const struct relume_light *lights, int n,
                                                const struct relume_relight_params *params);

// The same at one pixel under directional lights, in double precision: the slow reference.
RELUME_API void relume_relight_pixel(double rgb[3], const struct relume_codes *codes, int x, int y,
                                     const struct relume_light *lights, int n);

#ifdef __cplusplus
}
#endif
#endif
