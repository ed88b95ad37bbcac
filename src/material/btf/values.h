// values.h - single values of a BTF and its levels of detail
#ifndef BTF_VALUES_H
#define BTF_VALUES_H

#include <relume/material/btf.h>

// All sets; NULL ends the list.
extern const struct relume_btf_set *const relume_btf_sets[];

// Which directions replace one, and how much each counts: barycentric weights, all > 0, sum 1.
struct relume_direction_blend {
    int count;     // 1 to 3
    int index[3];  // numbers of directions
    double weight[3];
    // The direction that they replace: the one asked for, or, below the lowest directions, the
    // one of its azimuth on their rim.
    struct relume_vec3 direction;
    double rim;  // z asked for over z of `direction`: below 1 only below the rim, never below 0
    // Of the sum of weight x direction, at most 1: interpolation multiplies what is linear in the
    // direction, as n.l, by this length.
    double length;
};
// The three around a unit direction.
struct relume_direction_blend relume_direction_mesh_at(const relume_direction_mesh *mesh,
                                                       struct relume_vec3 d);
// The triangles of directions that cover the sphere, `*n` of them, for clients that look directions
// up themselves: corner n is the nadir, which is no measured direction. They belong to the mesh.
const int (*relume_direction_mesh_triangles(const relume_direction_mesh *mesh, int *n))[3];

// One picture as halfs [height][width][3], row 0 at the top.
const uint16_t *relume_btf_picture(const relume_btf *btf, int view, int light);
// Replace one picture of a created BTF; values are clipped to what a half holds.
void relume_btf_store(relume_btf *btf, int view, int light, const float *rgb);

// A BTF of half the sides: every texel the mean of two by two (three at an odd end; a side of 1
// stays), without ground truth. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status relume_btf_halve(relume_btf **out, const relume_btf *btf,
                               const struct relume_btf_params *params);

// A material of pictures in place of measurements, in the terms of glTF 2.0 (Khronos 2021, appendix
// B). Pictures are borrowed during the call and repeat like samples; beyond 2048 texels on a side
// they are reduced, of two the smaller one grows. Values are taken for [0, 1], NaN for 0.
struct relume_btf_paint_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_image *colour;   // linear, three channels; NULL: white
    const struct relume_image *surface;  // green of roughness, blue of metal, likewise; NULL: all
    float factor[3];                     // times the colour, [0, 1]
    float roughness, metallic;           // times what the picture says, [0, 1]
    int threads;                         // default: all cores
    // Normals as glTF paints them: (n + 1) / 2, x to the right, y up, z off the surface. NULL: none
    const struct relume_image *normals;
    float bump;  // times x and y of these; default 1
};
#define relume_btf_paint_params(...)                                                               \
    (&(const struct relume_btf_paint_params){RELUME_SIZED(relume_btf_paint_params), __VA_ARGS__})
// The model `lit` where nothing shines and there are no normals, else `painted`, glTF's
// microfacets, which is for drawing alone: it is neither fitted nor saved. With all levels of
// detail. The caller destroys `*out`. RELUME_EINVAL for another number of channels, RELUME_ENOMEM.
relume_status relume_btf_paint(relume_btf_fitted **out,
                               const struct relume_btf_paint_params *params);

// A level of detail, 0 being the model itself, beyond the last one the last; belongs to the model.
const relume_btf_fitted *relume_btf_fitted_level(const relume_btf_fitted *fitted, int level);

// The value at (x, y) in texels from the upper left corner (centres at +0.5) of a sample that is
// repeated without end: bilinear, or of the nearest texel.
void relume_btf_sample(const relume_btf *btf, double x, double y, bool bilinear,
                       struct relume_vec3 view, struct relume_vec3 light, float rgb[3]);

#endif
