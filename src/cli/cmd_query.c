#include "cli.h"
#include "frame_options.h"

static const struct option options[] = {
    {"--eye", OPTION_TEXT, "x,y,z", "where the ray starts", 0, 0},
    {"--direction", OPTION_TEXT, "x,y,z", "where it goes, into the scene", 0, 0},
    LIGHT_OPTIONS,
    {"--nearest", OPTION_FLAG, NULL, "slab: nearest view instead of the quadralinear basis", 0, 0},
    CPU_OPTION,
    {"--json", OPTION_FLAG, NULL, "one JSON object", 0, 0},
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

static void print(const struct args *args, const float rgb[3])
{
    if (!args_has(args, "--json")) {
        printf("%.9g %.9g %.9g\n", (double)rgb[0], (double)rgb[1], (double)rgb[2]);
        return;
    }
    printf("{\"rgb\": [");
    for (int c = 0; c < 3; c++) {
        json_number(stdout, (double)rgb[c]);
        fputs(c < 2 ? ", " : "]}\n", stdout);
    }
}

static relume_status query(const struct args *args, const struct relume_light *lights, int count)
{
    struct relume_vec3 eye, direction;
    relume_status status = args_vec3(&eye, "--eye", args_text(args, "--eye", ""));
    if (!status)
        status = args_vec3(&direction, "--direction", args_text(args, "--direction", ""));
    if (status)
        return status;
    relume_pack *pack;
    struct prefix_log about;
    float rgb[3];
    status = relume_open(&pack, args_input(args, 0),
                         relume_open_params(.log = args_log(args), .threads = args_threads(args)));
    struct relume_frame_params params = parse_frame(args);
    params.log = prefix_log(&about, args_log(args), args_input(args, 0));
    params.interpolation =
        args_has(args, "--nearest") ? RELUME_INTERPOLATE_CONSTANT : RELUME_INTERPOLATE_DEFAULT;
    if (!status)
        status = relume_query(rgb, pack, eye, direction, lights, count, &params);
    if (!status)
        print(args, rgb);
    relume_pack_destroy(&pack);
    return status;
}

static relume_status run(const struct args *args)
{
    relume_rig *rig = NULL;
    const struct relume_light *lights;
    int count;
    if (!args_has(args, "--eye") || !args_has(args, "--direction"))
        return usage_error("query: expected --eye x,y,z and --direction x,y,z");
    relume_status status = parse_lights(args, &rig, &lights, &count);
    if (!status)
        status = query(args, lights, count);
    relume_rig_destroy(&rig);
    return status;
}

const struct command command_query = {
    .name = "query",
    .usage = "FILE --eye x,y,z --direction x,y,z [OPTION ...]",
    .summary = "print the linear r g b that one ray sees",
    .example = "relume query teapot.exr --eye 0,0,3 --direction 0,0,-1 --light \"dir 1 1 1\"",
    .min_inputs = 1,
    .max_inputs = 1,
    .options = options,
    .run = run,
};
