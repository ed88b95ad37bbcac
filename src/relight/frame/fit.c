// fit.c - the size of a frame, and the picture's place in it
#include <relume/frame.h>

#include <math.h>

struct relume_rect relume_rect_fit(int width, int height, int frame_width, int frame_height)
{
    if (width < 1 || height < 1)
        return (struct relume_rect){0, 0, frame_width, frame_height};
    const double scale = fmin((double)frame_width / width, (double)frame_height / height);
    struct relume_rect place = {.width = (int)fmax(lround(width * scale), 1.0),
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

struct relume_rect relume_camera_rect(int frame[2], const struct relume_pack_info *info,
                                      const struct relume_camera *camera)
{
    const bool look = camera->framing == RELUME_FRAME_LOOK;
    const bool square = look || camera->look_at.field_of_view_deg != 0.0;
    const int own[2] = {look ? 1024 : info->width, look ? 512 : info->height};
    relume_frame_size(&frame[0], &frame[1], own, camera);
    return square ? (struct relume_rect){0, 0, frame[0], frame[1]}
                  : relume_rect_fit(own[0], own[1], frame[0], frame[1]);
}
