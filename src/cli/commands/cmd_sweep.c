// cmd_sweep.c - relume sweep: every coder of a grid judged by lights that it has not seen
#include "book_options.h"
#include "commands/sweep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

struct sweep_options {
    struct args args;
    const char *output, *basis, *coefficients, *interpolant, *colour, *bits, *step, *codebook,
        *test, *domain, *transfer;
    int leave_out, memory;
    bool skip_missing, json, csv;
    struct book_options books;
    bool allow_outside;
};
#define OPTIONS struct sweep_options

static const struct option options[] = {
    TEXT_AS(OPTION_OUTPUT, "-o", output, "output", "OUT",
            "write OUT.csv, OUT.json, OUT.svg, OUT.png; keep OUT.resume"),
    TEXT("--basis", basis, "model", "LIST", "bases, separated by commas; default: all"),
    TEXT("--coefficients", coefficients, "model", "LIST",
         "sizes; default: those natural to each basis"),
    TEXT("--interpolant", interpolant, "model", "LIST",
         "of pca and table, also auto; default: their own"),
    TEXT("--colour", colour, "model", "LIST", "rgb, luminance; default: rgb"),
    TEXT("--bits", bits, "model", "LIST", "8, 10, 12, 16, half; default: 8"),
    TEXT("--step", step, "model", "LIST", "plane, common; default: plane"),
    TEXT("--codebook", codebook, "model", "LIST", "code vectors, 0: planes; default: 0"),
    BOOK_FORM_OPTIONS,
    INT("--leave-out", leave_out, "model", "K", "lights left out at a time; default: 1", 1, 65535),
    TEXT("--test", test, "model", "CAPTURE", "measure on the lights of another capture instead"),
    TEXT("--domain", domain, "model", "D", "auto, linear or display; default: as encode"),
    INT("--memory", memory, "machine", "MB",
        "for samples; more than fit are thinned out; default: 1024", 1, 1048576),
    TEXT("--transfer", transfer, "input", "T", "linear, srgb or gamma:G; overrides the capture's"),
    FLAG("--skip-missing", skip_missing, "input", "leave out lights whose image does not exist"),
    ALLOW_OUTSIDE_OPTION,
    FLAG("--json", json, "output", "print one JSON object"),
    FLAG("--csv", csv, "output", "print comma-separated values"),
    {0},
};

enum { MOST = 64, MOST_ROWS = 4096, MOST_COEFFICIENTS = 4096 };

// ---------------------------------------------------------------- the grid

struct grid {
    const struct relume_basis *basis[MOST];
    bool automatic[MOST];  // the basis is called auto: components with the interpolant chosen
    const struct relume_interpolant *interpolant[MOST];  // NULL: chosen
    int size[MOST], codes[MOST];
    struct relume_books_params books;
    bool share;
    bool luminance[MOST];
    enum relume_storage storage[MOST];
    enum relume_step step[MOST];
    int bases, interpolants, sizes, colours, storages, steps, books_count;
};

// The words of a comma-separated list, each given to `accept`.
static relume_status parse_list(const char *option, const char *text, int *count, struct grid *grid,
                                relume_status (*accept)(struct grid *, int, const char *))
{
    *count = 0;
    while (*text) {
        const size_t n = strcspn(text, ",");
        char word[64];
        if (n == 0 || n >= sizeof word)
            return usage_error("%s: expected words separated by commas; found '%s'", option, text);
        if (*count == MOST)
            return usage_error("%s: expected at most %d words", option, MOST);
        snprintf(word, sizeof word, "%.*s", (int)n, text);
        const relume_status status = accept(grid, (*count)++, word);
        if (status)
            return status;
        text += n;
        if (*text == ',' && !*++text)
            return usage_error("%s: expected a word after the last comma", option);
    }
    return *count ? RELUME_OK : usage_error("%s: expected a list; found nothing", option);
}

static relume_status accept_basis(struct grid *grid, int i, const char *word)
{
    const char *names[MOST] = {"auto"};
    for (int n = 0; relume_bases[n]; n++)
        names[n + 1] = relume_bases[n]->name;
    grid->automatic[i] = !strcmp(word, "auto");
    grid->basis[i] = grid->automatic[i] ? &relume_basis_pca : relume_basis_find(word);
    return grid->basis[i] ? RELUME_OK : unknown_name("basis", word, names);
}

static relume_status accept_interpolant(struct grid *grid, int i, const char *word)
{
    const char *names[MOST] = {"auto"};
    for (int n = 0; relume_interpolants[n]; n++)
        names[n + 1] = relume_interpolants[n]->name;
    grid->interpolant[i] = relume_interpolant_find(word);
    return grid->interpolant[i] || !strcmp(word, "auto")
               ? RELUME_OK
               : unknown_name("--interpolant", word, names);
}

static bool parse_whole(const char *word, long least, long most, int *out)
{
    char *end;
    const long number = strtol(word, &end, 10);
    *out = (int)number;
    return end != word && !*end && number >= least && number <= most;
}

static relume_status accept_size(struct grid *grid, int i, const char *word)
{
    if (parse_whole(word, 1, MOST_COEFFICIENTS, &grid->size[i]))
        return RELUME_OK;
    return usage_error("--coefficients: expected whole numbers from 1 to %d; found '%s'",
                       MOST_COEFFICIENTS, word);
}

static relume_status accept_codes(struct grid *grid, int i, const char *word)
{
    if (parse_whole(word, 0, 65536, &grid->codes[i]))
        return RELUME_OK;
    return usage_error("--codebook: expected whole numbers from 0 to 65536; found '%s'", word);
}

static relume_status accept_colour(struct grid *grid, int i, const char *word)
{
    static const char *const names[] = {"rgb", "luminance", NULL};
    grid->luminance[i] = !strcmp(word, names[1]);
    return grid->luminance[i] || !strcmp(word, names[0]) ? RELUME_OK
                                                         : unknown_name("--colour", word, names);
}

static relume_status accept_storage(struct grid *grid, int i, const char *word)
{
    static const char *const names[] = {"8", "10", "12", "16", "half", "log", "float", NULL};
    return relume_storage_parse(&grid->storage[i], word) ? unknown_name("--bits", word, names)
                                                         : RELUME_OK;
}

static relume_status accept_step(struct grid *grid, int i, const char *word)
{
    static const char *const names[] = {"plane", "common", NULL};
    grid->step[i] = !strcmp(word, names[1]) ? RELUME_STEP_COMMON : RELUME_STEP_PLANE;
    return grid->step[i] == RELUME_STEP_COMMON || !strcmp(word, names[0])
               ? RELUME_OK
               : unknown_name("--step", word, names);
}

static relume_status parse_grid(const struct sweep_options *o, struct grid *g)
{
    const char *bases = o->basis;
    const char *sizes = o->coefficients;
    const char *interpolants = o->interpolant;
    *g = (struct grid){0};
    relume_status status = RELUME_OK;
    if (bases)
        status = parse_list("--basis", bases, &g->bases, g, accept_basis);
    if (!bases)
        status = accept_basis(g, g->bases++, "auto");
    for (int i = 0; !bases && relume_bases[i]; i++)
        g->basis[g->bases++] = relume_bases[i];
    if (!status && sizes)
        status = parse_list("--coefficients", sizes, &g->sizes, g, accept_size);
    if (!status && interpolants)
        status = parse_list("--interpolant", interpolants, &g->interpolants, g, accept_interpolant);
    if (!status)
        status = parse_list("--colour", o->colour, &g->colours, g, accept_colour);
    if (!status)
        status = parse_list("--bits", o->bits, &g->storages, g, accept_storage);
    if (!status)
        status = parse_list("--step", o->step, &g->steps, g, accept_step);
    if (!status)
        status = parse_list("--codebook", o->codebook ? o->codebook : "0", &g->books_count, g,
                            accept_codes);
    if (!status)
        status = parse_books(&o->args, &o->books, o->codebook != NULL, &g->books);
    g->share = o->books.share;
    return status;
}

static void add_row(struct sweep *sweep, const struct grid *g, struct sweep_row row, int codes)
{
    if (sweep->rows == MOST_ROWS)
        return;
    if (codes) {
        row.books = g->books;
        row.books.codes = codes;
        row.store.share = g->share;
    }
    sweep->row[sweep->rows++] = row;
}

// Halves and codebooks have no step.
static void add_rows(struct sweep *sweep, const struct grid *g, struct sweep_row row)
{
    for (int i = 0; i < g->storages; i++)
        for (int j = 0; j < g->steps; j++)
            for (int k = 0; k < g->books_count; k++) {
                const bool stepless = g->codes[k] || !relume_storage_top(g->storage[i]);
                if (stepless && j > 0)
                    continue;
                row.store = (struct relume_heldout_store){
                    .storage = g->storage[i], .step = stepless ? RELUME_STEP_PLANE : g->step[j]};
                add_row(sweep, g, row, g->codes[k]);
            }
}

static void add_forms(struct sweep *sweep, const struct grid *g, int number, int size)
{
    const struct relume_basis *basis = g->basis[number];
    const bool interpolates = basis->interpolates && g->interpolants && !g->automatic[number];
    for (int i = 0; i < (interpolates ? g->interpolants : 1); i++)
        for (int j = 0; j < g->colours; j++)
            if (!g->luminance[j] || !basis->learned)
                add_rows(sweep, g,
                         (struct sweep_row){
                             .basis = basis,
                             .interpolant = interpolates ? g->interpolant[i] : NULL,
                             .choose = g->automatic[number] || (interpolates && !g->interpolant[i]),
                             .luminance = g->luminance[j],
                             .wanted = size,
                             .coefficients = size ? size : sweep->lights,
                         });
}

// "ptm has 6 coefficients" and what other sizes up to 36 the bases have.
static relume_status no_such_size(const struct grid *g)
{
    char text[1024];
    size_t at = 0;
    for (int b = 0; b < g->bases && at < sizeof text; b++) {
        if (g->automatic[b])
            continue;
        at += (size_t)snprintf(text + at, sizeof text - at, "%s%s has", at ? "; " : "",
                               g->basis[b]->name);
        for (int k = 1; k <= 36 && at < sizeof text; k++)
            if (g->basis[b]->has_count(k))
                at += (size_t)snprintf(text + at, sizeof text - at, " %d", k);
    }
    return usage_error("--coefficients: none of the bases has that many; up to 36, %s", text);
}

// A basis that keeps every light has one size. The others have a row for each that is asked for,
// which says why where it cannot be, or of the usual ones those that the lights determine.
static relume_status make_rows(struct sweep *sweep, const struct grid *g)
{
    static const int usual[] = {1, 4, 6, 9, 16, 18, 25, 27, 36, 49};
    sweep->row = calloc(MOST_ROWS, sizeof *sweep->row);
    if (!sweep->row)
        return RELUME_ENOMEM;
    bool possible = !g->sizes;
    for (int b = 0; b < g->bases; b++) {
        const struct relume_basis *basis = g->basis[b];
        if (basis->interpolates && !basis->learned) {
            add_forms(sweep, g, b, 0);
            possible = true;
            continue;
        }
        for (int i = 0; i < g->sizes; i++) {
            add_forms(sweep, g, b, g->size[i]);
            possible |= basis->has_count(g->size[i]);
        }
        for (size_t i = 0; !g->sizes && i < sizeof usual / sizeof *usual; i++)
            if (basis->has_count(usual[i]) && basis->fit_count(usual[i], sweep->lights) == usual[i])
                add_forms(sweep, g, b, usual[i]);
    }
    if (sweep->rows == MOST_ROWS)
        return usage_error("sweep: expected a grid of fewer than %d rows", MOST_ROWS);
    return possible ? RELUME_OK : no_such_size(g);
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
            a->luminance != b->luminance || a->wanted != b->wanted)
            break;
    }
    return end;
}

// Keeps the last sentence, as the reason for leaving a row out, and maps progress to the whole.
struct listener {
    struct relume_log log, inner;  // `inner` is for steps whose own progress is not shown
    const struct relume_log *to;
    double first, extent, last;
    char said[200];
};

static void hear(void *user, enum relume_level level, const char *text)
{
    struct listener *l = user;
    if (level == RELUME_ERROR)
        snprintf(l->said, sizeof l->said, "%s", text);
    else
        l->to->message(l->to->user, level, text);
}

static bool pass_progress(void *user, const char *what, double done)
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

static struct listener *listen_to(struct listener *l, const struct relume_log *to, double first,
                                  double extent)
{
    *l = (struct listener){.log = {hear, pass_progress, l, to->inputs},
                           .inner = {hear, hold_progress, l, to->inputs},
                           .to = to,
                           .first = first,
                           .extent = extent,
                           .last = first};
    return l;
}

struct work {
    struct sweep *sweep;
    relume_capture *capture;
    relume_heldout *heldout;
    sweep_resume *resume;
    relume_making *folder;  // for files whose size is wanted
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

static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// The real file of all lights, for its size.
static relume_status encode_row(struct work *w, struct sweep_row *row, const struct relume_log *log)
{
    const struct args *args = w->sweep->args;
    const struct relume_coder_params params = coder_params(row, log);
    char path[4096];
    snprintf(path, sizeof path, "%s/row.exr", relume_making_path(w->folder));
    relume_coder *coder = NULL;
    relume_pack *pack = NULL;
    const double start = seconds_now();
    relume_status status = relume_coder_learn(
        &coder, row->basis, w->capture, &params,
        relume_encode_params(.log = log, .domain = w->sweep->domain, .threads = args->threads));
    if (!status)
        status = relume_pack_encode(
            w->capture, coder, path, NULL,
            relume_pack_encode_params(.log = log, .domain = w->sweep->domain,
                                      .storage = row->store.storage, .step = row->store.step,
                                      .books = row->books.codes ? &row->books : NULL,
                                      .share = row->store.share, .threads = args->threads));
    row->seconds = seconds_now() - start;
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
    relume_coder_destroy(&coder);
    unlink(path);
    return status;
}

// What one row's data or coder forbid leaves that row out; all else ends the sweep.
static bool is_skipped(relume_status status)
{
    return relume_status_is_input(status) || status == RELUME_EINVAL;
}

static void skip_row(struct sweep_row *row, const struct listener *l, relume_status status)
{
    snprintf(row->skipped, sizeof row->skipped, "%s",
             *l->said ? l->said : relume_status_text(status));
}

static relume_status measure_rows(struct work *w, struct sweep_row **rows, int n,
                                  struct listener *l);

// One way of storing may be impossible where the others are not.
static relume_status measure_apart(struct work *w, struct sweep_row **rows, int n,
                                   struct listener *l)
{
    const double first = l->first, extent = l->extent / n;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < n; i++) {
        listen_to(l, l->to, first + i * extent, extent);
        status = measure_rows(w, &rows[i], 1, l);
    }
    return status;
}

static relume_status measure_rows(struct work *w, struct sweep_row **rows, int n,
                                  struct listener *l)
{
    struct relume_heldout_store store[MOST_ROWS];
    struct relume_heldout_quality before, after[MOST_ROWS];
    const struct relume_coder_params params = coder_params(rows[0], &l->log);
    for (int i = 0; i < n; i++) {
        rows[i]->books.log = &l->inner;
        store[i] = rows[i]->store;
        store[i].books = rows[i]->books.codes ? &rows[i]->books : NULL;
    }
    l->extent *= 0.9;
    relume_status status =
        relume_heldout_measure(w->heldout, rows[0]->basis, &params, store, n, &before, after);
    if (is_skipped(status) && n > 1)
        return measure_apart(w, rows, n, l);
    if (is_skipped(status))
        skip_row(rows[0], l, status);
    if (status)
        return is_skipped(status) ? RELUME_OK : status;
    l->first += l->extent;
    l->extent /= 9.0 * n;
    for (int i = 0; !status && i < n; i++, l->first += l->extent) {
        rows[i]->before_db = before.psnr_db;
        rows[i]->quality = after[i];
        status = encode_row(w, rows[i], &l->log);
        if (is_skipped(status)) {
            skip_row(rows[i], l, status);
            status = RELUME_OK;
        } else if (!status) {
            rows[i]->known = true;
            status = sweep_resume_keep(w->resume, rows[i]);
        }
    }
    return status;
}

static relume_status measure_group(struct work *w, int first, int end)
{
    struct sweep_row *rows[MOST_ROWS];
    struct listener l;
    const double all = (double)w->sweep->rows;
    int n = 0;
    for (int i = first; i < end; i++)
        if (!w->sweep->row[i].known)
            rows[n++] = &w->sweep->row[i];
    listen_to(&l, w->sweep->args->log, first / all, (end - first) / all);
    const relume_status status = n ? measure_rows(w, rows, n, &l) : RELUME_OK;
    if (status && *l.said)
        l.to->message(l.to->user, RELUME_ERROR, l.said);
    return status;
}

// ---------------------------------------------------------------- the whole

static bool all_known(const struct sweep *sweep)
{
    for (int i = 0; i < sweep->rows; i++)
        if (!sweep->row[i].known)
            return false;
    return true;
}

static relume_status measure_all(struct work *w, const relume_capture *test)
{
    struct sweep *s = w->sweep;
    relume_status status = relume_heldout_open(
        &w->heldout, w->capture,
        relume_heldout_params(.log = s->args->log, .test = test, .leave_out = s->leave_out,
                              .domain = s->domain, .threads = s->args->threads,
                              .memory = (uint64_t)s->options->memory << 20));
    if (!status) {
        const struct relume_heldout_info info = relume_heldout_info(w->heldout);
        s->measured = (double)info.pixels / (double)info.all_pixels;
        status = relume_making_open(&w->folder, NULL, RELUME_MADE_FOLDER, false, s->args->log);
    }
    if (!status && s->measured < 1.0)
        say(s->args, RELUME_NOTE,
            "measured on %.0f %% of the picture's rows; give more --memory to use more",
            100.0 * s->measured);
    for (int first = 0, end; !status && first < s->rows; first = end) {
        end = group_end(s, first);
        status = measure_group(w, first, end);
    }
    relume_making_abort(&w->folder);
    relume_heldout_destroy(&w->heldout);
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
    struct work w = {.sweep = sweep, .capture = capture};
    const uint64_t memory = (uint64_t)sweep->options->memory << 20;
    relume_status status = sweep->out ? sweep_check(sweep) : RELUME_OK;
    if (!status)
        status = sweep_resume_open(&w.resume, sweep, both, memory);
    if (!status && !all_known(sweep))
        status = measure_all(&w, test);
    if (status == RELUME_ECANCEL && sweep->out)
        say(sweep->args, RELUME_NOTE,
            "finished rows are kept; run the same command again to continue");
    if (!status)
        status = finish(sweep, w.resume);
    sweep_resume_close(&w.resume);
    return status;
}

static relume_status open_capture(const struct sweep_options *o, const char *path,
                                  relume_capture **out)
{
    struct relume_transfer transfer = {.curve = RELUME_CURVE_AUTO};
    if (args_transfer(&transfer, "--transfer", o->transfer))
        return RELUME_EINVAL;
    return relume_capture_open(out, path,
                               relume_capture_params(.log = o->args.log, .transfer = transfer,
                                                     .skip_missing = o->skip_missing,
                                                     .allow_outside = o->allow_outside));
}

static relume_status check_options(const struct sweep_options *o)
{
    if (o->test && args_given(&o->args, &o->leave_out))
        return usage_error("sweep: expected --leave-out or --test; found both");
    if (o->json && o->csv)
        return usage_error("sweep: expected --json or --csv; found both");
    return RELUME_OK;
}

static relume_status run(const struct args *args)
{
    const struct sweep_options *o = (const void *)args;
    struct grid *grid = calloc(1, sizeof *grid);
    relume_capture *capture = NULL, *test = NULL;
    struct sweep sweep = {.args = args,
                          .options = o,
                          .capture = args->input[0],
                          .test = o->test,
                          .out = o->output,
                          .leave_out = o->leave_out,
                          .measured = 1.0};
    relume_status status = grid ? check_options(o) : RELUME_ENOMEM;
    if (!status)
        status = parse_grid(o, grid);
    if (!status)
        status = args_domain(&sweep.domain, o->domain);
    if (!status)
        status = open_capture(o, sweep.capture, &capture);
    if (!status && sweep.test)
        status = open_capture(o, sweep.test, &test);
    if (!status) {
        const struct relume_manifest *m = relume_capture_manifest(capture);
        sweep.domain = relume_encode_domain(capture, sweep.domain);
        sweep.views = m->views;
        sweep.lights = m->lights;
        sweep.judged = test ? relume_capture_manifest(test)->lights : m->lights;
        sweep.width = relume_capture_width(capture);
        sweep.height = relume_capture_height(capture);
        status = make_rows(&sweep, grid);
    }
    if (!status)
        status = sweep_captures(&sweep, capture, test);
    relume_capture_destroy(&capture);
    relume_capture_destroy(&test);
    free(sweep.row);
    free(grid);
    return status;
}

const struct command command_sweep = {
    .name = "sweep",
    .usage = "CAPTURE [--leave-out K | --test CAPTURE2] [-o OUT] [--json | --csv] [OPTION ...]",
    .summary = "compare file size and quality of coders on lights left out",
    .example = "relume sweep photos/dirs.lp --basis pca,hsh,ptm --leave-out 5 -o statue",
    .min_inputs = 1,
    .max_inputs = 1,
    .options = options,
    .size = sizeof(struct sweep_options),
    .defaults = &(const struct sweep_options){.colour = "rgb",
                                              .bits = "8",
                                              .step = "plane",
                                              .leave_out = 1,
                                              .domain = "auto",
                                              .memory = 1024},
    .run = run,
};
