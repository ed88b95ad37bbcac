// cmd_relight.c - relume relight: a file under any lights, as a picture
#include "cli.h"
#include "commands/btf_inputs.h"
#include "develop.h"
#include "frame_options.h"
#include "glare_options.h"

#include <math.h>
#include <string.h>

static const struct option options[] = {
    {"-o", OPTION_PICTURE, "OUT", "picture to write: .exr (linear), .png, .jpg, .tif, .hdr, ...", 0,
     0},
    LIGHT_OPTIONS,
    {"--view", OPTION_INT, "N", "a captured view at its own size (panoramas: unfolded)", 0, 65535},
    {"--eye", OPTION_TEXT, "x,y,z",
     "slab: look at the window from this point; default: the middle of the cameras", 0, 0},
    {"--look-at", OPTION_TEXT, "x,y,z", "--eye: where it looks; default: the middle of the object",
     0, 0},
    {"--up", OPTION_TEXT, "x,y,z", "--eye: the direction that is up in the picture; default: 0,1,0",
     0, 0},
    {"--fov", OPTION_NUMBER, "DEG",
     "--eye: horizontal field of view; default: the slabs' windows; --pass glare: of a planar file",
     0.01, 179},
    {"--pan", OPTION_NUMBER, "A", "panorama: degrees to the right", 0, 0},
    {"--tilt", OPTION_NUMBER, "A", "panorama: degrees up", 0, 0},
    {"--zoom", OPTION_NUMBER, "F", "panorama: 1 shows 90 degrees; default: 1", 0.01, 1000},
    {"--projection", OPTION_TEXT, "P",
     "panorama: perspective (default), stereographic, planet (seen from above, as a small globe)",
     0, 0},
    {"--size", OPTION_TEXT, "WxH", SIZE_HELP, 0, 0},
    {"--filter", OPTION_TEXT, "F",
     "resampling: linear (auto), cubic or nearest to enlarge; all but nearest average to reduce", 0,
     0},
    INTERPOLATE_OPTIONS,
    {"--aperture", OPTION_NUMBER, "A",
     "slab: diameter of the lens, which blurs what is out of focus; default: 0 (all sharp)", 0,
     1e9},
    {"--focus", OPTION_NUMBER, "Z",
     "slab: the plane at z = Z is sharp; free camera: distance from the look-at point to the plane "
     "in focus; default: the st plane, the look-at point",
     0, 0},
    DEVELOP_OPTIONS,
    {"--pass", OPTION_TEXT, "NAME",
     "colour, normals, specular, diffuse-gain, unsharp, luminance, false-colour, difference, glare",
     0, 0},
    GLARE_OPTIONS,
    {"--alpha", OPTION_FLAG, NULL,
     "make the background transparent where the capture has a mask: .png and .exr of a captured "
     "view",
     0, 0},
    {"--objects", OPTION_TEXT, "FILE",
     "objects covered with BTFs, in the scene (docs/objects.md); needs a file with depth", 0, 0},
    {"--samples", OPTION_INT, "N", "--objects: N x N rays a pixel; default 3", 1, 16},
    {"--capture", OPTION_TEXT, "CAPTURE", "--pass difference: the photographs", 0, 0},
    ALLOW_OUTSIDE_OPTION,
    CPU_OPTION,
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

static bool wants_glare(const struct args *args)
{
    return !strcmp(args_text(args, "--pass", ""), "glare");
}

static relume_status parse_filter(const struct args *args, struct relume_frame_params *params)
{
    static const char *const names[] = {"auto", "nearest", "linear", "cubic", NULL};
    const char *name = args_text(args, "--filter", names[0]);
    return relume_filter_parse(&params->filter, name) ? unknown_name("--filter", name, names)
                                                      : RELUME_OK;
}

static relume_status parse_look(const struct args *args, struct relume_look *look)
{
    static const char *const names[] = {"perspective", "stereographic", "planet", NULL};
    const char *name = args_text(args, "--projection", names[0]);
    int which = 0;
    while (names[which] && strcmp(names[which], name))
        which++;
    if (!names[which])
        return unknown_name("--projection", name, names);
    const bool planet = which == 2;
    look->stereographic = which > 0;
    look->pan_deg = args_number(args, "--pan", 0.0);
    look->tilt_deg = args_number(args, "--tilt", planet ? -90.0 : 0.0);
    look->zoom = args_number(args, "--zoom", planet ? 0.5 : 1.0);
    return RELUME_OK;
}

static relume_status parse_vector(const struct args *args, const char *name,
                                  struct relume_vec3 *out)
{
    return args_has(args, name) ? args_vec3(out, name, args_text(args, name, NULL)) : RELUME_OK;
}

static relume_status parse_eye(const struct args *args, struct relume_camera *camera)
{
    camera->framing = RELUME_FRAME_EYE;
    camera->aim.aimed = args_has(args, "--look-at");
    camera->aim.field_of_view_deg = args_number(args, "--fov", 0.0);
    relume_status status = parse_vector(args, "--eye", &camera->eye);
    if (!status)
        status = parse_vector(args, "--look-at", &camera->aim.at);
    if (!status)
        status = parse_vector(args, "--up", &camera->aim.up);
    return status;
}

static relume_status parse_camera(const struct args *args, struct relume_camera *camera)
{
    const bool look = args_has(args, "--pan") || args_has(args, "--tilt") ||
                      args_has(args, "--zoom") || args_has(args, "--projection");
    relume_status status = RELUME_OK;
    *camera = (struct relume_camera){0};
    if (args_has(args, "--view") + args_has(args, "--eye") + look > 1)
        return usage_error(
            "relight: expected one of --view, --eye, --pan/--tilt/--zoom/--projection");
    if (!args_has(args, "--eye") && (args_has(args, "--look-at") || args_has(args, "--up") ||
                                     (args_has(args, "--fov") && !wants_glare(args))))
        return usage_error("relight: --look-at, --up and --fov need --eye");
    if (args_has(args, "--view")) {
        camera->framing = RELUME_FRAME_VIEW;
        camera->view = args_int(args, "--view", 0);
    } else if (args_has(args, "--eye")) {
        status = parse_eye(args, camera);
    } else if (look) {
        camera->framing = RELUME_FRAME_LOOK;
        status = parse_look(args, &camera->look);
    }
    return status ? status : parse_size(args, &camera->width, &camera->height);
}

static relume_status parse_slab(const struct args *args, struct relume_frame_params *params)
{
    const bool nearest = args_has(args, "--nearest");
    const bool named = args_has(args, "--interpolate");
    const bool lens = args_has(args, "--aperture") || args_has(args, "--focus");
    if (nearest + named + lens > 1)
        return usage_error("relight: expected one of --interpolate, --nearest, --aperture/--focus");
    params->aperture = args_number(args, "--aperture", 0.0);
    return parse_interpolation(args, params);
}

static relume_status parse_pass(const struct args *args, struct relume_frame_params *params)
{
    const char *name = args_text(args, "--pass", relume_pass_name(RELUME_PASS_COLOUR));
    const char *names[RELUME_PASSES + 2] = {NULL};
    for (int i = 0; i < RELUME_PASSES; i++)
        names[i] = relume_pass_name((enum relume_pass)i);
    names[RELUME_PASSES] = "glare";  // of the frame, not of its views
    if (!wants_glare(args) && relume_pass_parse(&params->pass, name))
        return unknown_name("--pass", name, names);
    if (params->pass != RELUME_PASS_COLOUR && args_has(args, "--objects"))
        return usage_error("objects can be shown in colour only; leave out --pass");
    const bool difference = params->pass == RELUME_PASS_DIFFERENCE;
    if (difference != args_has(args, "--capture"))
        return usage_error("relight: --pass difference and --capture work only together");
    return RELUME_OK;
}

static relume_status open_capture(const struct args *args, relume_capture **capture)
{
    const char *path = args_text(args, "--capture", NULL);
    return path ? relume_capture_open(
                      capture, path,
                      relume_capture_params(.log = args_log(args),
                                            .allow_outside = args_has(args, "--allow-outside")))
                : RELUME_OK;
}

// Linear pictures hold the vectors; others the codes (n + 1) / 2, as normal maps do, and black
// where there is none.
static void show_normals(struct relume_image *frame, const char *path)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const size_t samples = (size_t)frame->width * (size_t)frame->height * 3;
    for (size_t i = 0; !relume_image_saves_linear(path) && i < samples; i += 3) {
        float *n = frame->data + i;
        const bool known = n[0] != 0.0f || n[1] != 0.0f || n[2] != 0.0f;
        for (int c = 0; known && c < 3; c++)
            n[c] = relume_transfer_decode(srgb, 0.5f * n[c] + 0.5f);
    }
}

static relume_status make_frame(struct relume_image *frame, relume_renderer *renderer,
                                const struct args *args, const struct relume_camera *camera)
{
    const char *path = args_text(args, "--objects", NULL);
    relume_objects *objects;
    if (!path)
        return relume_renderer_frame(frame, renderer, camera);
    relume_status status = objects_open(&objects, path, args);
    if (!status)
        status = relume_objects_frame(
            frame, objects, renderer, camera,
            relume_render_params(.log = args_log(args), .samples = args_int(args, "--samples", 3),
                                 .threads = args_threads(args)));
    relume_objects_destroy(&objects);
    return status;
}

// ---------------------------------------------------------------- glare

// The horizontal field of view of a frame, from the angle of its middle pixels. 0: not known.
static double field_of_view(const struct relume_pack_info *info, const struct relume_camera *camera,
                            const struct relume_image *frame)
{
    const struct relume_geometry *const g = &info->geometry;
    if (camera->framing == RELUME_FRAME_LOOK) {
        const double y = 0.5 * frame->height, x = 0.5 * frame->width;
        const struct relume_vec3 a =
            relume_look_ray(camera->look, frame->width, frame->height, x - 0.5, y);
        const struct relume_vec3 b =
            relume_look_ray(camera->look, frame->width, frame->height, x + 0.5, y);
        const double pixel = hypot(hypot(a.x - b.x, a.y - b.y), a.z - b.z);
        return 2.0 * atan(0.5 * pixel * frame->width) * 180.0 / M_PI;
    }
    if (camera->framing == RELUME_FRAME_EYE && camera->aim.field_of_view_deg > 0.0)
        return camera->aim.field_of_view_deg;
    double width = g->window_max[0] - g->window_min[0], distance = 0.0;
    int size[2];
    if (g->projection == RELUME_SLAB) {
        width = g->st_max[0] - g->st_min[0];
        distance = (camera->framing == RELUME_FRAME_EYE ? camera->eye.z : g->uv_z) - g->st_z;
    } else if (g->projection == RELUME_PLANAR && g->perspective) {
        distance = g->camera_z;
    }
    width *= (double)frame->width / relume_camera_place(size, info, camera).width;
    return distance > 0.0 ? 2.0 * atan(0.5 * width / distance) * 180.0 / M_PI : 0.0;
}

static relume_status add_glare(struct relume_image *frame, relume_renderer *renderer,
                               const struct args *args, const struct relume_camera *camera)
{
    const struct relume_pack_info *info = relume_pack_info(relume_renderer_pack(renderer));
    const double fov = args_number(args, "--fov", field_of_view(info, camera, frame));
    struct viewer_eye eye;
    struct relume_image seen = {0};
    if (info->geometry.projection > RELUME_SLAB && camera->framing != RELUME_FRAME_LOOK)
        return usage_error("--pass glare: expected --pan, --tilt or --zoom for a panorama");
    relume_status status = relume_frame_lamps(frame, NULL, renderer, camera);
    const double luminance = args_number(args, "--nits", 100.0) * relume_glare_luminance(frame);
    if (!status)
        status = open_viewer_eye(
            &eye, args, luminance,
            relume_psf_params(.log = args_log(args), .threads = args_threads(args),
                              .size = GLARE_SIZE, .half_field_deg = GLARE_FIELD_DEG));
    if (status)
        return status;
    eye.params.fov_deg = fov;
    status = see(&seen, &eye, frame, false);
    close_viewer_eye(&eye);
    if (!status) {
        relume_image_destroy(frame);
        *frame = seen;
    }
    return status;
}

// The mask of the view as a fourth channel; 1 everywhere where there is none.
static relume_status add_alpha(struct relume_image *frame, relume_pack *pack,
                               const struct relume_camera *camera)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const bool slab = info->geometry.projection == RELUME_SLAB;
    const bool view =
        camera->framing == RELUME_FRAME_VIEW || (camera->framing == RELUME_FRAME_DEFAULT && !slab);
    if (!view || frame->width != info->width || frame->height != info->height)
        return usage_error("--alpha: expected a captured view at its own size (--view N)");
    struct relume_image mask, with = {0};
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    relume_status status = relume_pack_mask(&mask, pack, camera->view);
    if (!status)
        status = relume_image_create(&with, frame->width, frame->height, 4);
    for (size_t i = 0; !status && i < pixels; i++) {
        memcpy(with.data + 4 * i, frame->data + 3 * i, 3 * sizeof *with.data);
        with.data[4 * i + 3] = !mask.data || mask.data[i] > 0.5f ? 1.0f : 0.0f;
    }
    relume_image_destroy(&mask);
    if (status)
        return status;
    relume_image_destroy(frame);
    *frame = with;
    return RELUME_OK;
}

static relume_status render(const struct args *args, const struct relume_camera *camera,
                            struct relume_frame_params params, struct developing developing,
                            const struct relume_light *lights, int count)
{
    relume_pack *pack;
    relume_renderer *renderer = NULL;
    relume_capture *capture = NULL;
    struct prefix_log about;
    struct relume_image frame = {0};
    const char *output = args_text(args, "-o", NULL);
    relume_status status =
        relume_open(&pack, args_input(args, 0),
                    relume_open_params(.log = args_log(args), .threads = args_threads(args),
                                       .allow_outside = args_has(args, "--allow-outside"),
                                       .sphere = camera->framing == RELUME_FRAME_LOOK));
    if (status)
        return status;
    const struct relume_pack_info *info = relume_pack_info(pack);
    const bool free_eye = info->slabs || relume_aim_given(&camera->aim);
    const double plane_z = free_eye ? 0.0 : info->geometry.st_z;
    params.log = prefix_log(&about, args_log(args), args_input(args, 0));
    params.focus = args_number(args, "--focus", plane_z) - plane_z;
    if (!free_eye && (args_has(args, "--aperture") || args_has(args, "--focus")))
        params.interpolation = RELUME_INTERPOLATE_LINEAR;
    status = open_capture(args, &capture);
    params.capture = capture;
    if (!status)
        status = relume_renderer_create(&renderer, pack, &params);
    if (!status)
        status = relume_renderer_set_lights(renderer, lights, count);
    if (!status)
        status = make_frame(&frame, renderer, args, camera);
    if (!status && wants_glare(args))
        status = add_glare(&frame, renderer, args, camera);
    if (!status && params.pass == RELUME_PASS_NORMALS)
        show_normals(&frame, output);
    else if (!status)
        status = develop(&frame, developing, output);
    if (!status && args_has(args, "--alpha"))
        status = add_alpha(&frame, pack, camera);
    if (!status)
        status = relume_image_save(&frame, output, relume_image_params(.log = args_log(args)));
    relume_image_destroy(&frame);
    relume_renderer_destroy(&renderer);
    relume_capture_destroy(&capture);
    relume_pack_destroy(&pack);
    return status;
}

static relume_status run(const struct args *args)
{
    struct relume_camera camera;
    struct relume_frame_params params = parse_frame(args);
    struct developing developing = {0};
    relume_rig *rig = NULL;
    const struct relume_light *lights;
    int count;
    if (!args_has(args, "-o"))
        return usage_error("relight: expected -o OUT");
    if (args_has(args, "--alpha") && !relume_image_saves_alpha(args_text(args, "-o", NULL)))
        return usage_error("--alpha: expected an output that ends in .png or .exr; found '%s'",
                           args_text(args, "-o", NULL));
    relume_status status = parse_camera(args, &camera);
    if (!status)
        status = parse_slab(args, &params);
    if (!status)
        status = parse_filter(args, &params);
    if (!status)
        status = parse_pass(args, &params);
    if (!status)
        status = parse_developing(args, &developing);
    if (!status)
        status = parse_lights(args, &rig, &lights, &count);
    if (!status)
        status = render(args, &camera, params, developing, lights, count);
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
