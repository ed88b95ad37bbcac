// directions.h - patterns of light directions on the sphere (Wong 1998, 8.1.4)
#ifndef RELUME_DIRECTIONS_H
#define RELUME_DIRECTIONS_H

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
    // Patterns that need the sphere itself (spacing) learn by `hemisphere` which part.
    relume_status (*fill)(double (*out)[2], int n, uint64_t seed, bool hemisphere);
};
// All patterns; NULL ends the list.
extern RELUME_API const struct relume_pattern *const relume_patterns[];
// NULL when there is none of that name.
RELUME_API const struct relume_pattern *relume_pattern_find(const char *name);

// How directions are spread. Borrowed during the call.
struct relume_directions_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    uint64_t seed;    // equal seeds give equal directions
    bool hemisphere;  // only directions on the pole's side
    bool pole_y;      // the pole is +y (panoramas); default +z
};
#define relume_directions_params(...)                                                              \
    (&(const struct relume_directions_params){RELUME_SIZED(relume_directions_params), __VA_ARGS__})

// Fill `out[n]` with unit directions. RELUME_EINVAL when n < 1, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_directions_make(struct relume_vec3 *out, int n,
                                                   const struct relume_pattern *pattern,
                                                   const struct relume_directions_params *params);

// Spherical cap discrepancy: the largest difference, over caps, between the share of directions in
// a cap and the share of area; in [0, 1], smaller is more even. The maximum is taken over caps of
// every radius around the directions (1024 of them when there are more), their antipodes and 1024
// spiral points, so it is a close lower bound. With `hemisphere` areas are shares of the pole's
// hemisphere.
RELUME_RESULT relume_status
relume_directions_discrepancy(double *out, const struct relume_vec3 *lights, int n,
                              const struct relume_directions_params *params);

// Lights that a file gives. Thread-safety: plain data.
struct relume_captured_lights {
    int count;
    struct relume_vec3 *direction;  // [count], unit, in the order of the file
    struct relume_vec3 *position;   // [count], world units, or NULL: only directions are given
    float (*intensity)[3];          // [count], or NULL: all 1; positions: power
    char **name;                    // [count], or NULL: the file does not name all
};

// Reads lights from a capture.json, the JSON of `relume lights`, a .dome file or a text. A .dome
// file (RelightLab) holds mm from the middle of the picture, which become world units by its
// imageWidth, 2 world units. An LED that is multiplied by its ledAdjust has the intensity 1 /
// ledAdjust. A text is a .lp file, lines `[name] x y z`, or a table (docs/capture.md, "Lists of
// lights"). With `positions` the vectors of texts are positions in world units, and a file that
// gives none is an error. Images that a file names need not exist. The caller destroys `out`, which
// is empty on failure. An input status, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_captured_lights_load(struct relume_captured_lights *out,
                                                        const char *path, bool positions,
                                                        const struct relume_log *log);
RELUME_API void relume_captured_lights_destroy(struct relume_captured_lights *list);

// Only the directions; free `*out` with relume_free().
RELUME_RESULT relume_status relume_captured_lights_read(struct relume_vec3 **out, int *n,
                                                        const char *path,
                                                        const struct relume_log *log);

#ifdef __cplusplus
}
#endif
#endif
