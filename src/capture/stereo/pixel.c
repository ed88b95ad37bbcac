// pixel.c - room of one worker
#include "capture/stereo/pixel.h"

#include "core/base/memory.h"

relume_status stereo_room_create(struct stereo_room *room, int lights)
{
    enum { ROWS = REFLECT_PARTS + 9 };
    const size_t stride = (size_t)reflect_stride(lights);
    *room = (struct stereo_room){.stride = (int)stride,
                                 .memory = mem_array(ROWS * stride, sizeof(float))};
    if (!room->memory)
        return RELUME_ENOMEM;
    room->parts = room->memory;
    float **const row[] = {&room->matte,  &room->gloss, &room->expected, &room->base,
                           &room->weight, &room->spare, &room->cosines};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        *row[i] = room->parts + (REFLECT_PARTS + i) * stride;
    return RELUME_OK;
}

void stereo_room_destroy(struct stereo_room *room)
{
    mem_free(room->memory);
    *room = (struct stereo_room){0};
}
