// export_olat.c - one light at a time: an EXR whose layers are a view under each of its lights,
// which compositors weigh and add up
//
// Layers are named light0000 and so on, in the order of the lights; olat.directions has three
// numbers for each. Red, green and blue without a layer are their mean, for programs that show no
// layers.
#include "exchange/formats/export.h"

#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "format/coder/coding.h"
#include "image/image/exr.h"

#include <math.h>
#include <relume/relight/relight.h>
#include <stdio.h>

enum { NAME = 24, PLAIN = 3 };  // channels without a layer

struct olat {
    const struct relume_codes *codes;
    int lights;
    const struct relume_vec3 *direction;
    const struct relume_export_params *p;
};

static uint16_t half_of(float v)
{
    return half_from_float(fminf(fmaxf(v, -65504.0f), 65504.0f));
}

// Where the samples of a light begin in a row: blue, green, red; the mean's are first.
static uint16_t *channels_of(void *samples, const struct olat *o, int row, int layer, size_t width)
{
    const size_t all = PLAIN * (size_t)(o->lights + 1);
    return (uint16_t *)samples + ((size_t)row * all + PLAIN * (size_t)(layer + 1)) * width;
}

static relume_status relight_rows(const struct olat *o, const struct relume_codes *band,
                                  float *mean, void *samples)
{
    const size_t width = (size_t)band->width;
    struct relume_image image = {0};
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < o->lights; i++) {
        const struct relume_light light = {
            .kind = RELUME_LIGHT_DIRECTIONAL, .direction = o->direction[i], .rgb = {1, 1, 1}};
        status = relume_relight(&image, band, &light, 1, relume_relight_params(.threads = 1));
        for (int y = 0; !status && y < band->height; y++) {
            uint16_t *out = channels_of(samples, o, y, i, width);
            const float *from = image.data + 3 * (size_t)y * width;
            for (size_t x = 0; x < width; x++)
                for (size_t c = 0; c < 3; c++) {
                    out[(2 - c) * width + x] = half_of(from[3 * x + c]);
                    mean[3 * ((size_t)y * width + x) + c] += from[3 * x + c] / (float)o->lights;
                }
        }
    }
    relume_image_destroy(&image);
    return status;
}

static relume_status fill_rows(void *context, int row, int rows, void *samples)
{
    const struct olat *o = context;
    const size_t width = (size_t)o->codes->width;
    const struct relume_rect rect = {0, row, o->codes->width, rows};
    struct relume_codes_part part;
    float *mean = mem_zeroed((size_t)rows * width, 3 * sizeof *mean);
    if (!mean)
        return RELUME_ENOMEM;
    relume_status status = relume_codes_crop(&part, o->codes, &rect);
    if (!status)
        status = relight_rows(o, &part.codes, mean, samples);
    for (int y = 0; !status && y < rows; y++) {
        uint16_t *out = channels_of(samples, o, y, -1, width);
        for (size_t x = 0; x < width; x++)
            for (size_t c = 0; c < 3; c++)
                out[(2 - c) * width + x] = half_of(mean[3 * ((size_t)y * width + x) + c]);
    }
    relume_codes_part_destroy(&part);
    mem_free(mean);
    return status;
}

// Blue, green and red of the mean, then of each layer: sorted as EXR wants it.
static void name_channels(const char **channel, char (*name)[NAME], int lights)
{
    static const char *const colours[] = {"B", "G", "R"};
    const int digits = lights > 10000 ? 5 : 4;
    for (int i = 0; i < PLAIN * (lights + 1); i++) {
        const int layer = i / PLAIN - 1;
        if (layer < 0)
            snprintf(name[i], NAME, "%s", colours[i % PLAIN]);
        else
            snprintf(name[i], NAME, "light%0*d.%s", digits, layer, colours[i % PLAIN]);
        channel[i] = name[i];
    }
}

static relume_status write(struct olat *o, const char *path, const char **channel,
                           float *directions)
{
    for (int i = 0; i < o->lights; i++) {
        const struct relume_vec3 d = o->direction[i];
        directions[3 * i] = (float)d.x;
        directions[3 * i + 1] = (float)d.y;
        directions[3 * i + 2] = (float)d.z;
    }
    const struct exr_attribute attribute = {.name = "olat.directions",
                                            .kind = EXR_FLOATS,
                                            .floats = directions,
                                            .count = 3 * o->lights};
    const struct exr_part part = {
        .name = "olat",
        .width = o->codes->width,
        .height = o->codes->height,
        .sample = EXR_SAMPLE_HALF,
        .codec = EXR_CODEC_ZIP,
        .channels = PLAIN * (o->lights + 1),
        .channel = channel,
        .attributes = 1,
        .attribute = &attribute,
        .rows = fill_rows,
        .context = o,
    };
    return exr_write(path, o->p->writer, &part, 1, false, o->p->threads, o->p->log);
}

relume_status export_olat(const struct relume_codes *codes, const char *path,
                          struct relume_export_report *report,
                          const struct relume_export_params *params)
{
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    struct olat o = {codes, info->lights, info->directions, params};
    const size_t channels = PLAIN * ((size_t)o.lights + 1);
    const char **channel = mem_array(channels, sizeof *channel);
    char(*name)[NAME] = mem_array(channels, sizeof *name);
    float *directions = mem_array((size_t)o.lights, 3 * sizeof *directions);
    relume_status status = channel && name && directions ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        name_channels(channel, name, o.lights);
        status = write(&o, path, channel, directions);
    }
    report->layers = status ? 0 : o.lights;
    mem_free(channel);
    mem_free(name);
    mem_free(directions);
    return status;
}
