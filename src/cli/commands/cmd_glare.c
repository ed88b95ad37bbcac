// cmd_glare.c - relume glare: a picture as a human eye sees it
#include "cli.h"
#include "commands/glare_pattern.h"
#include "develop.h"
#include "glare_options.h"
#include "output_name.h"
#include "program/film.h"

#include <math.h>
#include <string.h>

struct glare_options {
    struct args args;
    const char *output, *picture, *psf;
    double fov, fps, cycle, pan, tilt, luminance, field, width, temperature, threshold;
    int frames, size, wavelengths, planes;
    struct texts without;
    bool literal, retina_distance, no_veil, keep_light;
    struct eye_options glare;
    struct develop_options develop;
};
#define OPTIONS struct glare_options

static const struct option options[] = {
    TEXT_AS(OPTION_OUTPUT, "-o", output, "output", "OUT",
            "picture to write: .exr (linear), .png, ...; with --frames: name.%04d.png, a folder or "
            ".mp4"),
    NUMBER("--fov", fov, "camera", "DEG", "horizontal field of view of the picture; default: 45",
           0.01, 170),
    GLARE_OPTIONS,
    INT("--frames", frames, "glare pattern", "N", "number of pictures, starting at --time", 1,
        1000000),
    NUMBER("--fps", fps, "glare pattern", "F", "pictures a second; default: 30", 0.1, 1000),
    NUMBER("--cycle", cycle, "glare pattern", "S",
           "--frames: compute S seconds and repeat them as a seamless loop", 0.1, 120),
    NUMBER("--pan", pan, "camera", "A", "IN is a whole sphere: look this far to the right, degrees",
           0, 0),
    NUMBER("--tilt", tilt, "camera", "A", "IN is a whole sphere: look this far up", -90, 90),
    TEXT("--picture", picture, "picture", "WxH",
         "IN is a whole sphere: size of the picture; default: 1280x720"),
    TEXT_AS(OPTION_OUTPUT, "--psf", psf, "glare pattern", "OUT",
            "write the eye's pattern: a picture, or a folder with aperture and diagrams as well"),
    NUMBER("--luminance", luminance, "glare pattern", "L",
           "--psf without IN: luminance that the eye adapts to, cd/m^2; default: 1", 0, 1e9),
    INT("--size", size, "glare pattern", "N", "texels of the pattern, even; default: 1536", 64,
        8192),
    NUMBER("--field", field, "glare pattern", "DEG",
           "half field of the pattern at 400 nm; default: 4", 0.1, 20),
    NUMBER("--width", width, "glare pattern", "MM",
           "instead of --field: width of the aperture texture", 0.2, 100),
    INT("--wavelengths", wavelengths, "glare pattern", "N", "number of wavelengths; default: 32", 1,
        256),
    NUMBER("--temperature", temperature, "glare pattern", "K",
           "colour temperature of the light; default: equal-energy white", 1000, 40000),
    INT("--planes", planes, "glare pattern", "N", "depth layers of the vitreous body; default: one",
        0, 16),
    TEXTS("--without", without, "glare pattern", "PART",
          "leave out cornea, fibres, lens, vitreous or lids; repeats"),
    FLAG("--literal", literal, "glare pattern",
         "sum wavelengths by the formula as printed in the thesis"),
    FLAG("--retina-distance", retina_distance, "glare pattern",
         "focus with the thesis' printed d = 24 mm, which blurs"),
    FLAG("--no-veil", no_veil, "glare pattern",
         "leave out the faint veil of light beyond the pattern"),
    FLAG("--keep-light", keep_light, "glare pattern",
         "keep the picture's brightness when the lids close"),
    NUMBER("--threshold", threshold, "glare pattern", "L",
           "billboard, hybrid: pixels brighter than this are light sources", 0, 1e9),
    DEVELOP_OPTIONS,
    {0},
};

static relume_status parse_parts(const struct glare_options *o, unsigned *off)
{
    static const char *const names[] = {"cornea", "fibres", "lens", "vitreous", "lids", NULL};
    *off = 0;
    for (int i = 0; i < o->without.count; i++) {
        const char *const name = o->without.text[i];
        int part = 0;
        while (names[part] && strcmp(names[part], name))
            part++;
        if (!names[part])
            return unknown_name("--without", name, names);
        *off |= 1u << part;
    }
    return RELUME_OK;
}

static relume_status parse_psf(const struct glare_options *o, struct relume_psf_params *p)
{
    if (args_given(&o->args, &o->width) && args_given(&o->args, &o->field))
        return usage_error("glare: expected one of --field, --width");
    *p = (struct relume_psf_params){
        .log = o->args.log,
        .threads = o->args.threads,
        .size = o->size,
        .width_mm = o->width,
        .half_field_deg = args_given(&o->args, &o->width) ? 0.0 : o->field,
        .wavelengths = o->wavelengths,
        .temperature_k = o->temperature,
        .planes = o->planes,
        .literal = o->literal,
        .retina_distance = o->retina_distance,
    };
    return parse_parts(o, &p->parts_off);
}

// ---------------------------------------------------------------- what is looked at

static relume_status look_around(struct relume_image *frame, const struct glare_options *o)
{
    const struct relume_geometry sphere = {.projection = RELUME_SPHERICAL};
    const double fov = o->fov > 0.0 ? o->fov : 45.0;
    const struct relume_pan_tilt look = {
        .pan_deg = o->pan, .tilt_deg = o->tilt, .zoom = 1.0 / tan(0.5 * fov * M_PI / 180.0)};
    struct relume_image whole = *frame;
    int width = 1280, height = 720;
    char rest;
    const char *const size = o->picture ? o->picture : "1280x720";
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
                                       relume_view_params(.threads = o->args.threads));
    relume_image_destroy(&whole);
    return status;
}

static relume_status load(struct relume_image *frame, const struct glare_options *o)
{
    const bool sphere =
        args_given(&o->args, &o->pan) || args_given(&o->args, &o->tilt) || o->picture;
    relume_status status =
        relume_image_load(frame, o->args.input[0], relume_image_params(.log = o->args.log));
    if (!status && sphere && frame->width != 2 * frame->height)
        status = data_error("%s: %d x %d pixels; expected a sphere, twice as wide as high, for "
                            "--pan, --tilt and --picture",
                            o->args.input[0], frame->width, frame->height);
    if (!status && sphere)
        status = look_around(frame, o);
    return status;
}

// ---------------------------------------------------------------- pictures

static relume_status save_one(struct viewer_eye *e, const struct relume_image *frame,
                              const struct glare_options *o, struct developing developing)
{
    const char *const path = o->output;
    struct relume_image out = {0};
    relume_status status = see(&out, e, frame, false);
    if (!status)
        status = develop(&out, developing, path);
    if (!status)
        status = relume_image_save(&out, path, relume_image_params(.log = o->args.log));
    relume_image_destroy(&out);
    return status;
}

static bool go_on(const struct glare_options *o, double done)
{
    const struct relume_log *const log = o->args.log;
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
                                const struct glare_options *o, double fps)
{
    const double seconds = o->cycle;
    *cycle = NULL;
    return seconds > 0.0 ? relume_psf_cycle_create(
                               cycle, e->psf, e->eye,
                               relume_psf_cycle_params(.log = o->args.log, .seconds = seconds,
                                                       .fps = fps, .luminance = e->luminance))
                         : RELUME_OK;
}

static relume_status save_many(struct viewer_eye *e, const struct relume_image *frame,
                               const struct glare_options *o, struct developing developing)
{
    const int frames = o->frames;
    const double fps = o->fps;
    relume_psf_cycle *cycle;
    struct film *film = NULL;
    relume_status status = make_cycle(&cycle, e, o, fps);
    if (!status)
        status = film_open(&film, o->output, fps, true, o->args.log);
    for (int i = 0; !status && i < frames; i++) {
        struct relume_image out = {0};
        if (!go_on(o, (double)i / frames))
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

static relume_status check(const struct glare_options *o)
{
    const char *const out = o->output;
    if (!out && !o->psf)
        return usage_error("glare: expected -o OUT, --psf OUT or both");
    if (out && !o->args.inputs)
        return usage_error("glare: expected a picture IN for -o");
    if (out && args_given(&o->args, &o->frames) && !film_is(out))
        return usage_error("-o: expected name.%%04d.png, a folder or .mp4 for --frames; found '%s'",
                           out);
    if (!args_given(&o->args, &o->frames) &&
        (args_given(&o->args, &o->fps) || args_given(&o->args, &o->cycle)))
        return usage_error("glare: --fps and --cycle need --frames N");
    if (out && !args_given(&o->args, &o->frames) && strchr(out, '%') && film_is(out))
        return usage_error("glare: expected --frames N for '%s'", out);
    const char *const psf = o->psf;
    relume_status status = RELUME_OK;
    if (out && (!args_given(&o->args, &o->frames) || strchr(out, '%')))
        status = picture_name("-o", out);
    if (!status && psf && *name_ending(psf))
        status = picture_name("--psf", psf);
    return status;
}

static relume_status run(const struct args *args)
{
    const struct glare_options *o = (const void *)args;
    struct relume_image frame = {0};
    struct relume_psf_params psf;
    struct viewer_eye eye = {0};
    struct developing developing;
    relume_status status = check(o);
    if (!status)
        status = parse_psf(o, &psf);
    if (!status)
        status = parse_developing(&o->develop, &developing);
    if (!status && o->args.inputs)
        status = load(&frame, o);
    if (status) {
        relume_image_destroy(&frame);
        return status;
    }
    const double luminance =
        frame.data ? o->glare.nits * relume_glare_luminance(&frame) : o->luminance;
    status = open_viewer_eye(&eye, args, &o->glare, luminance, &psf);
    eye.params.fov_deg = o->fov;
    eye.params.no_veil = o->no_veil;
    eye.params.keep_light = o->keep_light;
    eye.params.threshold = o->threshold;
    if (!status && o->psf)
        status = save_pattern(&eye, args, o->psf);
    if (!status && o->output)
        status = args_given(&o->args, &o->frames) ? save_many(&eye, &frame, o, developing)
                                                  : save_one(&eye, &frame, o, developing);
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
    .size = sizeof(struct glare_options),
    .defaults = &(const struct glare_options){.size = GLARE_SIZE,
                                              .field = GLARE_FIELD_DEG,
                                              .frames = 1,
                                              .fps = 30.0,
                                              .luminance = 1.0,
                                              .glare = GLARE_DEFAULTS},
    .run = run,
};
