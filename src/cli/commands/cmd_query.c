// cmd_query.c - relume query: the colour of one ray, or of many
#include "cli.h"
#include "frame_options.h"
#include "rays.h"

#include <math.h>
#include <stdlib.h>

static const struct option options[] = {
    {"--eye", OPTION_TEXT, "x,y,z", "where the ray starts", 0, 0},
    {"--direction", OPTION_TEXT, "x,y,z", "where it goes, into the scene", 0, 0},
    {"--rays", OPTION_TEXT, "FILE",
     "many rays instead, one per line: eye and direction, six numbers; - reads standard input", 0,
     0},
    LIGHT_OPTIONS,
    INTERPOLATE_OPTIONS,
    CPU_OPTION,
    {"--json", OPTION_FLAG, NULL, "one JSON object", 0, 0},
    ALLOW_OUTSIDE_OPTION,
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
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
static void print(const struct args *args, const float (*rgb)[3], int n)
{
    const bool list = args_has(args, "--rays");
    if (!args_has(args, "--json")) {
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

static void count_none(const struct args *args, const float (*rgb)[3], int n)
{
    char text[200];
    int none = 0;
    for (int i = 0; i < n; i++)
        none += isnan(rgb[i][0]);
    if (!none)
        return;
    snprintf(text, sizeof text,
             "%d of %d rays are not in the file (they miss its window or its cameras): %s", none, n,
             args_has(args, "--json") ? "null" : "none");
    args_log(args)->message(args_log(args)->user, RELUME_WARNING, text);
}

static relume_status query(const struct args *args, const struct relume_ray *rays, int n,
                           const struct relume_light *lights, int count)
{
    relume_pack *pack;
    struct prefix_log about;
    struct relume_frame_params params = parse_frame(args);
    relume_status status = parse_interpolation(args, &params);
    if (status)
        return status;
    float(*rgb)[3] = malloc((size_t)(n ? n : 1) * sizeof *rgb);
    if (!rgb)
        return RELUME_ENOMEM;
    status = relume_open(&pack, args_input(args, 0),
                         relume_open_params(.log = args_log(args), .threads = args_threads(args),
                                            .allow_outside = args_has(args, "--allow-outside")));
    params.log = prefix_log(&about, args_log(args), args_input(args, 0));
    if (!status)
        status = relume_query_rays(rgb, pack, rays, n, lights, count, &params);
    if (!status)
        print(args, (const float(*)[3])rgb, n);
    if (!status && n > 1)
        count_none(args, (const float(*)[3])rgb, n);
    relume_pack_destroy(&pack);
    free(rgb);
    return status;
}

static relume_status take_rays(const struct args *args, struct relume_ray **rays, int *n)
{
    const char *path = args_text(args, "--rays", NULL);
    struct relume_ray ray = {0};
    *rays = NULL;
    if (path)
        return rays_read(rays, n, path, args_log(args));
    relume_status status = args_vec3(&ray.eye, "--eye", args_text(args, "--eye", ""));
    if (!status)
        status = args_vec3(&ray.direction, "--direction", args_text(args, "--direction", ""));
    if (!status && !(*rays = malloc(sizeof **rays)))
        status = RELUME_ENOMEM;
    if (!status)
        **rays = ray;
    *n = 1;
    return status;
}

static relume_status run(const struct args *args)
{
    relume_rig *rig = NULL;
    struct relume_ray *rays;
    const struct relume_light *lights;
    int count, n;
    const bool one = args_has(args, "--eye") || args_has(args, "--direction");
    if (args_has(args, "--rays") ? one : !args_has(args, "--eye") || !args_has(args, "--direction"))
        return usage_error("query: expected --eye x,y,z and --direction x,y,z, or --rays FILE");
    relume_status status = take_rays(args, &rays, &n);
    if (!status)
        status = parse_lights(args, &rig, &lights, &count);
    if (!status)
        status = query(args, rays, n, lights, count);
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
    .run = run,
};
