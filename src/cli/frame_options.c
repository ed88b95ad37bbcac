// frame_options.c - what `relight` and `query` share: lights, depth, kernels
#include "frame_options.h"

#include <ctype.h>
#include <stdlib.h>

static relume_status make_rig(const struct light_options *o, relume_rig **rig,
                              const struct relume_log *log)
{
    relume_status status = o->rig ? relume_rig_load(rig, o->rig, log) : relume_rig_create(rig);
    for (int i = 0; !status && i < o->light.count; i++)
        status = relume_rig_add(*rig, o->light.text[i], NULL, log);
    if (!status && !o->light.count && !o->rig)
        status = relume_rig_add(*rig, "dir 0 0 1", NULL, log);
    return status;
}

relume_status parse_lights(const struct args *args, const struct light_options *o, relume_rig **rig,
                           const struct relume_light **lights, int *count)
{
    relume_status status = make_rig(o, rig, args->log);
    if (!status && o->save_rig)
        status = relume_rig_save(*rig, o->save_rig, args->log);
    if (!status)
        status = relume_rig_lights(lights, count, *rig);
    if (status)
        relume_rig_destroy(rig);
    return status;
}

// A number, at `*text` and moved beyond it; 0 where there is none.
static int64_t take_side(const char **text)
{
    char *end;
    const int64_t side = isdigit((unsigned char)**text) ? strtol(*text, &end, 10) : 0;
    *text = side ? end : *text;
    return side;
}

relume_status parse_size(const char *text, int *width, int *height)
{
    const char *rest = text;
    if (!text)
        return RELUME_OK;
    const int64_t w = take_side(&rest);
    const bool both = *rest == 'x';
    rest += both;
    const int64_t h = both ? take_side(&rest) : 0;
    if (*rest || !(w || h) || w > 65536 || h > 65536 || w * h > 1 << 30)
        return usage_error("--size: expected WIDTHxHEIGHT, WIDTH or xHEIGHT, at most 65536 a side "
                           "and 2^30 pixels; found '%s'",
                           text);
    *width = (int)w;
    *height = (int)h;
    return RELUME_OK;
}

relume_status parse_interpolation(const struct interpolate_options *o,
                                  struct relume_frame_params *params)
{
    static const char *const names[] = {"constant", "linear", "depth", NULL};
    if (o->name && o->nearest)
        return usage_error("expected one of --interpolate and --nearest");
    if (o->nearest)
        params->interpolation = RELUME_INTERPOLATE_CONSTANT;
    return o->name && relume_interpolation_parse(&params->interpolation, o->name)
               ? unknown_name("--interpolate", o->name, names)
               : RELUME_OK;
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
