// provenance.c - where the pictures of a capture come from: files, camera, exposure, check sums,
// and the colour target by which they were corrected
#include "capture/acquire/acquire.h"

#include "capture/acquire/sha256.h"
#include "core/base/infile.h"
#include "core/base/json_write.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/base/tree.h"
#include "image/image/pages.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { CHUNK = 1 << 16 };

struct summing {
    const struct acquisition *s;
    int *failed;  // [shots]: errno
};

// Returns true for a page of the file whose page precedes it.
static bool is_next_page(const struct acquisition *s, int i)
{
    char file[PAGE_PATH], before[PAGE_PATH];
    return i > 0 && page_of(file, s->shot[i].path) && page_of(before, s->shot[i - 1].path) &&
           !strcmp(file, before);
}

static void sum_file(void *context, size_t item, int worker)
{
    struct summing *c = context;
    struct shot *shot = &c->s->shot[item];
    int *failed = &c->failed[item];
    struct sha256 sha;
    struct infile in;
    uint8_t *bytes = mem_array(CHUNK, 1);
    char file[PAGE_PATH];
    (void)page_of(file, shot->path);
    (void)worker;
    sha256_init(&sha);
    if (is_next_page(c->s, (int)item)) {
        mem_free(bytes);
        return;
    }
    if (!infile_open(&in, file, NULL, c->s->p.log) || !bytes)
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

static void put_positive(struct jwriter *w, const char *key, double value)
{
    if (value > 0.0)
        jput_number(w, key, value, 6);
}

static void put_photograph(struct jwriter *w, const struct shot *shot)
{
    const struct relume_exif *e = &shot->notes;
    const time_t taken = (time_t)e->taken_s;
    struct tm tm;
    char text[32];
    jgap(w, "\n    ");
    jopen_object(w, NULL);
    jput_text(w, "file", path_name(shot->path));
    jput_integer(w, "bytes", (long long)shot->bytes);
    jput_text(w, "sha256", shot->sha256);
    if (e->camera[0])
        jput_text(w, "camera", e->camera);
    put_positive(w, "exposure_s", e->time_s);
    put_positive(w, "f_number", e->f_number);
    put_positive(w, "iso", e->iso);
    put_positive(w, "focal_mm", e->focal_mm);
    if (taken && gmtime_r(&taken, &tm) && strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &tm))
        jput_text(w, "taken", text);  // by the camera's clock
    jclose(w);
}

static void put_pair(struct jwriter *w, const char *key, const double value[2])
{
    jopen_array(w, key);
    jput_fixed(w, NULL, value[0], 3);
    jput_fixed(w, NULL, value[1], 3);
    jclose(w);
}

static void put_chart(struct jwriter *w, const struct acquisition *s)
{
    const struct relume_chart *c = &s->out->chart;
    jgap(w, "\n    ");
    jopen_object(w, "colour");
    jput_text(w, "target", "ColorChecker 24");
    jput_text(w, "photograph", path_name(s->out->target));
    jput_floats(w, "matrix", c->matrix, 9, 9);
    jput_number(w, "exposure", c->exposure, 6);
    jput_integer(w, "patches", c->used);
    jopen_object(w, "delta_e_2000");
    put_pair(w, "before", c->before);
    put_pair(w, "white_balance", c->balanced);
    put_pair(w, "after", c->after);
    jclose_levels(w, 2);
}

// The balls in pixels of the photographs as they are upright, so that later crops leave them out.
static void put_balls(struct jwriter *w, const struct acquisition *s)
{
    const struct relume_ball *ball;
    const int balls = acquire_balls_inside(&ball, s);
    if (!balls)
        return;
    jgap(w, "\n    ");
    jopen_array(w, "balls");
    for (int i = 0; i < balls; i++)
        jput_numbers(w, NULL, (const double[]){ball[i].x, ball[i].y, ball[i].radius}, 3, 6);
    jclose(w);
}

char *acquire_provenance(const struct acquisition *s)
{
    struct jwriter w = {0};
    jopen_object(&w, NULL);
    jput_text(&w, "program", "relume " RELUME_VERSION);
    jopen_array(&w, "photographs");
    for (int i = 0; i < s->shots; i++)
        put_photograph(&w, &s->shot[i]);
    jclose(&w);
    put_balls(&w, s);
    if (s->out->target)
        put_chart(&w, s);
    if (s->out->crop[2]) {  // the last member, as provenance_crop has it
        jopen_array(&w, "crop");
        for (int i = 0; i < 4; i++)
            jput_integer(&w, NULL, s->out->crop[i]);
        jclose(&w);
    }
    return jtake(&w, NULL);
}

// Warns where photograph `i` is an earlier one under another name. Renderings may be equal.
static relume_status name_twin(struct acquisition *s, int i)
{
    for (int k = 0; k < i && !s->shot[i].notes.floats; k++)
        if (!strcmp(s->shot[k].sha256, s->shot[i].sha256))
            return acquire_warn(s,
                                "%s and %s are the same photograph, byte for byte; one of the "
                                "two lights has a wrong picture",
                                s->shot[k].path, s->shot[i].path);
    return RELUME_OK;
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
    for (int i = 1; !status && i < s->shots; i++)
        if (is_next_page(s, i)) {
            memcpy(s->shot[i].sha256, s->shot[i - 1].sha256, sizeof s->shot[i].sha256);
            s->shot[i].bytes = s->shot[i - 1].bytes;
        } else {
            status = name_twin(s, i);
        }
    mem_free(c.failed);
    return status;
}
