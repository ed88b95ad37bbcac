// select.c - a capture with some of its lights
#include "capture/manifest/capture.h"
#include "core/base/memory.h"

static bool select_lights(struct draft *d, const struct draft *from, const int *light, int n)
{
    const bool near = from->m.positions, bright = from->m.intensities;
    d->directions = arena_array(&d->arena, (size_t)n, sizeof *d->directions);
    d->positions = near ? arena_array(&d->arena, (size_t)n, sizeof *d->positions) : NULL;
    d->intensities = bright ? arena_array(&d->arena, (size_t)n, sizeof *d->intensities) : NULL;
    if (!d->directions || near != !!d->positions || bright != !!d->intensities)
        return false;
    for (int i = 0; i < n; i++) {
        d->directions[i] = from->m.directions[light[i]];
        if (near)
            d->positions[i] = from->m.positions[light[i]];
        for (int c = 0; bright && c < 3; c++)
            d->intensities[i][c] = from->m.intensities[light[i]][c];
    }
    return true;
}

static bool select_images(struct draft *d, const struct draft *from, const int *light, int n)
{
    d->view = arena_array(&d->arena, (size_t)d->m.views, sizeof *d->view);
    for (int v = 0; d->view && v < d->m.views; v++) {
        d->view[v] = from->view[v];
        d->view[v].images = arena_array(&d->arena, (size_t)n, sizeof *d->view[v].images);
        if (!d->view[v].images)
            return false;
        for (int i = 0; i < n; i++)
            d->view[v].images[i] = from->view[v].images[light[i]];
    }
    return d->view;
}

static bool select_pictures(relume_capture *c, const relume_capture *from, const int *light, int n)
{
    int *of = arena_array(&c->draft.arena, (size_t)n, sizeof *of);
    for (int i = 0; of && i < n; i++)
        of[i] = from->light_of ? from->light_of[light[i]] : light[i];
    c->light_of = of;
    return of;
}

static relume_status fill(relume_capture *c, const relume_capture *from, const int *light, int n)
{
    c->draft.arena = (struct arena){0};
    c->cache = NULL;
    c->owned = NULL;  // it stays the whole capture's, which unmaps it
    c->owned_bytes = 0;
    c->owned_changed = NULL;
    c->owned_mask = (struct relume_image){0};
    c->draft.m.lights = n;
    c->path = mem_text(from->path);
    if (!c->path || !select_lights(&c->draft, &from->draft, light, n) ||
        !select_images(&c->draft, &from->draft, light, n) || !select_pictures(c, from, light, n))
        return RELUME_ENOMEM;
    draft_publish(&c->draft);
    return image_cache_create(&c->cache, c->draft.m.views * n, 0, 0, NULL);
}

relume_status relume_capture_select(relume_capture **out, const relume_capture *capture,
                                    const int *light, int lights)
{
    *out = NULL;
    for (int i = 0; i < lights; i++)
        if (light[i] < 0 || light[i] >= capture->draft.m.lights)
            return RELUME_EINVAL;
    relume_capture *c = lights > 0 ? mem_copy(capture, 1, sizeof *capture) : NULL;
    if (!c)
        return lights > 0 ? RELUME_ENOMEM : RELUME_EINVAL;
    const relume_status status = fill(c, capture, light, lights);
    if (status)
        relume_capture_destroy(&c);
    *out = c;
    return status;
}
