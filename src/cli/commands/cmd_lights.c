// cmd_lights.c - relume lights: a pattern of directions and how even it is
#include "lights_environment.h"

#include <stdlib.h>

struct lights_options {
    struct args args;
    int count, seed;
    enum { POLE_Z, POLE_Y } pole;
    bool hemisphere, json;
    const char *environment, *csv;
    enum recipe recipe;
    const struct relume_pattern *pattern;
};
#define OPTIONS struct lights_options

static const struct option options[] = {
    GROUP("lights"),
    ENTRY("--pattern", pattern, "P",
          "hammersley (default), grid, random, jittered, poisson, spiral", relume_patterns, NULL),
    INT("-n", count, "N", "number of directions; default: 100", 1, 65536),
    FLAG("--hemisphere", hemisphere, "only directions on the pole's side"),
    NAME("--pole", pole, "z|y", "the pole: z (planar, slab; default) or y (panoramas)", POLE_Z, "z",
         "y"),
    INT("--seed", seed, "S", "seed of the random patterns; default: 0", 0, 2147483647),
    GROUP("an environment"),
    TEXT("--environment", environment, "MAP",
         "FILE's lights: the weight of each by which pictures under them add up to the light of "
         "this HDR picture; degrees may follow it, as in --light \"env MAP 90\""),
    GROUP("output"),
    TEXT_AS(OPTION_OUTPUT, "--csv", csv, "OUT", "--environment: write the weights to this file"),
    NAME("--recipe", recipe, "PROGRAM",
         "--environment: print what nuke, natron or blender needs to add up the layers of export "
         "--to olat",
         RECIPE_NUKE, "nuke", "natron", "blender"),
    FLAG("--json", json, "print one JSON object"),
    {0},
};

static void print_json(const struct relume_pattern *pattern, bool hemisphere,
                       const struct relume_vec3 *v, int n, double discrepancy)
{
    struct jwriter w = json_dense();
    jopen_object(&w, NULL);
    jput_text(&w, "pattern", pattern->name);
    jput_integer(&w, "n", n);
    jput_truth(&w, "hemisphere", hemisphere);
    jopen_array(&w, "directions");
    for (int i = 0; i < n; i++)
        jput_vector(&w, NULL, v[i], 9);
    jclose(&w);
    jput_number(&w, "discrepancy", discrepancy, 9);
    jend(&w);
}

static relume_status check(const struct lights_options *o)
{
    const char *needs = o->csv ? "--csv" : o->recipe ? "--recipe" : NULL;
    if (!o->environment && (needs || o->args.inputs))
        return usage_error("lights: %s needs --environment MAP", needs ? needs : "a FILE");
    if (o->environment && !o->args.inputs)
        return usage_error("lights: --environment needs a FILE whose lights are weighed");
    if (o->environment && (o->pattern || given(o, &o->count)))
        return usage_error("lights: expected one of --environment and a pattern");
    if (o->json && o->recipe)
        return usage_error("lights: expected one of --json and --recipe");
    return RELUME_OK;
}

static relume_status run_lights(const struct args *args)
{
    const struct lights_options *o = (const void *)args;
    const relume_status wrong = check(o);
    if (wrong)
        return wrong;
    if (o->environment)
        return lights_environment(args,
                                  &(const struct environment_order){args->input[0], o->environment,
                                                                    o->csv, o->recipe, o->json});
    struct relume_directions_params params = {
        .log = o->args.log,
        .seed = (uint64_t)o->seed,
        .hemisphere = o->hemisphere,
        .pole_y = o->pole == POLE_Y,
    };
    const struct relume_pattern *pattern = o->pattern ? o->pattern : relume_patterns[0];
    const int n = o->count;
    struct relume_vec3 *v = malloc((size_t)n * sizeof *v);
    double discrepancy = 0.0;
    relume_status status = v ? relume_directions_make(v, n, pattern, &params) : RELUME_ENOMEM;
    if (!status)
        status = relume_directions_discrepancy(&discrepancy, v, n, &params);
    for (int i = 0; !status && !o->json && i < n; i++)
        printf("%.9g %.9g %.9g\n", v[i].x, v[i].y, v[i].z);
    if (!status && o->json)
        print_json(pattern, params.hemisphere, v, n, discrepancy);
    else if (!status)
        printf("# %d direction%s, spherical cap discrepancy %.6g\n", n, relume_plural(n),
               discrepancy);
    free(v);
    return status;
}

const struct command command_lights = {
    COMMAND(run_lights, "lights", "[--pattern P] [-n N] | FILE --environment MAP",
            "print a pattern of light directions and how evenly it covers the sphere, or what each "
            "light of a file weighs in an environment",
            "relume lights --pattern hammersley -n 100 --hemisphere", 0, 1),
    .defaults = &(const OPTIONS){.count = 100},
};
