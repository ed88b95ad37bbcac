// texture.c - samples of textures
#include "material/synthesis/texture.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/image.h"

#include <math.h>

enum { LEAST_SIDE = 8, MOST_CHANNELS = 16 };

relume_status texture_check(const struct relume_texture *t, const struct relume_log *log)
{
    if (t->width < LEAST_SIDE || t->height < LEAST_SIDE)
        return log_fail(log, RELUME_EUNFIT,
                        "texture: expected at least %d x %d texels; found %d x %d", LEAST_SIDE,
                        LEAST_SIDE, t->width, t->height);
    if (t->channels < 1 || t->channels > MOST_CHANNELS)
        return log_fail(log, RELUME_EUNFIT, "texture: expected 1 to %d channels; found %d",
                        MOST_CHANNELS, t->channels);
    const size_t row = (size_t)t->width * (size_t)t->channels;
    for (size_t i = 0; i < row * (size_t)t->height; i++)
        if (!isfinite(t->value[i]))
            return log_fail(log, RELUME_EUNFIT,
                            "texture: row %zu, column %zu: expected a number; found %g", i / row,
                            i % row / (size_t)t->channels, (double)t->value[i]);
    return RELUME_OK;
}

static void to_luma_chroma(float out[3], const float *linear)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    float c[3];
    for (int i = 0; i < 3; i++)
        c[i] = relume_transfer_encode(srgb, linear[i]);
    out[0] = 0.299f * c[0] + 0.587f * c[1] + 0.114f * c[2];
    out[1] = 0.713f * (c[0] - out[0]);
    out[2] = 0.564f * (c[2] - out[0]);
}

relume_status relume_texture_of_image(struct relume_texture *out, const struct relume_image *image,
                                      const struct relume_log *log)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    *out = (struct relume_texture){.width = image->width, .height = image->height};
    if (image->channels != 1 && image->channels != 3)
        return log_fail(log, RELUME_EINVAL, "texture: expected 1 or 3 channels; found %d",
                        image->channels);
    out->channels = image->channels;
    out->value = mem_array(pixels * (size_t)out->channels, sizeof *out->value);
    if (!out->value)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < pixels; i++)
        if (image->channels == 3)
            to_luma_chroma(out->value + 3 * i, image->data + 3 * i);
        else
            out->value[i] = relume_transfer_encode(srgb, image->data[i]);
    const relume_status status = texture_check(out, log);
    if (status)
        relume_texture_destroy(out);
    return status;
}

void relume_texture_destroy(struct relume_texture *texture)
{
    mem_free(texture->value);
    *texture = (struct relume_texture){.value = NULL};
}
