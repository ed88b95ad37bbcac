// cmd_lights.c - relume lights: a pattern of directions and how even it is
#include "pattern_option.h"

#include <stdlib.h>
#include <string.h>

static const struct option options[] = {
    PATTERN_OPTION,
    {"-n", OPTION_INT, "N", "number of directions; default 100", 1, 65536},
    {"--hemisphere", OPTION_FLAG, NULL, "only directions on the pole's side", 0, 0},
    {"--pole", OPTION_TEXT, "z|y", "the pole: z (planar, slab; default) or y (panoramas)", 0, 0},
    {"--seed", OPTION_INT, "S", "seed of the random patterns; default 0", 0, 2147483647},
    {"--json", OPTION_FLAG, NULL, "print one JSON object", 0, 0},
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

static relume_status choose_pole(bool *pole_y, const char *name)
{
    static const char *const names[] = {"z", "y", NULL};
    *pole_y = !strcmp(name, "y");
    return *pole_y || !strcmp(name, "z") ? RELUME_OK : unknown_name("pole", name, names);
}

static void print_json(const struct relume_pattern *pattern, bool hemisphere,
                       const struct relume_vec3 *v, int n, double discrepancy)
{
    printf("{\"pattern\":\"%s\",\"n\":%d,\"hemisphere\":%s,\"directions\":[", pattern->name, n,
           hemisphere ? "true" : "false");
    for (int i = 0; i < n; i++)
        printf("%s[%.9g,%.9g,%.9g]", i ? "," : "", v[i].x, v[i].y, v[i].z);
    printf("],\"discrepancy\":");
    json_number(stdout, discrepancy);
    puts("}");
}

static void print_lines(const struct relume_vec3 *v, int n, double discrepancy)
{
    for (int i = 0; i < n; i++)
        printf("%.9g %.9g %.9g\n", v[i].x, v[i].y, v[i].z);
    printf("# %d directions, spherical cap discrepancy %.6g\n", n, discrepancy);
}

static relume_status run(const struct args *args)
{
    const struct relume_pattern *pattern;
    struct relume_lights_params params = {
        .log = args_log(args),
        .seed = (uint64_t)args_int(args, "--seed", 0),
        .hemisphere = args_has(args, "--hemisphere"),
    };
    relume_status status = args_pattern(&pattern, args);
    if (!status)
        status = choose_pole(&params.pole_y, args_text(args, "--pole", "z"));
    if (status)
        return status;
    const int n = args_int(args, "-n", 100);
    struct relume_vec3 *v = malloc((size_t)n * sizeof *v);
    double discrepancy = 0.0;
    status = v ? relume_lights_make(v, n, pattern, &params) : RELUME_ENOMEM;
    if (!status)
        status = relume_lights_discrepancy(&discrepancy, v, n, &params);
    if (!status && args_has(args, "--json"))
        print_json(pattern, params.hemisphere, v, n, discrepancy);
    else if (!status)
        print_lines(v, n, discrepancy);
    free(v);
    return status;
}

const struct command command_lights = {
    .name = "lights",
    .usage = "[--pattern P] [-n N]",
    .summary = "print a pattern of light directions and how evenly it covers the sphere",
    .example = "relume lights --pattern hammersley -n 100 --hemisphere",
    .min_inputs = 0,
    .max_inputs = 0,
    .options = options,
    .run = run,
};
