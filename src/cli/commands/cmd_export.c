// cmd_export.c - relume export: a relume file for other programs
#include "cli.h"
#include "output_name.h"

#include <string.h>
#include <strings.h>

struct export_options {
    struct args args;
    const char *output, *to, *type, *colorspace;
    int coefficients, quality, resolution, view;
    double bytes_per_pixel, psnr;
    bool force;
    bool allow_outside;
};
#define OPTIONS struct export_options

static const struct option options[] = {
    TEXT_AS(OPTION_OUTPUT, "-o", output, "output", "OUT",
            "the file (.ptm, .rti) or folder to write"),
    TEXT("--to", to, "model", "FORMAT",
         "relight, ptm, lptm, rti or deepzoom; default: by OUT's ending (.ptm, .lptm, .rti), else "
         "relight"),
    TEXT("--type", type, "model", "T", "relight, deepzoom: bilinear, rbf, ptm, lptm, hsh or sh"),
    TEXT("--colorspace", colorspace, "model", "C",
         "rgb, ycc (ptm, hsh, sh: only the luminance changes with the light) or mycc (bilinear, "
         "rbf: separate planes for luminance and chroma); default: rgb"),
    INT("--coefficients", coefficients, "model", "K",
        "planes (bilinear, rbf; default: up to 27) or terms of the type", 1, 45),
    NUMBER("--bytes-per-pixel", bytes_per_pixel, "model", "B",
           "size of all plane JPEGs (ptm, lptm: of the file), not exceeded", 0.001, 100),
    NUMBER("--psnr", psnr, "model", "DB", "at least this PSNR against the original", 1, 100),
    INT("--quality", quality, "model", "Q",
        "10 less doubles the quantiser step; default: 95 or more, so that no blocks are seen (ptm, "
        "lptm: raw planes)",
        1, 100),
    INT("--resolution", resolution, "model", "R",
        "bilinear: side of the grid of lights; default: 15 to 33, by the lights", 3, 33),
    INT("--view", view, "input", "N", "which view of a slab; default: 0", 0, 65535),
    FLAG("--force", force, "output", "replace a folder that relume made"),
    ALLOW_OUTSIDE_OPTION,
    {0},
};

static void say_result(const struct export_options *o, const struct relume_export_report *r)
{
    const char *out = o->output;
    char quality[64] = "";
    if (r->quality)
        snprintf(quality, sizeof quality, "quality %d%s, ", r->quality,
                 args_given(&o->args, &o->quality) ? "" : " (chosen)");
    if (r->exact)
        say(&o->args, RELUME_NOTE, "%s: %d plane%s, copied unchanged: nothing is lost", out,
            r->planes, relume_plural(r->planes));
    else
        say(&o->args, RELUME_NOTE,
            "%s: %s%d plane%s, %.3f bytes per pixel; the export differs from the original by "
            "%.2f dB (%s)",
            out, quality, r->planes, relume_plural(r->planes), r->bytes_per_pixel, r->psnr_db,
            judgement(r->psnr_db));
}

// What a name's ending means; NULL: nothing, or nothing that export writes.
static const char *format_of_ending(const char *ending)
{
    static const char *const formats[] = {"ptm", "lptm", "rti"};
    for (size_t i = 0; *ending && i < sizeof formats / sizeof *formats; i++)
        if (!strcasecmp(ending + 1, formats[i]))
            return formats[i];
    return NULL;
}

// Files of the field that a folder should not be called by.
static bool is_no_folder(const char *ending)
{
    static const char *const others[] = {".hsh", ".json", ".dzi", ".lp", ".zip"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (!strcasecmp(ending, others[i]))
            return true;
    return false;
}

// --to, or what the ending of OUT says; both must not contradict each other.
static relume_status choose_format(enum relume_exchange *format, const struct export_options *o)
{
    static const char *const formats[] = {"relight", "ptm", "lptm", "rti", "deepzoom", NULL};
    const char *out = o->output, *ending = name_ending(out);
    const char *said = format_of_ending(ending);
    const char *to = o->to ? o->to : said ? said : "relight";
    if (*ending && relume_image_can_save(out))
        return usage_error(
            "-o: %s: export writes no pictures; expected .ptm, .rti or the name of a "
            "folder ('relume relight' writes pictures)",
            out);
    if (is_no_folder(ending))
        return usage_error(
            "-o: %s: export cannot write this ending; expected .ptm, .rti or the name of a folder",
            out);
    if (relume_exchange_parse(format, to))
        return unknown_name("--to", to, formats);
    if (said && strcmp(said, to) && (strcmp(said, "ptm") || strcmp(to, "lptm")))
        return usage_error("-o: %s: --to %s writes %s; expected another name, or --to %s", out, to,
                           strstr(to, "ptm")   ? "a .ptm file"
                           : strcmp(to, "rti") ? "a folder"
                                               : "an .rti file",
                           said);
    return RELUME_OK;
}

static relume_status parse(const struct export_options *o, enum relume_exchange *format,
                           struct relume_export_params *p)
{
    static const char *const types[] = {"bilinear", "rbf", "ptm", "lptm", "hsh", "sh", NULL};
    static const char *const spaces[] = {"rgb", "ycc", "mycc", NULL};
    const char *type = o->type;
    const char *space = o->colorspace ? o->colorspace : "rgb";
    if (!o->output)
        return usage_error("export: expected -o OUT");
    const relume_status status = choose_format(format, o);
    if (status)
        return status;
    if (type && relume_web_type_parse(&p->type, type))
        return unknown_name("--type", type, types);
    if (strcmp(space, "rgb") && strcmp(space, "ycc") && strcmp(space, "mycc"))
        return unknown_name("--colorspace", space, spaces);
    p->ycc = strcmp(space, "rgb");
    if (!strcmp(space, "mycc") && p->type > RELUME_WEB_RBF)
        return usage_error("--colorspace mycc: works only with --type bilinear and rbf");
    const bool folder = *format == RELUME_EXCHANGE_RELIGHT || *format == RELUME_EXCHANGE_DEEPZOOM;
    const char *only_folders = o->type                                ? "--type"
                               : o->colorspace                        ? "--colorspace"
                               : args_given(&o->args, &o->resolution) ? "--resolution"
                                                                      : NULL;
    const char *jpeg = args_given(&o->args, &o->quality)           ? "--quality"
                       : args_given(&o->args, &o->bytes_per_pixel) ? "--bytes-per-pixel"
                       : args_given(&o->args, &o->psnr)            ? "--psnr"
                                                                   : NULL;
    if (!folder && only_folders)
        return usage_error("%s: works only with --to relight and deepzoom", only_folders);
    if ((*format == RELUME_EXCHANGE_PTM || *format == RELUME_EXCHANGE_LPTM) &&
        args_given(&o->args, &o->coefficients))
        return usage_error(
            "--coefficients: .ptm always has 6; leave it out, or choose another --to");
    if (*format == RELUME_EXCHANGE_RTI && jpeg)
        return usage_error("%s: .rti cannot hold JPEG; use --to ptm or lptm", jpeg);
    if (args_given(&o->args, &o->bytes_per_pixel) + args_given(&o->args, &o->psnr) +
            args_given(&o->args, &o->quality) >
        1)
        return usage_error("export: expected one of --bytes-per-pixel, --psnr and --quality");
    return RELUME_OK;
}

static relume_status run(const struct args *args)
{
    const struct export_options *o = (const void *)args;
    enum relume_exchange format;
    struct relume_export_params p = {
        .log = o->args.log,
        .view = o->view,
        .coefficients = o->coefficients,
        .resolution = o->resolution,
        .bytes_per_pixel = o->bytes_per_pixel,
        .psnr_db = o->psnr,
        .quality = o->quality,
        .force = o->force,
        .threads = o->args.threads,
    };
    relume_status status = parse(o, &format, &p);
    if (status)
        return status;
    relume_pack *pack;
    struct relume_export_report report;
    status = relume_open(
        &pack, o->args.input[0],
        relume_open_params(.log = p.log, .threads = p.threads, .allow_outside = o->allow_outside));
    if (!status)
        status = relume_export(pack, o->output, format, &report, &p);
    relume_pack_destroy(&pack);
    if (!status)
        say_result(o, &report);
    return status;
}

const struct command command_export = {
    .name = "export",
    .usage = "FILE -o OUT [OPTION ...]",
    .summary = "write a relume file as .ptm, .rti or a folder that web viewers show",
    .example = "relume export statue.exr --to relight -o web/statue --bytes-per-pixel 1",
    .min_inputs = 1,
    .max_inputs = 1,
    .options = options,
    .size = sizeof(struct export_options),
    .run = run,
};
