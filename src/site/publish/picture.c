// picture.c - ordinary pictures in the site
#include "site/publish/picture.h"

#include "core/base/memory.h"
#include "core/math/scalar.h"
#include "exchange/formats/sheet.h"
#include "image/image/picture.h"

#include <math.h>
#include <relume/format/coder.h>
#include <relume/context.h>
#include <relume/frame.h>

// Of the quantiser, in codes of luminance: no block is seen.
#define STEP 6.0

relume_status picture_still(struct relume_image *out, relume_pack *pack, int side, bool look,
                            const struct site *site)
{
    const bool pole_y = relume_coder_info(relume_pack_info(pack)->coder)->pole_y;
    const struct relume_vec3 front =
        pole_y ? (struct relume_vec3){0.35, 0.8, 0.49} : (struct relume_vec3){0, 0, 1};
    return picture_lit(out, pack, side, look, front, site);
}

relume_status picture_lit(struct relume_image *out, relume_pack *pack, int side, bool look,
                          struct relume_vec3 direction, const struct site *site)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const struct relume_light light = {.direction = direction, .rgb = {1, 1, 1}};
    const int longer = larger_of(info->width, info->height);
    struct relume_camera camera = {.framing = RELUME_FRAME_DEFAULT};
    if (look && info->geometry.projection >= RELUME_CYLINDRICAL) {
        camera.framing = RELUME_FRAME_LOOK;
        camera.look.zoom = 1.0;
        camera.width = side;
        camera.height = side / 2;
    } else if (side && longer > side) {
        camera.width = larger_of(1, (int)lround((double)info->width * side / longer));
        camera.height = larger_of(1, (int)lround((double)info->height * side / longer));
    }
    return relume_frame(
        out, pack, &camera, &light, 1,
        relume_frame_params(.log = site->log, .threads = site->params->threads, .once = true));
}

relume_status picture_save_jpeg(const struct site *site, const char *name,
                                const struct relume_image *picture, const struct relume_rect *at)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const size_t width = (size_t)at->width, pixels = width * (size_t)at->height;
    float *plane = mem_array(3 * pixels, sizeof *plane);
    struct sheet_result jpeg = {0};
    struct sheet s = {
        .width = at->width, .height = at->height, .planes = 3, .fixed = true, .ycbcr = true};
    for (size_t c = 0; plane && c < 3; c++) {
        float *to = plane + c * pixels;
        for (size_t i = 0; i < pixels; i++) {
            const size_t row = (size_t)at->top + i / width, column = (size_t)at->left + i % width;
            const float v = picture->data[3 * (row * (size_t)picture->width + column) + c];
            to[i] = relume_transfer_encode(srgb, fminf(fmaxf(v, 0.0f), 1.0f));
        }
        s.plane[c] = to;
        s.maximum[c] = s.weight[c] = 1.0;
    }
    relume_status status =
        plane ? sheet_encode(&jpeg, &s, STEP * sqrt(3.0) / 255.0) : RELUME_ENOMEM;
    if (!status)
        status = site_save(site, name, jpeg.bytes, jpeg.size);
    mem_free(jpeg.bytes);
    mem_free(plane);
    return status;
}

relume_status picture_save_png(const struct site *site, const char *name, int width, int height,
                               int channels, const uint8_t *samples)
{
    struct relume_buffer png = {0};
    const struct relume_writer writer = relume_buffer_writer(&png);
    relume_status status =
        picture_write_bytes(name, &writer, width, height, channels, samples, site->log);
    if (!status)
        status = site_save_data(site, name, png.data, png.size);
    relume_buffer_destroy(&png);
    return status;
}
