// av1_read.c - the one place that knows dav1d
#include "lossy/av1.h"

#include <dav1d/dav1d.h>
#include <errno.h>
#include <string.h>

static void keep(const uint8_t *data, void *nobody)
{
    (void)data, (void)nobody;
}

static bool fits(const Dav1dPicture *p, const struct av1_shape *shape)
{
    const enum Dav1dPixelLayout layout =
        shape->components == 1 ? DAV1D_PIXEL_LAYOUT_I400 : DAV1D_PIXEL_LAYOUT_I444;
    return p->p.w == shape->width && p->p.h == shape->height && p->p.bpc == AV1_BITS &&
           p->p.layout == layout;
}

static void copy(uint16_t *samples, const Dav1dPicture *p, const struct av1_shape *shape)
{
    const size_t width = (size_t)shape->width, height = (size_t)shape->height;
    for (int c = 0; c < shape->components; c++)
        for (size_t y = 0; y < height; y++)
            memcpy(samples + ((size_t)c * height + y) * width,
                   (const char *)p->data[c] + (ptrdiff_t)y * p->stride[c > 0],
                   width * sizeof *samples);
}

// The pictures that are ready; 0 when more data is wanted, else the library's error.
static int take(uint16_t *samples, const struct av1_shape *shape, Dav1dContext *context, int *taken)
{
    const size_t size = (size_t)shape->components * (size_t)shape->width * (size_t)shape->height;
    int error;
    Dav1dPicture p = {0};
    while (!(error = dav1d_get_picture(context, &p))) {
        const bool right = *taken < shape->pictures && fits(&p, shape);
        if (right)
            copy(samples + (size_t)(*taken)++ * size, &p, shape);
        dav1d_picture_unref(&p);
        if (!right)
            return DAV1D_ERR(EINVAL);
    }
    return error == DAV1D_ERR(EAGAIN) ? 0 : error;
}

relume_status av1_decode(uint16_t *samples, const struct av1_shape *shape,
                         const unsigned char *bytes, size_t size)
{
    Dav1dSettings settings;
    Dav1dContext *context;
    Dav1dData data = {0};
    int taken = 0, error = 0;
    dav1d_default_settings(&settings);
    settings.n_threads = 1;
    settings.frame_size_limit = (unsigned)shape->width * (unsigned)shape->height;
    settings.logger.callback = NULL;
    if (dav1d_open(&context, &settings))
        return RELUME_ENOMEM;
    error = size ? dav1d_data_wrap(&data, bytes, size, keep, NULL) : DAV1D_ERR(EINVAL);
    while (!error && data.sz) {
        const int sent = dav1d_send_data(context, &data);
        error = sent && sent != DAV1D_ERR(EAGAIN) ? sent : take(samples, shape, context, &taken);
    }
    if (!error)
        error = take(samples, shape, context, &taken);
    dav1d_data_unref(&data);
    dav1d_close(&context);
    if (error == DAV1D_ERR(ENOMEM))
        return RELUME_ENOMEM;
    return !error && taken == shape->pictures ? RELUME_OK : RELUME_EDAMAGED;
}
