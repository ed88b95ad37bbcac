// gathered.c - the views of slabs that a frame needs: relit, with their disparities
#include "base/log.h"
#include "base/memory.h"
#include "frame/renderer.h"

relume_status gathered_create(struct gathered *g, const struct renderer *r)
{
    const size_t views = (size_t)r->info->views;
    *g = (struct gathered){.views = r->info->views};
    g->needed = mem_zeroed(views, sizeof *g->needed);
    g->images = mem_zeroed(views, sizeof *g->images);
    return g->needed && g->images ? RELUME_OK : RELUME_ENOMEM;
}

void gathered_destroy(struct gathered *g)
{
    for (int i = 0; i < g->views; i++) {
        if (g->images)
            relume_image_destroy(&g->images[i]);
        if (g->disparity)
            relume_image_destroy(&g->disparity[i]);
    }
    free(g->needed);
    free(g->images);
    free(g->disparity);
    *g = (struct gathered){0};
}

bool renderer_may_take_depth(const struct renderer *r)
{
    const struct relume_view_params *v = &r->view;
    return r->info->has_depth && (v->interpolation == RELUME_INTERPOLATE_DEFAULT ||
                                  v->interpolation == RELUME_INTERPOLATE_DEPTH);
}

bool renderer_takes_depth(const struct renderer *r)
{
    return r->view.aperture == 0.0 && r->view.focus == 0.0 && renderer_may_take_depth(r);
}

relume_status renderer_disparity(struct relume_image *out, const struct renderer *r,
                                 const relume_slab *slab, int view)
{
    struct relume_image depth = {0};
    relume_status status = relume_pack_depth(&depth, r->pack, view);
    if (!status)
        status = relume_slab_disparity(out, slab, r->info->uv[view], &depth);
    if (status == RELUME_EINVAL)
        status = log_fail(r->params.log, RELUME_EDATA,
                          "view %d has no depth; expected depth in all views or in none", view);
    relume_image_destroy(&depth);
    return status;
}

relume_status gathered_fill(struct gathered *g, const struct renderer *r, bool by_depth,
                            const relume_slab *(*slab_of)(const void *slabs, int view),
                            const void *slabs)
{
    struct renderer quiet = *r;
    relume_status status = RELUME_OK;
    if (by_depth && !(g->disparity = mem_zeroed((size_t)g->views, sizeof *g->disparity)))
        return RELUME_ENOMEM;
    for (int v = 0; !status && v < g->views; v++) {
        if (!g->needed[v])
            continue;
        status = renderer_relight(&quiet, v, &g->images[v]);
        if (!status && by_depth)
            status = renderer_disparity(&g->disparity[v], r, slab_of(slabs, v), v);
        quiet.params.log = NULL;  // what there is to say of the lights has been said
    }
    return status;
}
