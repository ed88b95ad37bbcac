// develop.c - how a linear frame becomes a picture to look at: exposure and tone
#include "develop.h"

#include <math.h>

relume_status develop(struct relume_image *frame, const struct develop_options *o, const char *path)
{
    const struct relume_tone_params tone = {
        .exposure_ev = isnan(o->exposure) ? relume_tone_meter_for(frame, o->tone) : o->exposure,
        .tone = o->tone,
        .white = o->white,
    };
    if (!relume_image_saves_linear(path))
        return relume_tone_apply(frame, &tone);
    const float gain = exp2f((float)tone.exposure_ev);
    const size_t samples = (size_t)frame->width * (size_t)frame->height * 3;
    for (size_t i = 0; i < samples; i++)
        frame->data[i] *= gain;
    return RELUME_OK;
}

relume_status check_bits(const struct develop_options *o, const char *path)
{
    if (o->bits == BITS_8 || has_words(path))
        return RELUME_OK;
    return usage_error("--bits 16: expected an output that ends in .png or .tif; found '%s'", path);
}

relume_status save_developed(const struct relume_image *frame, const struct develop_options *o,
                             const char *path, const struct args *args)
{
    return relume_image_save(
        frame, path,
        relume_image_params(.log = args->log, .profile = o->icc,
                            .bits = o->bits == BITS_16 ? 16 : 8,
                            .threads = args->threads > 0 ? args->threads : relume_cpu_count()));
}
