// digest.c - a fingerprint of a capture, from what can be read quickly
#include "capture/manifest/capture.h"
#include "capture/manifest/reflectance_table.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/fnv.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { MIDDLE = 4096 };  // bytes that are looked at

static uint64_t hash_number(uint64_t h, double number)
{
    return fnv_of(h, &number, sizeof number);
}

static uint64_t hash_geometry(uint64_t h, const struct relume_geometry *g)
{
    const double numbers[] = {
        g->projection,  g->window_min[0], g->window_min[1], g->window_max[0], g->window_max[1],
        g->perspective, g->camera_z,      g->uv_z,          g->st_z,          g->st_min[0],
        g->st_min[1],   g->st_max[0],     g->st_max[1],     g->v_min,         g->v_max,
        g->disc,        g->center.x,      g->center.y,      g->center.z};
    h = fnv_of(h, numbers, sizeof numbers);
    return fnv_of(h, &g->pose, sizeof g->pose);
}

static uint64_t hash_manifest(const relume_capture *c)
{
    const struct relume_manifest *m = &c->draft.m;
    uint64_t h = hash_number(FNV_START, (double)c->width);
    h = hash_number(h, (double)c->height);
    h = hash_number(h, (double)m->views);
    h = fnv_of(h, m->directions, (size_t)m->lights * sizeof *m->directions);
    if (m->positions)
        h = fnv_of(h, m->positions, (size_t)m->lights * sizeof *m->positions);
    if (m->intensities)
        h = fnv_of(h, m->intensities, (size_t)m->lights * sizeof *m->intensities);
    h = hash_number(h, (double)m->no_falloff);
    h = hash_number(h, (double)m->transfer.curve);
    h = hash_number(h, (double)m->transfer.gamma);
    h = hash_geometry(h, &m->geometry);
    for (int i = 0; i < m->slabs; i++)
        h = hash_geometry(h, &m->slab[i]);
    for (int i = 0; i < m->views; i++) {
        h = fnv_of(h, m->view[i].uv, sizeof m->view[i].uv);
        h = hash_number(h, (double)m->view[i].slab);
        h = hash_number(h, (double)((m->view[i].depth != NULL) + 2 * (m->view[i].mask != NULL)));
    }
    return h;
}

struct digesting {
    const relume_capture *capture;
    const struct relume_log *log;
    uint64_t *image;  // [views][lights]
    int *failed;      // [views][lights]: errno
};

static void digest_file(struct digesting *d, size_t item)
{
    const struct relume_manifest *m = &d->capture->draft.m;
    const size_t lights = (size_t)m->lights;
    unsigned char bytes[MIDDLE];
    struct infile in;
    d->failed[item] = 0;
    if (!infile_open(&in, m->view[item / lights].images[item % lights], NULL, d->log)) {
        d->failed[item] = errno ? errno : EIO;
    } else {
        const ssize_t n = infile_read(&in, bytes, sizeof bytes, in.size / 2);
        d->failed[item] = n < 0 ? errno : 0;
        d->image[item] =
            fnv_of(hash_number(FNV_START, (double)in.size), bytes, n < 0 ? 0 : (size_t)n);
    }
    infile_close(&in);
}

static void digest_array(struct digesting *d, size_t item)
{
    const size_t lights = (size_t)d->capture->draft.m.lights;
    const struct picture_array a =
        capture_array(d->capture, (int)(item / lights), (int)(item % lights));
    const size_t size = (size_t)a.width * (size_t)a.height * (size_t)a.channels * a.bytes;
    const char *middle = (const char *)a.data + size / 2;
    d->image[item] = fnv_of(FNV_START, middle, size - size / 2 < MIDDLE ? size - size / 2 : MIDDLE);
}

static void digest_image(void *context, size_t item, int worker)
{
    struct digesting *d = context;
    (void)worker;
    if (d->capture->pictures.data)
        digest_array(d, item);
    else
        digest_file(d, item);
}

relume_status relume_capture_digest(char text[RELUME_DIGEST], const relume_capture *capture,
                                    const struct relume_log *log)
{
    const struct relume_manifest *m = &capture->draft.m;
    const size_t lights = (size_t)m->lights, images = lights * (size_t)m->views;
    struct digesting d = {.capture = capture, .log = log};
    d.image = mem_zeroed(images, sizeof *d.image);
    d.failed = mem_zeroed(images, sizeof *d.failed);
    relume_status status = d.image && d.failed ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        thread_for(0, images, digest_image, &d);
    for (size_t i = 0; !status && i < images; i++)
        if (d.failed[i])
            status = relume_input_fail(log, m->view[i / lights].images[i % lights],
                                       "cannot be read", d.failed[i]);
    if (!status)
        snprintf(text, RELUME_DIGEST, "%016" PRIx64,
                 fnv_of(hash_manifest(capture), d.image, images * sizeof *d.image));
    mem_free(d.image);
    mem_free(d.failed);
    return status;
}
