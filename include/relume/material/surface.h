// surface.h - large surfaces from a small sample: maps of its texels, tiles that fit in any order,
// and lookups with filtering (Meseth 2008, 4.2.2, 9.5, 9.6; Kwatra et al., "Graphcut Textures",
// 2003)
//
// A map says for every texel of a surface which texel of the sample stands there, so that it serves
// every model of the sample. Texels are counted from the top left, x right, y down; centres lie at
// +0.5; surfaces repeat in both directions.
#ifndef RELUME_SURFACE_H
#define RELUME_SURFACE_H

#include <relume/base.h>
#include <relume/material/btf.h>
#include <relume/image.h>
#include <relume/light.h>
#include <relume/material/synthesis.h>

#ifdef __cplusplus
extern "C" {
#endif

// Never changes. Thread-safety: safe.
typedef struct relume_btf_map relume_btf_map;

// Tiles and the matrix that lays them out; an index map is one tile and a matrix of 1 x 1.
struct relume_btf_map_info {
    int sample_width, sample_height;  // texels of the sample
    int tiles, width, height;         // texels of a tile
    const uint32_t *texel;            // [tiles][height][width]: y * sample_width + x of the sample
    int columns, rows;                // of the matrix
    const uint16_t *matrix;           // [rows][columns]: a tile
};

// Copies what `info` points to. RELUME_ELIMIT for texels and tiles that are not there and for sizes
// over the limits, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_btf_map_create(relume_btf_map **out,
                                                  const struct relume_btf_map_info *info,
                                                  const struct relume_log *log);
// An index map of a sample of that size: a NumPy array [height][width] of uint16 or uint32, the
// numbers y * sample_width + x; or a picture whose red and green are the place in the sample, from
// 0 at its left (top) to 1 at its right (bottom), taken as they stand in the file. An input status,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_btf_map_open(relume_btf_map **out, const char *path,
                                                int sample_width, int sample_height,
                                                const struct relume_btf_params *params);
// The surface that a map makes as one index map, by the ending of the name: .npy, uint32
// [height][width]; .exr, red and green the places of the texels' centres. RELUME_EINVAL for another
// ending, RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_btf_map_save(const relume_btf_map *map, const char *path,
                                                const struct relume_btf_params *params);
RELUME_API void relume_btf_map_destroy(relume_btf_map **map);
// Belongs to the map.
RELUME_API const struct relume_btf_map_info *relume_btf_map_info(const relume_btf_map *map);

struct relume_btf_tiles_params {  // zero in a field means its default
    size_t struct_size;           // filled by the macro (base.h)
    const struct relume_log *log;
    int tiles;          // default 10; [1, 256]
    int side;           // of a tile, texels; default: the sample's; a multiple of 8 in [16, 4096]
    int columns, rows;  // of the matrix; default 16; [1, 4096]
    uint64_t seed;      // equal seeds give equal maps, whatever the thread count
    int threads;        // default: all cores
};
#define relume_btf_tiles_params(...)                                                               \
    (&(const struct relume_btf_tiles_params){RELUME_SIZED(relume_btf_tiles_params), __VA_ARGS__})

// Tiles from patches of a sample of at least 16 x 16 texels, joined along minimum cuts. All tiles
// have the border of one that repeats, so that they fit in any order; the matrix has no equal
// neighbours where there are tiles enough. Patches keep to the grid of three levels of detail.
// RELUME_EINVAL (parameters), RELUME_EUNFIT (a smaller sample), RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_btf_map_tiles(relume_btf_map **out,
                                                 const relume_btf_fitted *sample,
                                                 const struct relume_btf_tiles_params *params);

// A sample as a texture of 12 channels (synthesis.h): the principal components of its texels'
// values in 64 pictures, in display coding. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_btf_texture(struct relume_texture *out,
                                               const relume_btf_fitted *sample, int threads);

// How visible the cuts of a map are. Steps are root mean square differences between neighbouring
// texels over pictures of the sample in display coding.
struct relume_btf_seams {
    double inside;     // the sample: between its neighbours
    double across;     // the map: between neighbours that are not neighbours in the sample
    double unrelated;  // between texels that have nothing to do with each other
    double share;      // of the map's neighbours that a cut separates
};
// RELUME_EINVAL when the map is of another sample, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_btf_map_seams(struct relume_btf_seams *out,
                                                 const relume_btf_map *map,
                                                 const relume_btf_fitted *sample,
                                                 const struct relume_log *log);

// A model and a map of its texels. Never changes. Thread-safety: safe.
typedef struct relume_btf_surface relume_btf_surface;

// `model` must outlive the surface; the map is copied. `map` NULL: the sample, repeated.
// RELUME_EINVAL when the map is of another sample, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_btf_surface_create(relume_btf_surface **out,
                                                      const relume_btf_fitted *model,
                                                      const relume_btf_map *map,
                                                      const struct relume_log *log);
// A folder with surface.json, texel.npy, matrix.npy and the model (docs/surfaces.md).
// RELUME_EINVAL, RELUME_EIO; an input status, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_btf_surface_save(const relume_btf_surface *surface,
                                                    const char *path,
                                                    const struct relume_btf_params *params);
// The folder again; the caller destroys `*out`. An input status with a sentence, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_btf_surface_open(relume_btf_surface **out, const char *path,
                                                    const struct relume_btf_params *params);
RELUME_API void relume_btf_surface_destroy(relume_btf_surface **surface);

// What a surface is.
struct relume_btf_surface_info {
    int width, height;                      // texels
    int levels;                             // of detail, at least 1
    const relume_btf_fitted *model;         // belongs to the surface, as the map
    const struct relume_btf_map_info *map;  // of the finest level
    uint64_t bytes;                         // of the arrays of all levels of the model and the map
};
// It belongs to `surface`.
RELUME_API const struct relume_btf_surface_info *relume_btf_surface_info(
    const relume_btf_surface *surface);

// Where the surface lies for the camera and for near lights: on z = 0, its middle at the origin,
// its width from -1 to 1, x right, y up.
struct relume_btf_camera {
    // Rectified, as samples are photographed: one texel or more a pixel, seen from the direction
    // `eye`. Else a perspective view from the point `eye`, z > 0, towards the point `at`.
    bool perspective;
    struct relume_vec3 eye, at;  // in the frame of the surface
    double fov_deg;              // across the picture, (0, 180)
};

// How a surface is drawn. Borrowed during the call.
struct relume_btf_draw_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;
};
#define relume_btf_draw_params(...)                                                                \
    (&(const struct relume_btf_draw_params){RELUME_SIZED(relume_btf_draw_params), __VA_ARGS__})

// Fill `image` (three channels, of any size) with the surface under all `lights`; area lights are
// not drawn; the map of an environment has +z before the surface. RELUME_EINVAL with a sentence,
// RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_btf_draw(struct relume_image *image,
                                            const relume_btf_surface *surface,
                                            const struct relume_btf_camera *camera,
                                            const struct relume_light *lights, int count,
                                            const struct relume_btf_draw_params *params);

#ifdef __cplusplus
}
#endif
#endif
