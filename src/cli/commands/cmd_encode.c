// cmd_encode.c - relume encode: a capture into a relume file
#include "cli/book_options.h"
#include "cli/cli.h"
#include "cli/commands/crop_option.h"
#include "cli/kept_notes.h"
#include "encode_parts.h"
#include "encode_report.h"

#include <string.h>
#include <strings.h>

struct encode_options {
    struct args args;
    const char *output;
    const struct relume_basis *basis;  // NULL: auto
    const struct relume_interpolant *interpolant;
    int coefficients;
    enum relume_storage bits;
    enum relume_step step;
    struct domain_choice domain;
    enum relume_compression compression;
    enum relume_pyramid pyramid;
    enum relume_effort effort;
    enum relume_moving shadows, highlights;
    struct relume_transfer transfer;
    double quality, psnr, jnd, bytes_per_pixel, ridge, assume_depth;
    unsigned luminance;
    bool lossless, robust, force, no_depth, skip_missing, repair, allow_outside;
    struct book_options books;
    struct crop crop;
    struct which_part part;
    const char *learnt;
    bool learn_only;
    int commands;
};
#define OPTIONS struct encode_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_RELUME, output, "FILE.exr", "the relume file to write"),
    FLAG("--force", force, "allow more coefficients than the lights determine"),
    NAME("--compression", compression, "C", "none, rle, zip or piz (all lossless); default: piz",
         RELUME_COMPRESS_NONE, "none", "rle", "zip", "piz"),
    NAME("--pyramid", pyramid, "P",
         "auto, yes or no: also store large views at 1/2, 1/4, ... of their size, which are shown "
         "sooner; default: auto, above 16 megapixels",
         RELUME_PYRAMID_DEFAULT, "auto", "yes", "no"),
    GROUP("model"),
    ENTRY("--basis", basis, "NAME", "auto, pca, eigen, table, sh, hsh, ptm, dct, dct-resampled",
          relume_bases, NAMES("auto")),
    INT("--coefficients", coefficients, "K",
        "coefficients per colour channel (pca: for all three together); default: basis auto: as "
        "many as --quality needs, at least 27; other bases: their own",
        1, 4096),
    NUMBER("--psnr", psnr, "DB",
           "compress with loss: the smallest file that reproduces the photographs at this PSNR", 10,
           60),
    NUMBER("--jnd", jnd, "J",
           "compress with loss: the smallest file in which 99 % of the pixels of every photograph "
           "differ by less than J just noticeable differences; encodes several times",
           0.05, 100),
    NUMBER("--bytes-per-pixel", bytes_per_pixel, "B",
           "compress with loss: the best quality within this many bytes per pixel of each view",
           1e-3, 100),
    NAME("--effort", effort, "E",
         "time for lossy planes: fast, usual (default), smallest; the photographs choose the "
         "quality",
         RELUME_EFFORT_FAST, "fast", "usual", "smallest"),
    FLAG("--lossless", lossless, "keep all that the planes hold, for measuring and editing"),
    NUMBER("--quality", quality, "DB",
           "basis auto: the fewest coefficients, at most 128, that reproduce the photographs at "
           "this PSNR; default: 38",
           10, 60),
    ENTRY("--interpolant", interpolant, "NAME",
          "pca, table: auto, chord, angular, tps, rbf, natural, hsh, delaunay, gaussian",
          relume_interpolants, NAMES("auto")),
    NAME("--colour", luminance, "C",
         "rgb, or luminance: one set of coefficients and a colour per pixel; default: rgb", 0,
         "rgb", "luminance"),
    OWN("--bits", bits, "B",
        "8, 10, 12, 16, half, log (half, coarser and smaller) or float; default: basis auto: the "
        "fewest bits whose error is invisible; other bases: 8, or half for high dynamic range; "
        "makes a lossless file",
        take_bits),
    NAME("--step", step, "S",
         "rounding step: plane (its own for each plane of coefficients) or common (one for all); "
         "default: plane",
         RELUME_STEP_PLANE, "plane", "common"),
    FLAG("--robust", robust,
         "give shadows, highlights and outliers less weight in the fit; slower"),
    OWN("--domain", domain, "D",
        "fit linear light, display values, or logarithms of high dynamic range: auto, linear, "
        "display, log or log:DELTA; default: auto, by the transfer of the capture, and with basis "
        "auto by the error",
        take_domain),
    NUMBER("--ridge", ridge, "R", "smoothing of the fit, 0 (none) to 1; default: 1e-6", 0, 1),
    FLAG("--no-depth", no_depth,
         "leave depth out: smaller file, but no near lights and no views corrected by depth"),
    NAME("--shadows", shadows, "S",
         "auto, yes or no: trace shadows through the depth, so that they move with the light; "
         "default: auto with basis auto, where they foresee photographs left out better, but not "
         "with --psnr or less than --bytes-per-pixel 1; else no",
         RELUME_MOVING_AUTO, "auto", "yes", "no"),
    NAME("--highlights", highlights, "S",
         "auto, yes or no: fit normals, colour and gloss, by which highlights move with the light; "
         "auto: where they foresee photographs left out better; planar captures without traced "
         "shadows; default: auto with basis auto and at least 64 x 64 pixels, but not with --psnr "
         "or less than --bytes-per-pixel 0.5; else no",
         RELUME_MOVING_AUTO, "auto", "yes", "no"),
    GROUP("input"),
    TRANSFER("--transfer", transfer, "linear, srgb or gamma:G; overrides the capture's"),
    CROP_OPTION,
    FLAG("--skip-missing", skip_missing, "leave out lights whose image does not exist"),
    ALLOW_OUTSIDE_OPTION,
    FLAG("--repair", repair,
         "replace NaN and infinite pixels by the same pixels under the nearest lights"),
    GROUP("codebooks"),
    BOOK_OPTIONS,
    GROUP("many machines"),
    OWN("--part", part, "I/N", "encode only part I of N, for 'relume join'", take_part),
    TEXT("--learnt", learnt, "FOLDER",
         "with --part: what all parts learn from is kept here, of which each part reads its share; "
         "missing shares are made"),
    FLAG("--learn-only", learn_only,
         "with --learnt: leave the share of this part there, and encode nothing"),
    INT("--commands", commands, "N",
        "print the shell commands that encode N parts and join them; encode nothing", 1,
        MOST_ARGUMENTS),
    GROUP("lights"),
    NUMBER("--assume-depth", assume_depth, "D",
           "near lights, capture without depth: assume the surface this far from the eye", 1e-6,
           1e9),
    {0},
};

// ---------------------------------------------------------------- a file that is coded again

// A folder of photographs may have such a name too.
static bool is_relume_file(const char *path)
{
    relume_pack *pack = NULL;
    const char *end = strrchr(path, '.');
    const bool is = end && !strcasecmp(end, ".exr") && !relume_pack_open(&pack, path, NULL);
    relume_pack_destroy(&pack);
    return is;
}

// The options that choose a model have no part in it.
static relume_status check_again(const struct encode_options *o)
{
    static const char *const used[] = {"-o",       "--psnr",    "--bytes-per-pixel",
                                       "--effort", "--pyramid", NULL};
    struct options_text text;
    const relume_status status = options_text(&text, &o->args, options, used);
    if (status || !text.text[0])
        return status;
    return usage_error("'%s' is a relume file, which takes --psnr, --bytes-per-pixel, --effort and "
                       "--pyramid; found %s",
                       o->args.input[0], text.text);
}

static relume_status encode_file_again(const struct encode_options *o,
                                       const struct relume_encode_capture_params *params)
{
    const struct args *args = &o->args;
    const char *input = args->input[0];
    struct relume_encode_result result;
    relume_pack *pack;
    relume_status status = check_again(o);
    if (!status)
        status = relume_pack_open(&pack, input,
                                  relume_pack_params(.log = args->log, .threads = args->threads));
    if (status)
        return status;
    const struct relume_pack_info *info = relume_pack_info(pack);
    const double bytes = (double)info->file_bytes;
    if (!strcmp(info->compression, "av1"))
        announce(args, RELUME_WARNING,
                 "%s: is lossy already; coding it again loses more than coding the "
                 "photographs once",
                 input);
    status = relume_encode_again(o->output, pack, &result, params);
    if (!status && info->notes)
        status = relume_pack_keep_notes(o->output, info->notes, args->log);
    if (!status)
        say_coded_again(args, &(const struct encoded_file){input, o->output, NULL, params, &result},
                        bytes);
    relume_pack_destroy(&pack);
    return status;
}

// ---------------------------------------------------------------- a capture

// Decoded images wait in memory up to this size, the rest of them beside the file.
#define KEPT_BYTES ((size_t)384 << 20)

// Opens the capture, encodes it, and prints how good the file is.
static relume_status encode(const struct args *args, const char *input, const char *output,
                            const struct relume_capture_params *open,
                            const struct relume_acquire_params *acquire,
                            const struct relume_encode_capture_params *params)
{
    struct relume_encode_result result;
    struct relume_capture_params own = *open;
    relume_capture *capture;
    own.keep_bytes = relume_encode_rereads(params) ? KEPT_BYTES : 0;
    relume_status status = relume_capture_open_photographs(&capture, input, &own, acquire, NULL);
    if (!status)
        status = relume_encode_capture(output, capture, &result, params);
    if (!status)
        say_encoded(args, &(const struct encoded_file){input, output, capture, params, &result});
    relume_capture_destroy(&capture);
    return status;
}

// Returns the params that the options ask for, without codebooks and the options' text.
static struct relume_encode_capture_params params_of(const struct encode_options *o)
{
    return (struct relume_encode_capture_params){
        .log = o->args.log,
        .threads = o->args.threads,
        .name = o->args.input[0],
        .basis = o->basis,
        .coefficients = o->coefficients,
        .quality_db = o->quality,
        .interpolant = o->interpolant,
        .choose_interpolant = given(o, &o->interpolant) && !o->interpolant,
        .luminance = o->luminance,
        .robust = o->robust,
        .force = o->force,
        .ridge = o->ridge,
        .no_ridge = given(o, &o->ridge) && o->ridge == 0.0,
        .domain = o->domain.domain,
        .display = o->domain.display,
        .shadows = o->shadows,
        .highlights = o->highlights,
        .storage = o->bits,
        .step = o->step,
        .compression = o->compression,
        .pyramid = o->pyramid,
        .no_depth = o->no_depth,
        .share = o->books.share,
        .psnr_db = o->psnr,
        .bytes_per_pixel = o->bytes_per_pixel,
        .jnd = o->jnd,
        .effort = o->effort,
        .lossless = o->lossless,
        .part = o->part.part,
        .parts = o->part.parts,
        .learnt = o->learnt,
        .learn_only = o->learn_only,
        .team = o->args.team,
    };
}

// The lines that --commands prints are checked as what they ask for; without --learnt they get a
// folder of their own.
static relume_status check_commands(const struct encode_options *o,
                                    const struct relume_encode_capture_params *params)
{
    struct relume_encode_capture_params line = *params;
    if (params->parts)
        return usage_error("--commands prints the lines with --part; expected one of the two");
    if (o->shadows == RELUME_MOVING_YES || o->highlights == RELUME_MOVING_YES)
        return usage_error("--commands: its parts could move neither shadows nor highlights; "
                           "expected without --shadows yes and --highlights yes");
    line.part = 1;
    line.parts = o->commands;
    if (!line.learnt && !line.learn_only)
        line.learnt = o->output;
    return relume_encode_check(&line);
}

static relume_status encode_as_asked(const struct encode_options *o)
{
    static const char *const not_kept[] = {"-o",       "--part",       "--commands",
                                           "--learnt", "--learn-only", NULL};
    const struct args *args = &o->args;
    const size_t length = strlen(o->output);
    const bool books = o->books.codes > 0;
    struct relume_encode_capture_params params = params_of(o);
    struct relume_acquire_params acquire = *relume_acquire_params(.threads = args->threads);
    struct relume_books_params books_params;
    struct options_text text;
    if (length && o->output[length - 1] == '/')
        return usage_error("-o: expected the name of a file, as FILE.exr; found '%s'", o->output);
    if (!o->lossless && is_relume_file(args->input[0]))
        return encode_file_again(o, &params);
    relume_status status = parse_books(args, &o->books, books, &books_params);
    params.books = books ? &books_params : NULL;
    params.options = text.text;
    acquire.crop_auto = o->crop.automatic;
    memcpy(acquire.crop, o->crop.part, sizeof acquire.crop);
    if (!status)
        status = options_text(&text, args, options, not_kept);
    if (!status)
        status = o->commands ? check_commands(o, &params) : relume_encode_check(&params);
    if (!status && o->commands)
        print_commands_of_parts(args, o->output, o->commands, !o->learnt);
    if (status || o->commands)
        return status;
    return encode(args, args->input[0], o->output,
                  relume_capture_params(.log = args->log, .transfer = o->transfer,
                                        .skip_missing = o->skip_missing,
                                        .allow_outside = o->allow_outside,
                                        .assume_depth = o->assume_depth, .repair = o->repair,
                                        .scratch = o->output),
                  &acquire, &params);
}

// Notes in the file that is replaced stay.
static relume_status run_encode(const struct args *args)
{
    const struct encode_options *o = (const void *)args;
    struct kept_notes kept;
    kept_notes_read(&kept, o->output);
    return kept_notes_write(&kept, o->output, encode_as_asked(o), args);
}

relume_status encode_as_usual(const struct args *args, const char *capture, const char *output)
{
    return encode(
        args, capture, output, relume_capture_params(.log = args->log), NULL,
        relume_encode_capture_params(.log = args->log, .threads = args->threads, .name = capture));
}

const struct command command_encode = {
    COMMAND(run_encode, "encode", "CAPTURE|FILE.exr -o FILE.exr [OPTION ...]",
            "compress a capture (capture.json, its folder, or a .lp file) into one relume file",
            "relume encode photos/dirs.lp -o statue.exr --basis sh --coefficients 16", 1, 1),
};
