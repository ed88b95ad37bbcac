// nearby.h - lights that stand near, on the GPU: each is a draw that evaluates the basis at every
// pixel's own direction
#ifndef VIEWER_NEARBY_H
#define VIEWER_NEARBY_H

#include "gl/program.h"
#include "gl/target.h"
#include "relit/light_uniforms.h"

#include <relume/relight/relight.h>

// What all views of a file share.
struct nearby {
    const struct gl *gl;
    const struct relume_log *log;
    struct program program;
    bool has_grid;         // has been uploaded
    GLuint grid;           // array texture of the weights by direction
    GLuint triangles;      // between its nodes, and where to begin to look for one
    int triangle_count;    // 0: the nodes are a grid
    int grid_rows, tiles;  // its rows above the tiles of divided cells
    GLuint patches;        // a column for each patch of the area light in use
    GLuint border;         // of the captured zone, by azimuth
    struct light_uniforms uniforms;
};

// What the draws need to know of a view.
struct nearby_view {
    struct relume_image surface;  // as relume_view_positions; empty: not known yet
    GLuint positions;             // the same as a texture, alpha 0 for background
    GLuint affine;                // scale and offset of its planes
    GLuint vectors;               // array texture of its codebooks
};

// Where the codes of a view are on the GPU.
struct nearby_codes {
    const struct relume_codes *codes;  // without planes and indices
    GLuint array;                      // array texture of planes, or of indices
    int layers;                        // of four planes
    double unit;                       // turns what a sampler gives into codes
};

// `gl` and `log` must outlive it. RELUME_ESYSTEM.
relume_status nearby_create(struct nearby *near, const struct gl *gl, const struct relume_log *log);
void nearby_destroy(struct nearby *near);
// Pictures and photometric files may have gone: forget what was kept of them.
void nearby_forget(struct nearby *near);

// Takes over `surface`, also on failure. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status nearby_view_create(struct nearby_view *view, const struct nearby *near,
                                 const struct nearby_codes *codes, struct relume_image *surface);
void nearby_view_destroy(struct nearby_view *view, const struct gl *gl);

// Draw what a near `light` shows of the view into the target in use. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status nearby_draw(struct nearby *near, const struct nearby_view *view,
                          const struct nearby_codes *codes, const struct relume_light *light);

#endif
