// create.c - volumes as callers of the library see them
#include "shape/volume/volume.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/scratch.h"
#include "shape/volume/store.h"

#include <string.h>

void relume_volume_destroy(relume_volume **volume)
{
    relume_volume *v = *volume;
    if (!v)
        return;
    if (v->mapped)
        scratch_unmap(v->data, v->mapped);
    else
        mem_free(v->data);
    mem_free(v->index.range);
    mem_free(v);
    *volume = NULL;
}

struct relume_volume_info relume_volume_info(const relume_volume *v)
{
    return (struct relume_volume_info){.size = {v->size[0], v->size[1], v->size[2]},
                                       .min = v->min,
                                       .max = v->max,
                                       .spacing = {v->spacing[0], v->spacing[1], v->spacing[2]},
                                       .format = v->format};
}

relume_status relume_volume_from(relume_volume **out, const void *samples,
                                 const struct relume_volume_params *params)
{
    const struct relume_volume_params p = PARAMS(relume_volume_params, params);
    const uint16_t one = 1;
    struct store s = {.slope = 1.0, .path = "samples", .log = p.log};
    *out = NULL;
    s.big = !*(const uint8_t *)&one;
    s.type = sample_type_find(p.type ? p.type : "u8", &s.big);
    if (!s.type)
        return log_fail(p.log, RELUME_EINVAL,
                        "samples of type '%s'; expected one of u8, i8, u16le "
                        "and so on",
                        p.type);
    relume_status status = store_begin(&s, (const int64_t[3]){p.size[0], p.size[1], p.size[2]}, &p);
    for (int z = 0; z < p.size[2] && !status; z++)
        status = store_put(&s, (const char *)samples + (size_t)z * store_layer_bytes(&s),
                           (size_t)p.size[0] * (size_t)p.size[1]);
    if (!status)
        status = store_end(&s);
    if (!status)
        s.volume->format = "memory";
    if (status)
        relume_volume_destroy(&s.volume);
    *out = s.volume;
    return status;
}
