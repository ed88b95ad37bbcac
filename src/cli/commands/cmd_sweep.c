// cmd_sweep.c - relume sweep: every coder of a grid judged by lights that it has not seen
#include "cli/book_options.h"
#include "cli/commands/sweep.h"
#include "cli/program/clock.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct sweep_options {
    struct args args;
    const char *output, *test;
    struct entries basis, interpolant;  // NULL: auto
    struct ints coefficients, luminance, bits, step, codebook;
    struct domain_choices domains;
    struct relume_transfer transfer;
    int leave_out, memory;
    bool skip_missing, json, csv, allow_outside, tone_map;
    struct book_options books;
};
#define OPTIONS struct sweep_options

static const struct option options[] = {
    GROUP("output"),
    TEXT_AS(OPTION_OUTPUT, "-o", output, "OUT",
            "write OUT.csv, OUT.json, OUT.svg, OUT.png, and OUT.resume to continue from"),
    FLAG("--json", json, "print one JSON object"),
    FLAG("--csv", csv, "print comma-separated values"),
    GROUP("model"),
    ENTRIES("--basis", basis, "LIST", "bases, separated by commas; default: all", relume_bases,
            NAMES("auto")),
    WORDS("--coefficients", coefficients, "LIST",
          "numbers of coefficients; default: those that suit each basis", OPTION_INT, .min = 1,
          .max = 4096),
    ENTRIES("--interpolant", interpolant, "LIST",
            "for pca and table: interpolants, or auto; default: their own", relume_interpolants,
            NAMES("auto")),
    WORDS("--colour", luminance, "LIST", "rgb, luminance (encode --help); default: rgb",
          OPTION_NAME, .names = NAMES("rgb", "luminance")),
    WORDS("--bits", bits, "LIST", "8, 10, 12, 16, half; default: 8", OPTION_OWN, .take = take_bits),
    WORDS("--step", step, "LIST", "rounding steps: plane, common (encode --help); default: plane",
          OPTION_NAME, .min = RELUME_STEP_PLANE, .names = NAMES("plane", "common")),
    WORDS("--codebook", codebook, "LIST", "numbers of code vectors; 0: no codebook; default: 0",
          OPTION_INT, .max = 65536),
    INT("--leave-out", leave_out, "K", "number of lights left out at a time; default: 1", 1, 65535),
    TEXT("--test", test, "CAPTURE", "measure on the lights of another capture instead"),
    OWN("--domain", domains, "LIST", "auto, linear, display, log or log:DELTA; default: as encode",
        take_domains),
    FLAG("--tone-map", tone_map,
         "compare each picture at an exposure of its own, with a gamma of 2.2, for high dynamic "
         "range"),
    GROUP("codebooks"),
    BOOK_FORM_OPTIONS,
    GROUP("machine"),
    INT("--memory", memory, "MB",
        "memory for pixels; if they do not fit, only some rows are measured; default: 1024", 1,
        1048576),
    GROUP("input"),
    TRANSFER("--transfer", transfer, "linear, srgb or gamma:G; overrides the capture's"),
    FLAG("--skip-missing", skip_missing, "leave out lights whose image does not exist"),
    ALLOW_OUTSIDE_OPTION,
    {0},
};

enum { MOST_ROWS = 4096 };

// ---------------------------------------------------------------- the grid

// Each way of storing. Halves and codebooks have no step.
static void add_rows(struct sweep *sweep, struct sweep_row row)
{
    const struct sweep_options *o = sweep->options;
    for (int i = 0; i < o->bits.count; i++)
        for (int j = 0; j < o->step.count; j++)
            for (int k = 0; k < o->codebook.count && sweep->rows < MOST_ROWS; k++) {
                const enum relume_storage storage = (enum relume_storage)o->bits.item[i];
                const int codes = o->codebook.item[k];
                const bool stepless = codes || !relume_storage_top(storage);
                if (stepless && j > 0)
                    continue;
                row.store = (struct relume_heldout_store){
                    .storage = storage,
                    .step = stepless ? RELUME_STEP_PLANE : (enum relume_step)o->step.item[j],
                    .share = codes && o->books.share};
                row.books = codes ? sweep->books : (struct relume_books_params){0};
                row.books.codes = codes;
                sweep->row[sweep->rows++] = row;
            }
}

// NULL is the basis that is called auto: components with the interpolant chosen.
static void add_forms(struct sweep *sweep, const struct relume_basis *asked, int size)
{
    const struct sweep_options *o = sweep->options;
    const struct relume_basis *basis = asked ? asked : &relume_basis_pca;
    const int listed = asked && basis->interpolates ? o->interpolant.count : 0;
    for (int i = 0; i < (listed ? listed : 1); i++)
        for (int j = 0; j < o->luminance.count; j++)
            if (!o->luminance.item[j] || !basis->learned)
                add_rows(sweep, (struct sweep_row){
                                    .basis = basis,
                                    .interpolant = listed ? o->interpolant.item[i] : NULL,
                                    .choose = !asked || (listed && !o->interpolant.item[i]),
                                    .luminance = o->luminance.item[j],
                                    .domain = sweep->domain,
                                    .several_domains = o->domains.count > 1,
                                    .wanted = size,
                                    .coefficients = size ? size : sweep->lights,
                                });
}

// "ptm has 6 coefficients" and what other sizes up to 36 the bases have.
static relume_status no_such_size(const struct entries *bases)
{
    char text[1024];
    size_t at = 0;
    for (int b = 0; b < bases->count && at < sizeof text; b++) {
        const struct relume_basis *basis = bases->item[b];
        if (!basis)
            continue;
        at +=
            (size_t)snprintf(text + at, sizeof text - at, "%s%s has", at ? "; " : "", basis->name);
        for (int k = 1; k <= 36 && at < sizeof text; k++)
            if (basis->has_count(k))
                at += (size_t)snprintf(text + at, sizeof text - at, " %d", k);
    }
    return usage_error("--coefficients: none of the bases has that many; up to 36, %s", text);
}

// A basis that keeps every light has one size. The others have a row for each that is asked for,
// which says why where it cannot be, or of the usual ones those that the lights determine; where
// they determine none, the least says so.
static bool add_sizes(struct sweep *sweep, const struct relume_basis *asked)
{
    static const int usual[] = {1, 4, 6, 9, 16, 18, 25, 27, 36, 49};
    const struct ints *sizes = &sweep->options->coefficients;
    const struct relume_basis *basis = asked ? asked : &relume_basis_pca;
    const int before = sweep->rows;
    bool possible = !sizes->count;
    if (basis->interpolates && !basis->learned) {
        add_forms(sweep, asked, 0);
        return true;
    }
    for (int i = 0; i < sizes->count; i++) {
        add_forms(sweep, asked, sizes->item[i]);
        possible |= basis->has_count(sizes->item[i]);
    }
    for (size_t i = 0; !sizes->count && i < sizeof usual / sizeof *usual; i++)
        if (basis->has_count(usual[i]) && basis->fit_count(usual[i], sweep->lights) == usual[i])
            add_forms(sweep, asked, usual[i]);
    for (size_t i = 0; sweep->rows == before && i < sizeof usual / sizeof *usual; i++)
        if (basis->has_count(usual[i]))
            add_forms(sweep, asked, usual[i]);
    return possible;
}

static bool same_domain(const struct domain_choice *a, const struct domain_choice *b)
{
    return a->domain == b->domain && a->display.curve == b->display.curve &&
           a->display.gamma == b->display.gamma;
}

// "log" and "log:0.01" are one domain, and so are "auto" and what it turns out to be.
static bool is_again(const struct sweep *sweep)
{
    for (int i = 0; i < sweep->rows; i++)
        if (same_domain(&sweep->row[i].domain, &sweep->domain))
            return true;
    return false;
}

static relume_status make_rows(struct sweep *sweep, const relume_capture *capture)
{
    struct entries bases = sweep->options->basis;
    bool possible = false;
    sweep->row = calloc(MOST_ROWS, sizeof *sweep->row);
    if (!sweep->row)
        return RELUME_ENOMEM;
    for (int i = 0; !sweep->options->basis.count && (!i || relume_bases[i - 1]); i++)
        bases.item[bases.count++] = i ? relume_bases[i - 1] : NULL;
    for (int d = 0; d < sweep->options->domains.count; d++) {
        sweep->domain = sweep->options->domains.item[d];
        sweep->domain.domain = relume_capture_domain(capture, sweep->domain.domain);
        const bool again = is_again(sweep);
        for (int b = 0; !again && b < bases.count; b++)
            possible |= add_sizes(sweep, bases.item[b]);
    }
    if (sweep->rows == MOST_ROWS)
        return usage_error("sweep: expected a grid of fewer than %d rows", MOST_ROWS);
    return possible ? RELUME_OK : no_such_size(&bases);
}

// ---------------------------------------------------------------- one group of rows

// Rows that differ only in how they are stored share their coefficients.
static int group_end(const struct sweep *sweep, int first)
{
    const struct sweep_row *a = &sweep->row[first];
    int end = first + 1;
    for (; end < sweep->rows; end++) {
        const struct sweep_row *b = &sweep->row[end];
        if (a->basis != b->basis || a->interpolant != b->interpolant || a->choose != b->choose ||
            a->luminance != b->luminance || a->wanted != b->wanted ||
            !same_domain(&a->domain, &b->domain))
            break;
    }
    return end;
}

// What the capture was warned of: rows have the same to say.
struct warnings {
    char text[8][200];
    int count;
};

// Keeps the last sentence, as the reason for leaving a row out, and maps progress to the whole.
struct listener {
    struct relume_log log, inner;  // `inner` is for steps whose own progress is not shown
    struct relume_log parts;       // for coders of some of the lights, whose warnings say nothing
    const struct relume_log *to;
    struct warnings *warnings;
    double first, extent, last;
    char said[200];
};

static bool is_new(struct warnings *w, const char *text)
{
    enum { MOST = sizeof w->text / sizeof *w->text };
    for (int i = 0; i < w->count; i++)
        if (!strncmp(w->text[i], text, sizeof w->text[i] - 1))
            return false;
    if (w->count < MOST)
        snprintf(w->text[w->count++], sizeof w->text[0], "%s", text);
    return true;
}

static void hear_errors(void *user, enum relume_level level, const char *text)
{
    struct listener *l = user;
    if (level == RELUME_ERROR)
        snprintf(l->said, sizeof l->said, "%s", text);
}

static void hear(void *user, enum relume_level level, const char *text)
{
    struct listener *l = user;
    if (level == RELUME_ERROR)
        hear_errors(user, level, text);
    else if (is_new(l->warnings, text))
        l->to->message(l->to->user, level, text);
}

static bool forward_progress(void *user, const char *what, double done)
{
    struct listener *l = user;
    (void)what;
    l->last = l->first + l->extent * done;
    return l->to->progress(l->to->user, "sweeping", l->last);
}

static bool hold_progress(void *user, const char *what, double done)
{
    const struct listener *l = user;
    (void)what;
    (void)done;
    return l->to->progress(l->to->user, "sweeping", l->last);
}

static struct listener *listen_to(struct listener *l, const struct relume_log *to,
                                  struct warnings *warnings, double first, double extent)
{
    *l = (struct listener){.log = {hear, forward_progress, l, to->context, false},
                           .inner = {hear, hold_progress, l, to->context, false},
                           .parts = {hear_errors, forward_progress, l, to->context, false},
                           .to = to,
                           .warnings = warnings,
                           .first = first,
                           .extent = extent,
                           .last = first};
    return l;
}

struct sweep_files {
    struct sweep *sweep;
    relume_capture *capture;
    relume_heldout *heldout;
    sweep_resume *resume;
    relume_making *folder;  // for files whose size is wanted
    struct warnings warnings;
};

static struct relume_coder_params coder_params(const struct sweep_row *row,
                                               const struct relume_log *log)
{
    return (struct relume_coder_params){.log = log,
                                        .coefficients = row->wanted,
                                        .interpolant = row->interpolant,
                                        .choose = row->choose,
                                        .luminance = row->luminance};
}

// The coder of all lights, which rows of a group share.
static relume_status learn(relume_coder **out, double *seconds, const struct sweep_files *w,
                           const struct sweep_row *row, const struct relume_log *log)
{
    const struct relume_coder_params params = coder_params(row, log);
    const double start = now_s();
    const relume_status status = relume_coder_learn(
        out, row->basis, w->capture, &params,
        relume_project_params(.log = log, .domain = row->domain.domain,
                              .display = row->domain.display, .threads = w->sweep->args->threads));
    *seconds = now_s() - start;
    return status;
}

// The real file of all lights, for its size.
static relume_status encode_row(struct sweep_files *w, struct sweep_row *row,
                                const relume_coder *coder, const struct relume_log *log)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/row.exr", relume_making_path(w->folder));
    relume_pack *pack = NULL;
    const double start = now_s();
    relume_status status = relume_pack_encode(
        w->capture, coder, path, NULL,
        relume_pack_encode_params(.log = log, .domain = row->domain.domain,
                                  .display = row->domain.display, .storage = row->store.storage,
                                  .step = row->store.step,
                                  .books = row->books.codes ? &row->books : NULL,
                                  .share = row->store.share, .threads = w->sweep->args->threads));
    row->seconds = now_s() - start;
    if (!status)
        status = relume_pack_open(&pack, path, relume_pack_params(.log = log));
    if (!status) {
        row->bytes = (double)relume_pack_info(pack)->file_bytes;
        row->bytes_per_pixel =
            row->bytes / ((double)w->sweep->views * w->sweep->width * w->sweep->height);
        row->coefficients = relume_coder_info(coder)->coefficients;
        row->planes = relume_coder_info(coder)->planes;
    }
    relume_pack_destroy(&pack);
    unlink(path);
    return status;
}

// What one row's data or coder forbid leaves that row out; all else ends the sweep, a photograph
// that cannot be read as well: every row is of all of them.
static bool is_skipped(relume_status status)
{
    return status >= RELUME_ELIMIT && status <= RELUME_EINVAL;
}

static void skip_row(struct sweep_row *row, const struct listener *l, relume_status status)
{
    snprintf(row->skipped, sizeof row->skipped, "%s",
             *l->said ? l->said : relume_status_text(status));
}

static relume_status measure_rows(struct sweep_files *w, struct sweep_row **rows, int n,
                                  struct listener *l);

// One way of storing may be impossible where the others are not.
static relume_status measure_apart(struct sweep_files *w, struct sweep_row **rows, int n,
                                   struct listener *l)
{
    const double first = l->first, extent = l->extent / n;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < n; i++) {
        listen_to(l, l->to, l->warnings, first + i * extent, extent);
        status = measure_rows(w, &rows[i], 1, l);
    }
    return status;
}

// What rows of one basis have in common is measured once: before and after storing.
static relume_status measure_heldout(struct sweep_files *w, struct sweep_row **rows, int n,
                                     struct listener *l)
{
    struct relume_heldout_store *store = calloc((size_t)n, sizeof *store);
    struct relume_heldout_quality before, *after = calloc((size_t)n, sizeof *after);
    const struct relume_coder_params params = coder_params(rows[0], &l->parts);
    relume_status status = store && after ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < n; i++) {
        rows[i]->books.log = &l->inner;
        store[i] = rows[i]->store;
        store[i].books = rows[i]->books.codes ? &rows[i]->books : NULL;
    }
    if (!status)
        status =
            relume_heldout_measure(w->heldout, rows[0]->basis, &params, store, n, &before, after);
    for (int i = 0; !status && i < n; i++) {
        rows[i]->before_db = before.psnr_db;
        rows[i]->quality = after[i];
    }
    free(store);
    free(after);
    return status;
}

static relume_status measure_rows(struct sweep_files *w, struct sweep_row **rows, int n,
                                  struct listener *l)
{
    l->extent *= 0.9;
    relume_status status = measure_heldout(w, rows, n, l);
    if (is_skipped(status) && n > 1)
        return measure_apart(w, rows, n, l);
    if (is_skipped(status))
        skip_row(rows[0], l, status);
    if (status)
        return is_skipped(status) ? RELUME_OK : status;
    relume_coder *coder = NULL;
    double seconds;
    l->first += l->extent;
    l->extent /= 9.0 * n;
    const relume_status learnt = learn(&coder, &seconds, w, rows[0], &l->inner);
    for (int i = 0; !status && i < n; i++, l->first += l->extent) {
        status = learnt ? learnt : encode_row(w, rows[i], coder, &l->log);
        rows[i]->seconds += seconds;
        if (is_skipped(status)) {
            skip_row(rows[i], l, status);
            status = RELUME_OK;
        } else if (!status) {
            rows[i]->known = true;
            status = sweep_resume_keep(w->resume, rows[i]);
        }
    }
    relume_coder_destroy(&coder);
    return status;
}

static relume_status measure_group(struct sweep_files *w, int first, int end)
{
    struct sweep_row *rows[MOST_ROWS];
    struct listener l;
    const double all = (double)w->sweep->rows;
    int n = 0;
    for (int i = first; i < end; i++)
        if (!w->sweep->row[i].known)
            rows[n++] = &w->sweep->row[i];
    listen_to(&l, w->sweep->args->log, &w->warnings, first / all, (end - first) / all);
    const relume_status status = n ? measure_rows(w, rows, n, &l) : RELUME_OK;
    if (status && *l.said)
        l.to->message(l.to->user, RELUME_ERROR, l.said);
    return status;
}

// ---------------------------------------------------------------- the whole

// The rows from `first` on that are of one domain; `*end` is the next.
static relume_status measure_domain(struct sweep_files *w, const relume_capture *test, int first,
                                    int *end)
{
    struct sweep *s = w->sweep;
    const struct domain_choice domain = s->row[first].domain;
    relume_status status = relume_heldout_open(
        &w->heldout, w->capture,
        relume_heldout_params(.log = s->args->log, .test = test, .leave_out = s->leave_out,
                              .domain = domain.domain, .display = domain.display,
                              .tone_mapped = s->tone_mapped, .threads = s->args->threads,
                              .memory = (uint64_t)s->options->memory << 20));
    if (!status) {
        const struct relume_heldout_info *info = relume_heldout_info(w->heldout);
        s->measured = (double)info->pixels / (double)info->all_pixels;
    }
    if (!status && s->measured < 1.0 && !first)
        announce(s->args, RELUME_NOTE,
                 "measured on %.0f %% of the picture's rows; give more --memory to use more",
                 100.0 * s->measured);
    for (*end = first; !status && *end < s->rows; first = *end) {
        if (!same_domain(&s->row[first].domain, &domain))
            break;
        *end = group_end(s, first);
        status = measure_group(w, first, *end);
    }
    relume_heldout_destroy(&w->heldout);
    return status;
}

static relume_status measure_all(struct sweep_files *w, const relume_capture *test)
{
    const struct sweep *s = w->sweep;
    relume_status status =
        relume_making_open(&w->folder, NULL, RELUME_MADE_FOLDER, false, s->args->log);
    for (int first = 0, end; !status && first < s->rows; first = end)
        status = measure_domain(w, test, first, &end);
    relume_making_abort(&w->folder);
    return status;
}

// The four files are of one sweep, also where two write them.
static relume_status finish(struct sweep *sweep, sweep_resume *resume)
{
    relume_status status = sweep_mark_hull(sweep);
    sweep_resume_lock(resume);
    if (!status && sweep->out)
        status = sweep_save(sweep);
    sweep_resume_unlock(resume);
    if (status)
        return status;
    if (sweep->options->json)
        sweep_print_json(sweep, stdout);
    else if (sweep->options->csv)
        sweep_print_csv(sweep, stdout);
    else
        sweep_print_text(sweep, stdout);
    return RELUME_OK;
}

static relume_status sweep_captures(struct sweep *sweep, relume_capture *capture,
                                    const relume_capture *test)
{
    const relume_capture *both[] = {capture, test, NULL};
    struct sweep_files w = {.sweep = sweep, .capture = capture};
    const uint64_t memory = (uint64_t)sweep->options->memory << 20;
    relume_status status = sweep->out ? sweep_check(sweep) : RELUME_OK;
    if (!status)
        status = sweep_resume_open(&w.resume, sweep, both, memory);
    int unknown = 0;
    for (int i = 0; i < sweep->rows; i++)
        unknown += !sweep->row[i].known;
    if (!status && unknown)
        status = measure_all(&w, test);
    if (status == RELUME_ECANCEL && sweep->out)
        announce(sweep->args, RELUME_NOTE,
                 "finished rows are kept; run the same command again to continue");
    if (!status)
        status = finish(sweep, w.resume);
    sweep_resume_close(&w.resume);
    return status;
}

// `keep` bytes of decoded images wait for the next row.
static relume_status open_capture(const struct sweep_options *o, const char *path, size_t keep,
                                  relume_capture **out)
{
    return relume_capture_open_photographs(
        out, path,
        relume_capture_params(.log = o->args.log, .transfer = o->transfer,
                              .skip_missing = o->skip_missing, .allow_outside = o->allow_outside,
                              .keep_bytes = keep),
        NULL, NULL);
}

static relume_status run_sweep(const struct args *args)
{
    const struct sweep_options *o = (const void *)args;
    relume_capture *capture = NULL, *test = NULL;
    struct sweep sweep = {.args = args,
                          .options = o,
                          .capture = args->input[0],
                          .test = o->test,
                          .out = o->output,
                          .leave_out = o->leave_out,
                          .tone_mapped = o->tone_map,
                          .measured = 1.0};
    if (o->test && given(o, &o->leave_out))
        return usage_error("sweep: expected --leave-out or --test; found both");
    if (o->json && o->csv)
        return usage_error("sweep: expected --json or --csv; found both");
    relume_status status = parse_books(args, &o->books, given(o, &o->codebook), &sweep.books);
    if (!status)
        status = open_capture(o, sweep.capture, KEEP_BYTES, &capture);
    if (!status && sweep.test)
        status = open_capture(o, sweep.test, 0, &test);
    if (!status) {
        const struct relume_manifest *m = relume_capture_manifest(capture);
        sweep.views = m->views;
        sweep.lights = m->lights;
        sweep.judged = test ? relume_capture_manifest(test)->lights : m->lights;
        sweep.width = relume_capture_width(capture);
        sweep.height = relume_capture_height(capture);
        status = make_rows(&sweep, capture);
    }
    if (!status)
        status = sweep_captures(&sweep, capture, test);
    relume_capture_destroy(&capture);
    relume_capture_destroy(&test);
    free(sweep.row);
    return status;
}

const struct command command_sweep = {
    COMMAND(run_sweep, "sweep",
            "CAPTURE [--leave-out K | --test CAPTURE2] [-o OUT] [--json | --csv] [OPTION ...]",
            "compare file size and quality of coders on lights left out",
            "relume sweep photos/dirs.lp --basis pca,hsh,ptm --leave-out 5 -o statue", 1, 1),
    .defaults = &(const OPTIONS){.luminance = {1, {0}},
                                 .domains = {.count = 1},
                                 .bits = {1, {RELUME_STORE_8}},
                                 .step = {1, {RELUME_STEP_PLANE}},
                                 .codebook = {1, {0}},
                                 .leave_out = 1,
                                 .memory = 1024},
};
