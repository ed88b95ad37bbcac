// film.c - pictures one after the other: numbered files, a folder or a film
#include "cli/program/film.h"

#include "cli/program/output_name.h"
#include "cli/program/say.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATH = 4096 };
enum kind { NUMBERED, FOLDER, FILM };

struct film {
    const struct relume_log *log;
    enum kind kind;
    char path[PATH], name[PATH];
    relume_making *making;  // NULL: numbered files
    int digits;             // of a number
    size_t before;          // where it stands in `path`
    const char *after;
    double fps;
    int pictures;
    int width, height;  // of the first
    pid_t ffmpeg;       // 0: not started
    int pipe;
};

// ---------------------------------------------------------------- names

// The only conversion in a name: %d, or %0Nd with N from 1 to 9.
static bool find_number(const char *path, size_t *before, int *digits, const char **after)
{
    const char *const at = strchr(path, '%');
    if (!at || strchr(at + 1, '%'))
        return false;
    *before = (size_t)(at - path);
    *digits = at[1] == '0' && at[2] >= '1' && at[2] <= '9' ? at[2] - '0' : 0;
    *after = at + (*digits ? 3 : 1);
    return *(*after)++ == 'd';
}

static bool is_film(const char *path)
{
    const char *const dot = strrchr(path, '.');
    return dot && (!strcmp(dot, ".mp4") || !strcmp(dot, ".mkv"));
}

bool film_is(const char *path)
{
    size_t before;
    int digits;
    const char *after;
    return is_film(path) || find_number(path, &before, &digits, &after) ||
           !strchr(path_name(path), '.');
}

const char *film_name(struct film *f)
{
    if (f->kind == NUMBERED)
        snprintf(f->name, sizeof f->name, "%.*s%0*d%s", (int)f->before, f->path, f->digits,
                 f->pictures, f->after);
    else
        snprintf(f->name, sizeof f->name, "%.4000s/%04d.png", relume_making_path(f->making),
                 f->pictures);
    return f->name;
}

relume_status film_open(struct film **out, const char *path, double fps, bool numbers,
                        const struct relume_log *log)
{
    struct film *const f = *out = calloc(1, sizeof *f);
    if (!f)
        return RELUME_ENOMEM;
    f->log = log;
    f->fps = fps;
    snprintf(f->path, sizeof f->path, "%s", path);
    for (size_t n = strlen(f->path); n > 1 && f->path[n - 1] == '/'; n--)
        f->path[n - 1] = '\0';
    f->kind = is_film(path)                                                        ? FILM
              : numbers && find_number(f->path, &f->before, &f->digits, &f->after) ? NUMBERED
                                                                                   : FOLDER;
    relume_status status = RELUME_OK;
    if (strlen(path) > 4000)
        status = say(f->log, RELUME_EINVAL, "-o: expected a shorter name");
    else if (f->kind != NUMBERED)
        status =
            relume_making_open(&f->making, f->path,
                               f->kind == FILM ? RELUME_MADE_FILE : RELUME_MADE_FOLDER, false, log);
    if (status) {
        free(f);
        *out = NULL;
    }
    return status;
}

// ---------------------------------------------------------------- ffmpeg

// In the child: names are arguments of their own, never words of a shell; "file:" keeps ffmpeg from
// reading them as anything else.
static void become_ffmpeg(const struct film *f, int input)
{
    char size[32], rate[32], to[PATH + 8];
    snprintf(rate, sizeof rate, "%g", f->fps);
    snprintf(size, sizeof size, "%dx%d", f->width, f->height);
    snprintf(to, sizeof to, "file:%.4000s", relume_making_path(f->making));
    const char *const format = !strcmp(strrchr(f->path, '.'), ".mp4") ? "mp4" : "matroska";
    const char *const arguments[] = {
        "ffmpeg",   "-v",       "error",    "-y",
        "-f",       "rawvideo", "-s",       size,
        "-r",       rate,       "-pix_fmt", "rgb24",
        "-i",       "pipe:0",   "-vf",      "pad=ceil(iw/2)*2:ceil(ih/2)*2",
        "-pix_fmt", "yuv420p",  "-f",       format,
        to,         NULL};
    (void)dup2(input, STDIN_FILENO);
    (void)execvp(arguments[0], (char *const *)(uintptr_t)arguments);
    _exit(127);
}

static relume_status start_ffmpeg(struct film *f)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC))
        return say(f->log, RELUME_ESYSTEM, "%s: cannot send pictures to ffmpeg; %s", f->path,
                   strerror(errno));
    f->ffmpeg = fork();
    if (f->ffmpeg == 0)
        become_ffmpeg(f, ends[0]);
    (void)close(ends[0]);
    f->pipe = ends[1];
    if (f->ffmpeg > 0)
        return RELUME_OK;
    (void)close(f->pipe);
    f->ffmpeg = 0;
    return say(f->log, RELUME_ESYSTEM, "%s: ffmpeg cannot be started; %s", f->path,
               strerror(errno));
}

static relume_status end_ffmpeg(struct film *f)
{
    int state = 0;
    if (!f->ffmpeg)
        return RELUME_OK;
    (void)close(f->pipe);
    while (waitpid(f->ffmpeg, &state, 0) < 0 && errno == EINTR)
        continue;
    f->ffmpeg = 0;
    if (WIFEXITED(state) && WEXITSTATUS(state) == 0)
        return RELUME_OK;
    if (WIFEXITED(state) && WEXITSTATUS(state) == 127)
        return say(f->log, RELUME_ESYSTEM,
                   "%s: ffmpeg is not installed, which films need; install it, or give the name "
                   "of a folder",
                   f->path);
    return say(f->log, RELUME_ESYSTEM, "%s: ffmpeg could not write the film", f->path);
}

static relume_status write_picture(struct film *f, const unsigned char *bytes, size_t n)
{
    while (n) {
        const ssize_t wrote = write(f->pipe, bytes, n);
        if (wrote < 0 && errno == EINTR)
            continue;
        if (wrote < 0) {
            const relume_status status = end_ffmpeg(f);  // says why it went away
            return status ? status
                          : say(f->log, RELUME_ESYSTEM,
                                "%s: ffmpeg stopped before the film was complete", f->path);
        }
        bytes += wrote;
        n -= (size_t)wrote;
    }
    return RELUME_OK;
}

static relume_status add_to_film(struct film *f, const struct relume_image *image)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const size_t samples = 3 * (size_t)image->width * (size_t)image->height;
    unsigned char *const bytes = malloc(samples);
    relume_status status = bytes ? RELUME_OK : RELUME_ENOMEM;
    if (!status && !f->ffmpeg)
        status = start_ffmpeg(f);
    for (size_t i = 0; !status && i < samples; i++) {
        const float code = 255.0f * relume_transfer_encode(srgb, image->data[i]) + 0.5f;
        bytes[i] = (unsigned char)fminf(fmaxf(code, 0.0f), 255.0f);
    }
    if (!status)
        status = write_picture(f, bytes, samples);
    free(bytes);
    return status;
}

// ---------------------------------------------------------------- pictures

relume_status film_add(struct film *f, const struct relume_image *image)
{
    if (!f->pictures) {
        f->width = image->width;
        f->height = image->height;
    }
    if (image->width != f->width || image->height != f->height)
        return say(f->log, RELUME_EINVAL,
                   "%s: the pictures changed size, from %d x %d to %d x %d; record again without "
                   "resizing the window",
                   f->path, f->width, f->height, image->width, image->height);
    const relume_status status =
        f->kind == FILM
            ? add_to_film(f, image)
            : relume_image_save(image, film_name(f), relume_image_params(.log = f->log));
    f->pictures += !status;
    return status;
}

relume_status film_close(struct film **film, bool keep)
{
    struct film *const f = *film;
    if (!f)
        return RELUME_OK;
    if (!keep)
        f->log = NULL;
    relume_status status = end_ffmpeg(f);
    if (keep && !status && f->making)
        status = relume_making_commit(&f->making);
    relume_making_abort(&f->making);
    free(f);
    *film = NULL;
    return status;
}
