// simplify_run.h - one run of collapses, of a whole mesh or of a piece of it
//
// A mesh for which memory is too short is done piece by piece (simplify_parts.c). A piece has
// vertices of its own numbers; what lies at a point that other pieces touch, too, stays.
#ifndef MESH_SIMPLIFY_RUN_H
#define MESH_SIMPLIFY_RUN_H

#include "shape/mesh/simplify.h"

// What of a mesh is a piece. `mesh` holds its vertices and those triangles of the original that are
// near it.
struct piece {
    struct relume_mesh mesh;
    uint32_t (*triangle)[3];  // [triangles]: as they are now
    uint32_t *part;           // of these; NULL: all are of one
    size_t triangles, own;    // behind the first `own` are those of other pieces
    float (*shown)[3];        // [vertices]: normals as they are now; NULL: the mesh's
    uint8_t *may;             // [vertices]: enum piece_vertex
    uint32_t *sample;         // [samples][2]: a vertex that has gone, and the triangle it lies on
    size_t samples;
};
enum piece_vertex { PIECE_STAYS, PIECE_MAY_GO, PIECE_WAITS };  // waiting: tried first

struct run {
    struct simplify s;
    const struct piece *piece;  // NULL: the whole mesh
    struct queue queue;
    struct samples samples;
    struct fan fan;
    uint8_t *stale;  // [points]: weigh again
    uint8_t *may;    // [points]: enum piece_vertex; NULL: all wait
    uint8_t *stays;  // [points]: of a piece
    struct error most, done;
    bool last_resort;  // nothing is tested any more
    size_t target, moves;
    struct relume_simplify_step *step;  // or NULL
    size_t steps;
    bool keep_steps;
    double told[2];  // the share of all work that this is: from, to
    relume_status status;
};

// What both share: weights, limits, what is seen. The mesh, its middle and scale are set.
relume_status run_settle(struct run *r, const struct relume_simplify_params *p);
// Memory for a run, then collapses until nothing may go any more or the target is reached.
relume_status run_prepare(struct run *r);
void run_down(struct run *r, const struct relume_log *log);
void run_free(struct run *r);
// What a mesh takes while it becomes smaller, beside itself: an upper bound.
size_t run_bytes(const struct simplify *s, size_t vertices, size_t triangles);

// The triangles that are left of a mesh. `shown`: normals in place of its own, of any length; or
// NULL.
relume_status run_collect(struct relume_mesh *out, const struct connect *c,
                          const struct relume_mesh *m, float (*shown)[3]);

// The whole run, in pieces that take at most `memory` bytes each; what waits is in a file without a
// name. Sets r->done, r->last_resort and r->step.
relume_status run_in_parts(struct relume_mesh *out, struct run *r, size_t memory,
                           const struct relume_log *log);

#endif
