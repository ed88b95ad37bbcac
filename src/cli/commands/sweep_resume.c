// sweep_resume.c - finished rows survive an interruption
//
// The file is text: a first line that says what it is, then one line a row: a key, the figures as
// hexadecimal floats, and a sum over the line. The key is a hash (FNV-1a) of everything that the
// figures depend on, so that a changed photograph or option finds nothing. Lines are only ever
// appended, each under the file's lock, so that several sweeps may keep theirs in one file.
#include "cli/commands/sweep.h"
#include "core/math/fnv.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

struct sweep_resume {
    const struct sweep *sweep;
    FILE *file;  // NULL: nothing is kept
    char *path;
    uint64_t key;
};

static const char HEADER[] = "relume sweep, finished rows, 1\n";

static uint64_t hash_text(uint64_t h, const char *text)
{
    return fnv_of(h, text ? text : "", text ? strlen(text) + 1 : 1);
}

static uint64_t hash_number(uint64_t h, int64_t number)
{
    return fnv_of(h, &number, sizeof number);
}

static uint64_t hash_file(uint64_t h, const char *path)
{
    struct stat s;
    h = hash_text(h, path);
    if (!path || stat(path, &s))
        return h;
    h = hash_number(h, s.st_size);
    h = hash_number(h, s.st_mtim.tv_sec);
    return hash_number(h, s.st_mtim.tv_nsec);
}

static uint64_t hash_capture(uint64_t h, const relume_capture *capture)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    h = fnv_of(h, m->directions, (size_t)m->lights * sizeof *m->directions);
    h = fnv_of(h, &m->geometry.projection, sizeof m->geometry.projection);
    h = hash_number(h, m->transfer.curve);
    h = fnv_of(h, &m->transfer.gamma, sizeof m->transfer.gamma);
    if (m->intensities)
        h = fnv_of(h, m->intensities, (size_t)m->lights * sizeof *m->intensities);
    for (int v = 0; v < m->views; v++) {
        h = hash_file(h, m->view[v].mask);
        for (int i = 0; i < m->lights; i++)
            h = hash_file(h, m->view[v].images[i]);
    }
    return h;
}

static uint64_t row_key(const sweep_resume *r, const struct sweep_row *row)
{
    uint64_t h = hash_text(r->key, row->basis->name);
    h = hash_text(h, row->interpolant ? row->interpolant->name : "");
    h = hash_number(h, row->choose);
    h = hash_number(h, row->luminance);
    h = hash_number(h, row->wanted);
    h = hash_number(h, row->domain.domain);
    h = hash_number(h, row->domain.display.curve);
    h = fnv_of(h, &row->domain.display.gamma, sizeof row->domain.display.gamma);
    h = hash_text(h, relume_storage_name(row->store.storage));
    h = hash_number(h, row->store.step);
    if (!row->books.codes)
        return h;
    const struct relume_books_params *b = &row->books;
    const int64_t form[] = {b->codes, b->stages,        b->split,        b->groups,
                            b->start, (int64_t)b->seed, row->store.share};
    h = fnv_of(h, form, sizeof form);
    return fnv_of(h, &b->dither, sizeof b->dither);
}

static uint64_t line_sum(const char *line, size_t n)
{
    return fnv_of(FNV_START, line, n) & 0xffffffff;
}

// ---------------------------------------------------------------- reading

struct kept {
    uint64_t key;
    struct sweep_row row;
    double measured;
};

static bool parse_line(const char *line, struct kept *k)
{
    const char *last = strrchr(line, ' ');
    struct sweep_row *r = &k->row;
    uint64_t sum;
    int end = 0;
    *k = (struct kept){0};
    if (!last || sscanf(last, " %" SCNx64 "%n", &sum, &end) != 1 || last[end] != '\n' ||
        sum != line_sum(line, (size_t)(last - line)))
        return false;
    return sscanf(line, "%" SCNx64 " %d %d %la %la %la %la %la %la %la %la", &k->key,
                  &r->coefficients, &r->planes, &r->bytes, &r->bytes_per_pixel, &r->before_db,
                  &r->quality.psnr_db, &r->quality.psnr_pooled_db, &r->quality.ssim, &r->seconds,
                  &k->measured) == 11;
}

static void find_row(const sweep_resume *r, struct sweep *sweep, const struct kept *k)
{
    for (int i = 0; i < sweep->rows; i++) {
        struct sweep_row *row = &sweep->row[i];
        if (row_key(r, row) != k->key)
            continue;
        row->known = true;
        row->coefficients = k->row.coefficients;
        row->planes = k->row.planes;
        row->bytes = k->row.bytes;
        row->bytes_per_pixel = k->row.bytes_per_pixel;
        row->before_db = k->row.before_db;
        row->quality = k->row.quality;
        row->seconds = k->row.seconds;
        sweep->measured = k->measured;
    }
}

static void warn(const sweep_resume *r, const char *what)
{
    announce(r->sweep->args, RELUME_WARNING, "%s: %s", r->path, what);
}

// False when another program wrote the file.
static bool read_rows(const sweep_resume *r, struct sweep *sweep)
{
    char line[1024];
    int broken = 0;
    if (!fgets(line, sizeof line, r->file))
        return true;
    if (strcmp(line, HEADER))
        return false;
    while (fgets(line, sizeof line, r->file)) {
        struct kept k;
        if (parse_line(line, &k))
            find_row(r, sweep, &k);
        else
            broken++;
    }
    if (broken)
        warn(r, "some lines are damaged; those rows are measured again");
    return true;
}

// ---------------------------------------------------------------- writing

static relume_status cannot_write(const sweep_resume *r)
{
    announce(r->sweep->args, RELUME_ERROR, "%s: cannot be written; %s", r->path, strerror(errno));
    return RELUME_EIO;
}

static bool finish_writing(sweep_resume *r)
{
    return !fflush(r->file) && !ferror(r->file) && !fsync(fileno(r->file));
}

// A file system without locks has one sweep at a time.
void sweep_resume_lock(sweep_resume *r)
{
    if (r && r->file)
        (void)flock(fileno(r->file), LOCK_EX);
}

void sweep_resume_unlock(sweep_resume *r)
{
    if (r && r->file)
        (void)flock(fileno(r->file), LOCK_UN);
}

// A line that was being written when the machine stopped stays alone.
static bool end_last_line(sweep_resume *r)
{
    if (fseek(r->file, 0, SEEK_END))
        return false;
    if (ftell(r->file) == 0)
        return fputs(HEADER, r->file) >= 0;
    if (fseek(r->file, -1, SEEK_END))
        return false;
    const int last = fgetc(r->file);
    return !fseek(r->file, 0, SEEK_END) && (last == '\n' || fputc('\n', r->file) != EOF);
}

relume_status sweep_resume_keep(sweep_resume *resume, const struct sweep_row *row)
{
    char line[1024];
    if (!resume || !resume->file)
        return RELUME_OK;
    const int n = snprintf(line, sizeof line, "%016" PRIx64 " %d %d %a %a %a %a %a %a %a %a",
                           row_key(resume, row), row->coefficients, row->planes, row->bytes,
                           row->bytes_per_pixel, row->before_db, row->quality.psnr_db,
                           row->quality.psnr_pooled_db, row->quality.ssim, row->seconds,
                           resume->sweep->measured);
    sweep_resume_lock(resume);
    bool good = end_last_line(resume);
    good = good && fprintf(resume->file, "%s %" PRIx64 "\n", line, line_sum(line, (size_t)n)) > 0;
    good = finish_writing(resume) && good;
    const relume_status status = good ? RELUME_OK : cannot_write(resume);
    sweep_resume_unlock(resume);
    return status;
}

// ---------------------------------------------------------------- opening

relume_status sweep_resume_open(sweep_resume **out, struct sweep *sweep,
                                const relume_capture *const *captures, uint64_t memory)
{
    *out = NULL;
    if (!sweep->out)
        return RELUME_OK;
    sweep_resume *r = calloc(1, sizeof *r);
    const size_t size = strlen(sweep->out) + sizeof ".resume";
    if (!r)
        return RELUME_ENOMEM;
    r->sweep = sweep;
    r->path = malloc(size);
    if (!r->path) {
        sweep_resume_close(&r);
        return RELUME_ENOMEM;
    }
    snprintf(r->path, size, "%s.resume", sweep->out);
    r->key = hash_text(FNV_START, RELUME_VERSION);
    for (; *captures; captures++)
        r->key = hash_capture(r->key, *captures);
    r->key = hash_number(r->key, sweep->test ? -1 : sweep->leave_out);
    r->key = hash_number(r->key, sweep->tone_mapped);
    r->key = hash_number(r->key, (int64_t)memory);
    relume_status status = relume_file_check(r->path, sweep->args->log);
    if (!status) {
        r->file = fopen(r->path, "a+e");
        status = r->file ? RELUME_OK : cannot_write(r);
    }
    sweep_resume_lock(r);
    if (!status && !read_rows(r, sweep)) {
        warn(r,
             "not written by relume sweep; it is left as it is, and finished rows are not saved");
        fclose(r->file);
        r->file = NULL;
    }
    if (!status && r->file && !(end_last_line(r) && finish_writing(r)))
        status = cannot_write(r);
    sweep_resume_unlock(r);
    if (status)
        sweep_resume_close(&r);
    *out = r;
    return status;
}

void sweep_resume_close(sweep_resume **resume)
{
    sweep_resume *r = *resume;
    *resume = NULL;
    if (!r)
        return;
    if (r->file)
        fclose(r->file);
    free(r->path);
    free(r);
}
