// cmd_export.c - relume export: a relume file for other programs
#include "cli.h"
#include "output_name.h"

#include <string.h>
#include <strings.h>

static const struct option options[] = {
    {"-o", OPTION_OUTPUT, "OUT", "the file (.ptm, .rti) or folder to write", 0, 0},
    {"--to", OPTION_TEXT, "FORMAT",
     "relight, ptm, lptm, rti or deepzoom; default: by OUT's ending (.ptm, .lptm, .rti), else "
     "relight",
     0, 0},
    {"--type", OPTION_TEXT, "T", "relight, deepzoom: bilinear, rbf, ptm, lptm, hsh or sh", 0, 0},
    {"--colorspace", OPTION_TEXT, "C",
     "rgb, ycc (ptm, hsh, sh: only the luminance changes with the light) or mycc (bilinear, rbf: "
     "separate planes for luminance and chroma); default: rgb",
     0, 0},
    {"--coefficients", OPTION_INT, "K",
     "planes (bilinear, rbf; default: up to 27) or terms of the type", 1, 45},
    {"--bytes-per-pixel", OPTION_NUMBER, "B",
     "size of all plane JPEGs (ptm, lptm: of the file), not exceeded", 0.001, 100},
    {"--psnr", OPTION_NUMBER, "DB", "at least this PSNR against the original", 1, 100},
    {"--quality", OPTION_INT, "Q",
     "10 less doubles the quantiser step; default: 95 or more, so that no blocks are seen (ptm, "
     "lptm: raw planes)",
     1, 100},
    {"--resolution", OPTION_INT, "R",
     "bilinear: side of the grid of lights; default: 15 to 33, by the lights", 3, 33},
    {"--view", OPTION_INT, "N", "which view of a slab; default: 0", 0, 65535},
    {"--force", OPTION_FLAG, NULL, "replace a folder that relume made", 0, 0},
    ALLOW_OUTSIDE_OPTION,
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

// What an error means for who looks at the pictures.
static const char *judgement(double psnr_db)
{
    return psnr_db >= 45.0   ? "not visible"
           : psnr_db >= 38.0 ? "hardly visible"
           : psnr_db >= 30.0 ? "visible"
                             : "clearly visible";
}

static void say_result(const struct args *args, const struct relume_export_report *r)
{
    const char *out = args_text(args, "-o", NULL);
    char text[512], quality[64] = "";
    if (r->quality)
        snprintf(quality, sizeof quality, "quality %d%s, ", r->quality,
                 args_has(args, "--quality") ? "" : " (chosen)");
    if (r->exact)
        snprintf(text, sizeof text, "%s: %d planes, copied unchanged: nothing is lost", out,
                 r->planes);
    else
        snprintf(text, sizeof text,
                 "%s: %s%d planes, %.3f bytes per pixel; the export differs from the original by "
                 "%.2f dB (%s)",
                 out, quality, r->planes, r->bytes_per_pixel, r->psnr_db, judgement(r->psnr_db));
    args_log(args)->message(args_log(args)->user, RELUME_NOTE, text);
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
static relume_status choose_format(enum relume_exchange *format, const struct args *args)
{
    static const char *const formats[] = {"relight", "ptm", "lptm", "rti", "deepzoom", NULL};
    const char *out = args_text(args, "-o", NULL), *ending = name_ending(out);
    const char *said = format_of_ending(ending);
    const char *to = args_text(args, "--to", said ? said : "relight");
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

static relume_status parse(const struct args *args, enum relume_exchange *format,
                           struct relume_export_params *p)
{
    static const char *const types[] = {"bilinear", "rbf", "ptm", "lptm", "hsh", "sh", NULL};
    static const char *const spaces[] = {"rgb", "ycc", "mycc", NULL};
    const char *type = args_text(args, "--type", NULL);
    const char *space = args_text(args, "--colorspace", "rgb");
    if (!args_has(args, "-o"))
        return usage_error("export: expected -o OUT");
    const relume_status status = choose_format(format, args);
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
    static const char *const only_folders[] = {"--type", "--colorspace", "--resolution"};
    static const char *const jpeg[] = {"--quality", "--bytes-per-pixel", "--psnr"};
    for (int i = 0; !folder && i < 3; i++)
        if (args_has(args, only_folders[i]))
            return usage_error("%s: works only with --to relight and deepzoom", only_folders[i]);
    if ((*format == RELUME_EXCHANGE_PTM || *format == RELUME_EXCHANGE_LPTM) &&
        args_has(args, "--coefficients"))
        return usage_error(
            "--coefficients: .ptm always has 6; leave it out, or choose another --to");
    for (int i = 0; *format == RELUME_EXCHANGE_RTI && i < 3; i++)
        if (args_has(args, jpeg[i]))
            return usage_error("%s: .rti cannot hold JPEG; use --to ptm or lptm", jpeg[i]);
    if (args_has(args, "--bytes-per-pixel") + args_has(args, "--psnr") +
            args_has(args, "--quality") >
        1)
        return usage_error("export: expected one of --bytes-per-pixel, --psnr and --quality");
    return RELUME_OK;
}

static relume_status run(const struct args *args)
{
    enum relume_exchange format;
    struct relume_export_params p = {
        .log = args_log(args),
        .view = args_int(args, "--view", 0),
        .coefficients = args_int(args, "--coefficients", 0),
        .resolution = args_int(args, "--resolution", 0),
        .bytes_per_pixel = args_number(args, "--bytes-per-pixel", 0.0),
        .psnr_db = args_number(args, "--psnr", 0.0),
        .quality = args_int(args, "--quality", 0),
        .force = args_has(args, "--force"),
        .threads = args_threads(args),
    };
    relume_status status = parse(args, &format, &p);
    if (status)
        return status;
    relume_pack *pack;
    struct relume_export_report report;
    status = relume_open(&pack, args_input(args, 0),
                         relume_open_params(.log = p.log, .threads = p.threads,
                                            .allow_outside = args_has(args, "--allow-outside")));
    if (!status)
        status = relume_export(pack, args_text(args, "-o", NULL), format, &report, &p);
    relume_pack_destroy(&pack);
    if (!status)
        say_result(args, &report);
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
    .run = run,
};
