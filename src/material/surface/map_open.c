// map_open.c - index maps that other programs made: NumPy arrays of numbers, pictures of places
#include "core/base/tree.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "material/surface/surface.h"

#include <string.h>

static struct relume_btf_map_info sizes(size_t width, size_t height, int sample_width,
                                        int sample_height)
{
    const size_t most = 1u << 24;  // larger ones are refused as that
    return (struct relume_btf_map_info){
        .sample_width = sample_width,
        .sample_height = sample_height,
        .tiles = 1,
        .width = (int)(width < most ? width : most),
        .height = (int)(height < most ? height : most),
        .columns = 1,
        .rows = 1,
    };
}

static relume_status open_numbers(relume_btf_map **out, const char *path, int sample_width,
                                  int sample_height, const struct relume_log *log)
{
    struct npy_file file;
    relume_status status = npy_open(&file, path, log);
    const struct npy *n = &file.npy;
    if (!status && (n->dims != 2 || (n->kind != NPY_U16 && n->kind != NPY_U32)))
        status =
            log_fail(log, RELUME_EFORMAT, "%s: expected uint16 or uint32 [height][width]", path);
    if (!status) {
        const struct relume_btf_map_info s =
            sizes(n->shape[1], n->shape[0], sample_width, sample_height);
        status = map_start(out, &s, log);
    }
    for (size_t i = 0; !status && i < map_texels(&(*out)->info); i++)
        (*out)->texel[i] = n->kind == NPY_U16 ? ((const uint16_t *)file.data)[i]
                                              : ((const uint32_t *)file.data)[i];
    npy_close(&file);
    return status;
}

// From a part of the side to a texel; false outside.
static bool place_texel(uint32_t *out, float part, int side)
{
    if (!(part >= 0.0f && part <= 1.0f))
        return false;
    *out = (uint32_t)((double)part * side);
    *out -= *out == (uint32_t)side;
    return true;
}

static relume_status open_picture(relume_btf_map **out, const char *path, int sample_width,
                                  int sample_height, const struct relume_btf_params *params)
{
    const struct relume_log *log = params ? params->log : NULL;
    struct relume_image image = {0};
    relume_status status = relume_image_load(
        &image, path,
        relume_image_params(.log = log, .channels = 3, .limits = params ? params->limits : NULL,
                            .transfer = {.curve = RELUME_CURVE_LINEAR}));
    const struct relume_btf_map_info s =
        sizes((size_t)image.width, (size_t)image.height, sample_width, sample_height);
    if (!status)
        status = map_start(out, &s, log);
    for (size_t i = 0; !status && i < map_texels(&s); i++) {
        const float *p = image.data + 3 * i;
        uint32_t x, y;
        if (place_texel(&x, p[0], sample_width) && place_texel(&y, p[1], sample_height))
            (*out)->texel[i] = y * (uint32_t)sample_width + x;
        else
            status = log_fail(log, RELUME_EDAMAGED,
                              "%s: row %zu, column %zu: expected a place from 0 to 1 in red and "
                              "green; found %g, %g",
                              path, i / (size_t)s.width, i % (size_t)s.width, (double)p[0],
                              (double)p[1]);
    }
    relume_image_destroy(&image);
    return status;
}

relume_status relume_btf_map_open(relume_btf_map **out, const char *path, int sample_width,
                                  int sample_height, const struct relume_btf_params *params)
{
    const struct relume_log *log = params ? params->log : NULL;
    *out = NULL;
    relume_status status = path_ends(path, ".npy")
                               ? open_numbers(out, path, sample_width, sample_height, log)
                               : open_picture(out, path, sample_width, sample_height, params);
    if (!status)
        status = map_check(&(*out)->info, path, log);
    if (status)
        relume_btf_map_destroy(out);
    return status;
}
