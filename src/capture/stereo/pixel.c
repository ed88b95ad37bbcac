// pixel.c - scratch memory of one worker
#include "capture/stereo/pixel.h"

#include "core/base/memory.h"

relume_status stereo_scratch_create(struct stereo_scratch *scratch, int lights)
{
    enum { ROWS = REFLECT_PARTS + 9 };
    const size_t stride = (size_t)reflect_stride(lights);
    *scratch = (struct stereo_scratch){.stride = (int)stride,
                                       .memory = mem_array(ROWS * stride, sizeof(float))};
    if (!scratch->memory)
        return RELUME_ENOMEM;
    scratch->parts = scratch->memory;
    float **const row[] = {&scratch->matte,  &scratch->gloss, &scratch->expected, &scratch->base,
                           &scratch->weight, &scratch->spare, &scratch->cosines};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        *row[i] = scratch->parts + (REFLECT_PARTS + i) * stride;
    return RELUME_OK;
}

void stereo_scratch_destroy(struct stereo_scratch *scratch)
{
    mem_free(scratch->memory);
    *scratch = (struct stereo_scratch){0};
}
