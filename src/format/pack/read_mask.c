// read_mask.c - what a mask leaves out is black
//
// Masked coefficients are stored as 0, which leaves what a coder adds to every pixel: the mean of
// `pca`. So in files with masks the mean is one more function (relume_coder_append_mean), whose
// coefficient is the mask: all who relight see ordinary codes, and nothing is left outside.
// Code vectors need not hold 0 at all: there masked pixels point to one more vector, of nothing.
#include "format/coder/codes.h"
#include "format/pack/reader.h"

#include <math.h>

relume_status reader_mask_plane(relume_pack *p, int view, int level, const struct relume_rect *rect,
                                void *plane)
{
    const size_t pixels = (size_t)rect->width * (size_t)rect->height;
    const struct view_parts *parts = &p->parts[view];
    const int top = level ? relume_storage_top(p->info.storage) : 0;
    const bool shares = level && p->info.domain == RELUME_DOMAIN_LINEAR;
    struct relume_image mask;
    const relume_status status =
        reader_load_plane(&mask, p, level ? parts->share[level - 1] : parts->mask, rect);
    for (size_t i = 0; !status && i < pixels; i++) {
        const float share = mask.data ? fminf(mask.data[i], 1.0f) : 1.0f;
        const float inside = shares ? share : share > (level ? 0.0f : 0.5f);
        const float number = top ? rintf(inside * (float)top) : inside;
        (void)codes_keep(plane, p->info.storage, i, &number, 1);
    }
    relume_image_destroy(&mask);
    return status;
}

relume_status reader_mask_codes(relume_pack *p, int view, int level, const struct relume_rect *rect,
                                const struct relume_codes *codes, uint16_t *data)
{
    const size_t pixels = (size_t)rect->width * (size_t)rect->height;
    const struct view_parts *parts = &p->parts[view];
    const float least = level ? 0.0f : 0.5f;
    struct relume_image mask;
    const relume_status status =
        reader_load_plane(&mask, p, level ? parts->share[level - 1] : parts->mask, rect);
    for (int k = 0; !status && mask.data && k < p->info.planes; k++) {
        uint16_t *plane = data + (size_t)k * pixels;
        const long zero = lrintf(-codes->offset[k] / codes->scale[k]);
        for (size_t i = 0; i < pixels; i++)
            if (mask.data[i] <= least)
                plane[i] = (uint16_t)(zero < 0 ? 0 : zero > 4095 ? 4095 : zero);
    }
    relume_image_destroy(&mask);
    return status;
}

// Indices have 16 bits: the largest books cannot hold another vector.
bool reader_has_nothing(const relume_pack *p, int codes)
{
    return p->info.has_mask && codes < 65536;
}

relume_status reader_mask_indices(relume_pack *p, int view, const struct relume_rect *rect,
                                  uint16_t *index)
{
    const struct read_books *set = &p->books[p->info.shared ? 0 : view];
    const size_t pixels = (size_t)rect->width * (size_t)rect->height;
    struct relume_image mask;
    const relume_status status = reader_load_plane(&mask, p, p->parts[view].mask, rect);
    for (int b = 0; !status && mask.data && b < p->info.books; b++)
        for (size_t i = 0; reader_has_nothing(p, set->book[b].codes) && i < pixels; i++)
            if (mask.data[i] <= 0.5f)
                index[(size_t)b * pixels + i] = (uint16_t)set->book[b].codes;
    relume_image_destroy(&mask);
    return status;
}
