// material.h - how a surface answers light: Lambert, a glossy microfacet coat, a mirror
//
// The coat is the microfacet model of Cook and Torrance (1982) with the GGX distribution and the
// height-correlated Smith term (Walter et al. 2007, Heitz 2014) and Schlick's Fresnel (1994). What
// the coat reflects is lost to the base on the way in and out, so no surface gains energy.
#ifndef SCENE_MATERIAL_H
#define SCENE_MATERIAL_H

#include "world/stage/texture.h"

#include <math.h>
#include <stdbool.h>

struct material {
    struct texture texture;  // albedo of the Lambertian base
    float f0[3];             // reflectance of the coat at normal incidence; 0: none
    float alpha;             // GGX roughness, (0, 1]
    float mirror;            // share of the coat that reflects like a mirror, [0, 1]
};

// A material at one point, seen from one direction.
struct surface {
    float n[3];   // shading normal
    float ng[3];  // normal of the triangle, on the side of `wo`
    float wo[3];  // towards the eye
    float diffuse[3];
    float f0[3];
    float alpha;
    float gloss;  // share of the coat that is rough: 1 - mirror
};

static inline float dot3(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// pi * brdf * cos for light from `wi`: the value that a directional light of value 1 shows.
// False when the light comes from behind the surface.
bool surface_lit(const struct surface *s, const float wi[3], float out[3]);

// Fresnel reflectance of the mirror's share.
void surface_mirror(const struct surface *s, float out[3]);

// Choose where to look for indirect light: `pick` chooses the layer, `u` the direction, all uniform
// in [0, 1). `out` is brdf * cos / density; false when the direction carries nothing.
bool surface_sample(const struct surface *s, float pick, const float u[2], float wi[3],
                    float out[3]);

#endif
