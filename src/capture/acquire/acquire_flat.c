// acquire_flat.c - uneven light, vignetting and the lamp's colour, taken out of the photographs
#include "capture/acquire/acquire.h"

#include "capture/acquire/chart.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <stdio.h>
#include <string.h>

// The factors by which each photograph is multiplied; they turn that of an even surface into ones.
static relume_status make_gain(const struct acquisition *s, struct relume_image *gain,
                               const char *path)
{
    struct relume_image flat;
    struct relume_falloff falloff;
    *gain = (struct relume_image){0};
    relume_status status = acquire_load(&flat, NULL, s, path, s->p.transfer);
    if (!status)
        status = acquire_check_size(s, &flat, path, s->width, s->height);
    if (!status)
        status = relume_image_create(gain, flat.width, flat.height, 3);
    for (size_t i = 0; !status && i < 3 * (size_t)flat.width * (size_t)flat.height; i++)
        gain->data[i] = 1.0f;
    if (!status && s->p.radial) {
        status = relume_falloff_fit(&falloff, &flat, NULL);
        if (!status)
            relume_falloff_divide(gain, &falloff);
    } else if (!status) {
        status = relume_flat_divide(gain, &flat, NULL);
    }
    if (status == RELUME_EUNFIT && gain->data)
        (void)log_fail(s->p.log, status, "%s: %s; expected an evenly lit surface", path,
                       s->p.radial ? "black, or its corners nearly so" : "black somewhere");
    relume_image_destroy(&flat);
    if (status)
        relume_image_destroy(gain);
    return status;
}

relume_status acquire_flatten(struct acquisition *s, const struct shot *shot,
                              struct relume_image *image)
{
    const bool each = s->flats.count > 1;
    if (!s->flats.count)
        return RELUME_OK;
    if (each)
        relume_image_destroy(&s->gain);
    if (!s->gain.data) {
        const relume_status status = make_gain(s, &s->gain, s->flats.path[each ? shot->number : 0]);
        if (status)
            return status;
    }
    for (size_t i = 0; i < 3 * (size_t)image->width * (size_t)image->height; i++)
        image->data[i] *= s->gain.data[i];
    return RELUME_OK;
}

void acquire_correct(const struct acquisition *s, struct relume_image *image, bool floats)
{
    if (s->out->target)
        relume_chart_apply(image, s->out->chart.matrix, !floats);
}

relume_status acquire_add_grey(struct acquisition *s, const struct relume_image *image)
{
    const int *r = s->p.white;
    float gain[3];
    if (!r[2])
        return RELUME_OK;
    // where a photograph shows the card black or clipped it says nothing; where that is all there
    // is, acquire_whiten says so
    const relume_status status = relume_white_measure(gain, image, r[0], r[1], r[2], r[3], NULL);
    if (status == RELUME_EINVAL)
        return relume_white_measure(gain, image, r[0], r[1], r[2], r[3], s->p.log);
    if (!s->grey.data && relume_image_create(&s->grey, r[2], r[3], 3))
        return RELUME_ENOMEM;
    for (int y = 0; !status && y < r[3]; y++)
        for (int x = 0; x < 3 * r[2]; x++)
            s->grey.data[3 * (size_t)y * (size_t)r[2] + (size_t)x] +=
                image->data[3 * ((size_t)(r[1] + y) * (size_t)image->width + (size_t)r[0]) +
                            (size_t)x];
    return RELUME_OK;
}

relume_status acquire_whiten(struct acquisition *s)
{
    float gain[3];
    if (!s->p.white[2])
        return RELUME_OK;
    if (relume_white_measure(gain, &s->grey, 0, 0, s->grey.width, s->grey.height, NULL))
        return log_fail(s->p.log, RELUME_EUNFIT,
                        "white region %d,%d of %d x %d is black or saturated in all photographs; "
                        "expected a grey that is lit",
                        s->p.white[0], s->p.white[1], s->p.white[2], s->p.white[3]);
    for (int i = 0; i < s->shots; i++)
        for (int c = 0; c < 3; c++)
            s->shot[i].intensity[c] =
                (s->has_intensities ? s->shot[i].intensity[c] : 1.0f) / gain[c];
    s->has_intensities = true;
    return RELUME_OK;
}
