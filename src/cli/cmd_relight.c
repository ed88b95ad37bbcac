#include "cli.h"
#include "frame_options.h"

#include <math.h>

static const struct option options[] = {
    {"-o", OPTION_TEXT, "OUT", "picture to write: .exr (linear), .png, .jpg, .tif, .hdr, ...", 0,
     0},
    LIGHT_OPTIONS,
    {"--view", OPTION_INT, "N", "a captured view at its own size (panoramas: unfolded)", 0, 65535},
    {"--eye", OPTION_TEXT, "x,y,z", "slab: the window as seen from there; default: the middle", 0,
     0},
    {"--pan", OPTION_NUMBER, "A", "panorama: degrees to the right", 0, 0},
    {"--tilt", OPTION_NUMBER, "A", "panorama: degrees up", 0, 0},
    {"--zoom", OPTION_NUMBER, "F", "panorama: 1 shows 90 degrees; default: 1", 0.01, 1000},
    {"--size", OPTION_TEXT, "WxH", "size of an --eye or --pan frame", 0, 0},
    {"--nearest", OPTION_FLAG, NULL, "slab: nearest view instead of the quadralinear basis", 0, 0},
    {"--exposure", OPTION_NUMBER, "EV", "multiply by 2^EV; default: 0", -100, 100},
    CPU_OPTION,
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

static relume_status parse_size(const char *text, struct relume_camera *camera)
{
    char rest;
    if (!text)
        return RELUME_OK;
    if (sscanf(text, "%dx%d%c", &camera->width, &camera->height, &rest) == 2 &&
        camera->width >= 1 && camera->width <= 65536 && camera->height >= 1 &&
        camera->height <= 65536 && (int64_t)camera->width * camera->height <= 1 << 30)
        return RELUME_OK;
    return usage_error(
        "--size: expected WIDTHxHEIGHT, at most 65536 a side and 2^30 pixels; found '%s'", text);
}

static relume_status parse_camera(const struct args *args, struct relume_camera *camera)
{
    const bool look =
        args_has(args, "--pan") || args_has(args, "--tilt") || args_has(args, "--zoom");
    *camera = (struct relume_camera){0};
    if (args_has(args, "--view") + args_has(args, "--eye") + look > 1)
        return usage_error("relight: expected one of --view, --eye, --pan/--tilt/--zoom");
    if (args_has(args, "--view")) {
        camera->framing = RELUME_FRAME_VIEW;
        camera->view = args_int(args, "--view", 0);
    } else if (args_has(args, "--eye")) {
        camera->framing = RELUME_FRAME_EYE;
        const relume_status status =
            args_vec3(&camera->eye, "--eye", args_text(args, "--eye", NULL));
        if (status)
            return status;
    } else if (look) {
        camera->framing = RELUME_FRAME_LOOK;
        camera->look.pan_deg = args_number(args, "--pan", 0.0);
        camera->look.tilt_deg = args_number(args, "--tilt", 0.0);
        camera->look.zoom = args_number(args, "--zoom", 1.0);
    }
    return parse_size(args_text(args, "--size", NULL), camera);
}

static relume_status render(const struct args *args, const struct relume_camera *camera,
                            const struct relume_light *lights, int count)
{
    relume_pack *pack;
    struct prefix_log about;
    struct relume_image frame = {0};
    relume_status status =
        relume_pack_open(&pack, args_input(args, 0),
                         relume_pack_params(.log = args_log(args), .threads = args_threads(args)));
    struct relume_frame_params params = parse_frame(args);
    params.log = prefix_log(&about, args_log(args), args_input(args, 0));
    if (!status)
        status = relume_frame(&frame, pack, camera, lights, count, &params);
    const float gain = exp2f((float)args_number(args, "--exposure", 0.0));
    const size_t samples = (size_t)frame.width * (size_t)frame.height * 3;
    for (size_t i = 0; !status && i < samples; i++)
        frame.data[i] *= gain;
    if (!status)
        status = relume_image_save(&frame, args_text(args, "-o", NULL),
                                   relume_image_params(.log = args_log(args)));
    relume_image_destroy(&frame);
    relume_pack_destroy(&pack);
    return status;
}

static relume_status run(const struct args *args)
{
    struct relume_camera camera;
    relume_rig *rig = NULL;
    const struct relume_light *lights;
    int count;
    if (!args_has(args, "-o"))
        return usage_error("relight: expected -o OUT");
    relume_status status = parse_camera(args, &camera);
    if (!status)
        status = parse_lights(args, &rig, &lights, &count);
    if (!status)
        status = render(args, &camera, lights, count);
    relume_rig_destroy(&rig);
    return status;
}

const struct command command_relight = {
    .name = "relight",
    .usage = "FILE -o OUT [OPTION ...]",
    .summary = "show a relume file under any lights, from any eye, as a picture",
    .example = "relume relight statue.exr -o raking.png --light \"dir 1 0 0.2 rgb 1 .9 .8\"",
    .min_inputs = 1,
    .max_inputs = 1,
    .options = options,
    .run = run,
};
