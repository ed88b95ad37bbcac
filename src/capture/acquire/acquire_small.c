// acquire_small.c - how well photographs fit their lights, judged by small ones where nobody wants
// the surface: 72 photographs of 24 megapixels would take an hour of one core
#include "capture/acquire/acquire.h"

#include "capture/acquire/photometric.h"
#include "core/base/memory.h"

#include <string.h>

// Of each pixel the value in the middle of what it stands for. NULL where there is no mask.
static relume_status shrink_mask(float **out, const struct acquisition *s,
                                 const relume_capture *capture)
{
    const struct relume_image *small = &s->shot[0].small;
    struct relume_image mask;
    *out = NULL;
    relume_status status = relume_capture_mask(&mask, capture, 0, s->p.log);
    if (status || !mask.data)
        return status;
    *out = mem_array((size_t)small->width * (size_t)small->height, sizeof **out);
    const int step = acquire_small_step(mask.width, mask.height);
    for (int y = 0; *out && y < small->height; y++)
        for (int x = 0; x < small->width; x++) {
            const int at[2] = {x * step + step / 2, y * step + step / 2};
            const int column = at[0] < mask.width ? at[0] : mask.width - 1;
            const int row = at[1] < mask.height ? at[1] : mask.height - 1;
            (*out)[(size_t)y * (size_t)small->width + (size_t)x] =
                mask.data[(size_t)row * (size_t)mask.width + (size_t)column];
        }
    relume_image_destroy(&mask);
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

relume_status acquire_fit_small(struct acquisition *s, const relume_capture *capture)
{
    const struct relume_image *first = &s->shot[0].small;
    const size_t n = 3 * (size_t)first->width * (size_t)first->height;
    struct relume_pictures pictures = {
        RELUME_SAMPLE_FLOAT, first->width, first->height, 3, NULL, NULL, NULL};
    struct relume_manifest manifest = *relume_capture_manifest(capture);
    relume_capture *small = NULL;
    float *mask, *data = mem_array(n * (size_t)s->shots, sizeof *data);
    relume_status status = shrink_mask(&mask, s, capture);
    if (!status && !data)
        status = RELUME_ENOMEM;
    for (int i = 0; !status && i < s->shots; i++)
        memcpy(data + n * (size_t)i, s->shot[i].small.data, n * sizeof *data);
    pictures.data = data;
    pictures.mask = mask;
    if (!status)
        status = relume_capture_create(&small, &manifest, &pictures,
                                       relume_capture_params(.log = s->p.log));
    if (!status)
        status = relume_photometric_fit(
            &s->out->photometric, small, 0,
            relume_photometric_params(.log = s->p.log, .threads = s->p.threads));
    relume_capture_destroy(&small);
    mem_free(data);
    mem_free(mask);
    return status;
}
