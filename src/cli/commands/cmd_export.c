// cmd_export.c - relume export: a relume file for other programs
#include "cli/cli.h"

#include <string.h>
#include <strings.h>

struct export_options {
    struct args args;
    const char *output;
    enum relume_exchange to;
    enum relume_web_type type;
    enum { RGB, YCC, MYCC } colorspace;
    int coefficients, quality, resolution, view, level;
    double bytes_per_pixel, psnr;
    bool force, allow_outside, keep_going;
};
#define OPTIONS struct export_options
#define FORMATS "relight", "ptm", "lptm", "rti", "deepzoom", "bc1", "bc7", "bc6h", "olat"

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "OUT", "the file (.ptm, .rti) or folder to write"),
    FLAG("--force", force, "replace a folder that relume made"),
    GROUP("model"),
    NAME("--to", to, "FORMAT",
         "relight, ptm, lptm, rti, deepzoom, or bc1, bc7, bc6h: eigenimages as DDS textures with a "
         "shader, or olat: one EXR with a layer for every light, for compositors; "
         "default: by OUT's ending (.ptm, .lptm, .rti), else relight",
         RELUME_EXCHANGE_RELIGHT, FORMATS),
    NAME("--type", type, "T", "relight, deepzoom: bilinear, rbf, ptm, lptm, hsh or sh",
         RELUME_WEB_BILINEAR, "bilinear", "rbf", "ptm", "lptm", "hsh", "sh"),
    NAME("--colorspace", colorspace, "C",
         "rgb, ycc (ptm, hsh, sh: only the luminance changes with the light) or mycc (bilinear, "
         "rbf: separate planes for luminance and chroma); default: rgb",
         RGB, "rgb", "ycc", "mycc"),
    INT("--coefficients", coefficients, "K",
        "planes (bilinear, rbf; default: up to 27) or terms of the type", 1, 45),
    NUMBER("--bytes-per-pixel", bytes_per_pixel, "B",
           "size of all plane JPEGs (ptm, lptm: of the file), not exceeded", 0.001, 100),
    NUMBER("--psnr", psnr, "DB", "at least this PSNR against the original", 1, 100),
    INT("--quality", quality, "Q",
        "10 less doubles the quantiser step; default: 95 or more, so that no blocks are seen (ptm, "
        "lptm: raw planes)",
        1, 100),
    INT("--resolution", resolution, "R",
        "bilinear: side of the grid of lights; default: 15 to 33, by the lights", 3, 33),
    GROUP("input"),
    INT("--view", view, "N", "which view of a slab; default: 0", 0, 65535),
    INT("--level", level, "N",
        "which level of a file with a pyramid, 1: half the size; no more than it is read; default: "
        "0, the view itself",
        0, 32),
    ALLOW_OUTSIDE_OPTION,
    KEEP_GOING_OPTION,
    {0},
};

static const char *const formats[] = {FORMATS};

static void say_result(const struct export_options *o, const struct relume_export_report *r)
{
    const char *out = o->output;
    char quality[64] = "";
    if (r->quality)
        snprintf(quality, sizeof quality, "quality %d%s, ", r->quality,
                 given(o, &o->quality) ? "" : " (chosen)");
    if (r->layers)
        announce(&o->args, RELUME_NOTE,
                 "%s: %d layers, one for each light; weights for an environment: relume lights "
                 "--environment sky.hdr %s",
                 out, r->layers, out);
    else if (r->exact)
        announce(&o->args, RELUME_NOTE, "%s: %d plane%s, copied unchanged: nothing is lost", out,
                 r->planes, relume_plural(r->planes));
    else
        announce(&o->args, RELUME_NOTE,
                 "%s: %s%d plane%s, %.3f bytes per pixel; the export differs from the original by "
                 "%.2f dB (%s)",
                 out, quality, r->planes, relume_plural(r->planes), r->bytes_per_pixel, r->psnr_db,
                 judgement(r->psnr_db));
}

// What a name's ending means; RELIGHT: nothing, or nothing that export writes.
static enum relume_exchange format_of_ending(const char *ending)
{
    for (int i = RELUME_EXCHANGE_PTM; *ending && i <= RELUME_EXCHANGE_RTI; i++)
        if (!strcasecmp(ending + 1, formats[i]))
            return (enum relume_exchange)i;
    return RELUME_EXCHANGE_RELIGHT;
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
static relume_status choose_format(enum relume_exchange *to, const struct export_options *o)
{
    const char *out = o->output, *ending = name_ending(out);
    const enum relume_exchange said = format_of_ending(ending);
    *to = given(o, &o->to) ? o->to : said;
    if (*to == RELUME_EXCHANGE_OLAT) {
        if (!strcasecmp(ending, ".exr"))
            return RELUME_OK;
        return usage_error("-o: %s: --to olat writes an .exr file; expected such a name", out);
    }
    if (*ending && relume_image_can_save(out))
        return usage_error(
            "-o: %s: export writes no pictures; expected .ptm, .rti or the name of a "
            "folder ('relume relight' writes pictures)",
            out);
    if (is_no_folder(ending))
        return usage_error(
            "-o: %s: export cannot write this ending; expected .ptm, .rti or the name of a folder",
            out);
    if (!said || said == *to || (said == RELUME_EXCHANGE_PTM && *to == RELUME_EXCHANGE_LPTM))
        return RELUME_OK;
    return usage_error("-o: %s: --to %s writes %s; expected another name, or --to %s", out,
                       formats[*to],
                       *to == RELUME_EXCHANGE_RTI    ? "an .rti file"
                       : strstr(formats[*to], "ptm") ? "a .ptm file"
                                                     : "a folder",
                       formats[said]);
}

static relume_status check(const struct export_options *o, enum relume_exchange to)
{
    const bool blocks = to >= RELUME_EXCHANGE_BC1 && to <= RELUME_EXCHANGE_BC6H;
    const bool folder = to == RELUME_EXCHANGE_RELIGHT || to == RELUME_EXCHANGE_DEEPZOOM;
    const bool olat = to == RELUME_EXCHANGE_OLAT;
    const bool bytes = given(o, &o->bytes_per_pixel), psnr = given(o, &o->psnr);
    const char *only_folders = given(o, &o->type)         ? "--type"
                               : given(o, &o->colorspace) ? "--colorspace"
                               : given(o, &o->resolution) ? "--resolution"
                                                          : NULL;
    const char *jpeg = o->quality ? "--quality" : bytes ? "--bytes-per-pixel" : "--psnr";
    if (o->colorspace == MYCC && o->type > RELUME_WEB_RBF)
        return usage_error("--colorspace mycc: works only with --type bilinear and rbf");
    if (!folder && only_folders)
        return usage_error("%s: works only with --to relight and deepzoom", only_folders);
    if (olat && (o->coefficients || o->quality || bytes || psnr))
        return usage_error("%s: --to olat writes half floats under every light; leave it out",
                           o->coefficients ? "--coefficients" : jpeg);
    if (blocks && (o->coefficients || o->quality || bytes || psnr))
        return usage_error("%s: textures have the size and the terms that they have; leave it out",
                           o->coefficients ? "--coefficients" : jpeg);
    if ((to == RELUME_EXCHANGE_PTM || to == RELUME_EXCHANGE_LPTM) && o->coefficients)
        return usage_error(
            "--coefficients: .ptm always has 6; leave it out, or choose another --to");
    if (to == RELUME_EXCHANGE_RTI && (o->quality || bytes || psnr))
        return usage_error("%s: .rti cannot hold JPEG; use --to ptm or lptm", jpeg);
    if (bytes + psnr + (o->quality > 0) > 1)
        return usage_error("export: expected one of --bytes-per-pixel, --psnr and --quality");
    return RELUME_OK;
}

static relume_status run_export(const struct args *args)
{
    const struct export_options *o = (const void *)args;
    enum relume_exchange to;
    const struct relume_export_params p = {
        .log = o->args.log,
        .view = o->view,
        .type = o->type,
        .ycc = o->colorspace != RGB,
        .coefficients = o->coefficients,
        .resolution = o->resolution,
        .bytes_per_pixel = o->bytes_per_pixel,
        .psnr_db = o->psnr,
        .quality = o->quality,
        .force = o->force,
        .threads = o->args.threads,
        .level = o->level,
    };
    relume_status status = choose_format(&to, o);
    if (!status)
        status = check(o, to);
    if (status)
        return status;
    relume_pack *pack;
    struct relume_export_report report;
    status = relume_open(&pack, o->args.input[0],
                         relume_open_params(.log = p.log, .threads = p.threads,
                                            .allow_outside = o->allow_outside,
                                            .keep_going = o->keep_going));
    if (!status)
        status = relume_export(pack, o->output, to, &report, &p);
    relume_pack_destroy(&pack);
    if (!status)
        say_result(o, &report);
    return status;
}

const struct command command_export = {
    COMMAND(run_export, "export", "FILE -o OUT [OPTION ...]",
            "write a relume file as .ptm, .rti or a folder that web viewers show",
            "relume export statue.exr --to relight -o web/statue --bytes-per-pixel 1", 1, 1),
};
