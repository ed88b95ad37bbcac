// map.c - which texel of a sample stands at each texel of a surface
#include "core/base/log.h"
#include "core/base/memory.h"
#include "material/surface/surface.h"

#include <string.h>

// Sides of surfaces and numbers of texels stay within an int.
static const int64_t MOST_SIDE = 1 << 24, MOST_TEXELS = 1 << 30;

relume_status map_start(relume_btf_map **out, const struct relume_btf_map_info *s,
                        const struct relume_log *log)
{
    const struct relume_limits limits = limits_or_default(NULL);
    *out = NULL;
    if (!limits_allow(&limits, s->sample_width, s->sample_height) ||
        !limits_allow(&limits, s->width, s->height) || s->tiles < 1 || s->tiles > 65536 ||
        (int64_t)s->tiles * s->width * s->height > MOST_TEXELS)
        return log_fail(log, RELUME_ELIMIT,
                        "map: expected sizes within the limits; found %d tiles of %d x %d texels",
                        s->tiles, s->width, s->height);
    if (!limits_allow(&limits, s->columns, s->rows) || (int64_t)s->columns * s->width > MOST_SIDE ||
        (int64_t)s->rows * s->height > MOST_SIDE)
        return log_fail(log, RELUME_ELIMIT,
                        "map: expected a matrix within the limits; found %d x %d tiles of %d x %d",
                        s->columns, s->rows, s->width, s->height);
    relume_btf_map *m = mem_zeroed(1, sizeof *m);
    if (!m)
        return RELUME_ENOMEM;
    m->info = *s;
    m->texel = mem_array(map_texels(s), sizeof *m->texel);
    m->matrix = mem_zeroed((size_t)s->columns * (size_t)s->rows, sizeof *m->matrix);
    m->info.texel = m->texel;
    m->info.matrix = m->matrix;
    if (!m->texel || !m->matrix)
        relume_btf_map_destroy(&m);
    *out = m;
    return m ? RELUME_OK : RELUME_ENOMEM;
}

relume_status map_check(const struct relume_btf_map_info *i, const char *name,
                        const struct relume_log *log)
{
    const size_t sample = (size_t)i->sample_width * (size_t)i->sample_height;
    const size_t across = (size_t)i->width, all = map_texels(i);
    for (size_t t = 0; t < all; t++)
        if (i->texel[t] >= sample)
            return log_fail(log, RELUME_EDAMAGED,
                            "%s: row %zu, column %zu: expected a texel of %d x %d; found number %u",
                            name, t / across, t % across, i->sample_width, i->sample_height,
                            i->texel[t]);
    for (size_t t = 0; t < (size_t)i->columns * (size_t)i->rows; t++)
        if (i->matrix[t] >= i->tiles)
            return log_fail(log, RELUME_EDAMAGED,
                            "%s: matrix: row %zu, column %zu: expected one of %d tiles; found %u",
                            name, t / (size_t)i->columns, t % (size_t)i->columns, i->tiles,
                            i->matrix[t]);
    return RELUME_OK;
}

relume_status relume_btf_map_create(relume_btf_map **out, const struct relume_btf_map_info *info,
                                    const struct relume_log *log)
{
    relume_status status = map_start(out, info, log);
    if (status)
        return status;
    memcpy((*out)->texel, info->texel, map_texels(info) * sizeof *info->texel);
    memcpy((*out)->matrix, info->matrix,
           (size_t)info->columns * (size_t)info->rows * sizeof *info->matrix);
    status = map_check(&(*out)->info, "map", log);
    if (status)
        relume_btf_map_destroy(out);
    return status;
}

void relume_btf_map_destroy(relume_btf_map **map)
{
    if (*map) {
        mem_free((*map)->texel);
        mem_free((*map)->matrix);
    }
    mem_free(*map);
    *map = NULL;
}

const struct relume_btf_map_info *relume_btf_map_info(const relume_btf_map *map)
{
    return &map->info;
}
