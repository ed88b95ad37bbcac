// cmd_glare.c - relume glare: a picture as a human eye sees it
#include "cli/commands/glare_pattern.h"
#include "cli/develop.h"
#include "cli/glare_options.h"
#include "cli/program/film.h"

#include <math.h>
#include <string.h>

struct glare_options {
    struct args args;
    const char *output, *psf;
    double fov, fps, cycle, pan, tilt, luminance, field, width, temperature, threshold;
    int frames, picture[2], size, wavelengths, planes;
    unsigned without;  // a bit for each part of the eye
    bool literal, retina_distance, no_veil, keep_light;
    struct eye_options glare;
    struct develop_options develop;
};
#define OPTIONS struct glare_options

static relume_status take_part(void *without, const struct option *o, const char *text,
                               const struct relume_log *log)
{
    static const char *const names[] = {"cornea", "fibres", "lens", "vitreous", "lids", NULL};
    for (int part = 0; names[part]; part++)
        if (!strcmp(names[part], text)) {
            *(unsigned *)without |= 1u << part;
            return RELUME_OK;
        }
    return unknown_word(log, o->name, text, names);
}

static const struct option options[] = {
    GROUP("output"),
    TEXT_AS(OPTION_OUTPUT, "-o", output, "OUT",
            "picture to write: .exr (linear), .png, ...; with --frames: name.%04d.png, a folder or "
            ".mp4"),
    GROUP("camera"),
    NUMBER("--fov", fov, "DEG", "horizontal field of view of the picture; default: 45", 0.01, 170),
    NUMBER("--pan", pan, "A", "IN is a whole sphere: look this many degrees to the right", 0, 0),
    NUMBER("--tilt", tilt, "A", "IN is a whole sphere: look this many degrees up", -90, 90),
    GROUP("glare"),
    GLARE_OPTIONS,
    GROUP("glare pattern"),
    INT("--frames", frames, "N", "number of pictures, starting at --time", 1, 1000000),
    NUMBER("--fps", fps, "F", "pictures a second; default: 30", 0.1, 1000),
    NUMBER("--cycle", cycle, "S",
           "--frames: compute S seconds of the eye and repeat them as a seamless loop", 0.1, 120),
    TEXT_AS(OPTION_OUTPUT, "--psf", psf, "OUT",
            "write the eye's pattern: a picture, or a folder with aperture and diagrams as well"),
    NUMBER("--luminance", luminance, "L",
           "--psf without IN: luminance that the eye adapts to, cd/m^2; default: 1", 0, 1e9),
    INT("--size", size, "N", "texels of the pattern, even; default: 1536", 64, 8192),
    NUMBER("--field", field, "DEG", "half field of the pattern at 400 nm; default: 4", 0.1, 20),
    NUMBER("--width", width, "MM", "instead of --field: width of the aperture texture", 0.2, 100),
    INT("--wavelengths", wavelengths, "N", "number of wavelengths; default: 32", 1, 256),
    NUMBER("--temperature", temperature, "K",
           "colour temperature of the light; default: equal-energy white", 1000, 40000),
    INT("--planes", planes, "N", "depth layers of the vitreous body; default: one", 0, 16),
    OWN("--without", without, "PART", "leave out cornea, fibres, lens, vitreous or lids; repeats",
        take_part),
    FLAG("--literal", literal, "sum wavelengths by the formula as printed in the thesis"),
    FLAG("--retina-distance", retina_distance,
         "focus with the thesis' printed d = 24 mm, which blurs"),
    FLAG("--no-veil", no_veil, "leave out the faint veil of light beyond the pattern"),
    FLAG("--keep-light", keep_light, "keep the picture's brightness when the lids close"),
    NUMBER("--threshold", threshold, "L",
           "billboard, hybrid: pixels brighter than this are light sources", 0, 1e9),
    GROUP("picture"),
    SIZE("--picture", picture, "WxH",
         "IN is a whole sphere: size of the picture; default: 1280x720", 1, 65536),
    DEVELOP_OPTIONS,
    {0},
};

static struct relume_psf_params psf_params(const struct glare_options *o)
{
    return (struct relume_psf_params){
        .log = o->args.log,
        .threads = o->args.threads,
        .size = o->size,
        .width_mm = o->width,
        .half_field_deg = given(o, &o->width) ? 0.0 : o->field,
        .wavelengths = o->wavelengths,
        .temperature_k = o->temperature,
        .planes = o->planes,
        .parts_off = o->without,
        .literal = o->literal,
        .retina_distance = o->retina_distance,
    };
}

// ---------------------------------------------------------------- what is looked at

static relume_status look_around(struct relume_image *frame, const struct glare_options *o)
{
    const struct relume_geometry sphere = {.projection = RELUME_SPHERICAL};
    const double fov = o->fov > 0.0 ? o->fov : 45.0;
    const struct relume_pan_tilt look = {
        .pan_deg = o->pan, .tilt_deg = o->tilt, .zoom = 1.0 / tan(0.5 * fov * M_PI / 180.0)};
    struct relume_image whole = *frame;
    *frame = (struct relume_image){0};
    relume_status status = relume_image_create(frame, o->picture[0], o->picture[1], 3);
    if (!status)
        status = relume_panorama_frame(frame, &sphere, &whole, look,
                                       relume_view_params(.threads = o->args.threads));
    relume_image_destroy(&whole);
    return status;
}

static relume_status load(struct relume_image *frame, const struct glare_options *o)
{
    const bool sphere = given(o, &o->pan) || given(o, &o->tilt) || given(o, &o->picture);
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
                              const struct glare_options *o)
{
    struct relume_image out = {0};
    relume_status status = see(&out, e, frame, false);
    if (!status)
        status = develop(&out, &o->develop, o->output);
    if (!status)
        status = save_developed(&out, &o->develop, o->output, &o->args);
    relume_image_destroy(&out);
    return status;
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

static relume_status save_many(struct viewer_eye *e, const struct relume_image *frame,
                               const struct glare_options *o)
{
    const struct relume_log *const log = o->args.log;
    relume_psf_cycle *cycle = NULL;
    struct film *film = NULL;
    relume_status status = RELUME_OK;
    if (o->cycle > 0.0)
        status = relume_psf_cycle_create(&cycle, e->psf, e->eye,
                                         relume_psf_cycle_params(.log = log, .seconds = o->cycle,
                                                                 .fps = o->fps,
                                                                 .luminance = e->luminance));
    if (!status)
        status = film_open(&film, o->output, o->fps, true, log);
    for (int i = 0; !status && i < o->frames; i++) {
        struct relume_image out = {0};
        if (!log->progress(log->user, "glare", (double)i / o->frames))
            status = RELUME_ECANCEL;
        if (!status)
            status = see_next(&out, e, cycle, frame, i, o->fps);
        if (!status)
            status = develop(&out, &o->develop, film_name(film));
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
    const char *const out = o->output, *const psf = o->psf;
    const bool many = given(o, &o->frames);
    if (!out && !psf)
        return usage_error("glare: expected -o OUT, --psf OUT or both");
    if (out && !o->args.inputs)
        return usage_error("glare: expected a picture IN for -o");
    if (out && many && !film_is(out))
        return usage_error("-o: expected name.%%04d.png, a folder or .mp4 for --frames; found '%s'",
                           out);
    if (!many && (given(o, &o->fps) || given(o, &o->cycle)))
        return usage_error("glare: --fps and --cycle need --frames N");
    if (out && !many && strchr(out, '%') && film_is(out))
        return usage_error("glare: expected --frames N for '%s'", out);
    if (many && (o->develop.icc || o->develop.bits))
        return usage_error("--icc and --bits are of single pictures; expected without --frames");
    if (given(o, &o->width) && given(o, &o->field))
        return usage_error("glare: expected one of --field, --width");
    relume_status status = RELUME_OK;
    if (out && (!many || strchr(out, '%')))
        status = picture_name(o->args.log, "-o", out);
    if (!status && out)
        status = check_bits(&o->develop, out);
    if (!status && psf && *name_ending(psf))
        status = picture_name(o->args.log, "--psf", psf);
    return status;
}

static relume_status run_glare(const struct args *args)
{
    const struct glare_options *o = (const void *)args;
    const struct relume_psf_params psf = psf_params(o);
    struct relume_image frame = {0};
    struct viewer_eye eye = {0};
    relume_status status = check(o);
    if (!status && args->inputs)
        status = load(&frame, o);
    const double luminance =
        frame.data ? o->glare.nits * relume_glare_luminance(&frame) : o->luminance;
    if (!status)
        status = open_viewer_eye(&eye, args, &o->glare, luminance, &psf);
    eye.params.fov_deg = o->fov;
    eye.params.no_veil = o->no_veil;
    eye.params.keep_light = o->keep_light;
    eye.params.threshold = o->threshold;
    if (!status && o->psf)
        status = save_pattern(&eye, args, o->psf);
    if (!status && o->output)
        status = (given(o, &o->frames) ? save_many : save_one)(&eye, &frame, o);
    close_viewer_eye(&eye);
    relume_image_destroy(&frame);
    return status;
}

const struct command command_glare = {
    COMMAND(run_glare, "glare", "[IN] -o OUT [OPTION ...]",
            "show a picture as a human eye sees it, with halos around bright lights",
            "relume glare candle.exr -o seen.png --fov 20 --magnify 2", 0, 1),
    .defaults = &(const OPTIONS){.picture = {1280, 720},
                                 .size = GLARE_SIZE,
                                 .field = GLARE_FIELD_DEG,
                                 .frames = 1,
                                 .fps = 30.0,
                                 .luminance = 1.0,
                                 .glare = GLARE_DEFAULTS},
};
