// capture_views.c - what lightfield and panorama share: transfer, lights, range of depth, what
// comes next
#include "commands/capture_views.h"

relume_status ingest_params(struct relume_ingest_params *out, struct relume_vec3 **lights,
                            const struct args *args, const struct views_options *o)
{
    *lights = NULL;
    *out = (struct relume_ingest_params){
        .log = args->log, .force = o->force, .threads = args->threads};
    if (args_transfer(&out->transfer, "--transfer", o->transfer))
        return RELUME_EINVAL;
    const relume_status status =
        o->lights ? relume_captured_lights_read(lights, &out->light_count, o->lights, args->log)
                  : RELUME_OK;
    out->lights = *lights;
    return status;
}

relume_status parse_depth_range(double range[2], const struct views_options *o)
{
    const char *text = o->depth_range;
    if (!text || parse_numbers(text, range, 2))
        return RELUME_OK;
    return usage_error("--depth-range: expected two numbers like 2,5; found '%s'", text);
}

void say_next(const struct args *args, const char *dir, const char *what)
{
    say(args, RELUME_NOTE, "%s: %s; next: relume encode %s -o FILE.exr", dir, what, dir);
}
