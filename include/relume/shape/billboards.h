// billboards.h - a surface seen from afar: a cloud of flat pictures in its place
//
//     struct relume_billboards cloud;
//     relume_billboards_create(&cloud, &mesh, relume_billboards_params(.error = 0.01));
//
// Planes are found that pass each triangle within an error; on each lies a rectangle of texels,
// and a texel knows which place of the surface it shows, so that any material can be evaluated
// there (Decoret, Durand, Sillion, Dorsey 2003, "Billboard Clouds for Extreme Model
// Simplification"; Meseth 2008, chapter 7).
#ifndef RELUME_BILLBOARDS_H
#define RELUME_BILLBOARDS_H

#include <relume/base.h>
#include <relume/image.h>
#include <relume/shape/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

// What a texel shows, at the middle of the part of it that is covered.
struct relume_billboard_texel {
    float coverage;     // the covered share of its area, [0, 1]
    uint32_t triangle;  // of the mesh; RELUME_BILLBOARD_NONE where nothing is covered
    float weight[2];    // of its second and third corner
};

// A rectangle of width x height texels.
struct relume_billboard {
    float corner[3];         // of its first texel
    float across[3], up[3];  // unit: along rows of texels, and from row to row
    float normal[3];         // unit: cross(across, up), the side that it shows
    int width, height;       // texels
    size_t first;            // of them in the cloud
    float error;             // no vertex of its triangles is farther from the plane
};

// Plain data. Zero-filled is empty.
struct relume_billboards {
    struct relume_billboard *billboard;  // [count]
    size_t count;
    struct relume_billboard_texel *texel;  // row by row
    size_t texels;
    uint32_t *owner;  // [triangles of the mesh]: which one stands for it;
                      // RELUME_BILLBOARD_NONE of triangles without extent
    float side;       // of a texel, in the unit of the mesh
    float error;      // the largest of all
};
RELUME_API void relume_billboards_free(struct relume_billboards *cloud);

// How planes are found.
enum relume_billboards_method {
    // Clusters of triangles, which begin as one triangle each, are merged (Meseth 2008, 7.2, with
    // Eq. 7.1 as an angle and Eq. 7.2 as the wasted share): compact, with bounded normals.
    RELUME_BILLBOARDS_CLUSTERS = 0,
    // Again and again the plane that passes most area (Decoret et al. 2003, without penalties):
    // fewer and larger rectangles, whatever the normals.
    RELUME_BILLBOARDS_GREEDY,
};

// Lengths are shares of the longest side of the box about the mesh.
struct relume_billboards_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    enum relume_billboards_method method;
    double error;      // the largest, (0, 1]; default: 0.01, or none where `count` is given
    int count;         // at most so many billboards, of clusters, where that can be had
    double texel;      // side of a texel; default: half the error, of `count` half what came of it
    double angle_deg;  // clusters: between triangles and their plane, (0, 90]; default 60
    double waste;      // clusters: the share of a rectangle that may be empty, (0, 1]; default 0.75
    int neighbours;  // clusters: that a triangle may be merged with at first, [1, 256]; default 32
};
#define relume_billboards_params(...)                                                              \
    (&(const struct relume_billboards_params){RELUME_SIZED(relume_billboards_params), __VA_ARGS__})

// Of the mesh only positions and triangles count. RELUME_EINVAL (values, positions that are not
// finite, triangles of vertices that are not there), RELUME_EUNFIT with a sentence (no triangle
// has an extent), RELUME_ELIMIT with a sentence (more than 4 million triangles or 64 million
// texels), RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_billboards_create(struct relume_billboards *out,
                                                     const struct relume_mesh *mesh,
                                                     const struct relume_billboards_params *params);

// The cloud for other programs: rectangles as two triangles each, with the normals of their planes,
// and one picture that all texels lie in, linear red, green, blue and coverage. `colour` is the
// picture of the mesh (three channels; NULL: its colours of vertices, or 0.8 everywhere). The
// caller frees both. RELUME_ELIMIT with a sentence (a picture beyond 16384 x 16384), RELUME_ENOMEM.
RELUME_RESULT relume_status relume_billboards_sheet(struct relume_mesh *quads,
                                                    struct relume_image *picture,
                                                    const struct relume_billboards *cloud,
                                                    const struct relume_mesh *mesh,
                                                    const struct relume_image *colour,
                                                    const struct relume_log *log);

#ifdef __cplusplus
}
#endif
#endif
