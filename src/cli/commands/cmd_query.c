// cmd_query.c - relume query: the colour of one ray, or of many
#include "cli.h"
#include "frame_options.h"
#include "rays.h"

#include <math.h>
#include <stdlib.h>

struct query_options {
    struct args args;
    const char *eye, *direction, *rays;
    bool json;
    struct light_options lighting;
    struct interpolate_options interpolation;
    int cpu_mask;
    bool allow_outside;
};
#define OPTIONS struct query_options

static const struct option options[] = {
    TEXT("--eye", eye, "camera", "x,y,z", "where the ray starts"),
    TEXT("--direction", direction, "camera", "x,y,z", "where it goes, into the scene"),
    TEXT("--rays", rays, "camera", "FILE",
         "many rays instead, one per line: eye and direction, six numbers; - reads standard input"),
    LIGHT_OPTIONS,
    INTERPOLATE_OPTIONS,
    CPU_OPTION,
    FLAG("--json", json, "output", "one JSON object"),
    ALLOW_OUTSIDE_OPTION,
    {0},
};

static void print_json(const float rgb[3])
{
    if (isnan(rgb[0])) {
        fputs("null", stdout);
        return;
    }
    fputc('[', stdout);
    for (int c = 0; c < 3; c++) {
        json_number(stdout, (double)rgb[c]);
        fputs(c < 2 ? ", " : "]", stdout);
    }
}

static void print_line(const float rgb[3])
{
    if (isnan(rgb[0]))
        puts("none");
    else
        printf("%.9g %.9g %.9g\n", (double)rgb[0], (double)rgb[1], (double)rgb[2]);
}

// A list where a list was asked for.
static void print(const struct query_options *o, const float (*rgb)[3], int n)
{
    const bool list = o->rays;
    if (!o->json) {
        for (int i = 0; i < n; i++)
            print_line(rgb[i]);
        return;
    }
    fputs(list ? "{\"rgb\": [" : "{\"rgb\": ", stdout);
    for (int i = 0; i < n; i++) {
        fputs(i ? ", " : "", stdout);
        print_json(rgb[i]);
    }
    fputs(list ? "]}\n" : "}\n", stdout);
}

static void count_none(const struct query_options *o, const float (*rgb)[3], int n)
{
    int none = 0;
    for (int i = 0; i < n; i++)
        none += isnan(rgb[i][0]);
    if (!none)
        return;
    say(&o->args, RELUME_WARNING,
        "%d of %d rays are not in the file (they miss its window or its cameras): %s", none, n,
        o->json ? "null" : "none");
}

static relume_status query(const struct query_options *o, const struct relume_ray *rays, int n,
                           const struct relume_light *lights, int count)
{
    relume_pack *pack;
    struct prefix_log about;
    struct relume_frame_params params = parse_frame(&o->args, &o->lighting, o->cpu_mask);
    relume_status status = parse_interpolation(&o->interpolation, &params);
    if (status)
        return status;
    float(*rgb)[3] = malloc((size_t)(n ? n : 1) * sizeof *rgb);
    if (!rgb)
        return RELUME_ENOMEM;
    status = relume_open(&pack, o->args.input[0],
                         relume_open_params(.log = o->args.log, .threads = o->args.threads,
                                            .allow_outside = o->allow_outside));
    params.log = prefix_log(&about, o->args.log, o->args.input[0]);
    if (!status)
        status = relume_query_rays(rgb, pack, rays, n, lights, count, &params);
    if (!status)
        print(o, (const float(*)[3])rgb, n);
    if (!status && n > 1)
        count_none(o, (const float(*)[3])rgb, n);
    relume_pack_destroy(&pack);
    free(rgb);
    return status;
}

static relume_status take_rays(const struct query_options *o, struct relume_ray **rays, int *n)
{
    const char *path = o->rays;
    struct relume_ray ray = {0};
    *rays = NULL;
    if (path)
        return rays_read(rays, n, path, o->args.log);
    relume_status status = args_vec3(&ray.eye, "--eye", o->eye);
    if (!status)
        status = args_vec3(&ray.direction, "--direction", o->direction);
    if (!status && !(*rays = malloc(sizeof **rays)))
        status = RELUME_ENOMEM;
    if (!status)
        **rays = ray;
    *n = 1;
    return status;
}

static relume_status run(const struct args *args)
{
    const struct query_options *o = (const void *)args;
    relume_rig *rig = NULL;
    struct relume_ray *rays;
    const struct relume_light *lights;
    int count, n;
    const bool one = o->eye || o->direction;
    if (o->rays ? one : !o->eye || !o->direction)
        return usage_error("query: expected --eye x,y,z and --direction x,y,z, or --rays FILE");
    relume_status status = take_rays(o, &rays, &n);
    if (!status)
        status = parse_lights(args, &o->lighting, &rig, &lights, &count);
    if (!status)
        status = query(o, rays, n, lights, count);
    relume_rig_destroy(&rig);
    free(rays);
    return status;
}

const struct command command_query = {
    .name = "query",
    .usage = "FILE --eye x,y,z --direction x,y,z | --rays FILE [OPTION ...]",
    .summary = "print the linear r g b that a ray sees, or many rays",
    .example = "relume query teapot.exr --eye 0,0,3 --direction 0,0,-1 --light \"dir 1 1 1\"",
    .min_inputs = 1,
    .max_inputs = 1,
    .options = options,
    .size = sizeof(struct query_options),
    .defaults = &(const struct query_options){.cpu_mask = ALL_KERNELS},
    .run = run,
};
