// ndf.h - distributions of micro-normals as small pictures of the hemisphere
//
// A direction h of the upper hemisphere lies at (h.x, h.y) / (1 + h.z) of the unit disc (parabolic
// map, Heidrich and Seidel 1998), which fills a square of `side` x `side` cells, row 0 at the least
// y. Three channels: the share of light cs, of each colour, is multiplied in.
#ifndef GBRDF_NDF_H
#define GBRDF_NDF_H

#include "core/math/vec.h"

// Of what is kept for a material.
enum { NDF_SIDE = 32, NDF_VALUES = NDF_SIDE * NDF_SIDE * 3 };

// Place in cells, centres at +0.5.
static inline void ndf_place(vec3 h, int side, double at[2])
{
    const double scale = 0.5 * side / (1.0 + h.z);
    at[0] = 0.5 * side + scale * h.x;
    at[1] = 0.5 * side + scale * h.y;
}
// The direction of the middle of a cell; false off the disc.
bool ndf_direction(int column, int row, int side, vec3 *h);
// Solid angle of a cell whose middle has r2 = u^2 + v^2 on the disc.
double ndf_solid_angle(double r2, int side);

// Bilinear.
void ndf_at(const float *ndf, vec3 h, float rgb[3]);

// Fill cells without weight from those around (push-pull, Gortler et al. 1996): value[side][side]
// of one channel, side a power of two of at most NDF_SIDE. Where nothing has weight: zeros.
void ndf_fill(float *value, const float *weight, int side);

// What a material sends back, in all directions, of light from some directions around: at normal
// incidence's reflectance r0 the share is r0 x all + (1 - r0) x grazing, channel by channel.
enum { NDF_FROM = 49 };
struct ndf_albedo {
    struct {
        double all[3], grazing[3];
    } from[NDF_FROM];
};
void ndf_albedo(struct ndf_albedo *out, const float *ndf);
// The greatest share over the directions.
double ndf_reflects(const struct ndf_albedo *albedo, int channel, double r0);

// Scale it so that at r0 no more than `most` is sent back.
void ndf_limit(float *ndf, double r0, double most);
// The greatest r0 in [0, 1] at which no more than `most` is, 0 where none is.
double ndf_most_r0(const struct ndf_albedo *albedo, double most);

// The slopes of all micro-normals times `factor`: GGX of one alpha becomes GGX of another. What the
// micro-normals cover of the plane stays, in each channel.
void ndf_widen(float *ndf, double factor);
// GGX of `alpha` (Walter et al. 2007, Eq. 33), a quarter of it: so at normal incidence a material
// shines as by the usual D F G / (4 cos cos). Lobes narrower than the cells are as wide as these.
void ndf_ggx(float *ndf, double alpha, const double rgb[3]);

#endif
