// acquire_products.c - pictures of the surface that a capture is asked for: normals, albedo, height
#include "capture/acquire/acquire.h"

#include "capture/acquire/photometric.h"
#include "core/base/log.h"

static relume_status save(const struct acquisition *s, const char *path,
                          const struct relume_image *image)
{
    if (!path)
        return RELUME_OK;
    if (!image->data)
        return log_fail(s->p.log, RELUME_EUNFIT,
                        "%s: normals cannot be computed; expected three lights or more that do "
                        "not lie in one plane",
                        path);
    return relume_image_save(image, path, relume_image_params(.log = s->p.log));
}

static relume_status save_height(const struct acquisition *s)
{
    const struct relume_photometric *surface = &s->out->photometric;
    struct relume_image height = {0};
    relume_status status = RELUME_OK;
    if (s->p.height && surface->normal.data)
        status = relume_height_integrate(
            &height, &surface->normal,
            relume_height_params(.log = s->p.log,
                                 .pixel = (s->p.width_mm > 0.0 ? s->p.width_mm : 2.0) / s->width,
                                 .threads = s->p.threads, .confidence = &surface->confidence));
    if (!status)
        status = save(s, s->p.height, &height);
    relume_image_destroy(&height);
    return status;
}

relume_status acquire_write_products(const struct acquisition *s)
{
    relume_status status = save(s, s->p.normals, &s->out->photometric.normal);
    if (!status)
        status = save(s, s->p.albedo, &s->out->photometric.albedo);
    return status ? status : save_height(s);
}
