// btf.h - the inside of a relume_btf, and what its readers and its models share
#ifndef BTF_BTF_H
#define BTF_BTF_H

#include "core/math/vec.h"
#include "material/btf/npy.h"

#include <relume/material/btf.h>

struct relume_btf {
    struct relume_btf_info info;  // owns what it points to
    char *path;                   // where it was read from, or NULL
    vec3 *view, *light;
    relume_direction_mesh *views, *lights;
    const uint16_t *values;   // [stored view][stored light][height][width][3]
    uint16_t *own;            // or NULL: scratch memory behind `values`
    struct npy_file file;     // or the file behind them
    int *view_at, *light_at;  // where a view and a light of this BTF are stored
    int stored_lights;
};

static inline size_t btf_texels(const relume_btf *btf)
{
    return (size_t)btf->info.width * (size_t)btf->info.height;
}

// What sentences about it begin with.
static inline const char *btf_name(const relume_btf *btf)
{
    return btf->path ? btf->path : btf->info.name;
}

// Everything of a BTF but its values; `path` is where it comes from, or NULL. An input status for
// directions that cannot be used.
relume_status btf_start(relume_btf **out, const struct relume_btf_info *info, const char *path,
                        const struct relume_log *log);
// relume_direction_mesh_create, with sentences that begin "PATH: WHAT "; `path` may be NULL.
relume_status btf_make_mesh(relume_direction_mesh **out, const vec3 *directions, int n,
                            const char *path, const char *what, const struct relume_log *log);
// Zeroed scratch memory as its values.
relume_status btf_allocate(relume_btf *btf, const struct relume_btf_params *params);
// A folder of pictures named by their angles.
relume_status btf_open_pictures(relume_btf **out, const char *path,
                                const struct relume_btf_params *params);
// A folder with capture.json whose views are the cameras of a slab.
relume_status btf_open_capture(relume_btf **out, const char *path,
                               const struct relume_btf_params *params);
// A .btf file of the University of Bonn.
relume_status btf_open_ubo(relume_btf **out, const char *path,
                           const struct relume_btf_params *params);

// Store the pictures [height][width][3] that `picture` gives of all views and lights.
// RELUME_ENOMEM.
relume_status btf_fill(relume_btf *btf, int threads, const void *context,
                       void (*picture)(const void *context, int view, int light, float *rgb));

// The side of the next level of detail.
int btf_half_side(int side);

// Values of `count` texels from `first` on as out[texel][view][light][3].
void btf_gather(const relume_btf *btf, size_t first, size_t count, float *out);

// Call `body` for every texel with its values [view][light][3]; which worker takes one is open.
// RELUME_ENOMEM, RELUME_ECANCEL; `what` names the work for progress, NULL: no progress.
relume_status btf_for_texels(const relume_btf *btf, int threads, const struct relume_log *log,
                             const char *what, void *context,
                             void (*body)(void *context, size_t texel, const float *values));

// Unit vectors of a JSON array; the caller frees `*out`.
struct json_t;
relume_status btf_read_directions(const struct json_t *array, const char *path, const char *what,
                                  const struct relume_limits *limits, vec3 **out, int *count,
                                  const struct relume_log *log);
// Writes them as such an array, each on a line of its own.
struct jwriter;
void btf_put_directions(struct jwriter *w, const char *key, const vec3 *d, int n);

#endif
