// cmd_relight.c - relume relight: a file under any lights, as a picture
#include "cli/cli.h"
#include "cli/materials/btf_inputs.h"
#include "cli/develop.h"
#include "cli/frame_options.h"
#include "cli/glare_options.h"

#include <math.h>
#include <string.h>

enum { GLARE_PASS = RELUME_PASSES };  // of the frame, not of its views

struct relight_options {
    struct args args;
    const char *output, *objects, *reflections, *capture, *state;
    double crop[4], reflection_at[2];
    int size[2], view, samples, radius, cpu_mask;
    struct relume_vec3 eye, look_at, up;
    double fov, pan, tilt, zoom, aperture, focus, gain, highlight, exponent, range[2];
    enum { PERSPECTIVE, STEREOGRAPHIC, PLANET } projection;
    enum relume_filter filter;
    enum relume_interpolation interpolation;
    unsigned pass;
    const struct relume_transport *transport;  // NULL: none
    int bounces, spacing, cameras;
    bool nearest, alpha, allow_outside, keep_going, every_light, force;
    int format;  // of the pictures of every light: an index of `formats`
    struct light_options lighting;
    struct develop_options develop;
    struct eye_options glare;
};
#define OPTIONS struct relight_options
static const char *const formats[] = {"png", "jpg", "tif", "exr"};
enum { ACROSS = 3, MOST_ACROSS = 16 };  // rays along each side of a pixel

static relume_status take_transport(void *place, const struct option *o, const char *text,
                                    const struct relume_log *log)
{
    const char *names[16];
    int n = 0;
    for (; n < 15 && relume_transports[n]; n++)
        names[n] = relume_transport_name(relume_transports[n]);
    names[n] = NULL;
    const struct relume_transport *found = relume_transport_find(text);
    memcpy(place, &found, sizeof found);
    return found ? RELUME_OK : unknown_word(log, o->name, text, names);
}

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "OUT",
           "picture to write: .exr (linear), .png, .jpg, .tif, .hdr, ..."),
    FLAG("--every-light", every_light, "-o FOLDER: one picture for each captured light"),
    NAME("--format", format, "F", "--every-light: png, jpg, tif or exr; default: png", 0, "png",
         "jpg", "tif", "exr"),
    FLAG("--force", force, "--every-light: replace a folder that relume made"),
    TEXT_AS(OPTION_STATE, "--state", state, "LINE",
            "show it as a page or the viewer did when this line or link was copied there; options "
            "beside it count before it"),
    GROUP("lights"),
    LIGHT_OPTIONS,
    GROUP("camera"),
    INT("--view", view, "N", "a captured view at its own size (panoramas: unfolded)", 0, 65535),
    NUMBERS("--crop", crop, "x,y,w,h",
            "captured view: only these w x h pixels, from column x and row y of the picture at "
            "--size; reads only that part of the file",
            4),
    POINT("--eye", eye, "x,y,z",
          "slab, scene file: look from this point; default: the middle of the cameras, the file's "
          "eye"),
    POINT("--look-at", look_at, "x,y,z",
          "slab, scene file: the point looked at; default: the middle of the object"),
    POINT("--up", up, "x,y,z",
          "slab, scene file: the direction that is up in the picture; default: 0,1,0"),
    NUMBER("--fov", fov, "DEG",
           "slab, scene file: horizontal field of view; default: the slabs' windows; --pass glare: "
           "of a planar file",
           0.01, 179),
    NUMBER("--pan", pan, "A", "panorama: degrees to the right", 0, 0),
    NUMBER("--tilt", tilt, "A", "panorama: degrees up", 0, 0),
    NUMBER("--zoom", zoom, "F", "panorama: 1 shows 90 degrees; default: 1", 0.01, 1000),
    NAME("--projection", projection, "P",
         "panorama: perspective (default), stereographic, planet (seen from above, as a small "
         "globe)",
         PERSPECTIVE, "perspective", "stereographic", "planet"),
    INTERPOLATE_OPTIONS,
    NUMBER("--aperture", aperture, "A",
           "slab: diameter of the lens, which blurs what is out of focus; default: 0 (all sharp)",
           0, 1e9),
    NUMBER("--focus", focus, "Z",
           "slab: the plane at z = Z is sharp; free camera: distance from the look-at point to the "
           "plane in focus; default: the st plane, the look-at point",
           0, 0),
    GROUP("picture"),
    SIZE("--size", size, "WxH",
         "size of the picture: WxH, W (or Wx) or xH; one alone keeps the proportions, both add "
         "black borders if the proportions differ",
         0, 65536),
    NAME("--filter", filter, "F",
         "resampling: linear (auto), cubic or nearest to enlarge; all but nearest average to "
         "reduce",
         RELUME_FILTER_DEFAULT, "auto", "nearest", "linear", "cubic"),
    DEVELOP_OPTIONS,
    NAME("--pass", pass, "NAME",
         "colour, normals, specular, diffuse-gain, unsharp, luminance, false-colour, difference, "
         "glare",
         RELUME_PASS_COLOUR, "colour", "normals", "specular", "diffuse-gain", "unsharp",
         "luminance", "false-colour", "difference", "glare"),
    NUMBER("--gain", gain, "G",
           "--pass diffuse-gain, unsharp: how strongly relief is exaggerated; default: 2", 1, 20),
    NUMBER("--highlight", highlight, "H",
           "--pass specular: brightness of the highlight, relative to the brightest parts of the "
           "picture; default: 0.6",
           0.01, 10),
    NUMBER("--exponent", exponent, "E",
           "--pass specular: how narrow the highlight is, 1 matt to 1000 like a mirror; default: "
           "40",
           1, 1000),
    INT("--radius", radius, "PX", "--pass unsharp: sharpen detail finer than this; default: 4", 1,
        64),
    NUMBERS("--range", range, "LOW,HIGH",
            "--pass false-colour: linear luminance shown as dark blue and as yellow; default: from "
            "the picture",
            2),
    FLAG("--alpha", alpha,
         "captured view with a mask: make the background transparent (.png and .exr)"),
    TEXT("--capture", capture, "CAPTURE", "--pass difference: the capture to compare with"),
    GROUP("glare"),
    GLARE_OPTIONS,
    GROUP("objects"),
    TEXT("--objects", objects, "FILE",
         "objects covered with BTFs, or mirrors, in the scene (docs/objects.md); needs a file with "
         "depth"),
    TEXT("--reflections", reflections, "FILE",
         "--objects: what their mirrors shall reflect where (docs/reflections.md)"),
    NUMBERS("--reflection-at", reflection_at, "x,y",
            "--objects: print what is reflected at this pixel of the picture, as a constraint for "
            "--reflections",
            2),
    OWN("--transport", transport, "NAME",
        "--objects, scene files: how light goes between them and the scene: none (default), ssao, "
        "ssdo, ism, radiosity, micro, path (docs/transport.md)",
        take_transport),
    INT("--bounces", bounces, "N", "--transport: of light off objects; default: 2", 0, 16),
    INT("--spacing", spacing, "N",
        "--transport micro, path: gather light at every N-th pixel each way, and at borders; "
        "default: 4 (micro), 1 (path)",
        1, 16),
    INT("--cameras", cameras, "N",
        "--transport ssao, ssdo: look at the objects from N further sides, too; default: 4", 0, 16),
    INT("--samples", samples, "N",
        "--objects, scene files: N x N rays a pixel, at most 16; default: 3; with --transport: "
        "directions that light is gathered from at a pixel",
        1, 65536),
    GROUP("input"),
    ALLOW_OUTSIDE_OPTION,
    KEEP_GOING_OPTION,
    GROUP("machine"),
    CPU_OPTION,
    {0},
};

static struct relume_pan_tilt pan_tilt(const struct relight_options *o)
{
    const bool planet = o->projection == PLANET;
    return (struct relume_pan_tilt){
        .stereographic = o->projection != PERSPECTIVE,
        .pan_deg = o->pan,
        .tilt_deg = planet && !given(o, &o->tilt) ? -90.0 : o->tilt,
        .zoom = o->zoom > 0.0 ? o->zoom
                : planet      ? 0.5
                              : 1.0,
    };
}

static relume_status parse_camera(const struct relight_options *o, struct relume_camera *camera)
{
    const bool eye = given(o, &o->eye), view = given(o, &o->view);
    const bool look =
        given(o, &o->pan) || given(o, &o->tilt) || given(o, &o->zoom) || given(o, &o->projection);
    if (view + eye + look > 1)
        return usage_error(
            "relight: expected one of --view, --eye, --pan/--tilt/--zoom/--projection");
    if (given(o, o->crop) && (eye || look || o->alpha || o->objects || o->pass == GLARE_PASS))
        return usage_error("--crop: expected a captured view (--view N) without --alpha, "
                           "--objects and --pass glare");
    const bool aims =
        given(o, &o->look_at) || given(o, &o->up) || (given(o, &o->fov) && o->pass != GLARE_PASS);
    if (aims && (view || look || given(o, o->crop)))
        return usage_error("relight: --look-at, --up and --fov turn an eye; leave out %s",
                           view || look ? "--view, --pan, --tilt, --zoom and --projection"
                                        : "--crop");
    *camera = (struct relume_camera){
        .framing = view   ? RELUME_FRAME_VIEW
                   : eye  ? RELUME_FRAME_EYE
                   : look ? RELUME_FRAME_LOOK
                          : RELUME_FRAME_DEFAULT,
        .view = o->view,
        .eye = o->eye,
        .width = o->size[0],
        .height = o->size[1],
    };
    if (eye || aims)
        camera->look_at = (struct relume_look_at){given(o, &o->look_at), o->look_at, o->up, o->fov};
    if (look)
        camera->look = pan_tilt(o);
    return RELUME_OK;
}

// As the viewer's sliders. Each belongs to a pass or two.
static relume_status check_pass(const struct relight_options *o)
{
    const struct {
        const char *option;
        const void *member;
        enum relume_pass pass, other;
    } belongs[] = {
        {"--gain", &o->gain, RELUME_PASS_DIFFUSE_GAIN, RELUME_PASS_UNSHARP},
        {"--highlight", &o->highlight, RELUME_PASS_SPECULAR, RELUME_PASS_SPECULAR},
        {"--exponent", &o->exponent, RELUME_PASS_SPECULAR, RELUME_PASS_SPECULAR},
        {"--radius", &o->radius, RELUME_PASS_UNSHARP, RELUME_PASS_UNSHARP},
        {"--range", &o->range, RELUME_PASS_FALSE_COLOUR, RELUME_PASS_FALSE_COLOUR},
        {"--capture", &o->capture, RELUME_PASS_DIFFERENCE, RELUME_PASS_DIFFERENCE},
    };
    for (size_t i = 0; i < sizeof belongs / sizeof *belongs; i++)
        if (given(o, belongs[i].member) && o->pass != belongs[i].pass &&
            o->pass != belongs[i].other)
            return usage_error("relight: %s works only with --pass %s", belongs[i].option,
                               relume_pass_name(belongs[i].pass));
    if ((o->reflections || given(o, o->reflection_at)) && !o->objects)
        return usage_error("--reflections and --reflection-at work only with --objects; add "
                           "--objects FILE");
    if ((o->transport || given(o, &o->bounces)) && !o->objects)
        return usage_error("--transport and --bounces work only with --objects or a scene file; "
                           "add --objects FILE");
    if (given(o, &o->spacing) && !(o->transport && relume_transport_spacing(o->transport)))
        return usage_error("--spacing works only with --transport micro and path");
    if (given(o, &o->cameras) && !(o->transport && relume_transport_cameras(o->transport) >= 0))
        return usage_error("--cameras works only with --transport ssao and ssdo");
    if (o->samples > MOST_ACROSS && !(o->transport && relume_transport_samples(o->transport)))
        return usage_error("--samples: expected 1 to %d rays along each side of a pixel; found %d",
                           MOST_ACROSS, o->samples);
    if (o->pass == RELUME_PASS_DIFFERENCE && !o->capture)
        return usage_error("relight: --pass difference needs --capture");
    if (o->pass != RELUME_PASS_COLOUR && o->pass != GLARE_PASS && o->objects)
        return usage_error("objects can be shown in colour only; leave out --pass");
    if (given(o, &o->range) && !(o->range[0] >= 0.0 && o->range[0] < o->range[1]))
        return usage_error("--range: expected two luminances LOW,HIGH, the first one smaller; "
                           "found '%g,%g'",
                           o->range[0], o->range[1]);
    return RELUME_OK;
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

static struct relume_render_params render_params(const struct relight_options *o)
{
    const bool gathers = o->transport && relume_transport_samples(o->transport);
    return (struct relume_render_params){
        .struct_size = sizeof(struct relume_render_params),
        .log = o->args.log,
        .samples = gathers ? ACROSS : o->samples,
        .threads = o->args.threads,
        .transport = o->transport,
        .transport_samples = given(o, &o->samples) && gathers ? o->samples : 0,
        .bounces = given(o, &o->bounces) && !o->bounces ? -1 : o->bounces,
        .transport_spacing = o->spacing,
        .transport_cameras = given(o, &o->cameras) && !o->cameras ? -1 : o->cameras,
    };
}

static relume_status set_objects(relume_objects **objects, relume_renderer *renderer,
                                 const struct relight_options *o)
{
    const struct relume_render_params params = render_params(o);
    if (!o->objects)
        return RELUME_OK;
    const relume_status status = objects_open(objects, o->objects, o->reflections, &o->args);
    return status ? status : relume_renderer_set_objects(renderer, *objects, &params);
}

static relume_status tell_reflection(const relume_objects *objects, relume_pack *pack,
                                     const struct relight_options *o,
                                     const struct relume_camera *camera,
                                     const struct relume_image *frame)
{
    struct relume_viewport viewport;
    struct relume_vec3 eye, direction;
    if (!given(o, o->reflection_at))
        return RELUME_OK;
    const relume_status status =
        relume_frame_viewport(&viewport, pack, camera, frame->width, frame->height);
    if (status)
        return status;
    relume_viewport_ray(&eye, &direction, &viewport, o->reflection_at[0] + 0.5,
                        o->reflection_at[1] + 0.5);
    return objects_tell_reflection(objects, eye, direction);
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
            relume_pan_tilt_ray(camera->look, frame->width, frame->height, x - 0.5, y);
        const struct relume_vec3 b =
            relume_pan_tilt_ray(camera->look, frame->width, frame->height, x + 0.5, y);
        const double pixel = hypot(hypot(a.x - b.x, a.y - b.y), a.z - b.z);
        return 2.0 * atan(0.5 * pixel * frame->width) * 180.0 / M_PI;
    }
    if (camera->framing == RELUME_FRAME_EYE && camera->look_at.field_of_view_deg > 0.0)
        return camera->look_at.field_of_view_deg;
    double width = g->window_max[0] - g->window_min[0], distance = 0.0;
    int size[2];
    if (g->projection == RELUME_SLAB) {
        width = g->st_max[0] - g->st_min[0];
        distance = (camera->framing == RELUME_FRAME_EYE ? camera->eye.z : g->uv_z) - g->st_z;
    } else if (g->projection == RELUME_PLANAR && g->perspective) {
        distance = g->camera_z;
    }
    width *= (double)frame->width / relume_camera_rect(size, info, camera).width;
    return distance > 0.0 ? 2.0 * atan(0.5 * width / distance) * 180.0 / M_PI : 0.0;
}

static relume_status add_glare(struct relume_image *frame, relume_renderer *renderer,
                               const struct relight_options *o, const struct relume_camera *camera)
{
    const struct relume_pack_info *info = relume_pack_info(relume_renderer_pack(renderer));
    const double fov = o->fov > 0.0 ? o->fov : field_of_view(info, camera, frame);
    struct viewer_eye eye;
    struct relume_image seen = {0};
    if (info->geometry.projection > RELUME_SLAB && camera->framing != RELUME_FRAME_LOOK)
        return usage_error("--pass glare: expected --pan, --tilt or --zoom for a panorama");
    relume_status status = relume_frame_visible_lights(frame, NULL, renderer, camera);
    const double luminance = o->glare.nits * relume_glare_luminance(frame);
    if (!status)
        status = open_viewer_eye(&eye, &o->args, &o->glare, luminance,
                                 relume_psf_params(.log = o->args.log, .threads = o->args.threads,
                                                   .size = GLARE_SIZE,
                                                   .half_field_deg = GLARE_FIELD_DEG));
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

static relume_status draw(struct relume_image *out, relume_renderer *renderer,
                          const struct relight_options *o, const struct relume_camera *camera)
{
    if (!given(o, o->crop))
        return relume_renderer_frame(out, renderer, camera);
    int at[4];
    for (int i = 0; i < 4; i++) {
        at[i] = (int)fmin(fmax(o->crop[i], -1.0), 1e6);
        if (at[i] != o->crop[i])
            return usage_error("--crop: expected four whole numbers, x,y,w,h; found %g",
                               o->crop[i]);
    }
    const struct relume_rect rect = {at[0], at[1], at[2], at[3]};
    int width, height;
    relume_frame_size(&width, &height, at + 2, camera);
    return relume_renderer_detail(out, renderer, camera->view, &rect, width, height);
}

// An eye that is only turned stays where a slab is seen from when nobody says it.
static relume_status place_eye(struct relume_camera *camera, relume_pack *pack,
                               const struct relight_options *o)
{
    struct relume_viewport viewport;
    if (camera->framing != RELUME_FRAME_DEFAULT || !relume_look_at_given(&camera->look_at))
        return RELUME_OK;
    if (relume_pack_info(pack)->geometry.projection != RELUME_SLAB)
        return usage_error("%s: --look-at, --up and --fov turn the eye of slabs and scene files; "
                           "panoramas turn by --pan and --tilt",
                           o->args.input[0]);
    const struct relume_camera usual = {.framing = RELUME_FRAME_DEFAULT};
    const relume_status status = relume_frame_viewport(&viewport, pack, &usual, 1, 1);
    camera->framing = RELUME_FRAME_EYE;
    camera->eye = relume_viewport_eye(&viewport);
    return status;
}

static double elevation(struct relume_vec3 d)
{
    return atan2(d.z, hypot(d.x, d.y)) * 180.0 / M_PI;
}

// Says how far below the lowest captured light that of a raking picture stands; "": it does not.
static void describe_low_light(char text[160], const relume_renderer *renderer)
{
    const struct relume_pack_info *info = relume_pack_info(relume_renderer_pack(renderer));
    const struct relume_coder_info *coder = relume_coder_info(info->coder);
    double low = 90.0, lowest = 90.0;
    int n;
    const struct relume_light *light = relume_renderer_lights(&n, renderer);
    *text = '\0';
    if (info->geometry.projection != RELUME_PLANAR)
        return;
    for (int i = 0; i < n; i++)
        if (light[i].kind == RELUME_LIGHT_DIRECTIONAL)
            low = fmin(low, elevation(light[i].direction));
    for (int i = 0; i < coder->lights; i++)
        lowest = fmin(lowest, elevation(coder->directions[i]));
    if (low < lowest)
        snprintf(text, 160,
                 "; the light stands %.0f degrees above the picture, the lowest photographed one "
                 "%.0f; --light raking takes one that shows relief",
                 low, lowest);
}

// Raking light leaves some surfaces nearly black.
static void note_darkness(const struct relume_image *frame, const struct relight_options *o,
                          const relume_renderer *renderer, const char *path)
{
    static const double bright = 0.9, dark = 0.1;  // relume_tone_meter_bright, white
    char low[160];
    const double ev = relume_tone_meter_bright(frame);
    const double top = bright * exp2(-ev);
    if (o->every_light || o->pass != RELUME_PASS_COLOUR || given(o, &o->develop.exposure) ||
        relume_image_saves_linear(path) || ev == 0.0 || top >= dark)
        return;
    describe_low_light(low, renderer);
    announce(&o->args, RELUME_NOTE,
             "%s: nearly black, its bright parts are %.1f %% of white; --exposure auto adds %.1f "
             "stops%s",
             path, 100.0 * top, ev, low);
}

// Draws what the renderer's lights show, as the file `path` has it.
static relume_status draw_picture(relume_renderer *renderer, const relume_objects *objects,
                                  const struct relight_options *o,
                                  const struct relume_camera *camera, const char *path)
{
    relume_pack *pack = relume_renderer_pack(renderer);
    struct relume_image frame = {0};
    relume_status status = draw(&frame, renderer, o, camera);
    if (!status)
        status = tell_reflection(objects, pack, o, camera, &frame);
    if (!status && o->pass == GLARE_PASS)
        status = add_glare(&frame, renderer, o, camera);
    if (!status)
        note_darkness(&frame, o, renderer, path);
    if (!status && o->pass == RELUME_PASS_NORMALS)
        show_normals(&frame, path);
    else if (!status)
        status = develop(&frame, &o->develop, path);
    if (!status && o->alpha)
        status = add_alpha(&frame, pack, camera);
    if (!status)
        status = save_developed(&frame, &o->develop, path, &o->args);
    relume_image_destroy(&frame);
    return status;
}

static relume_status draw_light(relume_renderer *renderer, const relume_objects *objects,
                                const struct relight_options *o, const struct relume_camera *camera,
                                const char *folder, int i)
{
    const relume_coder *coder = relume_pack_info(relume_renderer_pack(renderer))->coder;
    const struct relume_coder_info *info = relume_coder_info(coder);
    const struct relume_light light = {
        .kind = RELUME_LIGHT_DIRECTIONAL, .direction = info->directions[i], .rgb = {1, 1, 1}};
    char path[4200];
    snprintf(path, sizeof path, "%.4096s/light%04d.%s", folder, i, formats[o->format]);
    relume_status status = relume_renderer_set_lights(renderer, &light, 1);
    if (!status)
        status = draw_picture(renderer, objects, o, camera, path);
    if (!status && o->args.log->progress &&
        !o->args.log->progress(o->args.log->user, "relighting", (i + 1.0) / info->lights))
        status = RELUME_ECANCEL;
    return status;
}

// A picture under each captured light, in the folder that is the output.
static relume_status draw_every_light(relume_renderer *renderer, const relume_objects *objects,
                                      const struct relight_options *o,
                                      const struct relume_camera *camera)
{
    const relume_coder *coder = relume_pack_info(relume_renderer_pack(renderer))->coder;
    const int lights = relume_coder_info(coder)->lights;
    relume_making *folder;
    relume_status status =
        relume_making_open(&folder, o->output, RELUME_MADE_FOLDER, o->force, o->args.log);
    if (status)
        return status;
    for (int i = 0; !status && i < lights; i++)
        status = draw_light(renderer, objects, o, camera, relume_making_path(folder), i);
    if (status) {
        relume_making_abort(&folder);
        return status;
    }
    announce(&o->args, RELUME_NOTE, "%s: %d pictures, one for each captured light", o->output,
             lights);
    return relume_making_commit(&folder);
}

static relume_status render(const struct relight_options *o, struct relume_camera *camera,
                            struct relume_frame_params params, relume_rig *rig,
                            const struct relume_light *lights, int count)
{
    relume_pack *pack;
    relume_renderer *renderer = NULL;
    relume_objects *objects = NULL;
    relume_capture *capture = NULL;
    struct prefix_log about;
    const bool lens = given(o, &o->aperture) || given(o, &o->focus);
    relume_status status = relume_open(
        &pack, o->args.input[0],
        relume_open_params(.log = o->args.log, .threads = o->args.threads,
                           .allow_outside = o->allow_outside, .keep_going = o->keep_going,
                           .sphere = camera->framing == RELUME_FRAME_LOOK));
    if (status)
        return status;
    const struct relume_pack_info *info = relume_pack_info(pack);
    const bool free_eye = info->slabs || relume_look_at_given(&camera->look_at);
    const double plane_z = free_eye ? 0.0 : info->geometry.st_z;
    params.once = !o->every_light;
    params.log = prefix_log(&about, o->args.log, o->args.input[0]);
    params.focus = given(o, &o->focus) ? o->focus - plane_z : 0.0;
    if (!free_eye && lens)
        params.interpolation = RELUME_INTERPOLATE_LINEAR;
    if (o->capture)
        status = relume_capture_open_photographs(
            &capture, o->capture,
            relume_capture_params(.log = o->args.log, .allow_outside = o->allow_outside), NULL,
            NULL);
    params.capture = capture;
    if (!status)
        status = place_eye(camera, pack, o);
    if (!status)
        status = aim_lights(&o->args, &o->lighting, rig, pack, o->args.input[0], &lights, &count);
    if (!status)
        status = relume_renderer_create(&renderer, pack, &params);
    if (!status)
        status = relume_renderer_set_lights(renderer, lights, count);
    if (!status)
        status = set_objects(&objects, renderer, o);
    if (!status)
        status = o->every_light ? draw_every_light(renderer, objects, o, camera)
                                : draw_picture(renderer, objects, o, camera, o->output);
    relume_renderer_destroy(&renderer);
    relume_objects_destroy(&objects);
    relume_capture_destroy(&capture);
    relume_pack_destroy(&pack);
    return status;
}

// ---------------------------------------------------------------- scene files

// Options that are of one file alone.
static relume_status check_scene(const struct relight_options *o)
{
    const struct {
        const char *option;
        const void *member;
    } of_files[] = {
        {"--view", &o->view},
        {"--crop", o->crop},
        {"--pan", &o->pan},
        {"--tilt", &o->tilt},
        {"--zoom", &o->zoom},
        {"--projection", &o->projection},
        {"--aperture", &o->aperture},
        {"--focus", &o->focus},
        {"--objects", &o->objects},
        {"--reflections", &o->reflections},
        {"--reflection-at", o->reflection_at},
        {"--pass", &o->pass},
        {"--alpha", &o->alpha},
        {"--interpolate", &o->interpolation},
        {"--nearest", &o->nearest},
        {"--every-light", &o->every_light},
        {"--filter", &o->filter},
        {"--capture", &o->capture},
        {"--assume-depth", &o->lighting.assume_depth},
    };
    for (size_t i = 0; i < sizeof of_files / sizeof *of_files; i++)
        if (given(o, of_files[i].member))
            return usage_error("%s: a scene file holds objects, captures and their places; leave "
                               "out %s",
                               o->args.input[0], of_files[i].option);
    if (given(o, &o->bounces) && !o->transport)
        return usage_error("--bounces works only with --transport");
    if (given(o, &o->spacing) && !(o->transport && relume_transport_spacing(o->transport)))
        return usage_error("--spacing works only with --transport micro and path");
    if (given(o, &o->cameras) && !(o->transport && relume_transport_cameras(o->transport) >= 0))
        return usage_error("--cameras works only with --transport ssao and ssdo");
    if (o->samples > MOST_ACROSS && !(o->transport && relume_transport_samples(o->transport)))
        return usage_error("--samples: expected 1 to %d rays along each side of a pixel; found %d",
                           MOST_ACROSS, o->samples);
    return RELUME_OK;
}

static relume_status draw_scene(const struct relight_options *o, const struct relume_light *lights,
                                int count)
{
    const struct relume_camera camera = {
        .framing = given(o, &o->eye) ? RELUME_FRAME_EYE : RELUME_FRAME_DEFAULT,
        .eye = o->eye,
        .look_at = {given(o, &o->look_at), o->look_at, o->up, o->fov},
        .width = o->size[0],
        .height = o->size[1],
    };
    const struct relume_render_params params = render_params(o);
    relume_tableau *tableau;
    struct relume_image frame = {0};
    relume_status status = relume_tableau_open(
        &tableau, o->args.input[0],
        relume_tableau_params(.log = o->args.log, .limits = &o->args.limits,
                              .threads = o->args.threads, .allow_outside = o->allow_outside,
                              .keep_going = o->keep_going));
    if (!status && !o->lighting.rig && !o->lighting.light.count)
        status = relume_rig_lights(&lights, &count, relume_tableau_rig(tableau));
    if (!status)
        status = relume_tableau_frame(&frame, tableau, &camera, lights, count, &params);
    if (!status)
        status = develop(&frame, &o->develop, o->output);
    if (!status)
        status = save_developed(&frame, &o->develop, o->output, &o->args);
    relume_image_destroy(&frame);
    relume_tableau_destroy(&tableau);
    return status;
}

static relume_status run_scene(const struct relight_options *o)
{
    relume_rig *rig = NULL;
    const struct relume_light *lights;
    int count;
    relume_status status = check_scene(o);
    if (!status)
        status = parse_lights(&o->args, &o->lighting, &rig, &lights, &count);
    if (!status)
        status = draw_scene(o, lights, count);
    if (!status)
        status = save_lights(&o->args, &o->lighting, rig);
    relume_rig_destroy(&rig);
    return status;
}

// ---------------------------------------------------------------- the command

// A picture, or with --every-light a folder of them.
static relume_status check_output(const struct relight_options *o)
{
    char picture[16];
    snprintf(picture, sizeof picture, "a.%s", formats[o->format]);
    if (!o->every_light && (given(o, &o->format) || o->force))
        return usage_error("--format and --force work only with --every-light");
    if (o->every_light && (o->lighting.light.count || o->lighting.rig || o->lighting.save_rig ||
                           given(o, o->reflection_at)))
        return usage_error("--every-light: leave out --light, --rig, --save-rig and "
                           "--reflection-at");
    if (o->every_light && o->alpha && !relume_image_saves_alpha(picture))
        return usage_error("--alpha: expected --format png or exr");
    if (o->every_light)
        return check_bits(&o->develop, picture);
    const relume_status status = picture_name(o->args.log, "-o", o->output);
    return status ? status : check_bits(&o->develop, o->output);
}

static relume_status run_relight(const struct args *args)
{
    const struct relight_options *o = (const void *)args;
    const struct relume_pass_params strength = {
        .gain = (float)o->gain,
        .specular = (float)o->highlight,
        .exponent = (float)o->exponent,
        .radius = o->radius,
        .low = (float)o->range[0],
        .top = (float)o->range[1],
    };
    struct relume_frame_params params = parse_frame(args, &o->lighting, o->cpu_mask);
    struct relume_camera camera;
    relume_rig *rig = NULL;
    const struct relume_light *lights;
    int count;
    relume_status status = check_output(o);
    if (status)
        return status;
    if (o->alpha && !o->every_light && !relume_image_saves_alpha(o->output))
        return usage_error("--alpha: expected an output that ends in .png or .exr; found '%s'",
                           o->output);
    if (o->nearest + (o->interpolation > 0) + (given(o, &o->aperture) || given(o, &o->focus)) > 1)
        return usage_error("relight: expected one of --interpolate, --nearest, --aperture/--focus");
    if (relume_kind_of(args->input[0]) == RELUME_KIND_SCENE)
        return run_scene(o);
    params.aperture = o->aperture;
    params.interpolation = o->nearest ? RELUME_INTERPOLATE_CONSTANT : o->interpolation;
    params.filter = o->filter;
    params.pass = o->pass == GLARE_PASS ? RELUME_PASS_COLOUR : o->pass;
    params.strength = &strength;
    status = parse_camera(o, &camera);
    if (!status)
        status = check_pass(o);
    if (!status)
        status = parse_lights_of_file(args, &o->lighting, &rig, &lights, &count);
    if (!status)
        status = render(o, &camera, params, rig, lights, count);
    if (!status)
        status = save_lights(args, &o->lighting, rig);
    relume_rig_destroy(&rig);
    return status;
}

const struct command command_relight = {
    COMMAND(run_relight, "relight", "FILE -o OUT [OPTION ...]",
            "show a relume file under any lights, from any eye, as a picture",
            "relume relight statue.exr -o raking.png --light \"raking left rgb 1 .9 .8\"", 1, 1),
    .defaults =
        &(const OPTIONS){.samples = ACROSS, .cpu_mask = ALL_KERNELS, .glare = GLARE_DEFAULTS},
};
