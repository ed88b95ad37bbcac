// sweep_report.c - the table as text, CSV and JSON, and its diagram
#include "cli/commands/sweep.h"
#include "cli/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DOMAIN_WORDS = 24 };

// With its delta, where that is not the usual one.
static const char *domain_words(char text[DOMAIN_WORDS], const struct domain_choice *d)
{
    const char *name = relume_domain_name(d->domain, d->display);
    if (d->display.curve == RELUME_CURVE_LOG && d->display.gamma != RELUME_LOG_DELTA)
        relume_transfer_text(d->display, text, DOMAIN_WORDS);
    else
        snprintf(text, DOMAIN_WORDS, "%s", name);
    return text;
}

void sweep_coder_name(const struct sweep_row *row, char *text, size_t size)
{
    char words[DOMAIN_WORDS];
    int n;
    if (row->choose && row->basis->joint)
        n = snprintf(text, size, "auto");
    else
        n = snprintf(text, size, "%s%s%s%s", row->basis->name,
                     row->choose || row->interpolant ? " " : "",
                     row->choose        ? "auto"
                     : row->interpolant ? row->interpolant->name
                                        : "",
                     row->luminance ? " luminance" : "");
    if (row->several_domains)
        snprintf(text + n, size - (size_t)n, " %s", domain_words(words, &row->domain));
}

const char *sweep_step_name(const struct sweep_row *row)
{
    if (row->books.codes)
        return "-";
    return row->store.step == RELUME_STEP_COMMON ? "common" : "plane";
}

relume_status sweep_mark_hull(struct sweep *sweep)
{
    const size_t n = (size_t)sweep->rows;
    double *rate = calloc(n, sizeof *rate), *quality = calloc(n, sizeof *quality);
    bool *on = calloc(n, sizeof *on);
    const bool good = rate && quality && on;
    for (size_t i = 0; good && i < n; i++) {
        rate[i] = sweep->row[i].known ? sweep->row[i].bytes_per_pixel : 0.0;
        quality[i] = sweep->row[i].quality.psnr_db;
    }
    if (good)
        relume_rate_hull(on, rate, quality, sweep->rows);
    for (size_t i = 0; good && i < n; i++)
        sweep->row[i].on_hull = on[i];
    free(rate);
    free(quality);
    free(on);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- text

void sweep_print_text(const struct sweep *sweep, FILE *out)
{
    fprintf(out, "%-18s %4s %4s %-6s %5s %6s %9s %9s %9s %9s %8s %7s  %s\n", "coder", "K", "bits",
            "step", "codes", "planes", "bytes/px", "before dB", "PSNR dB", "pooled dB", "SSIM",
            "seconds", "hull");
    for (int i = 0; i < sweep->rows; i++) {
        const struct sweep_row *r = &sweep->row[i];
        struct shown why;
        char name[64];
        sweep_coder_name(r, name, sizeof name);
        fprintf(out, "%-18s %4d %4s %-6s %5d ", name, r->coefficients,
                relume_storage_name(r->store.storage), sweep_step_name(r), r->books.codes);
        if (r->known)
            fprintf(out, "%6d %9.4f %9.3f %9.3f %9.3f %8.4f %7.2f  %s\n", r->planes,
                    r->bytes_per_pixel, r->before_db, r->quality.psnr_db, r->quality.psnr_pooled_db,
                    r->quality.ssim, r->seconds, r->on_hull ? "*" : "");
        else
            fprintf(out, "skipped: %s\n", shown(&why, r->skipped));
    }
}

// ---------------------------------------------------------------- CSV

static void csv_number(FILE *out, double value)
{
    fputc(',', out);
    if (isfinite(value))
        fprintf(out, "%.9g", value);
}

static void csv_text(FILE *out, const char *text)
{
    fputs(",\"", out);
    for (; *text; text++)
        fprintf(out, *text == '"' ? "\"\"" : "%c", *text);
    fputc('"', out);
}

void sweep_print_csv(const struct sweep *sweep, FILE *out)
{
    fputs(
        "coder,coefficients,bits,step,codebook,planes,bytes,bytes_per_pixel,psnr_before_db,psnr_db,"
        "psnr_pooled_db,ssim,seconds,hull,skipped,domain\n",
        out);
    for (int i = 0; i < sweep->rows; i++) {
        const struct sweep_row *r = &sweep->row[i];
        char name[64], words[DOMAIN_WORDS];
        sweep_coder_name(r, name, sizeof name);
        fprintf(out, "%s,%d,%s,%s,%d", name, r->coefficients, relume_storage_name(r->store.storage),
                sweep_step_name(r), r->books.codes);
        if (!r->known) {
            fputs(",,,,,,,,,", out);
            csv_text(out, r->skipped);
            fprintf(out, ",%s\n", domain_words(words, &r->domain));
            continue;
        }
        fprintf(out, ",%d,%.0f", r->planes, r->bytes);
        csv_number(out, r->bytes_per_pixel);
        csv_number(out, r->before_db);
        csv_number(out, r->quality.psnr_db);
        csv_number(out, r->quality.psnr_pooled_db);
        csv_number(out, r->quality.ssim);
        csv_number(out, r->seconds);
        fprintf(out, ",%d,,%s\n", r->on_hull, domain_words(words, &r->domain));
    }
}

// ---------------------------------------------------------------- JSON

static void put_quality(struct jwriter *w, const struct sweep_row *r)
{
    json_measure(w, "planes", r->planes);
    json_measure(w, "bytes", r->bytes);
    json_measure(w, "bytes_per_pixel", r->bytes_per_pixel);
    json_measure(w, "psnr_before_db", r->before_db);
    json_measure(w, "psnr_db", r->quality.psnr_db);
    json_measure(w, "psnr_pooled_db", r->quality.psnr_pooled_db);
    json_measure(w, "ssim", r->quality.ssim);
    json_measure(w, "seconds", r->seconds);
    jput_truth(w, "hull", r->on_hull);
}

static void put_row(struct jwriter *w, const struct sweep_row *r)
{
    char words[DOMAIN_WORDS];
    jopen_object(w, NULL);
    jput_text(w, "basis", r->basis->name);
    jput_text(w, "interpolant", r->interpolant ? r->interpolant->name : NULL);
    jput_text(w, "colour", r->luminance ? "luminance" : "rgb");
    jput_integer(w, "coefficients", r->coefficients);
    jput_text(w, "bits", relume_storage_name(r->store.storage));
    jput_text(w, "step", sweep_step_name(r));
    jput_integer(w, "codebook", r->books.codes);
    jput_text(w, "domain", domain_words(words, &r->domain));
    if (r->known)
        put_quality(w, r);
    else
        jput_text(w, "skipped", r->skipped);
    jclose(w);
}

void sweep_print_json(const struct sweep *sweep, FILE *out)
{
    char words[DOMAIN_WORDS];
    struct jwriter w = json_to(out);
    jopen_object(&w, NULL);
    jput_text(&w, "capture", sweep->capture);
    jput_text(&w, "test", sweep->test);
    if (sweep->test)
        jput_null(&w, "leave_out");
    else
        jput_integer(&w, "leave_out", sweep->leave_out);
    jput_integer(&w, "views", sweep->views);
    jput_integer(&w, "lights", sweep->lights);
    jput_integer(&w, "judged", sweep->judged);
    jput_integer(&w, "width", sweep->width);
    jput_integer(&w, "height", sweep->height);
    jput_text(&w, "domain", domain_words(words, &sweep->row[0].domain));
    jput_truth(&w, "tone_mapped", sweep->tone_mapped);
    json_measure(&w, "measured", sweep->measured);
    jopen_array(&w, "rows");
    for (int i = 0; i < sweep->rows; i++)
        put_row(&w, &sweep->row[i]);
    jend(&w);
}

// ---------------------------------------------------------------- the diagram

enum { MOST_SERIES = 64 };

struct diagram {
    const struct sweep *sweep;
    bool bits, steps, codes;  // that rows differ in
    struct plot_series series[MOST_SERIES];
    char coder[MOST_SERIES][64], store[MOST_SERIES][64];  // what their names are made of
    int series_count;
    struct plot_point *point;
    int points;
};

static void find_differences(struct diagram *d)
{
    const struct sweep_row *first = &d->sweep->row[0];
    for (int i = 0; i < d->sweep->rows; i++) {
        d->bits |= d->sweep->row[i].store.storage != first->store.storage;
        d->steps |= d->sweep->row[i].store.step != first->store.step;
        d->codes |= d->sweep->row[i].books.codes != first->books.codes;
    }
}

// What all rows share is not repeated in the legend.
static void store_name(const struct diagram *d, const struct sweep_row *row, char *text,
                       size_t size)
{
    const bool planes = !row->books.codes;
    size_t n = 0;
    *text = '\0';
    if (d->bits)
        n += (size_t)snprintf(text, size, ", %s", relume_storage_name(row->store.storage));
    if (d->steps && planes)
        n += (size_t)snprintf(text + n, size - n, ", %s", sweep_step_name(row));
    if (d->codes && planes)
        snprintf(text + n, size - n, ", planes");
    else if (d->codes)
        snprintf(text + n, size - n, ", %d codes", row->books.codes);
}

// The place of `text` among the first `count` different texts; `count` when it is new.
static int place_of(char (*texts)[64], int count, const char *text)
{
    int different = 0;
    for (int i = 0; i < count; i++) {
        bool seen = false;
        for (int j = 0; j < i; j++)
            seen |= !strcmp(texts[i], texts[j]);
        if (!strcmp(texts[i], text) && !seen)
            return different;
        different += !seen;
    }
    return different;
}

// Coders differ by colour and mark; where they are stored in several ways, the mark shows which.
static int find_series(struct diagram *d, const struct sweep_row *row)
{
    char coder[64], store[64];
    sweep_coder_name(row, coder, sizeof coder);
    store_name(d, row, store, sizeof store);
    for (int i = 0; i < d->series_count; i++)
        if (!strcmp(d->coder[i], coder) && !strcmp(d->store[i], store))
            return i;
    if (d->series_count == MOST_SERIES)
        return MOST_SERIES - 1;
    const int n = d->series_count++;
    struct plot_series *s = &d->series[n];
    s->colour = place_of(d->coder, n, coder);
    s->mark = d->bits || d->steps || d->codes ? place_of(d->store, n, store) : s->colour;
    snprintf(d->coder[n], sizeof d->coder[n], "%s", coder);
    snprintf(d->store[n], sizeof d->store[n], "%s", store);
    snprintf(s->name, sizeof s->name, "%.30s%.30s", coder, store);
    return n;
}

static void add_point(struct diagram *d, const struct sweep_row *row)
{
    if (!row->known || !(row->bytes_per_pixel > 0.0) || !isfinite(row->quality.psnr_db))
        return;
    struct plot_point *p = &d->point[d->points++];
    *p = (struct plot_point){.x = row->bytes_per_pixel,
                             .y = row->quality.psnr_db,
                             .series = find_series(d, row),
                             .on_hull = row->on_hull};
    snprintf(p->label, sizeof p->label, "%d", row->coefficients);
}

// The last three names of a path: files are often called capture.json or dirs.lp.
static const char *short_path(const char *path)
{
    const char *from = path + strlen(path);
    for (int names = 3; from > path; from--)
        if (from[-1] == '/' && --names == 0)
            break;
    return from;
}

static void describe(const struct sweep *sweep, char *text, size_t size)
{
    const char *bits = relume_storage_name(sweep->row[0].store.storage);
    bool one = true;
    for (int i = 0; i < sweep->rows; i++)
        one &= sweep->row[i].store.storage == sweep->row[0].store.storage;
    int n = snprintf(text, size, "%d light%s, %d x %d pixels; ", sweep->lights,
                     relume_plural(sweep->lights), sweep->width, sweep->height);
    if (sweep->test)
        n += snprintf(text + n, size - (size_t)n, "measured on %d other%s", sweep->judged,
                      relume_plural(sweep->judged));
    else
        n += snprintf(text + n, size - (size_t)n, "%d left out at a time", sweep->leave_out);
    if (one)
        n += snprintf(text + n, size - (size_t)n, "; %s%s coefficients", bits,
                      strcmp(bits, "half") ? "-bit" : "");
    if (sweep->tone_mapped)
        n += snprintf(text + n, size - (size_t)n, "; each at its own exposure");
    if (sweep->measured < 1.0)
        snprintf(text + n, size - (size_t)n, "; on %.0f %% of the picture's rows",
                 100.0 * sweep->measured);
}

static relume_status save_diagram(const struct sweep *sweep)
{
    struct diagram *d = calloc(1, sizeof *d);
    char title[160], subtitle[256];
    if (!d)
        return RELUME_ENOMEM;
    d->sweep = sweep;
    d->point = calloc((size_t)sweep->rows, sizeof *d->point);
    find_differences(d);
    for (int i = 0; d->point && i < sweep->rows; i++)
        add_point(d, &sweep->row[i]);
    snprintf(title, sizeof title, "File size and quality on lights left out: %.100s",
             short_path(sweep->capture));
    describe(sweep, subtitle, sizeof subtitle);
    const struct plot plot = {.title = title,
                              .subtitle = subtitle,
                              .x_label = "bytes per pixel and view (file)",
                              .y_label = "PSNR (dB)",
                              .series = d->series,
                              .series_count = d->series_count,
                              .point = d->point,
                              .points = d->points};
    relume_status status = d->point ? RELUME_OK : RELUME_ENOMEM;
    if (!status && d->points)
        status = plot_save(&plot, sweep->out, sweep->args->log);
    free(d->point);
    free(d);
    return status;
}

static void print_csv(const void *sweep, FILE *to)
{
    sweep_print_csv(sweep, to);
}

static void print_json(const void *sweep, FILE *to)
{
    sweep_print_json(sweep, to);
}

static relume_status save_table(const struct sweep *sweep, const char *extension,
                                void (*print)(const void *, FILE *))
{
    char path[4096];
    snprintf(path, sizeof path, "%s%s", sweep->out, extension);
    return relume_file_print(path, print, sweep, sweep->args->log);
}

relume_status sweep_save(const struct sweep *sweep)
{
    relume_status status = save_table(sweep, ".csv", print_csv);
    if (!status)
        status = save_table(sweep, ".json", print_json);
    return status ? status : save_diagram(sweep);
}

relume_status sweep_check(const struct sweep *sweep)
{
    static const char *const extensions[] = {".csv", ".json", ".svg", ".png"};
    relume_status status = RELUME_OK;
    char path[4096];
    for (size_t i = 0; !status && i < sizeof extensions / sizeof *extensions; i++) {
        snprintf(path, sizeof path, "%s%s", sweep->out, extensions[i]);
        status = relume_file_check(path, sweep->args->log);
    }
    return status;
}
