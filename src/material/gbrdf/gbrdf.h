// gbrdf.h - g-BRDFs: a measured material as maps that people can edit (Menzel and Guthe, "g-BRDFs:
// An Intuitive and Editable BTF Representation", 2009; Menzel's thesis, 2011, chapter 6)
#ifndef GBRDF_GBRDF_H
#define GBRDF_GBRDF_H

#include "material/gbrdf/meso.h"
#include "material/gbrdf/ndf.h"

// What is kept of a material (docs/gbrdf.md): one picture each, row 0 at the top.
struct gbrdf_maps {
    int width, height, materials;
    float *depth;        // over the plane, in widths of the sample
    uint16_t *rotation;  // half: about the normal, radians, counter-clockwise
    uint16_t *diffuse;   // half [3]: cd
    uint16_t *r0;        // half: reflectance at normal incidence
    uint8_t *label;      // whose NDF
    uint16_t *ndf;       // half [materials][NDF_SIDE][NDF_SIDE][3]: ndf.h
    float *light;        // one number: what a light of value 1 is multiplied by
};

// NULL, or what is wrong with them: a part and what it should hold.
const char *gbrdf_fault(const struct gbrdf_maps *maps);

struct gbrdf_texel {
    float normal[3], turn[2];  // cosine and sine of the rotation
    float diffuse[3], r0;
    int label;
};

// What rendering makes of the maps. One block of memory, freed by mem_free.
struct gbrdf {
    struct meso meso;
    const struct gbrdf_texel *texel;
    const float *ndf;  // [materials][NDF_VALUES]
    double light;
};
// RELUME_ENOMEM.
relume_status gbrdf_prepare(struct gbrdf **out, const struct gbrdf_maps *maps);

// A direction in the frame of a texel.
vec3 gbrdf_local(const struct gbrdf_texel *t, vec3 d);

// What the eye in direction `v` sees at (x, y) of the plane under light `l` of value 1, with n.l,
// occlusion and shadow; a white matte surface that faces the light shows 1.
void gbrdf_evaluate(const struct gbrdf *g, double x, double y, vec3 v, vec3 l, float rgb[3]);

// Whatever was found, no texel sends back more than comes in: distributions that do without any r0
// are scaled, then r0 is lowered where it must be, then the diffuse colour.
void gbrdf_limit_energy(struct gbrdf_maps *maps);
// The same of the texels of one material; what keeps to it stays as it is, bit by bit.
void gbrdf_limit_material(struct gbrdf_maps *maps, int label);

#endif
