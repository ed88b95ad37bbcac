// environment.h - lights as distributions: environment maps, goniometric and IES lamps, areas
#ifndef LIGHT_ENVIRONMENT_H
#define LIGHT_ENVIRONMENT_H

#include <relume/light.h>

// What a point, spot, slide, ies or gonio light sends to `point`: its value there and the unit
// direction towards it (Wong 1998, Eq. 7.7 with its sign corrected: L = S - P). False where nothing
// arrives: outside the cone or picture, at the light itself, at a point that is not finite.
bool relume_light_at(struct relume_vec3 *towards, float rgb[3], const struct relume_light *light,
                     struct relume_vec3 point);

// The frame of a slide, ies or gonio light that shines along `axis`: image right and up, unit
// vectors. Up is world +y projected, +z where the axis is vertical; seen along the axis, right is
// right.
void relume_light_frame(struct relume_vec3 *right, struct relume_vec3 *up, struct relume_vec3 axis);

// ------------------------------------------------------------------ area
// A piece of an area light: sends rgb * max(0, cos) / distance^2, the cosine being between `normal`
// and the direction from the piece to the point.
struct relume_light_patch {
    struct relume_vec3 position, normal;
    float rgb[3];  // radiance x area / pi
};

enum { RELUME_LIGHT_PATCHES_MOST = 32 };  // along one side

// How many patches a side an area light needs so that their sum is the integral to about 1 percent
// at points at least `distance` away; in [1, RELUME_LIGHT_PATCHES_MOST].
int relume_light_patch_side(const struct relume_light *area, double distance);

// The light in side x side pieces: Gauss-Legendre nodes, for discs in radius^2 and evenly in angle.
// Fills out[side * side].
void relume_light_patches(struct relume_light_patch *out, const struct relume_light *area,
                          int side);

// What a patch sends to `point`, as relume_light_at.
bool relume_light_patch_at(struct relume_vec3 *towards, float rgb[3],
                           const struct relume_light_patch *patch, struct relume_vec3 point);

// The least distance from an area light of the positions in `surface` (three channels) that lie
// before it; infinite when there are none.
double relume_area_distance(const struct relume_light *area, const struct relume_image *surface);

// ------------------------------------------------------------------ ies
// Read an IES LM-63 file (1986, 1991, 1995, 2002; type C photometry). `*out` is NULL on failure.
// Returns an input status with a sentence, RELUME_ENOMEM. Never changes afterwards. Thread-safety:
// safe.
relume_status relume_ies_load(relume_ies **out, const char *path, const struct relume_log *log);
// The same from `size` bytes of text; sentences begin with `name`.
relume_status relume_ies_parse(relume_ies **out, const char *text, size_t size, const char *name,
                               const struct relume_log *log);
void relume_ies_destroy(relume_ies **ies);

// Intensity in [0, 1] of the maximum, bilinear in the angles. vertical_deg in [0, 180] from the
// lamp's axis, horizontal_deg of any size; 0 outside the measured angles.
double relume_ies_value(const relume_ies *ies, double vertical_deg, double horizontal_deg);
// The largest intensity of the file, candela.
double relume_ies_candela(const relume_ies *ies);

// ------------------------------------------------------------------ gonio
struct relume_gonio_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const char *name;  // how sentences call the map; default: "distribution"
};
#define relume_gonio_params(...)                                                                   \
    (&(const struct relume_gonio_params){RELUME_SIZED(relume_gonio_params), __VA_ARGS__})

// A goniometric distribution of `map`, three channels, 1 being the light's own value. Six square
// faces side by side (+x -x +y -y +z -z, laid out as the cube of a panorama) or, twice as wide as
// high, a sphere (lat-long; resampled to faces half as high, at most 1024). The map is seen from
// the light: its middle -z is the axis, +x right, +y up (relume_light_frame). NaN, infinite and
// negative values become 0 with a warning. `map` is copied. RELUME_EINVAL with a sentence,
// RELUME_ENOMEM. Never changes. Thread-safety: safe.
relume_status relume_gonio_create(relume_gonio **out, const struct relume_image *map,
                                  const struct relume_gonio_params *params);
// The same from a file that relume_image_load reads. An input status, RELUME_ENOMEM.
relume_status relume_gonio_load(relume_gonio **out, const char *path, const struct relume_log *log);
void relume_gonio_destroy(relume_gonio **gonio);

// The value in a direction of the map's frame, any length but 0: bilinear within a face and
// continuous over the edges.
void relume_gonio_value(float rgb[3], const relume_gonio *gonio, struct relume_vec3 direction);
// Its faces of n x n texels, each in a border of one texel from its neighbours: 6 (n + 2) x (n + 2)
const struct relume_image *relume_gonio_map(const relume_gonio *gonio);

// ------------------------------------------------------------------ environment
struct relume_environment_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const char *name;  // how sentences call the map; default: "environment"
};
#define relume_environment_params(...)                                                             \
    (&(const struct relume_environment_params){RELUME_SIZED(relume_environment_params),            \
                                               __VA_ARGS__})

// Prepare a lat-long map (linear, three channels; spherical layout as seen from the scene: the
// middle column is -z, +x to its right, row 0 is up). NaN, infinite and negative values become 0
// with a warning; a map that is not twice as wide as high is a warning. `map` is copied.
// RELUME_EINVAL, RELUME_ENOMEM. Never changes. Thread-safety: safe.
relume_status relume_environment_create(relume_environment **out, const struct relume_image *map,
                                        const struct relume_environment_params *params);
// The same from a file that relume_image_load reads. Also an input status.
relume_status relume_environment_load(relume_environment **out, const char *path,
                                      const struct relume_log *log);
// One that has nothing but a directional `lamp`: what an environment shows of one bright source.
// Its map is empty, its fingerprint 0. RELUME_ENOMEM.
relume_status relume_environment_of_lamp(relume_environment **out, const struct relume_light *lamp);
void relume_environment_destroy(relume_environment **environment);

// The cleaned map at no more than 1024 x 512 pixels, for showing it.
const struct relume_image *relume_environment_map(const relume_environment *environment);
// Of that map: maps of other sizes or values have another number. For whoever keeps what was made
// of an environment longer than the environment, whose address may be used again.
uint64_t relume_environment_fingerprint(const relume_environment *environment);

// The map as light by light: a cell's energy-weighted direction and E dw / pi, without rotation. At
// most 256 x 128 cells with exact solid angles; black ones are left out.
struct relume_environment_cell {
    struct relume_vec3 direction;
    float rgb[3];  // radiance times solid angle / pi, linear
};
// All of them, `*n`; they belong to the environment.
const struct relume_environment_cell *relume_environment_cells(
    int *n, const relume_environment *environment);

// `direction` of the map as the scene sees it after the rotation.
struct relume_vec3 relume_environment_turn(struct relume_vec3 direction, double rotate_deg);

// `n` directional lights that replace an environment light, drawn by luminance (spread
// evenly; equal seeds give equal lights) and of the same total.
relume_status relume_environment_sample(struct relume_light *out, int n,
                                        const struct relume_light *environment, uint64_t seed);

#endif
