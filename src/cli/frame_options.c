// frame_options.c - what `relight` and `query` share: lights, depth, kernels
#include "frame_options.h"

relume_status parse_lights(const struct args *args, const struct light_options *o, relume_rig **rig,
                           const struct relume_light **lights, int *count)
{
    const int n = o->light.count;
    relume_status status =
        o->rig ? relume_rig_load(rig, o->rig, args->log) : relume_rig_create(rig);
    for (int i = 0; !status && i < (n || o->rig ? n : 1); i++)
        status = relume_rig_add(*rig, n ? o->light.text[i] : "dir 0 0 1", NULL, args->log);
    if (!status)
        status = relume_rig_lights(lights, count, *rig);
    if (status)
        relume_rig_destroy(rig);
    return status;
}

relume_status save_lights(const struct args *args, const struct light_options *o,
                          const relume_rig *rig)
{
    return o->save_rig ? relume_rig_save(rig, o->save_rig, args->log) : RELUME_OK;
}

struct relume_frame_params parse_frame(const struct args *args, const struct light_options *o,
                                       int cpu_mask)
{
    return (struct relume_frame_params){
        .cpu_off = ~(unsigned)cpu_mask,
        .threads = args->threads,
        .assume_depth = o->assume_depth,
    };
}
