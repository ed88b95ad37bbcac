// capture.c - an opened capture: what it is, its images, depth and masks
#include "capture/manifest/capture.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/scratch.h"
#include "core/math/vec.h"
#include "image/geometry/geometry.h"

#include <relume/image/response.h>
#include <stdio.h>
#include <string.h>

void changed_picture_free(struct changed_picture *picture)
{
    if (picture->mapped)
        scratch_unmap(picture->halves, picture->mapped);
    else
        mem_free(picture->halves);
    *picture = (struct changed_picture){0};
}

void relume_capture_destroy(relume_capture **capture)
{
    if (!*capture)
        return;
    image_cache_destroy(&(*capture)->cache);
    draft_free(&(*capture)->draft);
    if ((*capture)->owned)
        scratch_unmap((*capture)->owned, (*capture)->owned_bytes);
    for (int i = 0; (*capture)->owned_changed && i < (*capture)->pictured; i++)
        changed_picture_free(&(*capture)->owned_changed[i]);
    mem_free((*capture)->owned_changed);
    relume_image_destroy(&(*capture)->owned_mask);
    mem_free((*capture)->path);
    mem_free(*capture);
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

struct picture_array capture_array(const relume_capture *c, int view, int light)
{
    const struct relume_pictures *a = &c->pictures;
    const size_t bytes = a->sample == RELUME_SAMPLE_FLOAT ? 4
                         : a->sample == RELUME_SAMPLE_8   ? 1
                                                          : 2;
    const int at = c->light_of ? c->light_of[light] : light;
    const size_t index = (size_t)view * (size_t)c->pictured + (size_t)at;
    const size_t size = (size_t)a->width * (size_t)a->height * (size_t)a->channels * bytes;
    return (struct picture_array){
        (const char *)a->data + index * size, bytes, a->width, a->height, a->channels, false};
}

// What is read later is found where the capture was.
static struct relume_log log_of(const relume_capture *c, const struct relume_log *log)
{
    struct relume_log own = log ? *log : (struct relume_log){0};
    if (!own.context)
        own.context = c->context;
    return own;
}

// NULL: the picture is as its file.
static const struct changed_picture *changed_picture_of(const relume_capture *c, int light)
{
    const int at = c->light_of ? c->light_of[light] : light;
    return c->changed && c->changed[at].halves ? &c->changed[at] : NULL;
}

static relume_status whole_picture(picture_reader **out, const relume_capture *c, int view,
                                   int light, const struct relume_limits *limits,
                                   const struct relume_log *log)
{
    const struct relume_log own = log_of(c, log);
    const struct changed_picture *changed = changed_picture_of(c, light);
    if (changed)
        return array_picture_open(out, &(const struct picture_array){changed->halves, 2, c->width,
                                                                     c->height, 3, .halves = true});
    if (!c->pictures.data)
        return picture_open(out, c->draft.m.view[view].images[light], NULL, limits, &own);
    const struct picture_array array = capture_array(c, view, light);
    return array_picture_open(out, &array);
}

relume_status capture_picture(picture_reader **out, const relume_capture *c, int view, int light,
                              const struct relume_limits *limits, const struct relume_log *log)
{
    relume_status status = whole_picture(out, c, view, light, limits, log);
    if (status || !c->part.width)
        return status;
    const struct picture_info *info = picture_info_of(*out);
    if (info->width == c->whole[0] && info->height == c->whole[1])
        status = picture_crop(out, &c->part);
    if (status)
        picture_close(out);
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
        return log_fail(log, RELUME_EUNFIT, "%s: changed while it was being read", path);
    }
    struct relume_transfer from = image_transfer(capture->stated, info);
    if (changed_picture_of(capture, light))
        from = (struct relume_transfer){.curve = RELUME_CURVE_LINEAR};
    const relume_status opened = image_stream_open(
        out, reader, 3, from, to, m->intensities ? m->intensities[light] : no_gain);
    out->finite_only = !capture->repair;
    if (!opened && capture->rounded)
        image_stream_round(out);
    return opened;
}

void relume_capture_white(const relume_capture *capture, int light, float rgb[3])
{
    const float(*intensities)[3] = capture->draft.m.intensities;
    const struct relume_response *response =
        capture->transfer.curve == RELUME_CURVE_RESPONSE ? capture->transfer.response : NULL;
    for (int c = 0; c < 3; c++)
        rgb[c] = capture->floats && !capture->draft.m.display_coded
                     ? INFINITY
                     : (response ? relume_response_decode(response, c, 1.0f) : 1.0f) /
                           (intensities ? intensities[light][c] : 1.0f);
}

// A view's plane of an array of all of them.
static relume_status copy_plane(struct relume_image *out, int width, int height, int view,
                                const float *planes)
{
    const size_t size = (size_t)width * (size_t)height;
    const relume_status status = relume_image_create(out, width, height, 1);
    if (!status)
        memcpy(out->data, planes + (size_t)view * size, size * sizeof *planes);
    return status;
}

static relume_status load_whole_plane(struct relume_image *out, const relume_capture *capture,
                                      int view, const char *path, const float *planes,
                                      const struct relume_log *log)
{
    const bool cropped = capture->part.width > 0;
    const int wanted[2] = {cropped ? capture->whole[0] : capture->width,
                           cropped ? capture->whole[1] : capture->height};
    if (planes)
        return copy_plane(out, wanted[0], wanted[1], view, planes);
    const struct relume_transfer as_stored = {.curve = RELUME_CURVE_LINEAR};
    const struct relume_log own = log_of(capture, log);
    const relume_status status = image_load_large(
        out, path, relume_image_params(.log = &own, .channels = 1, .transfer = as_stored),
        capture->scratch);
    if (status || (out->width == wanted[0] && out->height == wanted[1]))
        return status;
    const int width = out->width, height = out->height;
    relume_image_destroy(out);
    return log_fail(log, RELUME_EUNFIT, "%s: %d x %d pixels; expected %d x %d as in the images",
                    path, width, height, wanted[0], wanted[1]);
}

static relume_status load_plane(struct relume_image *out, const relume_capture *capture, int view,
                                const char *path, const float *planes, const struct relume_log *log)
{
    *out = (struct relume_image){0};
    if (!path)
        return RELUME_OK;
    relume_status status = load_whole_plane(out, capture, view, path, planes, log);
    if (!status && capture->part.width)
        status = image_crop(out, &capture->part);
    if (status)
        relume_image_destroy(out);
    return status;
}

relume_status relume_capture_depth(struct relume_image *out, const relume_capture *capture,
                                   int view, const struct relume_log *log)
{
    const char *path = capture->draft.m.view[view].depth;
    const relume_status status = load_plane(out, capture, view, path, capture->pictures.depth, log);
    if (status || !out->data)
        return status;
    const size_t width = (size_t)out->width, n = width * (size_t)out->height;
    for (size_t i = 0; i < n; i++) {
        if (!(out->data[i] >= 0.0f)) {
            const float found = out->data[i];
            relume_image_destroy(out);
            return log_fail(log, RELUME_EDAMAGED,
                            "%s: depth %g at pixel (%zu, %zu); expected 0 or more", path,
                            (double)found, i % width, i / width);
        }
        if (i % width == width - 1)
            image_forget(out, (int)(i / width), 1);
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
    if (!out->data && !(status = image_create_large(out, width, height, 1, capture->scratch, log)))
        for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
            out->data[i] = 1.0f;
    for (int y = height - g->disc; !status && y < height; y++)
        for (int x = 0; x < width; x++)
            if (!relume_geometry_shows(g, width, height, x, y))
                out->data[(size_t)y * (size_t)width + (size_t)x] = 0.0f;
    return status;
}

relume_status relume_capture_masked(struct relume_image *out, const relume_capture *capture,
                                    int view, int light, const struct relume_log *log)
{
    struct relume_image mask = {0};
    relume_status status = relume_capture_image(out, capture, view, light, log);
    if (!status)
        status = relume_capture_mask(&mask, capture, view, log);
    const size_t pixels = (size_t)capture->width * (size_t)capture->height;
    for (size_t i = 0; !status && mask.data && i < pixels; i++)
        if (!(mask.data[i] > 0.5f))
            memset(out->data + 3 * i, 0, 3 * sizeof *out->data);
    relume_image_destroy(&mask);
    if (status)
        relume_image_destroy(out);
    return status;
}
