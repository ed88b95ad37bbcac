// map_save.c - maps as files that other programs read, and map_open.c
#include "core/base/tree.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "material/surface/surface.h"

static relume_status save_numbers(const struct relume_btf_map_info *m, int width, int height,
                                  const char *path, const struct relume_log *log)
{
    const struct npy npy = {.kind = NPY_U32, .dims = 2, .shape = {(size_t)height, (size_t)width}};
    uint32_t *texel = mem_array((size_t)width * (size_t)height, sizeof *texel), *to = texel;
    if (!texel)
        return RELUME_ENOMEM;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            *to++ = map_at(m, x, y);
    const relume_status status = npy_save(&npy, texel, path, log);
    mem_free(texel);
    return status;
}

static relume_status save_places(const struct relume_btf_map_info *m, int width, int height,
                                 const char *path, const struct relume_log *log)
{
    struct relume_image image;
    relume_status status = relume_image_create(&image, width, height, 3);
    if (status)
        return status;
    float *to = image.data;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, to += 3) {
            const uint32_t at = map_at(m, x, y), across = (uint32_t)m->sample_width;
            to[0] = (float)((at % across + 0.5) / m->sample_width);
            to[1] = (float)((at / across + 0.5) / m->sample_height);
        }
    status = relume_image_save(&image, path, relume_image_params(.log = log));
    relume_image_destroy(&image);
    return status;
}

relume_status relume_btf_map_save(const relume_btf_map *map, const char *path,
                                  const struct relume_btf_params *params)
{
    const struct relume_log *log = params ? params->log : NULL;
    const struct relume_btf_map_info *m = &map->info;
    const int width = m->columns * m->width, height = m->rows * m->height;
    if (path_ends(path, ".npy"))
        return save_numbers(m, width, height, path, log);
    if (path_ends(path, ".exr"))
        return save_places(m, width, height, path, log);
    return log_fail(log, RELUME_EINVAL, "%s: expected .npy or .exr for a map", path);
}
