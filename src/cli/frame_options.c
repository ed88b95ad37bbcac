#include "frame_options.h"

#include <stdlib.h>

relume_status parse_lights(const struct args *args, struct relume_light **lights, int *count)
{
    const int given = args_count(args, "--light");
    *count = given ? given : 1;
    *lights = calloc((size_t)*count, sizeof **lights);
    relume_status status = *lights ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < *count; i++)
        status = relume_light_parse(
            &(*lights)[i], given ? args_nth(args, "--light", i) : "dir 0 0 1", args_log(args));
    if (status) {
        free(*lights);
        *lights = NULL;
    }
    return status;
}

unsigned parse_cpu_off(const struct args *args)
{
    return args_has(args, "--cpu-mask") ? ~(unsigned)args_int(args, "--cpu-mask", 0) : 0u;
}
