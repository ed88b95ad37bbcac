// capture_views.c - relume capture --slab, --colmap, --panorama, --depth-from-views
#include "commands/capture_views.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool capture_views_asked(const struct args *args)
{
    return args_has(args, "--slab") || args_has(args, "--colmap") || args_has(args, "--panorama") ||
           args_has(args, "--depth-from-views");
}

static relume_status range_option(double range[2], const struct args *args)
{
    const char *text = args_text(args, "--depth-range", NULL);
    if (!text || parse_numbers(text, range, 2))
        return RELUME_OK;
    return usage_error("--depth-range: expected two numbers like 2,5; found '%s'", text);
}

static relume_status slab(const struct args *args, const char *const *photos, int n,
                          const struct relume_ingest_params *p)
{
    return relume_slab_ingest(
        args_text(args, "-o", NULL), photos, n,
        relume_slab_ingest_params(.names = args_text(args, "--names", NULL),
                                  .baseline = args_number(args, "--baseline", 0.0),
                                  .baseline_v = args_number(args, "--baseline-v", 0.0),
                                  .distance = args_number(args, "--distance", 0.0),
                                  .st_z = args_number(args, "--st-z", 0.0),
                                  .window = args_number(args, "--window", 0.0),
                                  .focus_disparity = args_number(args, "--focus-disparity", 0.0),
                                  .fill = args_has(args, "--fill"),
                                  .turn = args_has(args, "--turn"),
                                  .keep_order = args_has(args, "--keep-order")),
        p);
}

static relume_status posed(const struct args *args, const char *photos,
                           const struct relume_ingest_params *p)
{
    struct relume_posed_params posed = {
        .width = args_int(args, "--width", 0),
        .distance = args_number(args, "--distance", 0.0),
    };
    char rest;
    const char *grid = args_text(args, "--views", NULL);
    if (grid && sscanf(grid, "%4dx%4d%c", &posed.grid[0], &posed.grid[1], &rest) != 2)
        return usage_error("--views: expected a grid like 5x5; found '%s'", grid);
    if (args_inputs(args) != 1)
        return usage_error("--colmap: expected the folder of the photographs; found %d inputs",
                           args_inputs(args));
    return relume_posed_ingest(args_text(args, "-o", NULL), args_text(args, "--colmap", NULL),
                               photos, &posed, p);
}

static relume_status panorama(const struct args *args, const char *const *photos, int n,
                              const struct relume_ingest_params *p)
{
    static const char *const names[] = {"sphere", "cylinder", "cube", "stitch", NULL};
    const char *name = args_text(args, "--panorama", NULL);
    int source = 0;
    while (names[source] && strcmp(names[source], name))
        source++;
    if (!names[source])
        return unknown_name("panorama", name, names);
    struct relume_panorama_params panorama = {
        .depth = args_text(args, "--depth", NULL),
        .width = args_int(args, "--width", 0),
        .bands = args_int(args, "--bands", 0),
    };
    const relume_status status = range_option(panorama.depth_range, args);
    return status ? status
                  : relume_panorama_ingest(args_text(args, "-o", NULL), photos, n,
                                           (enum relume_panorama_source)source, &panorama, p);
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
        status = args_has(args, "--panorama") ? panorama(args, photos, n, &p)
                 : args_has(args, "--colmap") ? posed(args, photos[0], &p)
                                              : slab(args, photos, n, &p);
    free(lights);
    return status;
}

static void print_depth(const struct relume_slab_depth_report *r, bool json)
{
    const bool known = r->compared > 0;
    if (!json) {
        printf("views     %d, searched at %d x %d under %d light%s\n", r->views, r->width,
               r->height, r->lights, r->lights == 1 ? "" : "s");
        printf("planes    %d, distances %.4g to %.4g\n", r->planes, r->range[0], r->range[1]);
        printf("trusted   %.1f %% of pixels agree with the neighbouring views\n",
               100.0 * r->trusted);
        if (known)
            printf(
                "error     %.2f %% of the known depth (median), %.1f %% off by more than a plane\n",
                100.0 * r->median_relative, 100.0 * r->bad);
        return;
    }
    printf("{\"views\":%d,\"lights\":%d,\"width\":%d,\"height\":%d,\"planes\":%d,\"range\":[%.9g,"
           "%.9g],\"plane_step\":%.9g,\"trusted\":%.9g,\"compared\":%zu,\"median_relative\":",
           r->views, r->lights, r->width, r->height, r->planes, r->range[0], r->range[1],
           r->plane_step, r->trusted, r->compared);
    json_number(stdout, known ? r->median_relative : (double)NAN);
    printf(",\"bad\":");
    json_number(stdout, known ? r->bad : (double)NAN);
    printf("}\n");
}

static relume_status depth_of(const char *capture, const char *dir, const struct args *args)
{
    relume_capture *c;
    struct relume_slab_depth_report report;
    struct relume_slab_depth_params p = {
        .log = args_log(args),
        .force = args_has(args, "--force"),
        .threads = args_threads(args),
    };
    relume_status status = range_option(p.range, args);
    if (status)
        return status;
    status = relume_capture_open(&c, capture, relume_capture_params(.log = p.log));
    if (!status)
        status = relume_slab_depth(&report, c, dir, &p);
    if (!status && (args_has(args, "--json") || !args_has(args, "-q")))
        print_depth(&report, args_has(args, "--json"));
    relume_capture_destroy(&c);
    return status;
}

static relume_status refuse_others(const struct args *args)
{
    static const char *const of_lights[] = {
        "--ball",       "--ball-photos", "--matte",   "--near",    "--refine-lights",
        "--integrable", "--white",       "--flat",    "--normals", "--albedo",
        "--height",     "--encode",      "--relight", "--hdr",     "--times",
        "--ghosts",     "--align",       "--mask",    NULL};
    for (int i = 0; of_lights[i]; i++)
        if (args_has(args, of_lights[i]))
            return usage_error(
                "capture: %s does not work with photographs of many views; leave it out",
                of_lights[i]);
    return RELUME_OK;
}

relume_status capture_views(const struct args *args)
{
    const relume_status refused = refuse_others(args);
    if (refused)
        return refused;
    if (!args_has(args, "-o"))
        return usage_error("capture: expected -o DIR");
    if (args_has(args, "--slab") + args_has(args, "--colmap") + args_has(args, "--panorama") +
            args_has(args, "--depth-from-views") >
        1)
        return usage_error("capture: expected one of --slab, --colmap, --panorama and "
                           "--depth-from-views; compute depth in a second run");
    if (args_has(args, "--depth-from-views")) {
        if (args_inputs(args) != 1)
            return usage_error("--depth-from-views: expected one capture; found %d",
                               args_inputs(args));
        return depth_of(args_input(args, 0), args_text(args, "-o", NULL), args);
    }
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
