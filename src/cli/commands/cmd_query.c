// cmd_query.c - relume query: the colour of one ray, or of many
#include "cli/cli.h"
#include "cli/frame_options.h"
#include "cli/rays.h"

#include <math.h>
#include <stdlib.h>

struct query_options {
    struct args args;
    struct relume_ray ray;
    const char *rays;
    bool json, nearest, allow_outside, keep_going;
    enum relume_interpolation interpolation;
    struct light_options lighting;
    int cpu_mask;
};
#define OPTIONS struct query_options

static const struct option options[] = {
    GROUP("camera"),
    POINT("--eye", ray.eye, "x,y,z", "where the ray starts"),
    POINT("--direction", ray.direction, "x,y,z", "where it goes, into the scene"),
    TEXT("--rays", rays, "FILE",
         "many rays instead, one per line: eye and direction, six numbers; - reads standard input"),
    INTERPOLATE_OPTIONS,
    GROUP("lights"),
    LIGHT_OPTIONS,
    GROUP("machine"),
    CPU_OPTION,
    GROUP("output"),
    FLAG("--json", json, "one JSON object"),
    GROUP("input"),
    ALLOW_OUTSIDE_OPTION,
    KEEP_GOING_OPTION,
    {0},
};

static void put_colour(struct jwriter *w, const char *key, const float rgb[3])
{
    if (isnan(rgb[0]))
        jput_null(w, key);
    else
        jput_floats(w, key, rgb, 3, 9);
}

static void print_json(const float (*rgb)[3], int n, bool list)
{
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    if (list)
        jopen_array(&w, "rgb");
    for (int i = 0; i < n; i++)
        put_colour(&w, list ? NULL : "rgb", rgb[i]);
    jend(&w);
}

// A list where a list was asked for.
static void print(const struct query_options *o, const float (*rgb)[3], int n)
{
    if (!o->json) {
        for (int i = 0; i < n; i++)
            if (isnan(rgb[i][0]))
                puts("none");
            else
                printf("%.9g %.9g %.9g\n", (double)rgb[i][0], (double)rgb[i][1], (double)rgb[i][2]);
        return;
    }
    print_json(rgb, n, o->rays);
}

static void count_none(const struct query_options *o, const float (*rgb)[3], int n)
{
    int none = 0;
    for (int i = 0; i < n; i++)
        none += isnan(rgb[i][0]);
    if (!none)
        return;
    announce(&o->args, RELUME_WARNING,
             "%d of %d rays are not in the file (they miss its window or its cameras): %s", none, n,
             o->json ? "null" : "none");
}

static relume_status query(const struct query_options *o, const struct relume_ray *rays, int n,
                           relume_rig *rig, const struct relume_light *lights, int count)
{
    relume_pack *pack;
    struct prefix_log about;
    struct relume_frame_params params = parse_frame(&o->args, &o->lighting, o->cpu_mask);
    float(*rgb)[3] = malloc((size_t)(n ? n : 1) * sizeof *rgb);
    if (!rgb)
        return RELUME_ENOMEM;
    relume_status status = relume_open(
        &pack, o->args.input[0],
        relume_open_params(.log = o->args.log, .threads = o->args.threads,
                           .allow_outside = o->allow_outside, .keep_going = o->keep_going));
    params.log = prefix_log(&about, o->args.log, o->args.input[0]);
    params.interpolation = o->nearest ? RELUME_INTERPOLATE_CONSTANT : o->interpolation;
    if (!status)
        status = aim_lights(&o->args, &o->lighting, rig, pack, o->args.input[0], &lights, &count);
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

static relume_status run_query(const struct args *args)
{
    const struct query_options *o = (const void *)args;
    const bool eye = given(o, &o->ray.eye), direction = given(o, &o->ray.direction);
    relume_rig *rig = NULL;
    struct relume_ray *rays = NULL;
    const struct relume_light *lights;
    int count, n = 1;
    if (o->rays ? eye || direction : !eye || !direction)
        return usage_error("query: expected --eye x,y,z and --direction x,y,z, or --rays FILE");
    if (o->nearest && o->interpolation)
        return usage_error("expected one of --interpolate and --nearest");
    relume_status status = o->rays ? rays_read(&rays, &n, o->rays, args->log) : RELUME_OK;
    if (!status)
        status = parse_lights_of_file(args, &o->lighting, &rig, &lights, &count);
    if (!status)
        status = query(o, rays ? rays : &o->ray, n, rig, lights, count);
    if (!status)
        status = save_lights(args, &o->lighting, rig);
    relume_rig_destroy(&rig);
    free(rays);
    return status;
}

const struct command command_query = {
    COMMAND(run_query, "query", "FILE --eye x,y,z --direction x,y,z | --rays FILE [OPTION ...]",
            "print the linear r g b that a ray sees, or many rays",
            "relume query teapot.exr --eye 0,0,3 --direction 0,0,-1 --light \"dir 1 1 1\"", 1, 1),
    .defaults = &(const OPTIONS){.cpu_mask = ALL_KERNELS},
};
