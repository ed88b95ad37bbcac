// cmd_encode.c - relume encode: a capture into a relume file
#include "cli/book_options.h"
#include "cli/cli.h"
#include "cli/kept_notes.h"
#include "encode_parts.h"
#include "encode_seen.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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
    enum wander { WANDER_DEFAULT, WANDER_AUTO, WANDER_YES, WANDER_NO } shadows, highlights;
    struct relume_transfer transfer;
    double quality, psnr, jnd, bytes_per_pixel, ridge, assume_depth;
    unsigned luminance;
    bool robust, force, no_depth, skip_missing, repair, allow_outside;
    struct book_options books;
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
        "fewest bits whose error is invisible; other bases: 8, or half for high dynamic range",
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
         WANDER_AUTO, "auto", "yes", "no"),
    NAME("--highlights", highlights, "S",
         "auto, yes or no: fit normals, colour and gloss, by which highlights move with the light; "
         "auto: where they foresee photographs left out better; planar captures without traced "
         "shadows; default: auto with basis auto and at least 64 x 64 pixels, but not with --psnr "
         "or less than --bytes-per-pixel 0.5; else no",
         WANDER_AUTO, "auto", "yes", "no"),
    GROUP("input"),
    TRANSFER("--transfer", transfer, "linear, srgb or gamma:G; overrides the capture's"),
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

struct request {
    const char *input, *output;
    bool bits;  // the storage was asked for
    struct relume_capture_params open;
    const struct relume_basis *basis;
    struct relume_coder_params coder;
    struct relume_pack_encode_params pack;
    struct relume_books_params books;
    enum wander shadows, highlights;
    bool decide;     // the capture decides what the options leave open
    double quality;  // 0: the usual
    double unseen;   // lights left out, dB; 0: not known
    struct options_text options;
    const char *learnt;  // a folder, or NULL
    bool learn_only;
    bool silent;  // a trial, of which others speak
};

static bool is_coded(const struct request *r)
{
    return r->pack.psnr_db > 0.0 || r->pack.bytes_per_pixel > 0.0;
}

// What is between the pictures is left open, and they are kept with loss.
static bool is_table(const struct request *r)
{
    return is_coded(r) && !r->decide && r->basis == &relume_basis_table && !r->coder.interpolant &&
           !r->coder.choose;
}

// Parts of it need to know of each other what their pixels say.
static bool has_steps(const struct request *r, const relume_capture *capture)
{
    return is_coded(r) ||
           (!r->pack.books && r->pack.parts > relume_capture_manifest(capture)->views);
}

// The capture is looked at before it is encoded.
static bool learns_first(const struct request *r)
{
    return r->basis->learned || r->coder.choose || is_table(r);
}

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

// Bytes a pixel of all views; 0 of outputs that are no file.
static double bytes_of(const relume_capture *capture, const char *path)
{
    struct stat file;
    const struct relume_manifest *m = relume_capture_manifest(capture);
    const double pixels =
        (double)m->views * relume_capture_width(capture) * relume_capture_height(capture);
    return !stat(path, &file) && S_ISREG(file.st_mode) ? (double)file.st_size / pixels : 0.0;
}

// From which on a newcomer should know of coding with loss: bytes a pixel, and the photographs'
// own.
static const double LARGE = 4.0, LARGER = 1.5;

// Of the photographs' own files; 0 when one of them is none.
static double bytes_of_photographs(const relume_capture *capture)
{
    struct stat file;
    double sum = 0.0;
    const struct relume_manifest *m = relume_capture_manifest(capture);
    for (int v = 0; v < m->views; v++)
        for (int i = 0; i < m->lights; i++) {
            if (stat(m->view[v].images[i], &file) || !S_ISREG(file.st_mode))
                return 0.0;
            sum += (double)file.st_size;
        }
    return sum;
}

// What somebody should know who did not ask for a size.
static void say_size(char text[128], const relume_capture *capture, const char *output, double each)
{
    struct stat file;
    const double before = bytes_of_photographs(capture);
    const double now = stat(output, &file) ? 0.0 : (double)file.st_size;
    if (before > 0.0 && now > LARGER * before)
        snprintf(text, 128,
                 "; %.1f times the size of your photographs: --psnr %g makes it much smaller",
                 now / before, RELUME_USUAL_DB);
    else if (each > LARGE)
        snprintf(text, 128, "; with --psnr %g it is several times smaller", RELUME_USUAL_DB);
}

// What was asked for with --psnr or --bytes-per-pixel and cannot be had.
static void say_out_of_reach(char text[96], const struct request *r, double psnr_db, double bytes,
                             bool one)
{
    const double asked_db = r->pack.psnr_db, asked = r->pack.bytes_per_pixel;
    if (asked_db > psnr_db + 0.3)
        snprintf(text, 96, "; %g dB is more than it reaches%s", asked_db,
                 one ? "; without --psnr nothing visible is lost" : "");
    else if (asked_db > 0.0 && asked_db < psnr_db - 1.0)
        snprintf(text, 96, "; its coarsest coding is better than %g dB", asked_db);
    else if (asked > 0.0 && bytes > 1.1 * asked)
        snprintf(text, 96, "; it needs more than %g byte%s a pixel", asked,
                 asked == 1.0 ? "" : "s");
    else if (bytes > 0.0 && bytes < 0.7 * asked)
        snprintf(text, 96, "; its finest coding needs less than %g byte%s a pixel", asked,
                 asked == 1.0 ? "" : "s");
}

// What is predicted between photographs has the error of the file besides: dB of both.
static double both_errors(double a, double b)
{
    return -10.0 * log10(pow(10.0, -0.1 * a) + pow(10.0, -0.1 * b));
}

static void say_result(const struct args *args, const relume_capture *capture,
                       const relume_coder *coder, const struct relume_encode_report *report,
                       const struct request *r)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    if (r->pack.parts && !report->psnr_db) {
        announce(args, RELUME_NOTE,
                 "%s: part %d of %d, rows that wait for the others; 'relume join' makes one file "
                 "of all parts",
                 r->output, r->pack.part, r->pack.parts);
        return;
    }
    if (r->pack.parts) {
        announce(args, RELUME_NOTE,
                 "%s: part %d of %d: reproduces your photographs at %.1f dB PSNR (differences %s); "
                 "'relume join' makes one file of all parts",
                 r->output, r->pack.part, r->pack.parts, report->psnr_db,
                 judgement(report->psnr_db));
        return;
    }
    char bytes[48] = "", unseen[64] = "", more[128] = "";
    const double each = bytes_of(capture, r->output);
    const bool one = info->lights == 1;
    const bool single = one && relume_capture_manifest(capture)->views == 1;
    const bool short_of = r->decide && r->quality > report->psnr_db + 0.5;
    if (each > 0.0)
        snprintf(bytes, sizeof bytes, ", %.1f bytes a pixel", each);
    if (r->unseen > 0.0 && !one)
        snprintf(unseen, sizeof unseen, "; unseen light directions: about %.0f dB",
                 both_errors(r->unseen, report->psnr_db));
    if (is_coded(r))
        say_out_of_reach(more, r, report->psnr_db, each, one);
    if (short_of && !one && !r->coder.coefficients)
        snprintf(more, sizeof more, "; %g dB is more than %d coefficients reach", r->quality,
                 info->coefficients);
    else if (r->decide && !is_coded(r))
        say_size(more, capture, r->output, each);
    announce(args, RELUME_NOTE,
             "%s: reproduces your photograph%s at %.1f dB PSNR (differences %s) with %d "
             "coefficient%s%s, "
             "%s%s%s%s",
             r->output, single ? "" : "s", report->psnr_db, judgement(report->psnr_db),
             info->coefficients, relume_plural(info->coefficients), info->joint ? "" : " a colour",
             is_coded(r) ? "coded with loss" : storage_words(r->pack.storage), bytes, unseen, more);
}

// What in the capture says little: black and clipped pixels, black images.
static void say_census(const struct args *args, const struct request *r,
                       const struct relume_encode_census *c, bool hemispherical)
{
    if (c->black)
        announce(args, c->black == c->pixels ? RELUME_WARNING : RELUME_NOTE,
                 "%s: %zu of %zu pixels are black under every light", r->input, c->black,
                 c->pixels);
    if (c->clipped)
        announce(args, c->always_clipped == c->pixels ? RELUME_WARNING : RELUME_NOTE,
                 "%s: %zu of %zu pixels are overexposed in at least one photograph, %zu in all",
                 r->input, c->clipped, c->pixels, c->always_clipped);
    if (c->black_images && hemispherical)
        announce(args, RELUME_WARNING, "%s: %d image%s black", r->input, c->black_images,
                 c->black_images > 1 ? "s are" : " is");
}

// Near lights are resampled where the places of the pixels are known (capture.h).
static bool ignores_positions(const struct relume_manifest *m)
{
    const enum relume_projection p = m->geometry.projection;
    return m->positions && p != RELUME_PLANAR && (p != RELUME_SLAB || !m->view[0].depth);
}

static relume_status learn(relume_coder **coder, const relume_capture *capture, struct request *r)
{
    const struct relume_encode_params encode = {.log = r->pack.log,
                                                .domain = r->pack.domain,
                                                .display = r->pack.display,
                                                .storage = r->pack.storage,
                                                .threads = r->pack.threads,
                                                .team = r->pack.team};
    struct relume_decision decision;
    if (is_coded(r) && r->decide)
        return relume_pack_decide(coder, capture, &r->coder, &r->pack);
    relume_status status = RELUME_OK;
    if (is_table(r))
        status = relume_coder_between(&r->coder, capture, &encode);
    if (status || !r->decide)
        return status ? status : relume_coder_learn(coder, r->basis, capture, &r->coder, &encode);
    status = relume_coder_decide(coder, &decision, capture, r->quality, &r->coder, &encode);
    r->pack.domain = decision.domain;
    r->pack.storage = decision.storage;
    if (!r->unseen)
        r->unseen = decision.unseen_db;
    r->quality = r->quality > 0.0 ? r->quality : RELUME_USUAL_DB;
    return status;
}

// ---------------------------------------------------------------- shadows

// What was expected where neither shadows nor highlights can move; NULL: they can.
static const char *forbids_moving(const struct request *r, const relume_capture *capture)
{
    if (relume_capture_manifest(capture)->positions)
        return "distant lights";
    if (!r->decide && !r->basis->learned && r->basis != relume_basis_find("table"))
        return "basis pca, eigen or table";
    if (r->pack.parts)
        return "no parts";
    return r->pack.pyramid == RELUME_PYRAMID_YES ||
                   (double)relume_capture_width(capture) * relume_capture_height(capture) > 16e6
               ? "views without reduced levels"
               : NULL;
}

static const char *forbids_shadows(const struct request *r, const relume_capture *capture)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    for (int i = 0; i < m->views; i++)
        if (!m->view[i].depth || r->pack.no_depth)
            return "depth in every view";
    if (!relume_shadows_suit(&m->geometry))
        return "views that are no cube and no cylinder with discs";
    return forbids_moving(r, capture);
}

static const double LEAST_SHADOWS_DB = 0.5, LEAST_HIGHLIGHTS_DB = 0.3;
// Half a microsecond to two a sample is a minute or two on two cores; what takes longer waits until
// it is asked for.
static const double MOST_SAMPLES = 100e6;

static double samples_of(const relume_capture *capture)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    return (double)relume_capture_width(capture) * relume_capture_height(capture) * m->lights *
           m->views;
}

static bool is_better(relume_status status, const struct relume_shadows_gain *gain, double least_db)
{
    return !status && gain->traced_db - gain->faded_db >= least_db;
}

// What decides is the middle view.
static relume_status decide_shadows(const struct args *args, const relume_capture *capture,
                                    struct request *r)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    const char *why = forbids_shadows(r, capture);
    const bool display = relume_encode_domain(capture, r->pack.domain) == RELUME_DOMAIN_DISPLAY;
    struct relume_shadows_gain gain;
    if (r->shadows == WANDER_YES && why)
        return say(args->log, RELUME_EUNFIT, "%s: shadows cannot be traced; expected %s", r->input,
                   why);
    r->pack.shadows = r->shadows == WANDER_YES;
    if (r->shadows != WANDER_AUTO || why || m->lights < 8)
        return RELUME_OK;
    if (samples_of(capture) > MOST_SAMPLES) {
        announce(args, RELUME_NOTE,
                 "%s: between the lamps shadows fade; --shadows yes traces them through the depth, "
                 "which takes some minutes",
                 r->input);
        return RELUME_OK;
    }
    struct relume_log quiet = *args->log;
    quiet.message = NULL;  // of what is wrong with a photograph encoding says more
    const relume_status status =
        relume_shadows_judge(&gain, capture, m->views / 2, display,
                             relume_shadows_params(.log = &quiet, .threads = args->threads));
    if (status == RELUME_ELIMIT)
        announce(args, RELUME_NOTE,
                 "%s: between the lamps shadows fade; tracing them takes more than --max-memory "
                 "allows",
                 r->input);
    r->pack.shadows = is_better(status, &gain, LEAST_SHADOWS_DB);
    r->unseen = r->pack.shadows ? gain.traced_db : 0.0;
    if (r->pack.shadows)
        announce(args, RELUME_NOTE,
                 "%s: shadows are traced through the depth: %d lights left out are shown at "
                 "%.1f dB PSNR, faded ones at %.1f; --shadows no leaves that out",
                 r->input, gain.lights, gain.traced_db, gain.faded_db);
    return status == RELUME_ECANCEL || status == RELUME_ENOMEM ? status : RELUME_OK;
}

static const char *forbids_highlights(const struct request *r, const relume_capture *capture)
{
    enum { LEAST_LIGHTS = 16 };  // four of them are left out
    const struct relume_manifest *m = relume_capture_manifest(capture);
    if (r->pack.shadows)
        return "--shadows no";
    if (m->views != 1 || m->slabs || m->geometry.projection != RELUME_PLANAR ||
        m->geometry.perspective)
        return "one planar orthographic view";
    if (m->lights < LEAST_LIGHTS)
        return "at least 16 lights";
    return forbids_moving(r, capture);
}

// What was found out when highlights move by themselves, or not. Where nobody asked, what leaves
// the file as it was is not spoken of.
static void say_highlights(const struct args *args, const struct request *r, relume_status status,
                           const struct relume_shadows_gain *gain)
{
    if (r->pack.gloss)
        announce(args, RELUME_NOTE,
                 "%s: highlights move with the light: %d lights left out are shown at %.1f dB "
                 "PSNR, faded ones at %.1f; --highlights no leaves that out",
                 r->input, gain->lights, gain->traced_db, gain->faded_db);
    else if (is_better(status, gain, LEAST_HIGHLIGHTS_DB))
        announce(args, RELUME_NOTE,
                 "%s: highlights fade; --highlights yes moves them, which takes some minutes and "
                 "shows %d lights left out at %.1f dB PSNR in place of %.1f",
                 r->input, gain->lights, gain->traced_db, gain->faded_db);
    else if (status == RELUME_ELIMIT)
        announce(args, RELUME_NOTE,
                 "%s: highlights fade; moving them takes more than --max-memory allows", r->input);
    else if (status && r->highlights == WANDER_AUTO)
        announce(args, RELUME_NOTE, "%s: highlights fade; no surface could be fitted (%s)",
                 r->input, relume_status_text(status));
    else if (r->highlights == WANDER_AUTO)
        announce(args, RELUME_NOTE,
                 "%s: highlights fade: %d lights left out are shown at %.1f dB PSNR, moving ones "
                 "at %.1f",
                 r->input, gain->lights, gain->faded_db, gain->traced_db);
}

static relume_status try_highlights(const struct args *args, const relume_capture *capture,
                                    struct request *r, struct relume_image *model, bool display)
{
    struct relume_log quiet = *args->log;
    quiet.message = NULL;  // of what is wrong with a photograph encoding says more
    const struct relume_shadows_params *p =
        relume_shadows_params(.log = &quiet, .threads = args->threads);
    struct relume_shadows_gain gain;
    relume_status status = relume_gloss_judge(&gain, capture, display, p);
    if (is_better(status, &gain, LEAST_HIGHLIGHTS_DB) && samples_of(capture) <= MOST_SAMPLES) {
        status = relume_gloss_learn(model, capture, display, p);
        r->pack.gloss = status ? NULL : model;
    }
    if (r->pack.gloss)
        r->unseen = gain.traced_db;
    if (status == RELUME_ECANCEL || status == RELUME_ENOMEM)
        return status;
    say_highlights(args, r, status, &gain);
    return RELUME_OK;
}

// Where they are asked for and cannot move.
static relume_status refuse_highlights(const struct args *args, const relume_capture *capture,
                                       const struct request *r)
{
    const char *why = r->highlights == WANDER_YES ? forbids_highlights(r, capture) : NULL;
    return why ? say(args->log, RELUME_EUNFIT, "%s: highlights cannot move; expected %s", r->input,
                     why)
               : RELUME_OK;
}

static relume_status decide_highlights(const struct args *args, const relume_capture *capture,
                                       struct request *r, struct relume_image *model)
{
    enum { LEAST_SIDE = 64 };  // where nobody asked: less is no photograph
    if (r->highlights == WANDER_NO)
        return RELUME_OK;
    const relume_status refused = refuse_highlights(args, capture, r);
    if (refused)
        return refused;
    const char *why = forbids_highlights(r, capture);
    if (r->highlights == WANDER_DEFAULT &&
        (!r->decide || why || relume_capture_width(capture) < LEAST_SIDE ||
         relume_capture_height(capture) < LEAST_SIDE))
        return RELUME_OK;
    const bool display = relume_encode_domain(capture, r->pack.domain) == RELUME_DOMAIN_DISPLAY;
    if (why) {
        announce(args, RELUME_NOTE, "%s: highlights fade; expected %s, for them to move", r->input,
                 why);
        return RELUME_OK;
    }
    if (r->highlights != WANDER_YES)
        return try_highlights(args, capture, r, model, display);
    const relume_status status = relume_gloss_learn(
        model, capture, display, relume_shadows_params(.log = args->log, .threads = args->threads));
    r->pack.gloss = status ? NULL : model;
    return status;
}

// Where nobody asked for even steps and they turn out too coarse, as halves.
static relume_status write_file(const relume_capture *capture, const relume_coder *coder,
                                struct request *r, struct relume_encode_report *report)
{
    relume_status status = relume_pack_encode(capture, coder, r->output, report, &r->pack);
    if (status || r->bits || is_coded(r) || r->pack.parts || !relume_encode_is_coarse(report))
        return status;
    r->pack.storage = RELUME_STORE_HALF;
    return relume_pack_encode(capture, coder, r->output, report, &r->pack);
}

// The parts of this work, by what all of them say of it.
static relume_status form_team(relume_team_files **files, const relume_capture *capture,
                               struct request *r)
{
    char digest[RELUME_DIGEST], about[sizeof r->options.text + 128];
    relume_status status = relume_capture_digest(digest, capture, r->pack.log);
    if (status)
        return status;
    snprintf(about, sizeof about, "relume %s, capture %s, options %s", RELUME_VERSION, digest,
             r->options.text);
    status = relume_team_folder(files, r->learnt, r->pack.part - 1, r->pack.parts, about,
                                r->learn_only, r->pack.log);
    r->pack.team = status ? NULL : relume_team_of_folder(*files);
    return status;
}

// ---------------------------------------------------------------- relume-mpi

// What relume-mpi's own parts end in: they are removed, and those of --part are the user's.
static const char OWN_PART[] = "relume-mpi";

struct together {
    const struct args *args;
    const struct request *r;
    struct relume_encode_report *report;
};

static relume_status give_byte(struct relume_buffer *out, unsigned char byte)
{
    const struct relume_writer writer = relume_buffer_writer(out);
    return writer.write(writer.user, &byte, 1, 0) ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status say_written(void *context, int member, struct relume_buffer *out)
{
    (void)context;
    return give_byte(out, (unsigned char)(member & 1));
}

// The first process joins; its piece says whether the steps are too coarse.
static relume_status join_parts(void *context, int member, struct relume_buffer *out)
{
    const struct together *t = context;
    const struct args *args = t->args;
    const int parts = args->team->members;
    if (member)
        return give_byte(out, 0);
    struct relume_log log = *args->log;
    log.leave_unnoted = true;  // parts are written again where 8 bits are too few
    struct part_name *name = calloc((size_t)parts, sizeof *name);
    const char **path = calloc((size_t)parts, sizeof *path);
    relume_status status = name && path ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < parts; i++) {
        name_part(&name[i], t->r->output, i + 1, parts, OWN_PART);
        path[i] = name[i].text;
    }
    if (!status)
        status = relume_pack_join(
            path, parts, t->r->output, t->report,
            relume_pack_params(.log = &log, .limits = &args->limits, .threads = args->threads));
    free(path);
    free(name);
    return status ? status : give_byte(out, relume_encode_is_coarse(t->report));
}

// byte[members]: what each process has to say.
static relume_status share_bytes(const struct args *args, const char *what, relume_team_make *make,
                                 void *context, unsigned char *byte)
{
    const struct relume_team *team = args->team;
    struct relume_buffer *piece = calloc((size_t)team->members, sizeof *piece);
    relume_status status =
        piece ? team->share(team->user, what, make, context, piece) : RELUME_ENOMEM;
    for (int i = 0; !status && i < team->members; i++)
        if (piece[i].size == 1)
            byte[i] = piece[i].data[0];
        else
            status =
                say(args->log, RELUME_EDAMAGED, "process %d has shared %zu bytes (%s); expected 1",
                    i + 1, piece[i].size, what);
    for (int i = 0; piece && i < team->members; i++)
        relume_buffer_destroy(&piece[i]);
    free(piece);
    return status;
}

// Whether a part is there already, of the same work, since an earlier run was stopped.
struct kept {
    const struct request *r;
    const char *path, *capture;
};

static relume_status say_kept(void *context, int member, struct relume_buffer *out)
{
    const struct kept *k = context;
    const struct relume_pack_encode_params *p = &k->r->pack;
    struct relume_pack_part part;
    return give_byte(
        out, member == p->part - 1 && is_part(&part, k->path) && part.part == p->part &&
                 part.parts == p->parts && !strcmp(part.creator, "relume " RELUME_VERSION) &&
                 !strcmp(part.options, p->options) && !strcmp(part.capture, k->capture));
}

// Parts that need each other to be made are kept together.
static bool need_each_other(const struct request *r, const relume_capture *capture)
{
    return is_coded(r) || (r->pack.books && r->pack.share) ||
           r->pack.parts > relume_capture_manifest(capture)->views;
}

// The own part, unless it is kept.
static relume_status write_part(const struct args *args, const relume_capture *capture,
                                const relume_coder *coder, struct request *r, const char *path,
                                unsigned char *byte)
{
    char digest[RELUME_DIGEST];
    struct kept kept = {r, path, digest};
    struct relume_encode_report own;
    const int parts = args->team->members;
    bool all = true;
    relume_status status = relume_capture_digest(digest, capture, r->pack.log);
    if (!status)
        status = share_bytes(args, "kept", say_kept, &kept, byte);
    for (int i = 0; !status && i < parts; i++)
        all &= byte[i] != 0;
    const bool is_kept =
        !status && byte[args->team->member] && (all || !need_each_other(r, capture));
    return status || is_kept ? status : relume_pack_encode(capture, coder, path, &own, &r->pack);
}

// All processes write their parts, and the first joins them. Where that fails they stay, and the
// same command line takes them up.
static relume_status write_together(const struct args *args, const relume_capture *capture,
                                    const relume_coder *coder, struct request *r,
                                    struct relume_encode_report *report)
{
    struct together t = {args, r, report};
    struct part_name name;
    struct options_text again_text;
    bool again = true;
    unsigned char *byte = calloc((size_t)args->team->members, 1);
    relume_status status = byte ? RELUME_OK : RELUME_ENOMEM;
    name_part(&name, r->output, r->pack.part, r->pack.parts, OWN_PART);
    r->pack.free_storage = false;
    while (!status && again) {
        status = write_part(args, capture, coder, r, name.text, byte);
        if (!status)
            status = share_bytes(args, "written", say_written, NULL, byte);
        if (!status)
            status = share_bytes(args, "joined", join_parts, &t, byte);
        again = !status && byte[0] && !r->bits && r->pack.storage != RELUME_STORE_HALF;
        r->pack.storage = again ? RELUME_STORE_HALF : r->pack.storage;
        snprintf(again_text.text, sizeof again_text.text, "%.*s (halves)",
                 (int)sizeof again_text.text - 16, r->options.text);
        r->pack.options = again ? again_text.text : r->pack.options;
    }
    if (!status)
        remove(name.text);
    free(byte);
    r->pack.part = r->pack.parts = 0;
    return status;
}

// ---------------------------------------------------------------- one capture

static relume_status encode_team(const struct args *args, struct request *r,
                                 const relume_capture *capture)
{
    relume_coder *coder = NULL;
    struct relume_encode_report report;
    struct relume_image gloss = {0};
    relume_status status = refuse_highlights(args, capture, r);
    if (!status)  // which may take minutes
        status = decide_shadows(args, capture, r);
    if (r->pack.shadows && !r->coder.interpolant) {  // what traced shadows are added to
        r->coder.interpolant = relume_interpolant_find("delaunay");
        r->coder.choose = false;
    }
    if (!status)
        status = learn(&coder, capture, r);
    if (!status)  // in the domain that was chosen
        status = decide_highlights(args, capture, r, &gloss);
    if (!status && (!r->learn_only || has_steps(r, capture)))
        status = (args->team ? write_together(args, capture, coder, r, &report)
                             : write_file(capture, coder, r, &report));
    if (!status && !r->learn_only && !r->silent && !(args->team && args->team->member)) {
        say_census(args, r, &report.census, relume_capture_hemispherical(capture));
        say_result(args, capture, coder, &report, r);
        if ((r->bits || r->pack.parts) && !is_coded(r) && relume_encode_is_coarse(&report))
            announce(args, RELUME_WARNING,
                     "%s: very bright highlights: %s will ruin the picture; use --bits half",
                     r->output, storage_words(r->pack.storage));
    }
    relume_image_destroy(&gloss);
    relume_coder_destroy(&coder);
    return status;
}

// What learning has come to is what scripts wait for: the command's output.
static void say_learnt(const char *path, const char *text)
{
    struct shown name;
    printf("%s: %s\n", shown(&name, path), text);
}

static void say_share(const struct request *r, const relume_capture *capture, bool all)
{
    char text[256];
    if (all)
        snprintf(text, sizeof text,
                 "all is learnt; encode part %d of %d by the same line without --learn-only",
                 r->pack.part, r->pack.parts);
    else
        snprintf(text, sizeof text, "part %d of %d has learnt its share; %s", r->pack.part,
                 r->pack.parts,
                 has_steps(r, capture)
                     ? "run this line again when the other parts have learnt theirs"
                     : "other parts have not learnt theirs yet");
    say_learnt(r->learnt, text);
}

static relume_status encode(const struct args *args, struct request *r)
{
    relume_capture *capture;
    relume_team_files *team = NULL;
    struct prefix_log about;
    r->open.keep_bytes = learns_first(r) ? KEEP_BYTES : 0;
    relume_status status = relume_capture_open(&capture, r->input, &r->open);
    if (status)
        return status;
    if (r->learn_only && !learns_first(r) && !has_steps(r, capture)) {
        say_learnt(r->input, "nothing is learnt before encoding with these options; run the same "
                             "line without --learn-only");
        relume_capture_destroy(&capture);
        return RELUME_OK;
    }
    r->coder.log = prefix_log(&about, args->log, r->input);
    r->books.log = r->coder.log;
    if (ignores_positions(relume_capture_manifest(capture)))
        about.log.message(about.log.user, RELUME_WARNING,
                          "the lights stand near; they are treated as distant");
    if (args->team) {
        r->pack.team = args->team;
        r->pack.part = args->team->member + 1;
        r->pack.parts = args->team->members;
    }
    if (r->learnt)
        status = form_team(&team, capture, r);
    if (!status)
        status = encode_team(args, r, capture);
    if (r->learn_only && status == RELUME_ECANCEL && relume_team_folder_waits(team)) {
        status = RELUME_OK;
        say_share(r, capture, false);
    } else if (r->learn_only && !status) {
        say_share(r, capture, true);
    }
    relume_team_folder_destroy(&team);
    relume_capture_destroy(&capture);
    return status;
}

// About four times what shadows take of a pixel, or highlights.
static const double LEAST_SHADOW_BYTES = 1.0, LEAST_HIGHLIGHT_BYTES = 0.5;

static bool has_bytes_for(const struct request *r, double least)
{
    return !is_coded(r) || r->pack.bytes_per_pixel >= least;
}

static relume_status check_parts(const struct encode_options *o, const struct request *r)
{
    if (o->args.team && (o->part.parts || o->commands || o->learnt || o->learn_only))
        return usage_error("relume-mpi makes the parts, and joins them; expected without --part, "
                           "--commands and --learnt");
    if (o->learn_only && !o->learnt)
        return usage_error("--learn-only: expected --learnt FOLDER, where the share is left");
    if (o->learnt && !o->part.parts && !o->commands)
        return usage_error("--learnt is what parts share; expected --part or --commands with it");
    if (!o->part.parts && !o->commands && !o->args.team)
        return RELUME_OK;
    if (o->commands && (o->shadows == WANDER_YES || o->highlights == WANDER_YES))
        return usage_error("--commands: its parts could move neither shadows nor highlights; "
                           "expected without --shadows yes and --highlights yes");
    if (o->part.parts && o->commands)
        return usage_error("--commands prints the lines with --part; expected one of the two");
    if (o->learnt && strchr(r->options.text, '\n'))
        return usage_error(
            "--learnt keeps what was asked for in one line; expected options without "
            "line breaks");
    if (r->pack.books && r->pack.share && !o->learnt && o->part.parts)
        return usage_error("--share learns one set of codebooks from all views; expected --learnt "
                           "FOLDER, where the parts share what it is learnt from");
    return RELUME_OK;
}

// A trial of --jnd: the same request at a PSNR.
static relume_status encode_at(void *context, const struct args *args, double psnr_db,
                               const char *output)
{
    struct request r = *(const struct request *)context;
    r.output = output;
    r.pack.psnr_db = psnr_db;
    r.pack.log = r.open.log = args->log;
    r.silent = true;
    return encode(args, &r);
}

static relume_status work(const struct args *args)
{
    static const char *const not_kept[] = {"-o",       "--part",       "--commands",
                                           "--learnt", "--learn-only", NULL};
    const struct encode_options *o = (const void *)args;
    const bool books = o->books.codes > 0;
    const bool choose = given(o, &o->interpolant) ? !o->interpolant : !o->basis;
    const size_t length = strlen(o->output);
    if (length && o->output[length - 1] == '/')
        return usage_error("-o: expected the name of a file, as FILE.exr; found '%s'", o->output);
    struct request r = {
        .input = args->input[0],
        .output = o->output,
        .bits = o->bits,
        .open = {.log = args->log,
                 .transfer = o->transfer,
                 .skip_missing = o->skip_missing,
                 .allow_outside = o->allow_outside,
                 .assume_depth = o->assume_depth,
                 .repair = o->repair,
                 .scratch = o->output},
        .basis = o->basis ? o->basis : &relume_basis_pca,
        .coder = {.coefficients = o->coefficients,
                  .ridge = o->ridge,
                  .no_ridge = given(o, &o->ridge) && o->ridge == 0.0,
                  .choose = choose,
                  .interpolant = o->interpolant,
                  .luminance = o->luminance,
                  .robust = o->robust,
                  .force = o->force},
        .pack = {.log = args->log,
                 .domain = o->domain.domain,
                 .display = o->domain.display,
                 .storage = o->bits,
                 .step = o->step,
                 .compression = o->compression,
                 .pyramid = o->pyramid,
                 .no_depth = o->no_depth,
                 .psnr_db = o->jnd > 0.0 ? RELUME_USUAL_DB : o->psnr,
                 .bytes_per_pixel = o->bytes_per_pixel,
                 .share = o->books.share,
                 .part = o->part.part,
                 .parts = o->part.parts,
                 .free_storage = !o->bits,
                 .learn_only = o->learn_only,
                 .threads = args->threads},
        .highlights = o->highlights,
        .decide = !o->basis && !books && !o->robust && !o->luminance,
        .quality = o->quality,
        .learnt = o->learnt,
        .learn_only = o->learn_only,
    };
    // Shadows and highlights do not move together: who asks for highlights has chosen. And without
    // being asked for they take no more than some of the bytes.
    const bool shadows = r.decide && o->highlights != WANDER_YES;
    r.shadows = o->shadows                                         ? o->shadows
                : shadows && has_bytes_for(&r, LEAST_SHADOW_BYTES) ? WANDER_AUTO
                                                                   : WANDER_NO;
    if (!o->highlights && !has_bytes_for(&r, LEAST_HIGHLIGHT_BYTES))
        r.highlights = WANDER_NO;
    if (is_coded(&r) && r.pack.domain == RELUME_DOMAIN_AUTO)
        r.pack.domain = RELUME_DOMAIN_DISPLAY;
    if (r.quality > 0.0 && (!r.decide || o->coefficients))
        return usage_error("--quality chooses the coefficients of basis auto; expected without "
                           "--basis, --coefficients, --codebook and --robust");
    if (is_coded(&r) && (books || o->bits || given(o, &o->step) || given(o, &o->compression) ||
                         o->quality > 0.0 || (o->psnr > 0.0 && o->bytes_per_pixel > 0.0)))
        return usage_error(
            "--psnr and --bytes-per-pixel choose bits, step and compression; expected "
            "one of the two, without --bits, --step, --compression, --quality and "
            "--codebook");
    if (o->jnd > 0.0 && (o->psnr > 0.0 || o->bytes_per_pixel > 0.0 || o->part.parts ||
                         o->commands || o->learnt || args->team))
        return usage_error("--jnd encodes several times and compares; expected without --psnr, "
                           "--bytes-per-pixel, and of one process");
    if (is_coded(&r) && o->domain.display.curve == RELUME_CURVE_LOG)
        return usage_error("--psnr and --bytes-per-pixel are about what a screen shows; expected "
                           "them without --domain log");
    relume_status status = parse_books(args, &o->books, books, &r.books);
    r.pack.books = books ? &r.books : NULL;
    r.pack.options = r.options.text;
    if (!status)
        status = options_text(&r.options, args, options, not_kept);
    if (!status)
        status = check_parts(o, &r);
    if (!status && o->commands)
        print_commands_of_parts(args, o->output, o->commands, !o->learnt);
    if (!status && o->jnd > 0.0)
        return encode_seen(args, &(const struct encode_seen){.jnd = o->jnd,
                                                             .input = r.input,
                                                             .output = r.output,
                                                             .open = r.open,
                                                             .trial = encode_at,
                                                             .context = &r});
    return status || o->commands ? status : encode(args, &r);
}

// A new model of what was photographed; what people have written in the old one stays.
static relume_status run(const struct args *args)
{
    const struct encode_options *o = (const void *)args;
    struct kept_notes kept;
    kept_notes_read(&kept, o->output);
    return kept_notes_write(&kept, o->output, work(args), args);
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
        .shadows = WANDER_AUTO,
        .decide = true,
    };
    return encode(args, &r);
}

const struct command command_encode = {
    COMMAND("encode", "CAPTURE -o FILE.exr [OPTION ...]",
            "compress a capture (capture.json, its folder, or a .lp file) into one relume file",
            "relume encode photos/dirs.lp -o statue.exr --basis sh --coefficients 16", 1, 1),
};
