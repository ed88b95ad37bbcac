// layers.c - what views have beside their planes: depth and masks
#include "site/publish/layers.h"

#include "core/base/memory.h"
#include "site/publish/picture.h"

#include <math.h>

enum { MOST_CODE = 65535 };

// Equal steps of the inverse are equal steps of what the eye sees move.
void layers_find_steps(struct layers *l, const struct relume_image *depth)
{
    const size_t pixels = (size_t)depth->width * (size_t)depth->height;
    double min = INFINITY, max = 0.0;
    for (size_t i = 0; i < pixels; i++) {
        const double d = (double)depth->data[i];
        if (d > 0.0 && isfinite(d)) {
            min = fmin(min, 1.0 / d);
            max = fmax(max, 1.0 / d);
        }
    }
    l->depth_min = isfinite(min) ? min : 0.0;
    l->depth_step = fmax((max - l->depth_min) / (MOST_CODE - 1), 1e-12);
}

int layers_code(const struct layers *l, float depth)
{
    const double d = (double)depth;
    return d > 0.0 && isfinite(d)
               ? (int)fmin(1.0 + rint((1.0 / d - l->depth_min) / l->depth_step), MOST_CODE)
               : 0;
}

static relume_status write_depth(struct layers *l, const struct site *site, const char *name,
                                 const struct relume_image *depth)
{
    const size_t pixels = (size_t)depth->width * (size_t)depth->height;
    uint8_t *rgb = mem_zeroed(pixels, 3);
    if (!rgb)
        return RELUME_ENOMEM;
    layers_find_steps(l, depth);
    for (size_t i = 0; i < pixels; i++) {
        const int v = layers_code(l, depth->data[i]);
        rgb[3 * i] = (uint8_t)(v >> 8);
        rgb[3 * i + 1] = (uint8_t)(v & 255);
    }
    const relume_status status = picture_save_png(site, name, depth->width, depth->height, 3, rgb);
    mem_free(rgb);
    return status;
}

static relume_status write_mask(const struct site *site, const char *name,
                                const struct relume_image *mask)
{
    const size_t pixels = (size_t)mask->width * (size_t)mask->height;
    uint8_t *grey = mem_array(pixels, 1);
    if (!grey)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < pixels; i++)
        grey[i] = mask->data[i] > 0.5f ? 255 : 0;
    const relume_status status = picture_save_png(site, name, mask->width, mask->height, 1, grey);
    mem_free(grey);
    return status;
}

relume_status layers_write(struct layers *out, const struct site *site, const char *name,
                           relume_pack *pack, int view)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct relume_image image = {0};
    char *depth = mem_format("%s/depth.png", name), *mask = mem_format("%s/mask.png", name);
    relume_status status = depth && mask ? RELUME_OK : RELUME_ENOMEM;
    *out = (struct layers){0};
    if (!status && info->has_depth)
        status = relume_pack_depth(&image, pack, view);
    out->depth = !status && image.data;
    if (out->depth)
        status = write_depth(out, site, depth, &image);
    relume_image_destroy(&image);
    if (!status && info->has_mask)
        status = relume_pack_mask(&image, pack, view);
    out->mask = !status && image.data;
    if (out->mask)
        status = write_mask(site, mask, &image);
    relume_image_destroy(&image);
    mem_free(depth);
    mem_free(mask);
    return status;
}
