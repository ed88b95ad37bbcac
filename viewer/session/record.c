// record.c - moving pictures: what moves in them, and the folder or film that they become
#include "session/record.h"

#include "app/lamps.h"
#include "app/orbit.h"
#include "common/say.h"
#include "common/vec.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATH = 4096 };
static const double lowest_deg = 20;  // of a light that sweeps
static const double highest_deg = 60;

struct record {
    const struct relume_log *log;
    char path[PATH];  // the final name
    relume_making *making;
    bool film;
    int pictures;
    int width, height;
    pid_t ffmpeg;  // 0: not started
    int pipe;
};

relume_status record_parse(enum record_kind *out, const char *name)
{
    static const char *const names[] = {
        [RECORD_SWEEP] = "sweep", [RECORD_TURNTABLE] = "turntable", [RECORD_SCRIPT] = "script"};
    for (int i = 0; i < (int)(sizeof names / sizeof *names); i++)
        if (!strcmp(names[i], name)) {
            *out = (enum record_kind)i;
            return RELUME_OK;
        }
    return RELUME_EINVAL;
}

// ---------------------------------------------------------------- poses

static void pose_sweep(struct app *app, double part)
{
    const bool pole_y = app_pole_y(app);
    const int light = app->now.selected;
    const struct relume_vec3 from =
        lamps_direction(&app->start.light[light < app->start.lights ? light : 0], app_middle(app));
    const double height = asin(clamp(pole_y ? from.y : from.z, -1, 1)) * 180 / M_PI;
    const double elevation = clamp(height, lowest_deg, highest_deg) * M_PI / 180;
    const double azimuth = 2 * M_PI * part;
    const double x = cos(elevation) * cos(azimuth);
    const double y = cos(elevation) * sin(azimuth);
    const double z = sin(elevation);
    lamps_aim(&app->now, light,
              pole_y ? (struct relume_vec3){x, z, -y} : (struct relume_vec3){x, y, z},
              app_middle(app));
}

// As far as all sides of the grid allow.
static void pose_eye(struct app *app, double part)
{
    const struct app_file *f = &app->file;
    struct relume_vec3 *eye = &app->now.camera.eye;
    const double angle = 2 * M_PI * part;
    eye->x = 0.5 * (f->uv_min[0] + f->uv_max[0]) + 0.5 * (f->uv_max[0] - f->uv_min[0]) * cos(angle);
    eye->y = 0.5 * (f->uv_min[1] + f->uv_max[1]) + 0.5 * (f->uv_max[1] - f->uv_min[1]) * sin(angle);
}

static void pose_around(struct app *app, double part)
{
    app->now.camera.eye = app->start.camera.eye;
    orbit_turn(app, 360 * part, 0);
}

relume_status record_pose(struct app *app, enum record_kind kind, double part,
                          const struct relume_log *log)
{
    const enum relume_framing framing = app->now.camera.framing;
    if (kind == RECORD_SWEEP)
        pose_sweep(app, part);
    else if (orbit_is(app))
        pose_around(app, part);
    else if (framing == RELUME_FRAME_EYE)
        pose_eye(app, part);
    else if (framing == RELUME_FRAME_LOOK)
        app->now.camera.look.pan_deg = remainder(app->start.camera.look.pan_deg + 360 * part, 360);
    else
        return say(log, RELUME_EINVAL,
                   "turntable: expected a slab or a look into a panorama (--pan); found one view");
    return RELUME_OK;
}

// ---------------------------------------------------------------- folder

static relume_status cannot(const struct record *r, const char *what)
{
    return say(r->log, RELUME_EIO, "%s: %s; %s", r->path, what, strerror(errno));
}

static relume_status add_to_folder(struct record *r, const struct relume_image *image)
{
    char path[PATH + 32];
    snprintf(path, sizeof path, "%.*s/%04d.png", PATH, relume_making_path(r->making),
             r->pictures++);
    return relume_image_save(image, path, relume_image_params(.log = r->log));
}

// ---------------------------------------------------------------- film

static bool is_film(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && (!strcmp(dot, ".mp4") || !strcmp(dot, ".mkv"));
}

// In the child: names are arguments of their own, never words of a shell; "file:" keeps ffmpeg from
// reading them as anything else.
static void become_ffmpeg(const struct record *r, int input)
{
    char size[32], rate[16], to[PATH + 8];
    snprintf(rate, sizeof rate, "%d", RECORD_RATE);
    snprintf(size, sizeof size, "%dx%d", r->width, r->height);
    snprintf(to, sizeof to, "file:%.*s", PATH, relume_making_path(r->making));
    const char *format = strrchr(r->path, '.');
    const char *const arguments[] = {
        "ffmpeg",   "-v",       "error",    "-y",
        "-f",       "rawvideo", "-pix_fmt", "rgb24",
        "-s",       size,       "-r",       rate,
        "-i",       "pipe:0",   "-vf",      "pad=ceil(iw/2)*2:ceil(ih/2)*2",
        "-pix_fmt", "yuv420p",  "-f",       !strcmp(format, ".mp4") ? "mp4" : "matroska",
        to,         NULL};
    (void)dup2(input, STDIN_FILENO);
    (void)execvp(arguments[0], (char *const *)arguments);
    _exit(127);
}

static relume_status start_ffmpeg(struct record *r)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC))
        return cannot(r, "cannot send pictures to ffmpeg");
    r->ffmpeg = fork();
    if (r->ffmpeg == 0)
        become_ffmpeg(r, ends[0]);
    (void)close(ends[0]);
    r->pipe = ends[1];
    if (r->ffmpeg > 0)
        return RELUME_OK;
    (void)close(r->pipe);
    r->ffmpeg = 0;
    return cannot(r, "ffmpeg cannot be started");
}

static relume_status end_ffmpeg(struct record *r)
{
    int state = 0;
    if (!r->ffmpeg)
        return RELUME_OK;
    (void)close(r->pipe);
    while (waitpid(r->ffmpeg, &state, 0) < 0 && errno == EINTR)
        continue;
    r->ffmpeg = 0;
    if (WIFEXITED(state) && WEXITSTATUS(state) == 0)
        return RELUME_OK;
    if (WIFEXITED(state) && WEXITSTATUS(state) == 127)
        return say(r->log, RELUME_ESYSTEM,
                   "%s: ffmpeg is not installed, which films need; install it, or give the name of "
                   "a folder",
                   r->path);
    return say(r->log, RELUME_ESYSTEM, "%s: ffmpeg could not write the film", r->path);
}

static bool write_all(int to, const unsigned char *bytes, size_t n)
{
    while (n) {
        const ssize_t wrote = write(to, bytes, n);
        if (wrote < 0 && errno != EINTR)
            return false;
        bytes += wrote > 0 ? wrote : 0;
        n -= wrote > 0 ? (size_t)wrote : 0;
    }
    return true;
}

static relume_status add_to_film(struct record *r, const struct relume_image *image)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const size_t samples = 3 * (size_t)image->width * (size_t)image->height;
    unsigned char *bytes = malloc(samples);
    relume_status status = bytes ? RELUME_OK : RELUME_ENOMEM;
    if (!status && !r->ffmpeg)
        status = start_ffmpeg(r);
    for (size_t i = 0; !status && i < samples; i++) {
        const float code = 255 * relume_transfer_encode(srgb, image->data[i]) + 0.5f;
        bytes[i] = (unsigned char)fminf(fmaxf(code, 0), 255);
    }
    if (!status && !write_all(r->pipe, bytes, samples)) {
        status = end_ffmpeg(r);  // says why it went away
        status = status ? status : cannot(r, "ffmpeg stopped before the film was complete");
    }
    free(bytes);
    r->pictures++;
    return status;
}

// ---------------------------------------------------------------- interface

relume_status record_open(struct record **out, const char *path, const struct relume_log *log)
{
    struct record *r = *out = calloc(1, sizeof *r);
    if (!r)
        return RELUME_ENOMEM;
    r->log = log;
    r->film = is_film(path);
    relume_status status = RELUME_OK;
    if (strlen(path) + 8 > PATH)
        status = say(log, RELUME_EINVAL, "-o: expected a shorter name");
    snprintf(r->path, sizeof r->path, "%s", path);
    for (size_t n = strlen(r->path); n > 1 && r->path[n - 1] == '/'; n--)
        r->path[n - 1] = '\0';
    if (!status)
        status = relume_making_open(&r->making, r->path,
                                    r->film ? RELUME_MADE_FILE : RELUME_MADE_FOLDER, false, log);
    if (!status)
        return RELUME_OK;
    free(r);
    *out = NULL;
    return status;
}

relume_status record_add(struct record *r, const struct relume_image *image)
{
    if (r->log && r->log->progress && !r->log->progress(r->log->user, "recording", 0))
        return RELUME_ECANCEL;
    if (!r->pictures) {
        r->width = image->width;
        r->height = image->height;
    }
    if (image->width != r->width || image->height != r->height)
        return say(
            r->log, RELUME_EINVAL,
            "%s: the window's size changed while recording; record again without resizing it",
            r->path);
    return r->film ? add_to_film(r, image) : add_to_folder(r, image);
}

void record_abort(struct record **record)
{
    struct record *r = *record;
    if (!r)
        return;
    r->log = NULL;
    (void)end_ffmpeg(r);
    relume_making_abort(&r->making);
    free(r);
    *record = NULL;
}

relume_status record_commit(struct record **record)
{
    struct record *r = *record;
    relume_status status = end_ffmpeg(r);
    if (!status)
        status = relume_making_commit(&r->making);
    if (status) {
        record_abort(record);
        return status;
    }
    free(r);
    *record = NULL;
    return RELUME_OK;
}
