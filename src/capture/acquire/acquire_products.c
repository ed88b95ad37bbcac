// acquire_products.c - pictures of the surface that a capture is asked for: normals, albedo, height
#include "capture/acquire/acquire.h"

#include "capture/acquire/photometric.h"
#include "core/base/log.h"

#include <math.h>

static relume_status save(const struct acquisition *s, const char *path,
                          const struct relume_image *image, int bits)
{
    if (!path)
        return RELUME_OK;
    if (!image->data)
        return log_fail(s->p.log, RELUME_EUNFIT,
                        "%s: normals cannot be computed; expected three lights or more that do "
                        "not lie in one plane",
                        path);
    return relume_image_save(
        image, path, relume_image_params(.log = s->p.log, .bits = bits, .codes = bits == 16));
}

// Returns a picture whose values v are codes gain * v + offset; 0 where `known` is black.
static relume_status code(struct relume_image *out, const struct relume_image *image,
                          const struct relume_image *known, double gain, double offset)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    const size_t n = (size_t)image->channels;
    const relume_status status =
        relume_image_create(out, image->width, image->height, image->channels);
    for (size_t i = 0; !status && i < pixels; i++) {
        const float *k = known->data + 3 * i;
        const bool none = k[0] == 0.0f && k[1] == 0.0f && k[2] == 0.0f;
        for (size_t c = 0; c < n && !none; c++)
            out->data[n * i + c] = (float)(gain * (double)image->data[n * i + c] + offset);
    }
    return status;
}

// Formats of integers get 16 bits: (n + 1) / 2, as normal maps do.
static relume_status save_normals(const struct acquisition *s)
{
    const struct relume_image *normal = &s->out->photometric.normal;
    struct relume_image codes = {0};
    if (!s->p.normals || !normal->data || relume_image_saves_linear(s->p.normals))
        return save(s, s->p.normals, normal, 0);
    relume_status status = code(&codes, normal, normal, 0.5, 0.5);
    if (!status)
        status = save(s, s->p.normals, &codes, 16);
    relume_image_destroy(&codes);
    return status;
}

// Formats of integers get 16 bits, from the lowest height to the greatest.
static relume_status save_heights(const struct acquisition *s, const struct relume_image *height)
{
    const struct relume_image *normal = &s->out->photometric.normal;
    const size_t n = (size_t)height->width * (size_t)height->height;
    struct relume_image codes = {0};
    double low = 0.0, top = 0.0;
    if (!height->data || relume_image_saves_linear(s->p.height))
        return save(s, s->p.height, height, 0);
    for (size_t i = 0; i < n; i++) {
        low = fmin(low, (double)height->data[i]);
        top = fmax(top, (double)height->data[i]);
    }
    const double gain = top > low ? 1.0 / (top - low) : 0.0;
    relume_status status = code(&codes, height, normal, gain, -low * gain);
    if (!status)
        status = save(s, s->p.height, &codes, 16);
    if (!status)
        log_line(s->p.log, RELUME_NOTE, "%s: 0 is a height of %.4g %s, 65535 of %.4g", s->p.height,
                 low, s->p.width_mm > 0.0 ? "mm" : "world units", top);
    relume_image_destroy(&codes);
    return status;
}

static relume_status save_height(const struct acquisition *s)
{
    const struct relume_photometric *surface = &s->out->photometric;
    struct relume_image height = {0};
    relume_status status = RELUME_OK;
    if (!s->p.height)
        return RELUME_OK;
    if (surface->normal.data)
        status = relume_height_integrate(
            &height, &surface->normal,
            relume_height_params(.log = s->p.log,
                                 .pixel = (s->p.width_mm > 0.0 ? s->p.width_mm : 2.0) / s->whole[0],
                                 .threads = s->p.threads, .confidence = &surface->confidence));
    if (!status)
        status = save_heights(s, &height);
    relume_image_destroy(&height);
    return status;
}

relume_status acquire_write_products(const struct acquisition *s)
{
    relume_status status = save_normals(s);
    if (!status)
        status = save(s, s->p.albedo, &s->out->photometric.albedo, 0);
    return status ? status : save_height(s);
}

static relume_status write_products_of(struct acquisition *s, const relume_capture *capture)
{
    const struct relume_geometry *g = &relume_capture_manifest(capture)->geometry;
    const double width = g->window_max[0] - g->window_min[0];  // the whole photographs: 2
    s->whole[0] = relume_whole(2.0 * relume_capture_width(capture) / width + 0.5);
    const relume_status status =
        relume_photometric_fit(&s->out->photometric, capture, 0,
                               relume_photometric_params(.log = s->p.log, .threads = s->p.threads));
    return status && status != RELUME_EUNFIT ? status : acquire_write_products(s);
}

relume_status acquire_write_products_of(const char *folder, const struct relume_acquire_params *p)
{
    struct relume_acquisition out = {0};
    struct acquisition s = {.p = *p, .out = &out};
    relume_capture *capture;
    if (!p->normals && !p->albedo && !p->height)
        return RELUME_OK;
    relume_status status =
        relume_capture_open(&capture, folder, relume_capture_params(.log = p->log));
    if (!status)
        status = write_products_of(&s, capture);
    relume_capture_destroy(&capture);
    relume_acquisition_destroy(&out);
    return status;
}
