// lights.h - patterns of light directions on the sphere (Wong 1998, 8.1.4)
#ifndef RELUME_LIGHTS_H
#define RELUME_LIGHTS_H

#include <relume/base.h>

#ifdef __cplusplus
extern "C" {
#endif

// A way to spread directions. Constant; a NULL-terminated list of all is relume_patterns.
struct relume_pattern {
    const char *name;
    const char *summary;  // one line for help texts
    // Fill `out[n]` with points (phi / 2 pi, t) of the unit square, where t in [0, 1) is the
    // normalised height along the pole: equal areas of the square are equal areas of the sphere.
    // Patterns that need the sphere itself (spacing) are told whether it is `hemisphere`.
    relume_status (*fill)(double (*out)[2], int n, uint64_t seed, bool hemisphere);
};
extern RELUME_API const struct relume_pattern *const relume_patterns[];
// NULL when there is none of that name.
RELUME_API const struct relume_pattern *relume_pattern_find(const char *name);

struct relume_lights_params {
    const struct relume_log *log;
    uint64_t seed;    // equal seeds give equal directions
    bool hemisphere;  // only directions on the pole's side
    bool pole_y;      // the pole is +y (panoramas); default +z
};
#define relume_lights_params(...) (&(const struct relume_lights_params){__VA_ARGS__})

// Fill `out[n]` with unit directions. RELUME_EINVAL when n < 1, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_lights_make(struct relume_vec3 *out, int n,
                                               const struct relume_pattern *pattern,
                                               const struct relume_lights_params *params);

// Spherical cap discrepancy: the largest difference, over caps, between the share of directions in
// a cap and the share of area; in [0, 1], smaller is more even. The maximum is taken over caps of
// every radius around the directions (1024 of them when there are more), their antipodes and 1024
// spiral points, so it is a close lower bound. With `hemisphere` areas are shares of the pole's
// hemisphere.
RELUME_RESULT relume_status relume_lights_discrepancy(double *out, const struct relume_vec3 *lights,
                                                      int n,
                                                      const struct relume_lights_params *params);

// Read unit directions from a capture.json or the JSON of `relume lights`, from a .lp file, or from
// lines `x y z` ('#' starts a comment). The images that a file names need not exist. `*out` is to
// be freed with free(). Returns RELUME_EDATA, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_lights_read(struct relume_vec3 **out, int *n, const char *path,
                                               const struct relume_log *log);

#ifdef __cplusplus
}
#endif
#endif
