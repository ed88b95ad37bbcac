// dipole.h - light that spreads below a surface and leaves it elsewhere
#ifndef TRANSPORT_DIPOLE_H
#define TRANSPORT_DIPOLE_H

#include "world/transport/scattering.h"

enum { DIPOLE_STEPS = 1024 };

// What leaves around a point where light enters, in units of the world.
struct dipole {
    double albedo[3], falloff[3];     // alpha', sigma_tr
    double below[3], above[3];        // depth of the source, height of its image: z_r, z_v
    double index, enters;             // the part of even light that enters
    float near[DIPOLE_STEPS + 2][3];  // R_d by distance: dipole_at
    double half;                      // the distance in the middle of that table
};

// Of a world in which a unit is so many millimetres long.
void dipole_make(struct dipole *out, const struct scattering *scattering, double mm);
// R_d: what leaves `distance` away, per area, of what enters (Eq. 4 of the paper); of the table.
void dipole_at(float rgb[3], const struct dipole *d, double distance);
// The same in closed form, for one colour.
double dipole_exact(const struct dipole *d, int colour, double distance);
// All that leaves within a flat disc about the point; INFINITY: everywhere.
double dipole_disc(const struct dipole *d, int colour, double radius);
// The part of light that passes a smooth boundary at an angle to its normal (Fresnel).
double dipole_passes(double index, double cosine);

#endif
