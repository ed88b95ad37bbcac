// pictures.c - a capture whose pictures lie in memory and whose manifest a program fills in
#include "capture/manifest/capture.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "image/geometry/geometry.h"

#include <relume/image/response.h>
#include <string.h>

// All that a manifest of a program points to becomes the draft's own.
static bool copy_lights(struct draft *d, const struct relume_manifest *m)
{
    const size_t n = (size_t)m->lights;
    if (m->directions && (d->directions = arena_array(&d->arena, n, sizeof *d->directions)))
        memcpy(d->directions, m->directions, n * sizeof *d->directions);
    if (m->positions && (d->positions = arena_array(&d->arena, n, sizeof *d->positions)))
        memcpy(d->positions, m->positions, n * sizeof *d->positions);
    if (m->intensities && (d->intensities = arena_array(&d->arena, n, sizeof *d->intensities)))
        memcpy(d->intensities, m->intensities, n * sizeof *d->intensities);
    return !m->directions == !d->directions && !m->positions == !d->positions &&
           !m->intensities == !d->intensities;
}

static bool copy_slabs(struct draft *d, const struct relume_manifest *m)
{
    if (!m->slabs)
        return true;
    d->slab = arena_array(&d->arena, (size_t)m->slabs, sizeof *d->slab);
    if (d->slab)
        memcpy(d->slab, m->slab, (size_t)m->slabs * sizeof *d->slab);
    return d->slab != NULL;
}

static bool copy_response(struct draft *d)
{
    if (d->m.transfer.curve != RELUME_CURVE_RESPONSE)
        return true;
    struct relume_response *own = arena_array(&d->arena, 1, sizeof *own);
    if (own)
        *own = *d->m.transfer.response;
    d->m.transfer.response = own;
    return own != NULL;
}

// Messages name the pictures by these.
static bool name_view(struct draft *d, int view, const struct relume_pictures *pictures)
{
    struct relume_manifest_view *v = &d->view[view];
    v->images = arena_array(&d->arena, (size_t)d->m.lights, sizeof *v->images);
    bool good = v->images != NULL;
    for (int i = 0; good && i < d->m.lights; i++)
        good =
            (v->images[i] = arena_format(&d->arena, "memory (view %d, light %d)", view, i)) != NULL;
    v->depth = !pictures->depth ? NULL : arena_format(&d->arena, "memory (depth of view %d)", view);
    v->mask = !pictures->mask ? NULL : arena_format(&d->arena, "memory (mask of view %d)", view);
    return good && !pictures->depth == !v->depth && !pictures->mask == !v->mask;
}

static bool copy_views(struct draft *d, const struct relume_manifest *m,
                       const struct relume_pictures *pictures)
{
    d->view = arena_array(&d->arena, (size_t)d->m.views, sizeof *d->view);
    bool good = d->view != NULL;
    for (int i = 0; good && i < d->m.views; i++) {
        if (m->view)
            d->view[i] = m->view[i];
        good = name_view(d, i, pictures);
    }
    return good;
}

static bool is_zero(const struct relume_geometry *g)
{
    static const struct relume_geometry none;
    return !memcmp(g->window_min, none.window_min, sizeof g->window_min) &&
           !memcmp(g->window_max, none.window_max, sizeof g->window_max) && g->camera_z == 0.0 &&
           g->projection == RELUME_PLANAR;
}

static relume_status copy_manifest(struct draft *d, const struct relume_manifest *m,
                                   const struct relume_pictures *pictures)
{
    d->m = (struct relume_manifest){.transfer = m->transfer,
                                    .geometry = m->geometry,
                                    .slabs = m->slabs,
                                    .lights = m->lights,
                                    .no_falloff = m->no_falloff,
                                    .intensities_at_origin = m->intensities_at_origin,
                                    .views = m->views ? m->views : 1};
    d->has_window = !is_zero(&m->geometry);
    if (!d->has_window)
        d->m.geometry = relume_geometry_default(RELUME_PLANAR, 1, 1);
    return copy_lights(d, m) && copy_slabs(d, m) && copy_response(d) && copy_views(d, m, pictures)
               ? RELUME_OK
               : RELUME_ENOMEM;
}

// A manifest and pictures that can be: counts within the limits, what counts need is there.
static bool can_be(const struct relume_manifest *m, const struct relume_pictures *p,
                   const struct relume_limits *limits)
{
    const struct relume_limits most = limits_or_default(limits);
    return m->lights >= 1 && m->lights <= most.max_lights && (m->directions || m->positions) &&
           m->views >= 0 && m->views <= most.max_views && (m->view || m->views <= 1) &&
           m->slabs >= 0 && m->slabs <= RELUME_MOST_SLABS && (m->slab || !m->slabs) &&
           (m->view || !m->slabs) &&
           (m->transfer.curve != RELUME_CURVE_RESPONSE || m->transfer.response) && p->data &&
           p->sample <= RELUME_SAMPLE_16 && limits_allow(limits, p->width, p->height) &&
           (p->channels == 1 || p->channels == 3 || p->channels == 4);
}

relume_status relume_capture_create(relume_capture **out, const struct relume_manifest *manifest,
                                    const struct relume_pictures *pictures,
                                    const struct relume_capture_params *params)
{
    struct relume_capture_params p = PARAMS(relume_capture_params, params);
    *out = NULL;
    p.limits = limits_of(p.limits, p.log);
    p.keep_bytes = 0;  // they are in memory
    if (!can_be(manifest, pictures, p.limits))
        return RELUME_EINVAL;
    relume_capture *c = mem_zeroed(1, sizeof *c);
    if (!c)
        return RELUME_ENOMEM;
    c->pictures = *pictures;
    c->pictured = manifest->lights;
    c->path = mem_text("memory");
    relume_status status = c->path ? copy_manifest(&c->draft, manifest, pictures) : RELUME_ENOMEM;
    if (!status)
        status = draft_check_geometry(&c->draft, c->path, p.log);
    if (!status)
        status = draft_check_lights(&c->draft, c->path, p.log);
    if (!status)
        status = draft_check_views(&c->draft, c->path, p.log);
    draft_publish(&c->draft);
    if (!status)
        return capture_finish(out, c, &p);
    relume_capture_destroy(&c);
    return status;
}
