// capture_views.c - relume capture --slab, --colmap, --panorama, --depth-from-views
#include "capture_views.h"

#include <stdlib.h>

bool capture_views_asked(const struct args *args)
{
    return args_has(args, "--slab") || args_has(args, "--colmap") ||
           args_has(args, "--panorama") || args_has(args, "--depth-from-views");
}

static relume_status slab(const struct args *args, const char *const *photos, int n,
                          const struct relume_ingest_params *p)
{
    return relume_slab_ingest(
        args_text(args, "-o", NULL), photos, n,
        relume_slab_ingest_params(.names = args_text(args, "--names", NULL),
                                  .baseline = args_number(args, "--baseline", 0.0),
                                  .distance = args_number(args, "--distance", 0.0),
                                  .st_z = args_number(args, "--st-z", 0.0),
                                  .window = args_number(args, "--window", 0.0),
                                  .focus_disparity = args_number(args, "--focus-disparity", 0.0),
                                  .fill = args_has(args, "--fill"),
                                  .keep_order = args_has(args, "--keep-order")),
        p);
}

static relume_status ingest(const struct args *args, const char *const *photos, int n)
{
    struct relume_vec3 *lights = NULL;
    struct relume_ingest_params p = {
        .log = args_log(args),
        .force = args_has(args, "--force"),
        .threads = args_threads(args),
    };
    const char *transfer = args_text(args, "--transfer", NULL);
    const char *file = args_text(args, "--lights", NULL);
    if (transfer && relume_transfer_parse(&p.transfer, transfer))
        return usage_error("--transfer: expected linear, srgb or gamma:G; found '%s'", transfer);
    relume_status status =
        file ? relume_lights_read(&lights, &p.light_count, file, args_log(args)) : RELUME_OK;
    p.lights = lights;
    if (!status)
        status = slab(args, photos, n, &p);
    free(lights);
    return status;
}

relume_status capture_views(const struct args *args)
{
    if (!args_has(args, "-o"))
        return usage_error("capture: expected -o DIR");
    const int n = args_inputs(args);
    const char **photos = malloc((size_t)n * sizeof *photos);
    if (!photos)
        return RELUME_ENOMEM;
    for (int i = 0; i < n; i++)
        photos[i] = args_input(args, i);
    const relume_status status = ingest(args, photos, n);
    free(photos);
    return status;
}
