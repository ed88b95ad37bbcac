// cmd_glare.c - relume glare: a picture as a human eye sees it
#include "cli.h"
#include "commands/glare_pattern.h"
#include "develop.h"
#include "film.h"
#include "glare_options.h"
#include "output_name.h"

#include <math.h>
#include <string.h>

static const struct option options[] = {
    {"-o", OPTION_OUTPUT, "OUT",
     "picture to write: .exr (linear), .png, ...; with --frames: name.%04d.png, a folder or .mp4",
     0, 0},
    {"--fov", OPTION_NUMBER, "DEG", "horizontal field of view of the picture; default: 45", 0.01,
     170},
    GLARE_OPTIONS,
    {"--frames", OPTION_INT, "N", "number of pictures, starting at --time", 1, 1000000},
    {"--fps", OPTION_NUMBER, "F", "pictures a second; default: 30", 0.1, 1000},
    {"--cycle", OPTION_NUMBER, "S",
     "--frames: compute S seconds and repeat them as a seamless loop", 0.1, 120},
    {"--pan", OPTION_NUMBER, "A", "IN is a whole sphere: look this far to the right, degrees", 0,
     0},
    {"--tilt", OPTION_NUMBER, "A", "IN is a whole sphere: look this far up", -90, 90},
    {"--picture", OPTION_TEXT, "WxH",
     "IN is a whole sphere: size of the picture; default: 1280x720", 0, 0},
    {"--psf", OPTION_OUTPUT, "OUT",
     "write the eye's pattern: a picture, or a folder with aperture and diagrams as well", 0, 0},
    {"--luminance", OPTION_NUMBER, "L",
     "--psf without IN: luminance that the eye adapts to, cd/m^2; default: 1", 0, 1e9},
    {"--size", OPTION_INT, "N", "texels of the pattern, even; default: 1536", 64, 8192},
    {"--field", OPTION_NUMBER, "DEG", "half field of the pattern at 400 nm; default: 4", 0.1, 20},
    {"--width", OPTION_NUMBER, "MM", "instead of --field: width of the aperture texture", 0.2, 100},
    {"--wavelengths", OPTION_INT, "N", "number of wavelengths; default: 32", 1, 256},
    {"--temperature", OPTION_NUMBER, "K",
     "colour temperature of the light; default: equal-energy white", 1000, 40000},
    {"--planes", OPTION_INT, "N", "depth layers of the vitreous body; default: one", 0, 16},
    {"--without", OPTION_TEXT, "PART", "leave out cornea, fibres, lens, vitreous or lids; repeats",
     0, 0},
    {"--literal", OPTION_FLAG, NULL, "sum wavelengths by the formula as printed in the thesis", 0,
     0},
    {"--retina-distance", OPTION_FLAG, NULL,
     "focus with the thesis' printed d = 24 mm, which blurs", 0, 0},
    {"--no-veil", OPTION_FLAG, NULL, "leave out the faint veil of light beyond the pattern", 0, 0},
    {"--keep-light", OPTION_FLAG, NULL, "keep the picture's brightness when the lids close", 0, 0},
    {"--threshold", OPTION_NUMBER, "L",
     "billboard, hybrid: pixels brighter than this are light sources", 0, 1e9},
    DEVELOP_OPTIONS,
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

static relume_status parse_parts(const struct args *args, unsigned *off)
{
    static const char *const names[] = {"cornea", "fibres", "lens", "vitreous", "lids", NULL};
    *off = 0;
    for (int i = 0; i < args_count(args, "--without"); i++) {
        const char *const name = args_nth(args, "--without", i);
        int part = 0;
        while (names[part] && strcmp(names[part], name))
            part++;
        if (!names[part])
            return unknown_name("--without", name, names);
        *off |= 1u << part;
    }
    return RELUME_OK;
}

static relume_status parse_psf(const struct args *args, struct relume_psf_params *p)
{
    if (args_has(args, "--width") && args_has(args, "--field"))
        return usage_error("glare: expected one of --field, --width");
    *p = (struct relume_psf_params){
        .log = args_log(args),
        .threads = args_threads(args),
        .size = args_int(args, "--size", GLARE_SIZE),
        .width_mm = args_number(args, "--width", 0.0),
        .half_field_deg =
            args_has(args, "--width") ? 0.0 : args_number(args, "--field", GLARE_FIELD_DEG),
        .wavelengths = args_int(args, "--wavelengths", 0),
        .temperature_k = args_number(args, "--temperature", 0.0),
        .planes = args_int(args, "--planes", 0),
        .literal = args_has(args, "--literal"),
        .retina_distance = args_has(args, "--retina-distance"),
    };
    return parse_parts(args, &p->parts_off);
}

// ---------------------------------------------------------------- what is looked at

static relume_status look_around(struct relume_image *frame, const struct args *args)
{
    const struct relume_geometry sphere = {.projection = RELUME_SPHERICAL};
    const double fov = args_number(args, "--fov", 45.0);
    const struct relume_look look = {.pan_deg = args_number(args, "--pan", 0.0),
                                     .tilt_deg = args_number(args, "--tilt", 0.0),
                                     .zoom = 1.0 / tan(0.5 * fov * M_PI / 180.0)};
    struct relume_image whole = *frame;
    int width = 1280, height = 720;
    char rest;
    const char *const size = args_text(args, "--picture", "1280x720");
    *frame = (struct relume_image){0};
    relume_status status = RELUME_OK;
    if (sscanf(size, "%dx%d%c", &width, &height, &rest) != 2 || width < 1 || height < 1 ||
        width > 65536 || height > 65536 || (int64_t)width * height > 1 << 30)
        status =
            usage_error("--picture: expected WIDTHxHEIGHT, at most 2^30 pixels; found '%s'", size);
    if (!status)
        status = relume_image_create(frame, width, height, 3);
    if (!status)
        status = relume_panorama_frame(frame, &sphere, &whole, look,
                                       relume_view_params(.threads = args_threads(args)));
    relume_image_destroy(&whole);
    return status;
}

static relume_status load(struct relume_image *frame, const struct args *args)
{
    const bool sphere =
        args_has(args, "--pan") || args_has(args, "--tilt") || args_has(args, "--picture");
    relume_status status =
        relume_image_load(frame, args_input(args, 0), relume_image_params(.log = args_log(args)));
    if (!status && sphere && frame->width != 2 * frame->height)
        status = data_error("%s: %d x %d pixels; expected a sphere, twice as wide as high, for "
                            "--pan, --tilt and --picture",
                            args_input(args, 0), frame->width, frame->height);
    if (!status && sphere)
        status = look_around(frame, args);
    return status;
}

// ---------------------------------------------------------------- pictures

static relume_status save_one(struct viewer_eye *e, const struct relume_image *frame,
                              const struct args *args, struct developing developing)
{
    const char *const path = args_text(args, "-o", NULL);
    struct relume_image out = {0};
    relume_status status = see(&out, e, frame, false);
    if (!status)
        status = develop(&out, developing, path);
    if (!status)
        status = relume_image_save(&out, path, relume_image_params(.log = args_log(args)));
    relume_image_destroy(&out);
    return status;
}

static bool go_on(const struct args *args, double done)
{
    const struct relume_log *const log = args_log(args);
    return !log->progress || log->progress(log->user, "glare", done);
}

// Picture i of a film: of the loop, or of an eye that lives on.
static relume_status see_next(struct relume_image *out, struct viewer_eye *e,
                              const relume_psf_cycle *cycle, const struct relume_image *frame,
                              int i, double fps)
{
    relume_status status = RELUME_OK;
    if (!cycle) {
        if (i)
            status = relume_eye_advance(e->eye, 1.0 / fps, e->luminance);
        return status ? status : see(out, e, frame, i > 0);
    }
    status = relume_psf_cycle_show(e->psf, cycle, i / fps);
    return status ? status : relume_glare_apply(out, e->glare, frame, i > 0, e->psf, &e->params);
}

static relume_status make_cycle(relume_psf_cycle **cycle, struct viewer_eye *e,
                                const struct args *args, double fps)
{
    const double seconds = args_number(args, "--cycle", 0.0);
    *cycle = NULL;
    return seconds > 0.0 ? relume_psf_cycle_create(
                               cycle, e->psf, e->eye,
                               relume_psf_cycle_params(.log = args_log(args), .seconds = seconds,
                                                       .fps = fps, .luminance = e->luminance))
                         : RELUME_OK;
}

static relume_status save_many(struct viewer_eye *e, const struct relume_image *frame,
                               const struct args *args, struct developing developing)
{
    const int frames = args_int(args, "--frames", 1);
    const double fps = args_number(args, "--fps", 30.0);
    relume_psf_cycle *cycle;
    struct film *film = NULL;
    relume_status status = make_cycle(&cycle, e, args, fps);
    if (!status)
        status = film_open(&film, args_text(args, "-o", NULL), fps, args_log(args));
    for (int i = 0; !status && i < frames; i++) {
        struct relume_image out = {0};
        if (!go_on(args, (double)i / frames))
            status = RELUME_ECANCEL;
        if (!status)
            status = see_next(&out, e, cycle, frame, i, fps);
        if (!status)
            status = develop(&out, developing, film_name(film));
        if (!status)
            status = film_add(film, &out);
        relume_image_destroy(&out);
    }
    relume_psf_cycle_destroy(&cycle);
    const relume_status closed = film_close(&film, !status);
    return status ? status : closed;
}

static relume_status check(const struct args *args)
{
    const char *const out = args_text(args, "-o", NULL);
    if (!out && !args_has(args, "--psf"))
        return usage_error("glare: expected -o OUT, --psf OUT or both");
    if (out && !args_inputs(args))
        return usage_error("glare: expected a picture IN for -o");
    if (out && args_has(args, "--frames") && !film_is(out))
        return usage_error("-o: expected name.%%04d.png, a folder or .mp4 for --frames; found '%s'",
                           out);
    if (!args_has(args, "--frames") && (args_has(args, "--fps") || args_has(args, "--cycle")))
        return usage_error("glare: --fps and --cycle need --frames N");
    if (out && !args_has(args, "--frames") && strchr(out, '%') && film_is(out))
        return usage_error("glare: expected --frames N for '%s'", out);
    const char *const psf = args_text(args, "--psf", NULL);
    relume_status status = RELUME_OK;
    if (out && (!args_has(args, "--frames") || strchr(out, '%')))
        status = picture_name("-o", out);
    if (!status && psf && *name_ending(psf))
        status = picture_name("--psf", psf);
    return status;
}

static relume_status run(const struct args *args)
{
    struct relume_image frame = {0};
    struct relume_psf_params psf;
    struct viewer_eye eye = {0};
    struct developing developing;
    relume_status status = check(args);
    if (!status)
        status = parse_psf(args, &psf);
    if (!status)
        status = parse_developing(args, &developing);
    if (!status && args_inputs(args))
        status = load(&frame, args);
    if (status) {
        relume_image_destroy(&frame);
        return status;
    }
    const double luminance =
        frame.data ? args_number(args, "--nits", 100.0) * relume_glare_luminance(&frame)
                   : args_number(args, "--luminance", 1.0);
    status = open_viewer_eye(&eye, args, luminance, &psf);
    eye.params.fov_deg = args_number(args, "--fov", 0.0);
    eye.params.no_veil = args_has(args, "--no-veil");
    eye.params.keep_light = args_has(args, "--keep-light");
    eye.params.threshold = args_number(args, "--threshold", 0.0);
    if (!status && args_has(args, "--psf"))
        status = save_pattern(&eye, args, args_text(args, "--psf", NULL));
    if (!status && args_has(args, "-o"))
        status = args_has(args, "--frames") ? save_many(&eye, &frame, args, developing)
                                            : save_one(&eye, &frame, args, developing);
    close_viewer_eye(&eye);
    relume_image_destroy(&frame);
    return status;
}

const struct command command_glare = {
    .name = "glare",
    .usage = "[IN] -o OUT [OPTION ...]",
    .summary = "show a picture as a human eye sees it, with halos around bright lights",
    .example = "relume glare candle.exr -o seen.png --fov 20 --magnify 2",
    .min_inputs = 0,
    .max_inputs = 1,
    .options = options,
    .run = run,
};
