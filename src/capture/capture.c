// capture.c - an opened capture: every promise of the manifest checked against the files
#include "capture/capture.h"

#include "base/log.h"
#include "base/memory.h"
#include "base/tree.h"
#include "capture/near.h"
#include "math/vec.h"

#include <relume/response.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void relume_capture_destroy(relume_capture **capture)
{
    if (!*capture)
        return;
    kept_destroy(&(*capture)->kept);
    draft_free(&(*capture)->draft);
    free((*capture)->path);
    free(*capture);
    *capture = NULL;
}

const struct relume_manifest *relume_capture_manifest(const relume_capture *capture)
{
    return &capture->draft.m;
}

int relume_capture_width(const relume_capture *capture)
{
    return capture->width;
}

int relume_capture_height(const relume_capture *capture)
{
    return capture->height;
}

bool relume_capture_pole_y(const relume_capture *capture)
{
    const struct relume_manifest *m = &capture->draft.m;
    return m->slabs > 0 || m->geometry.projection >= RELUME_CYLINDRICAL;
}

bool relume_capture_hemispherical(const relume_capture *capture)
{
    const struct relume_manifest *m = &capture->draft.m;
    const bool pole_y = relume_capture_pole_y(capture);
    for (int i = 0; i < m->lights; i++)
        if (pole_from_world(m->directions[i], pole_y).z < -0.1)
            return false;
    return true;
}

static bool has_extension(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');
    return dot && !strcasecmp(dot, extension);
}

// The description in a folder: its capture.json, else its only .lp file.
static relume_status find_description(char **out, const char *folder, const struct relume_log *log)
{
    char *path = *out = mem_format("%s/capture.json", folder);
    if (!path)
        return RELUME_ENOMEM;
    if (!access(path, F_OK))
        return RELUME_OK;
    free(path);
    *out = tree_only(folder, ".lp");
    if (*out)
        return RELUME_OK;
    return log_fail(log, RELUME_EDATA,
                    "%s: no capture.json and no single .lp file in this folder; give the .lp file, "
                    "or make a capture of photographs first: relume capture %s -o DIR",
                    folder, folder);
}

static relume_status read_description(relume_capture *c, const char *path,
                                      const struct relume_capture_params *p)
{
    struct stat s;
    if (!stat(path, &s) && S_ISDIR(s.st_mode)) {
        const relume_status status = find_description(&c->path, path, p->log);
        if (status)
            return status;
    } else {
        c->path = mem_text(path);
    }
    if (!c->path)
        return RELUME_ENOMEM;
    if (!has_extension(c->path, ".lp"))
        return manifest_read(&c->draft, c->path, p);
    const relume_status status = lp_read(&c->draft, c->path, p->limits, p->log);
    return status ? status : lp_resolve(&c->draft, c->path, p);
}

// Keep only the lights for which `keep` holds, in every array that is indexed by light.
static void keep_lights(struct draft *d, const bool *keep)
{
    int n = 0;
    for (int i = 0; i < d->m.lights; i++) {
        if (!keep[i])
            continue;
        d->directions[n] = d->directions[i];
        if (d->positions)
            d->positions[n] = d->positions[i];
        if (d->intensities)
            memcpy(d->intensities[n], d->intensities[i], sizeof *d->intensities);
        for (int v = 0; v < d->m.views; v++)
            d->view[v].images[n] = d->view[v].images[i];
        n++;
    }
    d->m.lights = n;
}

static relume_status skip_missing(relume_capture *c, const struct relume_log *log)
{
    struct draft *d = &c->draft;
    const int before = d->m.lights;
    bool *keep = mem_array((size_t)before, sizeof *keep);
    if (!keep)
        return RELUME_ENOMEM;
    for (int i = 0; i < before; i++) {
        keep[i] = true;
        for (int v = 0; v < d->m.views && keep[i]; v++) {
            keep[i] = !access(d->view[v].images[i], F_OK);
            if (!keep[i])
                log_line(log, RELUME_WARNING, "%s: image '%s' does not exist; light %d is skipped",
                         c->path, d->view[v].images[i], i);
        }
    }
    keep_lights(d, keep);
    free(keep);
    if (d->m.lights == 0)
        return log_fail(log, RELUME_EDATA, "%s: no image exists; expected %d", c->path, before);
    return RELUME_OK;
}

// Before images are looked at one by one.
static relume_status count_missing(const relume_capture *c, const struct relume_log *log)
{
    const struct relume_manifest *m = &c->draft.m;
    const char *first = NULL;
    int missing = 0;
    for (int v = 0; v < m->views; v++)
        for (int i = 0; i < m->lights; i++)
            if (access(m->view[v].images[i], F_OK) && missing++ == 0)
                first = m->view[v].images[i];
    if (!missing)
        return RELUME_OK;
    return log_fail(
        log, RELUME_EDATA,
        "%s: no such file; %d of %d images %s missing; --skip-missing continues without "
        "%s",
        first, missing, m->views * m->lights, missing == 1 ? "is" : "are",
        missing == 1 ? "its light" : "their lights");
}

// All pictures of the array lie behind each other.
static struct picture_array array_of(const relume_capture *c, int view, int light)
{
    const struct relume_pictures *a = &c->pictures;
    const size_t bytes = a->sample == RELUME_SAMPLE_FLOAT ? 4
                         : a->sample == RELUME_SAMPLE_8   ? 1
                                                          : 2;
    const size_t index = (size_t)view * (size_t)c->draft.m.lights + (size_t)light;
    const size_t size = (size_t)a->width * (size_t)a->height * (size_t)a->channels * bytes;
    return (struct picture_array){(const char *)a->data + index * size, bytes, a->width, a->height,
                                  a->channels};
}

relume_status capture_picture(picture_reader **out, const relume_capture *c, int view, int light,
                              const struct relume_limits *limits, const struct relume_log *log)
{
    if (!c->pictures.data)
        return picture_open(out, c->draft.m.view[view].images[light], NULL, limits, log);
    const struct picture_array array = array_of(c, view, light);
    return array_picture_open(out, &array);
}

static relume_status check_image(relume_capture *c, int view, int light,
                                 const struct relume_capture_params *p)
{
    const char *path = c->draft.m.view[view].images[light];
    picture_reader *reader;
    relume_status status = capture_picture(&reader, c, view, light, p->limits, p->log);
    if (!status)
        status = picture_need_colour(reader, path, p->log);
    struct picture_info info = {0};
    if (!status)
        info = *picture_info_of(reader);
    picture_close(&reader);
    if (status)
        return status;
    c->floats |= info.floats;
    if (c->width == 0) {
        c->width = info.width;
        c->height = info.height;
        c->x = info.x;
        c->y = info.y;
        c->stated = c->draft.m.transfer;
        c->transfer = image_transfer(c->draft.m.transfer, &info);
        return RELUME_OK;
    }
    if (info.width != c->width || info.height != c->height)
        return log_fail(p->log, RELUME_EDATA,
                        "%s: %d x %d pixels; expected %d x %d as in the other images", path,
                        info.width, info.height, c->width, c->height);
    if (info.x != c->x || info.y != c->y)
        return log_fail(p->log, RELUME_EDATA,
                        "%s: its data window begins at (%d, %d); expected (%d, %d) as in the other "
                        "images",
                        path, info.x, info.y, c->x, c->y);
    return RELUME_OK;
}

static relume_status check_images(relume_capture *c, const struct relume_capture_params *p)
{
    const struct relume_manifest *m = &c->draft.m;
    for (int v = 0; v < m->views; v++)
        for (int i = 0; i < m->lights; i++) {
            const relume_status status = check_image(c, v, i, p);
            if (status)
                return status;
            if (!log_progress(p->log, "checking", (v + (i + 1.0) / m->lights) / (double)m->views))
                return RELUME_ECANCEL;
        }
    return RELUME_OK;
}

static relume_status check_discs(const relume_capture *c, const struct relume_log *log)
{
    const struct relume_geometry *g = &c->draft.m.geometry;
    if (relume_geometry_fits(g, c->width, c->height))
        return RELUME_OK;
    return log_fail(log, RELUME_EDATA,
                    "%s: panorama.discs; expected at most half of the %d columns and fewer than "
                    "the %d rows; found %d",
                    c->path, c->width, c->height, g->disc);
}

static relume_status finish(relume_capture *c, const struct relume_capture_params *p)
{
    if (p->transfer.curve != RELUME_CURVE_AUTO)
        c->draft.m.transfer = p->transfer;
    relume_status status = check_images(c, p);
    if (!status)
        status = check_discs(c, p->log);
    if (!status)
        status = kept_create(&c->kept, c->draft.m.views * c->draft.m.lights, p->keep_bytes);
    if (status)
        return status;
    struct relume_geometry *g = &c->draft.m.geometry;
    if (g->projection == RELUME_PLANAR && !c->draft.has_window) {
        const struct relume_geometry d =
            relume_geometry_default(RELUME_PLANAR, c->width, c->height);
        memcpy(g->window_min, d.window_min, sizeof g->window_min);
        memcpy(g->window_max, d.window_max, sizeof g->window_max);
    }
    c->draft.m.transfer = c->transfer;
    near_warn(c, p->log);
    return RELUME_OK;
}

relume_status capture_finish(relume_capture **out, relume_capture *c,
                             const struct relume_capture_params *p)
{
    c->repair = p->repair;
    c->assume_depth = p->assume_depth;
    c->limits = limits_or_default(p->limits);
    const relume_status status = finish(c, p);
    if (status)
        relume_capture_destroy(&c);
    *out = c;
    return status;
}

relume_status relume_capture_open(relume_capture **out, const char *path,
                                  const struct relume_capture_params *params)
{
    struct relume_capture_params p = params ? *params : (struct relume_capture_params){0};
    *out = NULL;
    relume_capture *c = mem_zeroed(1, sizeof *c);
    if (!c)
        return RELUME_ENOMEM;
    p.limits = limits_of(p.limits, p.log);
    relume_status status = read_description(c, path, &p);
    if (!status)
        status = p.skip_missing ? skip_missing(c, p.log) : count_missing(c, p.log);
    if (!status)
        return capture_finish(out, c, &p);
    relume_capture_destroy(&c);
    return status;
}

relume_status capture_stream(struct image_stream *out, const relume_capture *capture, int view,
                             int light, struct relume_transfer to, const struct relume_log *log)
{
    const struct relume_manifest *m = &capture->draft.m;
    static const float no_gain[3] = {1.0f, 1.0f, 1.0f};
    const char *path = m->view[view].images[light];
    picture_reader *reader;
    const relume_status status =
        capture_picture(&reader, capture, view, light, &capture->limits, log);
    if (status)
        return status;
    const struct picture_info *info = picture_info_of(reader);
    if (info->width != capture->width || info->height != capture->height) {
        picture_close(&reader);
        return log_fail(log, RELUME_EDATA, "%s: changed while it was being read", path);
    }
    const relume_status opened =
        image_stream_open(out, reader, 3, image_transfer(capture->stated, info), to,
                          m->intensities ? m->intensities[light] : no_gain);
    out->finite_only = !capture->repair;
    return opened;
}

void relume_capture_white(const relume_capture *capture, int light, float rgb[3])
{
    const float(*intensities)[3] = capture->draft.m.intensities;
    const struct relume_response *response =
        capture->transfer.curve == RELUME_CURVE_RESPONSE ? capture->transfer.response : NULL;
    for (int c = 0; c < 3; c++)
        rgb[c] = capture->floats ? INFINITY
                                 : (response ? relume_response_decode(response, c, 1.0f) : 1.0f) /
                                       (intensities ? intensities[light][c] : 1.0f);
}

// Fall-off of near lights is divided out.
static relume_status level(struct relume_image *image, const relume_capture *capture, int view,
                           int light, const struct relume_log *log)
{
    struct near near;
    if (!near_applies(capture, view))
        return RELUME_OK;
    const relume_status status = near_open(&near, capture, view, log);
    if (!status)
        near_level(&near, light, image);
    near_close(&near);
    return status;
}

relume_status relume_capture_image(struct relume_image *out, const relume_capture *capture,
                                   int view, int light, const struct relume_log *log)
{
    const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};
    *out = (struct relume_image){0};
    struct image_stream stream;
    relume_status status = capture_stream(&stream, capture, view, light, linear, log);
    if (status)
        return status;
    stream.finite_only = true;
    status = relume_image_create(out, capture->width, capture->height, 3);
    if (!status)
        status = image_stream_read(&stream, 0, capture->height, out->data);
    if (status == RELUME_EDATA)
        (void)log_fail(log, status, "%s: %s", capture->draft.m.view[view].images[light],
                       image_stream_error(&stream));
    if (!status)
        status = level(out, capture, view, light, log);
    if (status)
        relume_image_destroy(out);
    image_stream_close(&stream);
    return status;
}

// A view's plane of an array of all of them.
static relume_status copy_plane(struct relume_image *out, const relume_capture *c, int view,
                                const float *planes)
{
    const size_t size = (size_t)c->width * (size_t)c->height;
    const relume_status status = relume_image_create(out, c->width, c->height, 1);
    if (!status)
        memcpy(out->data, planes + (size_t)view * size, size * sizeof *planes);
    return status;
}

static relume_status load_plane(struct relume_image *out, const relume_capture *capture, int view,
                                const char *path, const float *planes, const struct relume_log *log)
{
    *out = (struct relume_image){0};
    if (!path)
        return RELUME_OK;
    if (planes)
        return copy_plane(out, capture, view, planes);
    const struct relume_transfer as_stored = {.curve = RELUME_CURVE_LINEAR};
    const relume_status status = relume_image_load(
        out, path, relume_image_params(.log = log, .channels = 1, .transfer = as_stored));
    if (status || (out->width == capture->width && out->height == capture->height))
        return status;
    const int width = out->width, height = out->height;
    relume_image_destroy(out);
    return log_fail(log, RELUME_EDATA, "%s: %d x %d pixels; expected %d x %d as in the images",
                    path, width, height, capture->width, capture->height);
}

relume_status relume_capture_depth(struct relume_image *out, const relume_capture *capture,
                                   int view, const struct relume_log *log)
{
    const char *path = capture->draft.m.view[view].depth;
    const relume_status status = load_plane(out, capture, view, path, capture->pictures.depth, log);
    if (status || !out->data)
        return status;
    const size_t n = (size_t)out->width * (size_t)out->height;
    for (size_t i = 0; i < n; i++)
        if (!(out->data[i] >= 0.0f)) {
            const float found = out->data[i];
            relume_image_destroy(out);
            return log_fail(log, RELUME_EDATA,
                            "%s: depth %g at pixel (%zu, %zu); expected 0 or more", path,
                            (double)found, i % (size_t)capture->width, i / (size_t)capture->width);
        }
    return RELUME_OK;
}

relume_status relume_capture_mask(struct relume_image *out, const relume_capture *capture, int view,
                                  const struct relume_log *log)
{
    const struct relume_geometry *g = &capture->draft.m.geometry;
    const int width = capture->width, height = capture->height;
    relume_status status = load_plane(out, capture, view, capture->draft.m.view[view].mask,
                                      capture->pictures.mask, log);
    if (status || !g->disc)
        return status;
    if (!out->data && !(status = relume_image_create(out, width, height, 1)))
        for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
            out->data[i] = 1.0f;
    for (int y = height - g->disc; !status && y < height; y++)
        for (int x = 0; x < width; x++)
            if (!relume_geometry_shows(g, width, height, x, y))
                out->data[(size_t)y * (size_t)width + (size_t)x] = 0.0f;
    return status;
}
