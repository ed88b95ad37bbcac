#include "cli.h"

#include <math.h>
#include <string.h>

static const struct option options[] = {
    {"-o", OPTION_TEXT, "OUT", "picture to write: .exr (linear), .png, ...", 0, 0},
    {"--fov", OPTION_NUMBER, "DEG", "horizontal field of view of the picture; default: 45", 0.01,
     170},
    {"--time", OPTION_NUMBER, "T", "seconds since the eye opened; default: 0", 0, 1e6},
    {"--subject", OPTION_TEXT, "FILE", "a person's measures (JSON, docs/glare.md)", 0, 0},
    {"--border", OPTION_TEXT, "B", "zero (default), clamp or periodic", 0, 0},
    {"--magnify", OPTION_NUMBER, "M", "enlarge the pattern against the picture; default: 1", 0.01,
     1000},
    {"--nits", OPTION_NUMBER, "L", "cd/m^2 of the value 1, for the pupil; default: 100", 0, 1e9},
    {"--size", OPTION_INT, "N", "texels of the pattern, even; default: 1536", 64, 8192},
    {"--field", OPTION_NUMBER, "DEG", "half field of the pattern at 400 nm; default: 3.6", 0.1, 20},
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

static relume_status run(const struct args *args)
{
    const struct relume_log *const log = args_log(args);
    struct relume_subject subject = relume_subject_default();
    struct relume_image frame = {0}, out = {0};
    relume_eye *eye = NULL;
    relume_psf *psf = NULL;
    relume_glare *glare = NULL;
    enum relume_glare_border border;
    const char *const border_name = args_text(args, "--border", "zero");
    if (!args_has(args, "-o"))
        return usage_error("glare: expected -o OUT");
    if (relume_glare_border_parse(&border, border_name))
        return unknown_name("--border", border_name, relume_glare_border_names());
    relume_status status = RELUME_OK;
    if (args_has(args, "--subject"))
        status = relume_subject_load(&subject, args_text(args, "--subject", NULL), log);
    if (!status)
        status = relume_image_load(&frame, args_input(args, 0), relume_image_params(.log = log));
    const double nits = args_number(args, "--nits", 100.0);
    const double luminance = status ? 0.0 : nits * relume_glare_luminance(&frame);
    if (!status)
        status = relume_eye_create(&eye, &subject, luminance);
    if (!status)
        status = relume_eye_advance(eye, args_number(args, "--time", 0.0), luminance);
    if (!status)
        status = relume_psf_create(
            &psf, relume_psf_params(.log = log, .threads = args_threads(args),
                                    .size = args_int(args, "--size", 1536),
                                    .half_field_deg = args_number(args, "--field", 3.6)));
    if (!status)
        status = relume_psf_update(psf, eye);
    if (!status)
        status = relume_glare_create(&glare);
    if (!status)
        status = relume_glare_apply(
            &out, glare, &frame, false, psf,
            relume_glare_params(.log = log, .threads = args_threads(args), .border = border,
                                .fov_deg = args_number(args, "--fov", 0.0),
                                .magnify = args_number(args, "--magnify", 0.0)));
    if (!status)
        status =
            relume_image_save(&out, args_text(args, "-o", NULL), relume_image_params(.log = log));
    relume_glare_destroy(&glare);
    relume_psf_destroy(&psf);
    relume_eye_destroy(&eye);
    relume_image_destroy(&frame);
    relume_image_destroy(&out);
    return status;
}

const struct command command_glare = {
    .name = "glare",
    .usage = "IN -o OUT [OPTION ...]",
    .summary = "a picture as a living eye would see it",
    .example = "relume glare candle.exr -o seen.png --fov 20 --magnify 2",
    .min_inputs = 1,
    .max_inputs = 1,
    .options = options,
    .run = run,
};
