// depths.c - disparities of a slab's views on the GPU, uploaded when first needed
#include "relit/depths.h"

#include "gl/target.h"
#include "relight/view/view.h"

#include <math.h>
#include <stdlib.h>

static void place_views(struct depths *d, const relume_slab *slab)
{
    const struct relume_slab_grid grid = relume_slab_grid(slab);
    for (int i = 0; i < grid.columns * grid.rows; i++) {
        const int view = grid.view[i];
        d->slab[view] = slab;
        d->uv[view][0] = grid.u[i % grid.columns];
        d->uv[view][1] = grid.v[i / grid.columns];
    }
}

relume_status depths_create(struct depths *d, const struct gl *gl, const relume_slab *const *slab,
                            int slabs, const struct depth_source *source)
{
    const size_t views = (size_t)relume_slab_grid(slab[0]).views;
    *d = (struct depths){.gl = gl, .source = *source, .views = (int)views};
    d->slab = calloc(views, sizeof *d->slab);
    d->texture = calloc(views, sizeof *d->texture);
    d->range = calloc(views, sizeof *d->range);
    d->uv = calloc(views, sizeof *d->uv);
    d->ranged = calloc(views, sizeof *d->ranged);
    d->at = calloc(views, sizeof *d->at);
    d->cut = calloc(views, sizeof *d->cut);
    if (!d->slab || !d->texture || !d->range || !d->uv || !d->ranged || !d->at || !d->cut ||
        !budget_create(&d->memory, (int)views, 0)) {
        depths_destroy(d);
        return RELUME_ENOMEM;
    }
    for (int i = 0; i < slabs; i++)
        place_views(d, slab[i]);
    return RELUME_OK;
}

static void leave(struct depths *d, int view)
{
    d->gl->DeleteTextures(1, &d->texture[view]);
    d->texture[view] = 0;
    budget_forget(&d->memory, view);
}

void depths_destroy(struct depths *d)
{
    if (d->texture)
        d->gl->DeleteTextures(d->views, d->texture);
    budget_destroy(&d->memory);
    free(d->slab);
    free(d->texture);
    free(d->range);
    free(d->uv);
    free(d->ranged);
    free(d->at);
    free(d->cut);
    *d = (struct depths){0};
}

static void upload(struct depths *d, int view, const struct relume_image *disparity,
                   const struct relume_rect *at)
{
    const struct gl *gl = d->gl;
    gl->GenTextures(1, &d->texture[view]);
    texture_use(gl, 0, GL_TEXTURE_2D, d->texture[view]);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl->PixelStorei(GL_UNPACK_ROW_LENGTH, disparity->width);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_R32F, at->width, at->height, 0, GL_RED, GL_FLOAT,
                   disparity->data + (size_t)at->top * (size_t)disparity->width + at->left);
    gl->PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    texture_settings(gl, GL_TEXTURE_2D);
    budget_set(&d->memory, view, (uint64_t)at->width * (uint64_t)at->height * sizeof(float));
    d->at[view] = *at;
}

// `at` is what becomes a texture; NULL: all of it, of no width: nothing.
static relume_status load(struct depths *d, int view, const struct relume_rect *at)
{
    struct relume_image depth = {0};
    struct relume_image disparity = {0};
    relume_status status = d->source.depth(&depth, d->source.user, view);
    if (!status)
        status = relume_slab_disparity(&disparity, d->slab[view], d->uv[view], &depth);
    if (!status) {
        const struct relume_rect all = {0, 0, disparity.width, disparity.height};
        (void)relume_slab_range(d->range[view], &disparity);
        d->ranged[view] = true;
        if (!at || at->width)
            upload(d, view, &disparity, at ? at : &all);
    }
    relume_image_destroy(&depth);
    relume_image_destroy(&disparity);
    return status;
}

static void drop_excess(struct depths *d)
{
    int oldest;
    while ((oldest = budget_excess(&d->memory, 0)) >= 0)
        leave(d, oldest);
}

static bool same(const struct relume_rect *a, const struct relume_rect *b)
{
    return a->left == b->left && a->top == b->top && a->width == b->width && a->height == b->height;
}

// `part` NULL: whole views.
static relume_status use_views(struct depths *d, const bool *needed, const struct relume_rect *part,
                               double range[2])
{
    relume_status status = RELUME_OK;
    d->memory.round++;
    range[0] = (double)INFINITY;
    range[1] = -(double)INFINITY;
    for (int i = 0; !status && i < d->views; i++) {
        if (!needed[i])
            continue;
        const struct relume_rect none = {0}, *at = part ? &part[i] : NULL;
        const bool whole = d->texture[i] && !d->cut[i];
        if (d->texture[i] && (part ? !same(&d->at[i], at) : !whole))
            leave(d, i);
        if (!d->texture[i] && (!part || at->width || !d->ranged[i]))
            status = load(d, i, part && !at->width ? &none : at);
        budget_use(&d->memory, i);
        d->cut[i] = part != NULL;
        range[0] = fmin(range[0], d->range[i][0]);
        range[1] = fmax(range[1], d->range[i][1]);
    }
    drop_excess(d);
    return status;
}

relume_status depths_use(struct depths *d, const bool *needed, double range[2])
{
    return use_views(d, needed, NULL, range);
}

relume_status depths_use_parts(struct depths *d, const bool *needed, const struct relume_rect *part,
                               double range[2])
{
    return use_views(d, needed, part, range);
}

relume_status depths_find_ranges(struct depths *d, const bool *needed)
{
    const struct relume_rect none = {0};
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < d->views; i++)
        if (needed[i] && !d->ranged[i])
            status = load(d, i, &none);
    return status;
}
