// simplify.h - fewer triangles that look the same
//
//     struct relume_mesh small;
//     relume_mesh_simplify(&small, NULL, &mesh, relume_simplify_params(.error = 0.001));
//
// Half-edge collapses in the order of quadric errors with attributes (Garland, Heckbert 1997;
// Hoppe 1999), each allowed only while two things hold everywhere: the surface stays near (every
// vertex of the original to the new surface, and middles of new triangles and edges to the
// original), and its shading looks the same from the distance that somebody looks from (Guthe 2008,
// chapter 10). Vertices are those of the original, none moves; their normals become those that show
// the original best, unless steps are asked for.
#ifndef RELUME_SIMPLIFY_H
#define RELUME_SIMPLIFY_H

#include <relume/base.h>
#include <relume/shape/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

// When to stop; at least one of error, triangles and jnd. Lengths are shares of the diagonal of the
// mesh's bounding box.
struct relume_simplify_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    double error;      // most distance between the surfaces, (0, 1]; default: see `distance`
    size_t triangles;  // as many or a few less; what can be seen no longer counts once no other
                       // collapse is left. Default: as few as can be
    double jnd;        // what must not be seen of the shading, JND, (0, 100]; 1 is 1 to 2 in
                       // 99 % of pictures. Default 4: seen where one looks for it
    double distance;   // of the eye, (0, 1e6]; default: where `error` is seen under 1/30 degree,
                       // without it 1.9, a picture on a screen, whose `error` is 0.0011
    double gloss;      // exponent of the highlight, [0, 1000]: 0 is matte; default 20. Negative: 0
    double white;      // cd/m^2 of a white surface in full light; default 200
    bool quadrics;     // quadric errors alone: nothing is tested, `error` is one of quadrics
    size_t memory;     // bytes that it may take beside the two meshes; default --max-memory
                       // (context.h). Larger meshes are done in parts, with what waits in a file
                       // without a name ($TMPDIR), 46 bytes a triangle
    bool no_steps;     // leave `step` out of the report: 16 bytes a vertex. With steps normals stay
                       // those of the original, and more triangles look as good
};
#define relume_simplify_params(...)                                                                \
    (&(const struct relume_simplify_params){RELUME_SIZED(relume_simplify_params), __VA_ARGS__})

// A vertex that has gone, in the order in which they went. Undone from the last one, the steps lead
// back to the original (a progressive mesh; Hoppe 1996).
struct relume_simplify_step {
    uint32_t vertex, onto;  // of the original
    float error;            // most distance of the surfaces so far; infinite where `triangles` were
                            // wanted and nothing else could go
    float distance;         // beyond which no step so far is seen
};

// What was done. Free `step` with relume_free.
struct relume_simplified {
    size_t triangles, vertices;  // left
    double error;                // measured at the vertices of the original
    double distance;             // beyond which the shading looks the same; infinite where not
                                 // all was tested
    size_t steps;
    struct relume_simplify_step *step;
};

// `*out` is new; `report` may be NULL. Edges of three and more triangles stay, as do borders,
// seams of texture, normals or colour, and edges between parts, along which vertices go. Triangles
// of less than three places go. RELUME_EINVAL for params out of range or vertices that are not
// there, RELUME_ELIMIT with a sentence when not even one part fits into the memory, RELUME_EIO with
// one where there is no space for the file, RELUME_EUNFIT where nothing is left, RELUME_ENOMEM,
// RELUME_ECANCEL.
RELUME_RESULT relume_status relume_mesh_simplify(struct relume_mesh *out,
                                                 struct relume_simplified *report,
                                                 const struct relume_mesh *mesh,
                                                 const struct relume_simplify_params *params);

#ifdef __cplusplus
}
#endif
#endif
