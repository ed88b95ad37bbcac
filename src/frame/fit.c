// fit.c - the size of a frame, and the picture's place in it
#include "base/log.h"
#include "frame/renderer.h"

#include <string.h>

struct relume_place relume_place_fit(int width, int height, int frame_width, int frame_height)
{
    if (width < 1 || height < 1)
        return (struct relume_place){0, 0, frame_width, frame_height};
    const double scale = fmin((double)frame_width / width, (double)frame_height / height);
    struct relume_place place = {.width = (int)fmax(lround(width * scale), 1.0),
                                 .height = (int)fmax(lround(height * scale), 1.0)};
    if (frame_width - width * scale < 1.0)
        place.width = frame_width;
    if (frame_height - height * scale < 1.0)
        place.height = frame_height;
    place.left = (frame_width - place.width) / 2;
    place.top = (frame_height - place.height) / 2;
    return place;
}

static int by_proportion(int given, int of, int other)
{
    return (int)fmin(fmax(round((double)given * other / of), 1.0), 65536.0);
}

void relume_frame_size(int *width, int *height, const int own[2],
                       const struct relume_camera *camera)
{
    *width = camera->width    ? camera->width
             : camera->height ? by_proportion(camera->height, own[1], own[0])
                              : own[0];
    *height = camera->height  ? camera->height
              : camera->width ? by_proportion(camera->width, own[0], own[1])
                              : own[1];
}

struct relume_place relume_camera_place(int frame[2], const struct relume_pack_info *info,
                                        const struct relume_camera *camera)
{
    const bool look = camera->framing == RELUME_FRAME_LOOK;
    const bool square = look || camera->aim.field_of_view_deg != 0.0;
    const int own[2] = {look ? 1024 : info->width, look ? 512 : info->height};
    relume_frame_size(&frame[0], &frame[1], own, camera);
    return square ? (struct relume_place){0, 0, frame[0], frame[1]}
                  : relume_place_fit(own[0], own[1], frame[0], frame[1]);
}

relume_status frame_put(struct relume_image *image, const struct relume_place *place,
                        const int frame[2], const struct renderer *r)
{
    struct relume_image out;
    if (image->width == frame[0] && image->height == frame[1])
        return RELUME_OK;
    const relume_status status = relume_image_create(&out, frame[0], frame[1], image->channels);
    if (status)
        return status;
    const size_t channels = (size_t)image->channels, row = channels * (size_t)image->width;
    const size_t samples = channels * (size_t)out.width * (size_t)out.height;
    for (size_t i = 0; r->params.places && i < samples; i++)
        out.data[i] = r->view.nothing;
    for (int y = 0; y < image->height; y++)
        memcpy(out.data +
                   channels * ((size_t)(place->top + y) * (size_t)out.width + (size_t)place->left),
               image->data + row * (size_t)y, row * sizeof *image->data);
    log_line(r->params.places ? NULL : r->params.log, RELUME_NOTE,
             "the picture does not have the proportions %d x %d: it fills %d x %d, with black "
             "borders; give the width alone to avoid them",
             frame[0], frame[1], image->width, image->height);
    relume_image_destroy(image);
    *image = out;
    return RELUME_OK;
}
