// depths.c - disparities of a slab's views on the GPU, uploaded when first needed
#include "relit/depths.h"

#include "gl/target.h"

#include <math.h>
#include <stdlib.h>

static const size_t budget = (size_t)256 << 20;

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
    d->bytes = calloc(views, sizeof *d->bytes);
    if (!d->slab || !d->texture || !d->range || !d->uv || !d->bytes) {
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
    d->bytes[view] = 0;
}

void depths_destroy(struct depths *d)
{
    for (int i = 0; d->texture && i < d->views; i++)
        leave(d, i);
    free(d->slab);
    free(d->texture);
    free(d->range);
    free(d->uv);
    free(d->bytes);
    *d = (struct depths){0};
}

static void upload(struct depths *d, int view, const struct relume_image *disparity)
{
    const struct gl *gl = d->gl;
    gl->GenTextures(1, &d->texture[view]);
    texture_use(gl, 0, GL_TEXTURE_2D, d->texture[view]);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_R32F, disparity->width, disparity->height, 0, GL_RED,
                   GL_FLOAT, disparity->data);
    texture_settings(gl, GL_TEXTURE_2D);
    d->bytes[view] = (size_t)disparity->width * (size_t)disparity->height * sizeof(float);
    (void)relume_slab_range(d->range[view], disparity);
}

static relume_status load(struct depths *d, int view)
{
    struct relume_image depth = {0};
    struct relume_image disparity = {0};
    relume_status status = d->source.depth(&depth, d->source.user, view);
    if (!status)
        status = relume_slab_disparity(&disparity, d->slab[view], d->uv[view], &depth);
    if (!status)
        upload(d, view, &disparity);
    relume_image_destroy(&depth);
    relume_image_destroy(&disparity);
    return status;
}

static void make_room(struct depths *d, const bool *needed)
{
    size_t all = 0;
    for (int i = 0; i < d->views; i++)
        all += d->bytes[i];
    for (int i = 0; all > budget && i < d->views; i++) {
        if (needed[i])
            continue;
        all -= d->bytes[i];
        leave(d, i);
    }
}

relume_status depths_use(struct depths *d, const bool *needed, double range[2])
{
    relume_status status = RELUME_OK;
    range[0] = (double)INFINITY;
    range[1] = -(double)INFINITY;
    for (int i = 0; !status && i < d->views; i++) {
        if (!needed[i])
            continue;
        if (!d->texture[i])
            status = load(d, i);
        range[0] = fmin(range[0], d->range[i][0]);
        range[1] = fmax(range[1], d->range[i][1]);
    }
    make_room(d, needed);
    return status;
}
