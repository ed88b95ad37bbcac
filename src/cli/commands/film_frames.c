// film_frames.c - photographs out of a film in which a lamp moves
//
// ffmpeg reads the film twice. First all frames pass by, small and grey. Frames that are much less
// sharp than those around them, or much darker than most, do not count. Frames are taken
// that differ most from all that are taken already (farthest-first traversal, Gonzalez 1985).
// Then ffmpeg writes these in full size.
#include "cli/commands/film_frames.h"

#include "cli/program/output_name.h"
#include "cli/program/say.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/wait.h>
#include <unistd.h>

enum { WIDTH = 320, HEIGHT = 240, STEP = 8, SMALL = (WIDTH / STEP) * (HEIGHT / STEP) };
enum { MOST_READ = 20000, AROUND = 7, PATH = 4096 };
static const double LEAST_SHARP = 0.7;       // of the median of the frames around
static const double LEAST_BRIGHT = 0.2;      // of the median of all frames
static const double LEAST_DIFFERENT = 0.04;  // RMS, of the mean brightness; noise has 0.01

struct frame {
    float small[SMALL];  // over its mean
    float mean;
    float sharp;    // fine detail over coarse, which hardly depends on the light
    float nearest;  // distance to the frames that are taken
    bool taken;
};

struct reading {
    const struct relume_log *log;
    const char *path;
    struct frame *frame;
    int frames;
};

bool film_frames_named(const char *path)
{
    static const char *const endings[] = {".mp4", ".mov", ".m4v", ".mkv", ".avi", ".webm"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (!strcasecmp(name_ending(path), endings[i]))
            return true;
    return false;
}

// ---------------------------------------------------------------- ffmpeg

// Starts ffmpeg on the film; `*output` (or NULL) reads what it writes. Names are arguments of their
// own, never words of a shell; "file:" and the list of protocols keep ffmpeg with this file.
static pid_t start_ffmpeg(const struct reading *r, const char *filter, const char *to, int *output)
{
    char from[PATH + 8];
    int ends[2] = {-1, -1};
    snprintf(from, sizeof from, "file:%.4000s", r->path);
    const char *const raw[] = {"ffmpeg",
                               "-nostdin",
                               "-v",
                               "error",
                               "-protocol_whitelist",
                               "file,pipe",
                               "-format_whitelist",
                               "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi",
                               "-i",
                               from,
                               "-an",
                               "-vsync",
                               "0",
                               "-vf",
                               filter,
                               "-f",
                               output ? "rawvideo" : "image2",
                               to,
                               NULL};
    if (output && pipe2(ends, O_CLOEXEC))
        return -1;
    const pid_t child = fork();
    if (child == 0) {
        if (output)
            (void)dup2(ends[1], STDOUT_FILENO);
        (void)execvp(raw[0], (char *const *)(uintptr_t)raw);
        _exit(127);
    }
    if (output) {
        (void)close(ends[1]);
        *output = ends[0];
    }
    return child;
}

static relume_status end_ffmpeg(const struct reading *r, pid_t child)
{
    int state = 0;
    if (child < 0)
        return say(r->log, RELUME_ESYSTEM, "%s: ffmpeg cannot be started; %s", r->path,
                   strerror(errno));
    while (waitpid(child, &state, 0) < 0 && errno == EINTR)
        continue;
    if (WIFEXITED(state) && WEXITSTATUS(state) == 0)
        return RELUME_OK;
    if (WIFEXITED(state) && WEXITSTATUS(state) == 127)
        return say(r->log, RELUME_ESYSTEM,
                   "%s: ffmpeg is not installed, which films need; install it, or give a folder "
                   "of frames",
                   r->path);
    return say(r->log, RELUME_EUNFIT, "%s: ffmpeg cannot read this film", r->path);
}

// ---------------------------------------------------------------- all frames

// Returns the sum of squared differences from the mean of the four pixels `far` away.
static double detail(const unsigned char *grey, int far)
{
    double sum = 0.0;
    for (int y = far; y < HEIGHT - far; y++)
        for (int x = far; x < WIDTH - far; x++) {
            const unsigned char *at = grey + y * WIDTH + x;
            const int curve = 4 * at[0] - at[-far] - at[far] - at[-far * WIDTH] - at[far * WIDTH];
            sum += (double)curve * curve;
        }
    return sum;
}

// Fills `out` from grey codes.
static void measure(struct frame *out, const unsigned char *grey)
{
    double sum = 0.0;
    memset(out, 0, sizeof *out);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const unsigned char code = grey[y * WIDTH + x];
            out->small[(y / STEP) * (WIDTH / STEP) + x / STEP] += code;
            sum += code;
        }
    out->mean = (float)(sum / (WIDTH * HEIGHT));
    out->sharp = (float)(detail(grey, 1) / fmax(detail(grey, 2), 1.0));
    for (int i = 0; i < SMALL; i++)
        out->small[i] /= (float)(STEP * STEP) * fmaxf(out->mean, 1.0f);
    out->nearest = HUGE_VALF;
}

// Reads one frame; false at the end.
static bool read_frame(unsigned char *grey, int from)
{
    size_t n = 0;
    while (n < (size_t)WIDTH * HEIGHT) {
        const ssize_t got = read(from, grey + n, (size_t)WIDTH * HEIGHT - n);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        n += (size_t)got;
    }
    return true;
}

static relume_status add_frame(struct reading *r, const unsigned char *grey)
{
    if (r->frames % 256 == 0) {
        struct frame *more = realloc(r->frame, (size_t)(r->frames + 256) * sizeof *more);
        if (!more)
            return RELUME_ENOMEM;
        r->frame = more;
    }
    measure(&r->frame[r->frames++], grey);
    return RELUME_OK;
}

static relume_status read_all(struct reading *r)
{
    static const char filter[] = "scale=320:240:flags=area,format=gray";
    unsigned char *grey = malloc((size_t)WIDTH * HEIGHT);
    int from = -1;
    relume_status status = grey ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        const pid_t child = start_ffmpeg(r, filter, "pipe:1", &from);
        while (!status && child > 0 && r->frames < MOST_READ && read_frame(grey, from))
            status = add_frame(r, grey);
        const bool long_film = r->frames == MOST_READ && read_frame(grey, from);
        if (from >= 0)
            (void)close(from);  // ffmpeg ends with its reader
        const relume_status ended = long_film || status ? RELUME_OK : end_ffmpeg(r, child);
        if (long_film)
            status = say(r->log, RELUME_EUNFIT, "%s: more than %d frames; cut the film", r->path,
                         MOST_READ);
        if (long_film || (status && child > 0))
            while (waitpid(child, NULL, 0) < 0 && errno == EINTR)
                continue;
        status = status ? status : ended;
    }
    free(grey);
    return status;
}

// ---------------------------------------------------------------- choosing

static int by_value(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static float median(float *value, int n)
{
    qsort(value, (size_t)n, sizeof *value, by_value);
    return value[n / 2];
}

// Marks as taken what is not to be chosen: blurred and dark frames.
static relume_status leave_out(struct reading *r)
{
    float *value = malloc((size_t)r->frames * sizeof *value), around[2 * AROUND + 1];
    if (!value)
        return RELUME_ENOMEM;
    for (int i = 0; i < r->frames; i++)
        value[i] = r->frame[i].mean;
    const float bright = median(value, r->frames);
    for (int i = 0; i < r->frames; i++) {
        int n = 0;
        for (int k = i - AROUND; k <= i + AROUND; k++)
            if (k >= 0 && k < r->frames)
                around[n++] = r->frame[k].sharp;
        value[i] = median(around, n);
    }
    for (int i = 0; i < r->frames; i++)
        r->frame[i].taken = r->frame[i].sharp < (float)LEAST_SHARP * value[i] ||
                            r->frame[i].mean < (float)LEAST_BRIGHT * bright;
    free(value);
    return RELUME_OK;
}

static float distance(const struct frame *a, const struct frame *b)
{
    float sum = 0.0f;
    for (int i = 0; i < SMALL; i++)
        sum += (a->small[i] - b->small[i]) * (a->small[i] - b->small[i]);
    return sqrtf(sum / SMALL);
}

// Returns the number of frames, chosen[] in the order of the film.
static int choose(int *chosen, int most, struct reading *r)
{
    int count = 0, next = 0;
    while (next < r->frames && r->frame[next].taken)
        next++;
    while (next < r->frames && count < most) {
        const struct frame *last = &r->frame[next];
        r->frame[next].taken = true;
        chosen[count++] = next;
        next = r->frames;
        for (int i = 0; i < r->frames; i++) {
            struct frame *f = &r->frame[i];
            if (f->taken)
                continue;
            f->nearest = fminf(f->nearest, distance(f, last));
            if (f->nearest > (float)LEAST_DIFFERENT &&
                (next == r->frames || f->nearest > r->frame[next].nearest))
                next = i;
        }
    }
    for (int i = 1; i < count; i++)
        for (int k = i; k > 0 && chosen[k] < chosen[k - 1]; k--) {
            const int swap = chosen[k];
            chosen[k] = chosen[k - 1];
            chosen[k - 1] = swap;
        }
    return count;
}

// ---------------------------------------------------------------- chosen frames

// Fills `out` with the film's name without its ending, as ffmpeg's pattern of names may hold it.
static void plain_stem(char out[100], const char *path)
{
    const char *name = path_name(path);
    snprintf(out, 100, "%.*s", (int)(strlen(name) - strlen(name_ending(name))), name);
    for (char *at = out; *at; at++)
        *at = *at == '%' ? '_' : *at;
}

static relume_status write_chosen(struct film_frames *out, const struct reading *r,
                                  const int *chosen, int count)
{
    enum { TERM = 24 };
    char stem[100], to[PATH + 128], filter[16 + TERM * FILM_FRAMES_MOST] = "select=";
    const char *folder = relume_making_path(out->folder);
    size_t n = strlen(filter);
    for (int i = 0; i < count; i++)
        n += (size_t)snprintf(filter + n, TERM, "%seq(n\\,%d)", i ? "+" : "", chosen[i]);
    plain_stem(stem, r->path);
    snprintf(to, sizeof to, "file:%.4000s/%s-%%04d.png", folder, stem);
    const relume_status status = end_ffmpeg(r, start_ffmpeg(r, filter, to, NULL));
    for (int i = 0; !status && i < count; i++) {
        snprintf(to, sizeof to, "%.4000s/%s-%04d.png", folder, stem, i + 1);
        out->path[i] = strdup(to);
        if (!out->path[i])
            return RELUME_ENOMEM;
        out->count++;
    }
    return status;
}

relume_status film_frames_open(struct film_frames *out, const char *path, int most,
                               const struct relume_log *log)
{
    struct reading r = {.log = log, .path = path};
    int chosen[FILM_FRAMES_MOST], count = 0;
    *out = (struct film_frames){0};
    relume_status status = relume_making_open(&out->folder, NULL, RELUME_MADE_FOLDER, false, log);
    if (!status)
        status = read_all(&r);
    if (!status && r.frames)
        status = leave_out(&r);
    if (!status && r.frames)
        count = choose(chosen, most, &r);
    if (!status && count < 3)
        status = say(log, RELUME_EUNFIT,
                     "%s: %d frames show %d lights; expected a film in which a lamp moves", path,
                     r.frames, count);
    if (!status)
        status = write_chosen(out, &r, chosen, count);
    out->frames = r.frames;
    if (status)
        film_frames_close(out);
    free(r.frame);
    return status;
}

void film_frames_close(struct film_frames *frames)
{
    for (int i = 0; i < frames->count; i++)
        free(frames->path[i]);
    relume_making_abort(&frames->folder);
    frames->count = 0;
}
