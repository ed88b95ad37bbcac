// frame_options.c - what `relight` and `query` share: lights, depth, kernels
#include "frame_options.h"

#include <ctype.h>
#include <stdlib.h>

static relume_status open_rig(const struct args *args, relume_rig **rig)
{
    const char *path = args_text(args, "--rig", NULL);
    return path ? relume_rig_load(rig, path, args_log(args)) : relume_rig_create(rig);
}

static relume_status add_lights(const struct args *args, relume_rig *rig)
{
    const int given = args_count(args, "--light");
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < given; i++)
        status = relume_rig_add(rig, args_nth(args, "--light", i), NULL, args_log(args));
    if (!status && !given && !args_has(args, "--rig"))
        status = relume_rig_add(rig, "dir 0 0 1", NULL, args_log(args));
    return status;
}

relume_status parse_lights(const struct args *args, relume_rig **rig,
                           const struct relume_light **lights, int *count)
{
    const char *save = args_text(args, "--save-rig", NULL);
    relume_status status = open_rig(args, rig);
    if (!status)
        status = add_lights(args, *rig);
    if (!status && save)
        status = relume_rig_save(*rig, save, args_log(args));
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

relume_status parse_size(const struct args *args, int *width, int *height)
{
    const char *const text = args_text(args, "--size", NULL), *rest = text;
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

relume_status parse_interpolation(const struct args *args, struct relume_frame_params *params)
{
    static const char *const names[] = {"constant", "linear", "depth", NULL};
    const char *name = args_text(args, "--interpolate", NULL);
    if (name && args_has(args, "--nearest"))
        return usage_error("expected one of --interpolate and --nearest");
    if (args_has(args, "--nearest"))
        params->interpolation = RELUME_INTERPOLATE_CONSTANT;
    return name && relume_interpolation_parse(&params->interpolation, name)
               ? unknown_name("--interpolate", name, names)
               : RELUME_OK;
}

struct relume_frame_params parse_frame(const struct args *args)
{
    return (struct relume_frame_params){
        .cpu_off = args_has(args, "--cpu-mask") ? ~(unsigned)args_int(args, "--cpu-mask", 0) : 0u,
        .threads = args_threads(args),
        .assume_depth = args_number(args, "--assume-depth", 0.0),
    };
}
