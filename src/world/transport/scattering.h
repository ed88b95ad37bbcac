// scattering.h - materials whose scattering has been measured, by name
#ifndef TRANSPORT_SCATTERING_H
#define TRANSPORT_SCATTERING_H

// How a material scatters, per mm in each colour: at least 0, the second above 0.
struct scattering {
    float absorption[3], reduced[3];  // sigma_a, sigma_s'
    float index;                      // of refraction, [1, 3]
};
struct scattering_preset {
    const char *name;
    struct scattering scattering;
    float white[3];  // what the table says that it shows in white light
};
// Ends with a name of NULL.
extern const struct scattering_preset scattering_presets[];
// NULL when there is none of that name.
const struct scattering_preset *scattering_find(const char *name);

#endif
