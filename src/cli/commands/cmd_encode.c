// cmd_encode.c - relume encode: a capture into a relume file
#include "book_options.h"
#include "cli.h"

#include <string.h>
#include <sys/stat.h>

struct encode_options {
    struct args args;
    const char *output, *basis, *interpolant, *colour, *bits, *step, *domain, *compression,
        *transfer;
    int coefficients;
    double quality, ridge, assume_depth;
    bool robust, force, no_depth, skip_missing, repair;
    struct book_options books;
    bool allow_outside;
};
#define OPTIONS struct encode_options

static const struct option options[] = {
    TEXT_AS(OPTION_RELUME, "-o", output, "output", "FILE.exr", "the relume file to write"),
    TEXT("--basis", basis, "model", "NAME", "auto, pca, table, sh, hsh, ptm, dct, dct-resampled"),
    INT("--coefficients", coefficients, "model", "K",
        "coefficients per colour channel (pca: for all three); default: auto: as --quality asks, "
        "at least 27; others: by the basis",
        1, 4096),
    NUMBER("--quality", quality, "model", "DB",
           "auto: as few coefficients as reproduce the photographs at this PSNR; default: 38, at "
           "most 128 of them",
           10, 60),
    TEXT("--interpolant", interpolant, "model", "NAME",
         "pca, table: auto, chord, angular, tps, rbf, natural, hsh, delaunay"),
    TEXT("--colour", colour, "model", "C",
         "rgb, or luminance: one set of coefficients and a colour per pixel; default: rgb"),
    TEXT("--bits", bits, "model", "B",
         "8, 10, 12, 16, half, log (half, coarser and smaller) or float; default: auto: the least "
         "that adds nothing visible; others: 8, half for high dynamic range"),
    TEXT("--step", step, "model", "S",
         "plane: each its own range; common: one step; default: plane"),
    FLAG("--robust", robust, "model",
         "shadows, highlights and stray values weigh less in the fit; slower"),
    FLAG("--force", force, "output", "allow more coefficients than the lights determine"),
    TEXT("--domain", domain, "model", "D",
         "auto, linear or display; default: auto, by the capture's transfer, and by error where "
         "the basis is auto"),
    TEXT("--compression", compression, "output", "C",
         "none, rle, zip or piz (all lossless); default: piz"),
    TEXT("--transfer", transfer, "input", "T", "linear, srgb or gamma:G; overrides the capture's"),
    NUMBER("--ridge", ridge, "model", "R", "smoothing of the fit, 0 (none) to 1; default: 1e-6", 0,
           1),
    BOOK_OPTIONS,
    FLAG("--no-depth", no_depth, "model",
         "leave depth out: smaller file, but no near lights and no views corrected by depth"),
    NUMBER("--assume-depth", assume_depth, "lights", "D",
           "near lights, capture without depth: assume the surface this far from the eye", 1e-6,
           1e9),
    FLAG("--skip-missing", skip_missing, "input", "leave out lights whose image does not exist"),
    ALLOW_OUTSIDE_OPTION,
    FLAG("--repair", repair, "input",
         "replace pixels that are NaN or infinite by those under the nearest lights"),
    {0},
};

static relume_status parse_basis(const char *name, const struct relume_basis **out)
{
    const char *names[32] = {"auto"};
    int n = 1;
    for (const struct relume_basis *const *b = relume_bases; *b; b++)
        names[n++] = (*b)->name;
    *out = strcmp(name, "auto") ? relume_basis_find(name) : &relume_basis_pca;
    return *out ? RELUME_OK : unknown_name("basis", name, names);
}

static relume_status parse_interpolant(const char *name, struct relume_coder_params *p)
{
    const char *names[32] = {"auto"};
    int n = 1;
    for (const struct relume_interpolant *const *i = relume_interpolants; *i; i++)
        names[n++] = (*i)->name;
    p->choose = name && !strcmp(name, "auto");
    p->interpolant = name ? relume_interpolant_find(name) : NULL;
    return !name || p->choose || p->interpolant ? RELUME_OK
                                                : unknown_name("--interpolant", name, names);
}

static relume_status parse_bits(const char *text, enum relume_storage *out)
{
    static const char *const names[] = {"8", "10", "12", "16", "half", "log", "float", NULL};
    return relume_storage_parse(out, text) ? unknown_name("--bits", text, names) : RELUME_OK;
}

// One of a NULL-terminated list of names; *out is its place.
static relume_status parse_choice(const char *option, const char *text, const char *const *names,
                                  int *out)
{
    for (*out = 0; names[*out]; ++*out)
        if (!strcmp(text, names[*out]))
            return RELUME_OK;
    return unknown_name(option, text, names);
}

static relume_status parse_compression(const char *text, enum relume_compression *out)
{
    static const char *const names[] = {"none", "rle", "zip", "piz", NULL};
    return relume_compression_parse(out, text) ? unknown_name("--compression", text, names)
                                               : RELUME_OK;
}

struct request {
    const char *input, *output;
    bool bits;  // the storage was asked for
    struct relume_capture_params open;
    const struct relume_basis *basis;
    struct relume_coder_params coder;
    struct relume_pack_encode_params pack;
    struct relume_books_params books;
    bool decide;     // the capture decides what the options leave open
    double quality;  // 0: the usual
    double unseen;   // dB; 0: not known
};

static const char *storage_words(enum relume_storage storage)
{
    static const char *const words[] = {
        [RELUME_STORE_DEFAULT] = "8 bits", [RELUME_STORE_8] = "8 bits",
        [RELUME_STORE_10] = "10 bits",     [RELUME_STORE_12] = "12 bits",
        [RELUME_STORE_16] = "16 bits",     [RELUME_STORE_HALF] = "half floats",
        [RELUME_STORE_FLOAT] = "floats",   [RELUME_STORE_LOG] = "half floats, rounded",
    };
    return words[storage];
}

// ", 12.3 bytes a pixel"; nothing of outputs that are no file.
static void bytes_words(char text[48], const relume_capture *capture, const char *path)
{
    struct stat file;
    const struct relume_manifest *m = relume_capture_manifest(capture);
    const double pixels =
        (double)m->views * relume_capture_width(capture) * relume_capture_height(capture);
    text[0] = 0;
    if (!stat(path, &file) && S_ISREG(file.st_mode))
        snprintf(text, 48, ", %.1f bytes a pixel", (double)file.st_size / pixels);
}

static void say_result(const struct args *args, const relume_capture *capture,
                       const relume_coder *coder, const struct relume_encode_report *report,
                       const struct request *r)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    char bytes[48], unseen[64] = "", more[96] = "";
    const bool one = info->lights == 1, short_of = r->decide && r->quality > report->psnr_db + 0.5;
    bytes_words(bytes, capture, r->output);
    if (r->unseen > 0.0 && !one)
        snprintf(unseen, sizeof unseen, "; unseen light directions: about %.0f dB", r->unseen);
    if (short_of && !one && !r->coder.coefficients)
        snprintf(more, sizeof more, "; %g dB is more than %d coefficients reach", r->quality,
                 info->coefficients);
    say(args, RELUME_NOTE,
        "%s: reproduces your photograph%s at %.1f dB PSNR (differences %s) with %d "
        "coefficient%s%s, "
        "%s%s%s%s",
        r->output, one ? "" : "s", report->psnr_db, judgement(report->psnr_db), info->coefficients,
        relume_plural(info->coefficients), info->joint ? "" : " a colour",
        storage_words(r->pack.storage), bytes, unseen, more);
}

// Codes are even steps up to the brightest value: a lamp in the picture of HDR radiance leaves the
// rest few of them.
static bool is_coarse(const struct relume_encode_report *report)
{
    static const double COARSE = 0.05;  // photographs of 8 bits lose a hundredth of this
    const double lost = report->typical > 0.0 ? report->steps_rms / report->typical : 0.0;
    return lost >= COARSE && report->steps_rms >= report->fit_rms;
}

static void say_coarse(const struct args *args, const struct relume_encode_report *report,
                       const struct request *r)
{
    if (r->bits && is_coarse(report))
        say(args, RELUME_WARNING,
            "%s: very bright highlights: %s will ruin the picture; use --bits half", r->output,
            storage_words(r->pack.storage));
}

// What in the capture says little: black and clipped pixels, black images.
static void say_census(const struct args *args, const struct request *r,
                       const struct relume_encode_census *c, bool hemispherical)
{
    if (c->black)
        say(args, c->black == c->pixels ? RELUME_WARNING : RELUME_NOTE,
            "%s: %zu of %zu pixels are black under every light", r->input, c->black, c->pixels);
    if (c->clipped)
        say(args, c->always_clipped == c->pixels ? RELUME_WARNING : RELUME_NOTE,
            "%s: %zu of %zu pixels are overexposed in at least one photograph, %zu in all",
            r->input, c->clipped, c->pixels, c->always_clipped);
    if (c->black_images && hemispherical)
        say(args, RELUME_WARNING, "%s: %d image%s black", r->input, c->black_images,
            c->black_images > 1 ? "s are" : " is");
}

// Near lights are resampled where the places of the pixels are known (capture.h).
static bool ignores_positions(const struct relume_manifest *m)
{
    const enum relume_projection p = m->geometry.projection;
    return m->positions && p != RELUME_PLANAR && (p != RELUME_SLAB || !m->view[0].depth);
}

// Learning reads the images once before the encoder does: decoded images of up to this size wait.
#define KEEP_BYTES ((size_t)640 << 20)

static relume_status learn(relume_coder **coder, const relume_capture *capture, struct request *r)
{
    const struct relume_encode_params encode = {.log = r->pack.log,
                                                .domain = r->pack.domain,
                                                .storage = r->pack.storage,
                                                .threads = r->pack.threads};
    struct relume_decision decision;
    if (!r->decide)
        return relume_coder_learn(coder, r->basis, capture, &r->coder, &encode);
    const relume_status status =
        relume_coder_decide(coder, &decision, capture, r->quality, &r->coder, &encode);
    r->pack.domain = decision.domain;
    r->pack.storage = decision.storage;
    r->unseen = decision.unseen_db;
    r->quality = r->quality > 0.0 ? r->quality : RELUME_USUAL_DB;
    return status;
}

// Where nobody asked for even steps and they turn out too coarse, as halves.
static relume_status write_file(const relume_capture *capture, const relume_coder *coder,
                                struct request *r, struct relume_encode_report *report)
{
    relume_status status = relume_pack_encode(capture, coder, r->output, report, &r->pack);
    if (status || r->bits || !is_coarse(report))
        return status;
    r->pack.storage = RELUME_STORE_HALF;
    return relume_pack_encode(capture, coder, r->output, report, &r->pack);
}

static relume_status encode(const struct args *args, struct request *r)
{
    relume_capture *capture;
    relume_coder *coder = NULL;
    struct prefix_log about;
    r->open.keep_bytes = r->basis->learned || r->coder.choose ? KEEP_BYTES : 0;
    relume_status status = relume_capture_open(&capture, r->input, &r->open);
    if (status)
        return status;
    r->coder.log = prefix_log(&about, args->log, r->input);
    r->books.log = r->coder.log;
    if (ignores_positions(relume_capture_manifest(capture)))
        about.log.message(about.log.user, RELUME_WARNING,
                          "the lights stand near; they are treated as distant");
    status = learn(&coder, capture, r);
    struct relume_encode_report report;
    if (!status)
        status = write_file(capture, coder, r, &report);
    if (!status) {
        say_census(args, r, &report.census, relume_capture_hemispherical(capture));
        say_result(args, capture, coder, &report, r);
        say_coarse(args, &report, r);
    }
    relume_coder_destroy(&coder);
    relume_capture_destroy(&capture);
    return status;
}

static relume_status parse(const struct encode_options *o, struct request *r)
{
    static const char *const steps[] = {"plane", "common", NULL};
    static const char *const colours[] = {"rgb", "luminance", NULL};
    int step = 0, colour = 0;
    *r = (struct request){
        .input = o->args.input[0],
        .output = o->output,
        .bits = o->bits != NULL,
        .open = {.log = o->args.log,
                 .skip_missing = o->skip_missing,
                 .allow_outside = o->allow_outside,
                 .assume_depth = o->assume_depth,
                 .repair = o->repair},
        .coder = {.coefficients = o->coefficients,
                  .ridge = o->ridge,
                  .no_ridge = args_given(&o->args, &o->ridge) && o->ridge == 0.0,
                  .robust = o->robust,
                  .force = o->force},
        .pack = {.log = o->args.log, .threads = o->args.threads},
    };
    if (!r->output)
        return usage_error("encode: expected -o FILE.exr");
    const char *basis = o->basis;
    relume_status status = parse_basis(basis, &r->basis);
    if (!status)
        status = parse_interpolant(
            o->interpolant || strcmp(o->basis, "auto") ? o->interpolant : "auto", &r->coder);
    if (!status)
        status = o->bits ? parse_bits(o->bits, &r->pack.storage) : RELUME_OK;
    if (!status)
        status = parse_choice("--step", o->step, steps, &step);
    if (!status)
        status = parse_choice("--colour", o->colour, colours, &colour);
    if (!status)
        status = args_domain(&r->pack.domain, o->domain);
    if (!status)
        status = parse_compression(o->compression, &r->pack.compression);
    if (!status)
        status = args_transfer(&r->open.transfer, "--transfer", o->transfer);
    const bool books = o->books.codes > 0;
    if (!status)
        status = parse_books(&o->args, &o->books, books, &r->books);
    r->pack.books = books ? &r->books : NULL;
    r->pack.no_depth = o->no_depth;
    r->pack.share = o->books.share;
    r->pack.step = step ? RELUME_STEP_COMMON : RELUME_STEP_PLANE;
    r->coder.luminance = colour;
    r->decide = !strcmp(basis, "auto") && !books && !r->coder.robust && !colour;
    r->quality = o->quality;
    if (!status && r->quality > 0.0 && (!r->decide || r->coder.coefficients))
        return usage_error("--quality chooses the coefficients of basis auto; expected without "
                           "--basis, --coefficients, --codebook and --robust");
    return status;
}

static relume_status run(const struct args *args)
{
    const struct encode_options *o = (const void *)args;
    struct request r;
    const relume_status status = parse(o, &r);
    return status ? status : encode(args, &r);
}

relume_status encode_as_usual(const struct args *args, const char *capture, const char *output)
{
    struct request r = {
        .input = capture,
        .output = output,
        .open = {.log = args->log},
        .basis = &relume_basis_pca,
        .coder = {.choose = true},
        .pack = {.log = args->log, .compression = RELUME_COMPRESS_PIZ, .threads = args->threads},
        .decide = true,
    };
    return encode(args, &r);
}

const struct command command_encode = {
    .name = "encode",
    .usage = "CAPTURE -o FILE.exr [OPTION ...]",
    .summary = "compress a capture (capture.json, its folder, or a .lp file) into one relume file",
    .example = "relume encode photos/dirs.lp -o statue.exr --basis sh --coefficients 16",
    .min_inputs = 1,
    .max_inputs = 1,
    .options = options,
    .size = sizeof(struct encode_options),
    .defaults = &(const struct encode_options){.basis = "auto",
                                               .step = "plane",
                                               .colour = "rgb",
                                               .domain = "auto",
                                               .compression = "piz"},
    .run = run,
};
