// acquire_crop.c - a part of the photographs: as it is given, or the object
#include "capture/acquire/acquire.h"

#include "capture/acquire/object.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/image.h"

#include <string.h>

struct relume_rect acquire_part(const struct acquisition *s)
{
    const int *crop = s->out->crop;
    return (struct relume_rect){crop[0], crop[1], crop[2], crop[3]};
}

int acquire_balls_inside(const struct relume_ball **ball, const struct acquisition *s)
{
    *ball = s->witnessed ? &s->witness : s->out->ball;
    return s->witnessed ? 1 : s->p.lights || s->balls.count ? 0 : s->out->balls;
}

void acquire_say_no_object(bool relief, const struct relume_log *log)
{
    log_line(log, RELUME_NOTE, "--crop auto: %s; nothing is cropped",
             relief ? "the object fills the photographs" : "no relief is found");
}

static relume_status find_crop(struct acquisition *s, int crop[4])
{
    const struct relume_image **small = mem_array((size_t)s->shots, sizeof *small);
    struct relume_rect part;
    bool relief = false;
    if (!small)
        return RELUME_ENOMEM;
    for (int i = 0; i < s->shots; i++)
        small[i] = &s->shot[i].small;
    const struct relume_ball *ball;
    const int balls = acquire_balls_inside(&ball, s);
    const struct object_search search = {
        .small = small,
        .count = s->shots,
        .step = acquire_small_step(s->width, s->height),
        .width = s->width,
        .height = s->height,
        .ball = ball,
        .balls = balls,
    };
    const relume_status status = object_find(&part, &relief, &search);
    mem_free(small);
    if (status)
        return status;
    memcpy(crop, (const int[]){part.left, part.top, part.width, part.height}, 4 * sizeof *crop);
    if (!part.width)
        acquire_say_no_object(relief, s->p.log);
    return RELUME_OK;
}

static relume_status crop_shot(struct acquisition *s, struct shot *shot)
{
    const struct relume_rect part = acquire_part(s);
    struct relume_image image = {0};
    relume_status status = acquire_fetch(&image, s, shot);
    if (!status)
        status = image_crop(&image, &part);
    if (!status)
        status = acquire_save(s, shot, &image);
    relume_image_destroy(&shot->small);
    if (!status)
        status = acquire_shrink(&shot->small, &image);
    relume_image_destroy(&image);
    return status;
}

static relume_status check_inside(const struct acquisition *s, const int crop[4])
{
    if (crop[0] >= 0 && crop[1] >= 0 && crop[2] > 0 && crop[3] > 0 &&
        crop[0] <= s->width - crop[2] && crop[1] <= s->height - crop[3])
        return RELUME_OK;
    return log_fail(s->p.log, RELUME_EINVAL,
                    "--crop %d,%d,%d,%d: expected a part of the photographs of %d x %d pixels",
                    crop[0], crop[1], crop[2], crop[3], s->width, s->height);
}

relume_status acquire_crop(struct acquisition *s)
{
    int *const crop = s->out->crop;
    memcpy(crop, s->p.crop, sizeof s->p.crop);
    relume_status status = RELUME_OK;
    if (s->p.crop_auto)
        status = find_crop(s, crop);
    else if (s->p.crop[2] || s->p.crop[3])
        status = check_inside(s, crop);
    for (int i = 0; !status && crop[2] && i < s->shots; i++) {
        status = crop_shot(s, &s->shot[i]);
        if (!status && !log_progress(s->p.log, "cropping", (i + 1.0) / s->shots))
            status = RELUME_ECANCEL;
    }
    if (status || !crop[2])
        return status;
    s->width = crop[2];
    s->height = crop[3];
    log_line(s->p.log, RELUME_NOTE, "cropped to %d,%d,%d,%d of %d x %d pixels", crop[0], crop[1],
             crop[2], crop[3], s->whole[0], s->whole[1]);
    return RELUME_OK;
}
