// brdf.h - the reflectance of a g-BRDF's texel (d-BRDF, Ashikhmin 2006, with a diffuse term):
//     rho(k1, k2) = cd / pi + q(h) F(k1.h) / (k1.n + k2.n - (k1.n)(k2.n))
//     F(c) = r0 + (1 - r0) (1 - c)^5
// k1 points to the light, k2 to the eye, h half way; q = cs p is the distribution of ndf.h.
#ifndef GBRDF_BRDF_H
#define GBRDF_BRDF_H

// What masking and shadowing divide by, of the two cosines: 0 for none but two zeros.
static inline double brdf_masking(double c1, double c2)
{
    return c1 + c2 - c1 * c2;
}

// Schlick's factor of 1 - r0.
static inline double brdf_grazing(double kh)
{
    const double x = 1.0 - kh, x2 = x * x;
    return x2 * x2 * x;
}

#endif
