// capture_views.c - what lightfield and panorama share: transfer, lights, what comes next
#include "cli/commands/capture_views.h"

relume_status ingest_params(struct relume_ingest_params *out, struct relume_vec3 **lights,
                            const struct args *args, const struct views_options *o)
{
    *lights = NULL;
    *out = (struct relume_ingest_params){
        .log = args->log, .transfer = o->transfer, .force = o->force, .threads = args->threads};
    const relume_status status =
        o->lights ? relume_captured_lights_read(lights, &out->light_count, o->lights, args->log)
                  : RELUME_OK;
    out->lights = *lights;
    return status;
}

void say_next(const struct args *args, const char *dir, const char *what)
{
    const char *q = relume_name_quotes(dir);
    announce(args, RELUME_NOTE, "%s: %s; next: relume encode %s%s%s -o FILE.exr", dir, what, q, dir,
             q);
}
