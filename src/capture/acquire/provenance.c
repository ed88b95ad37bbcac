// provenance.c - where the pictures of a capture come from: files, camera, exposure, check sums,
// and the colour target by which they were corrected
#include "capture/acquire/acquire.h"

#include "capture/acquire/sha256.h"
#include "core/base/infile.h"
#include "core/base/json.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/base/tree.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { CHUNK = 1 << 16 };

struct summing {
    const struct acquisition *s;
    int *failed;  // [shots]: errno
};

static void sum_file(void *context, size_t item, int worker)
{
    struct summing *c = context;
    struct shot *shot = &c->s->shot[item];
    int *failed = &c->failed[item];
    struct sha256 sha;
    struct infile in;
    uint8_t *bytes = mem_array(CHUNK, 1);
    (void)worker;
    sha256_init(&sha);
    if (!infile_open(&in, shot->path, NULL, c->s->p.log) || !bytes)
        *failed = bytes ? errno ? errno : EIO : ENOMEM;
    ssize_t n = 1;
    shot->bytes = 0;
    while (!*failed && n > 0) {
        n = infile_read(&in, bytes, CHUNK, shot->bytes);
        *failed = n < 0 ? errno : 0;
        if (n > 0) {
            sha256_add(&sha, bytes, (size_t)n);
            shot->bytes += (uint64_t)n;
        }
    }
    sha256_end(&sha, shot->sha256);
    infile_close(&in);
    mem_free(bytes);
}

static void put_text(FILE *f, const char *key, const char *text)
{
    char *quoted = jvalue_quote(text);
    fprintf(f, "\"%s\": %s", key, quoted ? quoted : "null");  // a name may be no UTF-8
    mem_free(quoted);
}

static void put_number(FILE *f, const char *key, double value)
{
    if (value > 0.0)
        fprintf(f, ", \"%s\": %.6g", key, value);
}

static void put_photograph(FILE *f, const struct shot *shot)
{
    const struct relume_exif *e = &shot->notes;
    const time_t taken = (time_t)e->taken_s;
    struct tm tm;
    char text[32];
    fputs("{", f);
    put_text(f, "file", path_name(shot->path));
    fprintf(f, ", \"bytes\": %llu, \"sha256\": \"%s\"", (unsigned long long)shot->bytes,
            shot->sha256);
    if (e->camera[0]) {
        fputs(", ", f);
        put_text(f, "camera", e->camera);
    }
    put_number(f, "exposure_s", e->time_s);
    put_number(f, "f_number", e->f_number);
    put_number(f, "iso", e->iso);
    put_number(f, "focal_mm", e->focal_mm);
    if (taken && gmtime_r(&taken, &tm) && strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &tm))
        fprintf(f, ", \"taken\": \"%s\"", text);  // by the camera's clock
    fputs("}", f);
}

static void put_chart(FILE *f, const struct acquisition *s)
{
    const struct relume_chart *c = &s->out->chart;
    fputs("{\"target\": \"ColorChecker 24\", ", f);
    put_text(f, "photograph", path_name(s->out->target));
    fputs(", \"matrix\": [", f);
    for (int i = 0; i < 9; i++)
        fprintf(f, "%s%.9g", i ? ", " : "", (double)c->matrix[i]);
    fprintf(f,
            "], \"exposure\": %.6g, \"patches\": %d, \"delta_e_2000\": {\"before\": [%.3f, %.3f], "
            "\"white_balance\": [%.3f, %.3f], \"after\": [%.3f, %.3f]}}",
            c->exposure, c->used, c->before[0], c->before[1], c->balanced[0], c->balanced[1],
            c->after[0], c->after[1]);
}

char *acquire_provenance(const struct acquisition *s)
{
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);
    if (!f)
        return NULL;
    fputs("{\"program\": \"relume " RELUME_VERSION "\", \"photographs\": [", f);
    for (int i = 0; i < s->shots; i++) {
        fputs(i ? ",\n    " : "\n    ", f);
        put_photograph(f, &s->shot[i]);
    }
    fputs("]", f);
    if (s->out->target) {
        fputs(",\n    \"colour\": ", f);
        put_chart(f, s);
    }
    fputs("}", f);
    const bool failed = fclose(f) != 0;
    char *out = mem_take(text);
    if (failed)
        mem_free(out);
    return failed ? NULL : out;
}

relume_status acquire_sum_files(struct acquisition *s)
{
    struct summing c = {s, mem_zeroed((size_t)s->shots, sizeof *c.failed)};
    if (!c.failed)
        return RELUME_ENOMEM;
    relume_status status = RELUME_OK;
    thread_for(s->p.threads, (size_t)s->shots, sum_file, &c);
    for (int i = 0; !status && i < s->shots; i++)
        if (c.failed[i])
            status = relume_input_fail(s->p.log, s->shot[i].path, "cannot be read", c.failed[i]);
    mem_free(c.failed);
    return status;
}
