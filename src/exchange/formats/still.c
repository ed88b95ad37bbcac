// still.c - a picture of linear light becomes a relume file that shows it under any light
#include "exchange/formats/still.h"

#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "encode/levels/pyramid.h"
#include "format/coder/coding.h"
#include "format/pack/pack_write.h"

#include <math.h>
#include <relume/encode/pack_encode.h>
#include <relume/image/photograph.h>

#define MOST_HALF 65504.0f

// Halves keep the 11 leading bits of what is not brighter than they can hold.
static enum relume_storage storage_of(const struct relume_image *image)
{
    const size_t values = 3 * (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < values; i++)
        if (fabsf(image->data[i]) > MOST_HALF)
            return RELUME_STORE_FLOAT;
    return RELUME_STORE_HALF;
}

static void fill(void *planes, enum relume_storage storage, const struct relume_image *image)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++) {
            const float v = image->data[3 * i + c];
            if (storage == RELUME_STORE_HALF)
                ((uint16_t *)planes)[c * pixels + i] = half_from_float(v);
            else
                ((float *)planes)[c * pixels + i] = v;
        }
}

static relume_status write(const struct relume_codes *codes, bool sphere, const char *out,
                           const struct relume_open_params *p)
{
    relume_coefficients *coefficients = NULL;
    relume_status status = relume_coefficients_keep(
        &coefficients, codes, relume_project_params(.log = p->log, .scratch = out));
    const struct relume_pack_view view = {.coefficients = coefficients};
    struct relume_pack_contents contents = {
        .coder = codes->coder,
        .domain = RELUME_DOMAIN_LINEAR,
        .display = {.curve = RELUME_CURVE_SRGB},
        .geometry = relume_geometry_default(sphere ? RELUME_SPHERICAL : RELUME_PLANAR, codes->width,
                                            codes->height),
        .views = 1,
        .view = &view,
        .report = {(double)NAN, (double)NAN},
        .preview = relume_pack_preview,
        .preview_user = &contents,
    };
    if (!status)
        status = relume_pack_write(&contents, out,
                                   relume_pack_params(.log = p->log, .threads = p->threads,
                                                      .compression = RELUME_COMPRESS_NONE));
    relume_coefficients_destroy(&coefficients);
    return status;
}

static relume_status encode(const struct relume_image *image, const char *out,
                            const struct relume_open_params *p)
{
    static const float one[3] = {1.0f, 1.0f, 1.0f}, zero[3] = {0.0f, 0.0f, 0.0f};
    const struct relume_vec3 light =
        p->sphere ? (struct relume_vec3){0.0, 1.0, 0.0} : (struct relume_vec3){0.0, 0.0, 1.0};
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    relume_coder *coder = NULL;
    const enum relume_storage storage = storage_of(image);
    const size_t bytes = pixels * relume_storage_bytes(storage);
    char *planes = mem_array(3, bytes);
    if (!planes)
        return RELUME_ENOMEM;
    fill(planes, storage, image);
    relume_status status =
        relume_coder_create(&coder, &relume_basis_table, &light, 1,
                            relume_coder_params(.log = p->log, .pole_y = p->sphere));
    const void *plane[3] = {planes, planes + bytes, planes + 2 * bytes};
    const struct relume_codes codes = {
        .coder = coder,
        .width = image->width,
        .height = image->height,
        .planes = 3,
        .storage = storage,
        .plane = plane,
        .scale = one,
        .offset = zero,
    };
    if (!status)
        status = write(&codes, p->sphere, out, p);
    relume_coder_destroy(&coder);
    mem_free(planes);
    return status;
}

relume_status still_write(const char *path, const char *out,
                          const struct relume_open_params *params)
{
    struct relume_image image = {0};
    relume_status status = relume_photograph_load(
        &image, NULL, path, relume_photograph_params(.log = params->log, .limits = params->limits));
    if (!status && params->sphere && image.width != 2 * image.height)
        status =
            log_fail(params->log, RELUME_EUNFIT,
                     "%s: %d x %d pixels; a picture of all directions is twice as wide as high",
                     path, image.width, image.height);
    if (!status)
        status = encode(&image, out, params);
    relume_image_destroy(&image);
    return status;
}
