// surface.h - the inside of maps and surfaces, and what their makers and readers share
#ifndef SURFACE_SURFACE_H
#define SURFACE_SURFACE_H

#include "material/model/ambient.h"

#include <relume/material/surface.h>

enum { SURFACE_LEVELS = 17 };

struct relume_btf_map {
    struct relume_btf_map_info info;  // owns what it points to
    uint32_t *texel;
    uint16_t *matrix;
};

// A map whose texels and matrix are still to be filled. An input status for sizes over the limits,
// RELUME_ENOMEM.
relume_status map_start(relume_btf_map **out, const struct relume_btf_map_info *sizes,
                        const struct relume_log *log);
// That every texel is of the sample and every tile is there; sentences begin with `name`.
relume_status map_check(const struct relume_btf_map_info *info, const char *name,
                        const struct relume_log *log);

static inline size_t map_texels(const struct relume_btf_map_info *i)
{
    return (size_t)i->tiles * (size_t)i->width * (size_t)i->height;
}

static inline int map_wrap(int64_t x, int n)
{
    const int64_t rest = x % n;
    return (int)(rest < 0 ? rest + n : rest);
}

// The texel of the sample at (x, y) of the surface, which repeats.
static inline uint32_t map_at(const struct relume_btf_map_info *i, int64_t x, int64_t y)
{
    const int sx = map_wrap(x, i->columns * i->width), sy = map_wrap(y, i->rows * i->height);
    const size_t tile =
        i->matrix[(size_t)(sy / i->height) * (size_t)i->columns + (size_t)(sx / i->width)];
    return i->texel[(tile * (size_t)i->height + (size_t)(sy % i->height)) * (size_t)i->width +
                    (size_t)(sx % i->width)];
}

struct relume_btf_surface {
    relume_btf_fitted *own;  // of surfaces that were opened, or NULL
    bool whole;              // the sample as it is: neighbours are those that it has
    int levels;
    struct surface_level {
        const relume_btf_fitted *model;
        struct relume_btf_map_info map;
        relume_btf_map *own;  // what `map` points to
    } level[SURFACE_LEVELS];
    struct relume_btf_surface_info info;
};

// Levels of the model and of the map, from the finest map, which the surface then owns.
relume_status surface_start(relume_btf_surface **out, const relume_btf_fitted *model,
                            relume_btf_map *map);

#endif
