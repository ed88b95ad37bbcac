// cmd_encode.c - relume encode: a capture into a relume file
#include "book_options.h"
#include "cli.h"

#include <string.h>
#include <sys/stat.h>

static const struct option options[] = {
    {"-o", OPTION_RELUME, "FILE.exr", "the relume file to write", 0, 0},
    {"--basis", OPTION_TEXT, "NAME", "auto, pca, table, sh, hsh, ptm, dct, dct-resampled", 0, 0},
    {"--coefficients", OPTION_INT, "K",
     "coefficients per colour channel (pca: for all three); default: auto: as --quality asks, at "
     "least 27; "
     "others: by the basis",
     1, 4096},
    {"--quality", OPTION_NUMBER, "DB",
     "auto: as few coefficients as reproduce the photographs at this PSNR; default: 38, at most "
     "128 of them",
     10, 60},
    {"--interpolant", OPTION_TEXT, "NAME",
     "pca, table: auto, chord, angular, tps, rbf, natural, hsh, delaunay", 0, 0},
    {"--colour", OPTION_TEXT, "C",
     "rgb, or luminance: one set of coefficients and a colour per pixel; default: rgb", 0, 0},
    {"--bits", OPTION_TEXT, "B",
     "8, 10, 12, 16, half, log (half, coarser and smaller) or float; default: auto: the least that "
     "adds nothing "
     "visible; others: 8, half for high dynamic range",
     0, 0},
    {"--step", OPTION_TEXT, "S", "plane: each its own range; common: one step; default: plane", 0,
     0},
    {"--robust", OPTION_FLAG, NULL,
     "shadows, highlights and stray values weigh less in the fit; slower", 0, 0},
    {"--force", OPTION_FLAG, NULL, "allow more coefficients than the lights determine", 0, 0},
    {"--domain", OPTION_TEXT, "D",
     "auto, linear or display; default: auto, by the capture's transfer, and by error where the "
     "basis is auto",
     0, 0},
    {"--compression", OPTION_TEXT, "C", "none, rle, zip or piz (all lossless); default: piz", 0, 0},
    {"--transfer", OPTION_TEXT, "T", "linear, srgb or gamma:G; overrides the capture's", 0, 0},
    {"--ridge", OPTION_NUMBER, "R", "smoothing of the fit, 0 (none) to 1; default: 1e-6", 0, 1},
    BOOK_OPTIONS,
    {"--no-depth", OPTION_FLAG, NULL,
     "leave depth out: smaller file, but no near lights and no views corrected by depth", 0, 0},
    {"--assume-depth", OPTION_NUMBER, "D",
     "near lights, capture without depth: assume the surface this far from the eye", 1e-6, 1e9},
    {"--skip-missing", OPTION_FLAG, NULL, "leave out lights whose image does not exist", 0, 0},
    ALLOW_OUTSIDE_OPTION,
    {"--repair", OPTION_FLAG, NULL,
     "replace pixels that are NaN or infinite by those under the nearest lights", 0, 0},
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
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
static relume_status parse_choice(const struct args *args, const char *option,
                                  const char *const *names, int *out)
{
    const char *text = args_text(args, option, names[0]);
    for (*out = 0; names[*out]; ++*out)
        if (!strcmp(text, names[*out]))
            return RELUME_OK;
    return unknown_name(option, text, names);
}

static relume_status parse_domain(const char *text, enum relume_domain *out)
{
    static const char *const names[] = {"auto", "linear", "display", NULL};
    for (int i = 0; names[i]; i++)
        if (!strcmp(text, names[i])) {
            *out = (enum relume_domain)i;
            return RELUME_OK;
        }
    return unknown_name("--domain", text, names);
}

static relume_status parse_compression(const char *text, enum relume_compression *out)
{
    static const char *const names[] = {"none", "rle", "zip", "piz", NULL};
    return relume_compression_parse(out, text) ? unknown_name("--compression", text, names)
                                               : RELUME_OK;
}

static relume_status parse_transfer(const char *text, struct relume_transfer *out)
{
    if (!text || !relume_transfer_parse(out, text))
        return RELUME_OK;
    return usage_error("--transfer: expected linear, srgb or gamma:G; found '%s'", text);
}

struct request {
    const struct relume_basis *basis;
    struct relume_transfer transfer;
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
    const char *path = args_text(args, "-o", NULL);
    char text[512], bytes[48], unseen[64] = "", more[96] = "";
    const bool one = info->lights == 1, short_of = r->decide && r->quality > report->psnr_db + 0.5;
    bytes_words(bytes, capture, path);
    if (r->unseen > 0.0 && !one)
        snprintf(unseen, sizeof unseen, "; unseen light directions: about %.0f dB", r->unseen);
    if (short_of && !one && !r->coder.coefficients)
        snprintf(more, sizeof more, "; %g dB is more than %d coefficients reach", r->quality,
                 info->coefficients);
    snprintf(text, sizeof text,
             "%s: reproduces your photograph%s at %.1f dB PSNR with %d coefficient%s%s, %s%s%s%s",
             path, one ? "" : "s", report->psnr_db, info->coefficients,
             info->coefficients == 1 ? "" : "s", info->joint ? "" : " a colour",
             storage_words(r->pack.storage), bytes, unseen, more);
    args_log(args)->message(args_log(args)->user, RELUME_NOTE, text);
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
    char text[384];
    if (!args_has(args, "--bits") || !is_coarse(report))
        return;
    snprintf(text, sizeof text,
             "%s: very bright highlights: %s will ruin the picture; use --bits half",
             args_text(args, "-o", ""), storage_words(r->pack.storage));
    args_log(args)->message(args_log(args)->user, RELUME_WARNING, text);
}

// What in the capture says little: black and clipped pixels, black images.
static void say_census(const struct args *args, const struct relume_encode_census *c,
                       bool hemispherical)
{
    const struct relume_log *log = args_log(args);
    char text[256];
    if (c->black) {
        snprintf(text, sizeof text, "%s: %zu of %zu pixels are black under every light",
                 args_input(args, 0), c->black, c->pixels);
        log->message(log->user, c->black == c->pixels ? RELUME_WARNING : RELUME_NOTE, text);
    }
    if (c->clipped) {
        snprintf(text, sizeof text,
                 "%s: %zu of %zu pixels are overexposed in at least one photograph, %zu in all",
                 args_input(args, 0), c->clipped, c->pixels, c->always_clipped);
        log->message(log->user, c->always_clipped == c->pixels ? RELUME_WARNING : RELUME_NOTE,
                     text);
    }
    if (c->black_images && hemispherical) {
        snprintf(text, sizeof text, "%s: %d image%s black", args_input(args, 0), c->black_images,
                 c->black_images > 1 ? "s are" : " is");
        log->message(log->user, RELUME_WARNING, text);
    }
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
static relume_status write_file(const struct args *args, const relume_capture *capture,
                                const relume_coder *coder, struct request *r,
                                struct relume_encode_report *report)
{
    const char *path = args_text(args, "-o", NULL);
    relume_status status = relume_pack_encode(capture, coder, path, report, &r->pack);
    if (status || args_has(args, "--bits") || !is_coarse(report))
        return status;
    r->pack.storage = RELUME_STORE_HALF;
    return relume_pack_encode(capture, coder, path, report, &r->pack);
}

static relume_status encode(const struct args *args, struct request *r)
{
    relume_capture *capture;
    relume_coder *coder = NULL;
    struct prefix_log about;
    const size_t keep = r->basis->learned || r->coder.choose ? KEEP_BYTES : 0;
    relume_status status = relume_capture_open(
        &capture, args_input(args, 0),
        relume_capture_params(.log = args_log(args), .transfer = r->transfer,
                              .skip_missing = args_has(args, "--skip-missing"),
                              .allow_outside = args_has(args, "--allow-outside"),
                              .assume_depth = args_number(args, "--assume-depth", 0.0),
                              .repair = args_has(args, "--repair"), .keep_bytes = keep));
    if (status)
        return status;
    r->coder.log = prefix_log(&about, args_log(args), args_input(args, 0));
    r->books.log = r->coder.log;
    if (ignores_positions(relume_capture_manifest(capture)))
        about.log.message(about.log.user, RELUME_WARNING,
                          "the lights stand near; they are treated as distant");
    status = learn(&coder, capture, r);
    struct relume_encode_report report;
    if (!status)
        status = write_file(args, capture, coder, r, &report);
    if (!status) {
        say_census(args, &report.census, relume_capture_hemispherical(capture));
        say_result(args, capture, coder, &report, r);
        say_coarse(args, &report, r);
    }
    relume_coder_destroy(&coder);
    relume_capture_destroy(&capture);
    return status;
}

static relume_status parse(const struct args *args, struct request *r)
{
    static const char *const steps[] = {"plane", "common", NULL};
    static const char *const colours[] = {"rgb", "luminance", NULL};
    int step = 0, colour = 0;
    *r = (struct request){
        .coder = {.coefficients = args_int(args, "--coefficients", 0),
                  .ridge = args_number(args, "--ridge", 0.0),
                  .no_ridge = args_number(args, "--ridge", 1.0) == 0.0,
                  .robust = args_has(args, "--robust"),
                  .force = args_has(args, "--force")},
        .pack = {.log = args_log(args), .threads = args_threads(args)},
    };
    if (!args_has(args, "-o"))
        return usage_error("encode: expected -o FILE.exr");
    const char *basis = args_text(args, "--basis", "auto");
    relume_status status = parse_basis(basis, &r->basis);
    if (!status)
        status = parse_interpolant(
            args_text(args, "--interpolant", strcmp(basis, "auto") ? NULL : "auto"), &r->coder);
    if (!status)
        status = args_has(args, "--bits")
                     ? parse_bits(args_text(args, "--bits", "8"), &r->pack.storage)
                     : RELUME_OK;
    if (!status)
        status = parse_choice(args, "--step", steps, &step);
    if (!status)
        status = parse_choice(args, "--colour", colours, &colour);
    if (!status)
        status = parse_domain(args_text(args, "--domain", "auto"), &r->pack.domain);
    if (!status)
        status = parse_compression(args_text(args, "--compression", "piz"), &r->pack.compression);
    if (!status)
        status = parse_transfer(args_text(args, "--transfer", NULL), &r->transfer);
    bool books = false;
    if (!status)
        status = parse_books(args, &r->books, &books);
    r->pack.books = books ? &r->books : NULL;
    r->pack.no_depth = args_has(args, "--no-depth");
    r->pack.share = args_has(args, "--share");
    r->pack.step = step ? RELUME_STEP_COMMON : RELUME_STEP_PLANE;
    r->coder.luminance = colour;
    r->decide = !strcmp(basis, "auto") && !books && !r->coder.robust && !colour;
    r->quality = args_number(args, "--quality", 0.0);
    if (!status && r->quality > 0.0 && (!r->decide || r->coder.coefficients))
        return usage_error("--quality chooses the coefficients of basis auto; expected without "
                           "--basis, --coefficients, --codebook and --robust");
    return status;
}

static relume_status run(const struct args *args)
{
    struct request r;
    const relume_status status = parse(args, &r);
    return status ? status : encode(args, &r);
}

const struct command command_encode = {
    .name = "encode",
    .usage = "CAPTURE -o FILE.exr [OPTION ...]",
    .summary = "compress a capture (capture.json, its folder, or a .lp file) into one relume file",
    .example = "relume encode photos/dirs.lp -o statue.exr --basis sh --coefficients 16",
    .min_inputs = 1,
    .max_inputs = 1,
    .options = options,
    .run = run,
};
