// cmd_lights.c - relume lights: a pattern of directions and how even it is
#include "pattern_option.h"

#include <stdlib.h>
#include <string.h>

struct lights_options {
    struct args args;
    int count, seed;
    bool hemisphere, json;
    const char *pole;
    const char *pattern;
};
#define OPTIONS struct lights_options

static const struct option options[] = {
    PATTERN_OPTION,
    INT("-n", count, "lights", "N", "number of directions; default 100", 1, 65536),
    FLAG("--hemisphere", hemisphere, "lights", "only directions on the pole's side"),
    TEXT("--pole", pole, "lights", "z|y", "the pole: z (planar, slab; default) or y (panoramas)"),
    INT("--seed", seed, "lights", "S", "seed of the random patterns; default 0", 0, 2147483647),
    FLAG("--json", json, "output", "print one JSON object"),
    {0},
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
    printf("# %d direction%s, spherical cap discrepancy %.6g\n", n, relume_plural(n), discrepancy);
}

static relume_status run(const struct args *args)
{
    const struct lights_options *o = (const void *)args;
    const struct relume_pattern *pattern;
    struct relume_directions_params params = {
        .log = o->args.log,
        .seed = (uint64_t)o->seed,
        .hemisphere = o->hemisphere,
    };
    relume_status status = choose_pattern(&pattern, o->pattern);
    if (!status)
        status = choose_pole(&params.pole_y, o->pole);
    if (status)
        return status;
    const int n = o->count;
    struct relume_vec3 *v = malloc((size_t)n * sizeof *v);
    double discrepancy = 0.0;
    status = v ? relume_directions_make(v, n, pattern, &params) : RELUME_ENOMEM;
    if (!status)
        status = relume_directions_discrepancy(&discrepancy, v, n, &params);
    if (!status && o->json)
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
    .size = sizeof(struct lights_options),
    .defaults = &(const struct lights_options){.pole = "z", .count = 100},
    .run = run,
};
