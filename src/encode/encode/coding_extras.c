// coding_extras.c - what a file with loss has beside planes: depth, masks, levels, the preview,
// what shadows and highlights move by; and how many bytes that takes
#include "encode/encode/coding.h"

#include "encode/encode/depth_step.h"
#include "encode/encode/overhead.h"

relume_status coding_load_extras(struct coding *c, int view)
{
    struct contents *f = c->f;
    const struct relume_manifest *manifest = relume_capture_manifest(f->capture);
    if (f->view[view].depth || f->view[view].mask)
        return RELUME_OK;
    const relume_status status = contents_extras(f, view);
    if (!status && f->depth[view].data)
        f->view[view].depth_step =
            (float)depth_step(manifest, &f->depth[view], manifest->view[view].slab, f->p->psnr_db);
    return status;
}

// Of what moves with the light, which all views are asked for once.
static bool has_models(const struct contents *f)
{
    for (int i = 0; i < f->views; i++)
        if (f->view[i].shadow || f->view[i].gloss)
            return true;
    return false;
}

// Counts what belongs to the whole file, for the first member.
static relume_status count_common(double *bytes, const struct coding *c, const struct overhead *o)
{
    double heads = 0.0, models = 0.0;
    relume_status status = overhead_heads(&heads, o);
    if (!status && has_models(c->f))
        status = overhead_models(&models, o);
    *bytes += heads + models;
    return status;
}

static relume_status count_preview(double *bytes, struct coding *c, const struct overhead *o)
{
    double preview = 0.0;
    relume_status status = coded_rows_load_view(&c->rows, c->f->views / 2);
    if (!status)
        status = overhead_preview(&preview, o);
    *bytes += preview;
    return status;
}

static relume_status count_rest(struct coding *c, int member, double *bytes)
{
    const struct group_share share = coding_share(c, member);
    struct overhead o;
    relume_status status = overhead_create(&o, c->f, &c->groups);
    if (!status)
        status = coding_each_view(c, share, c->leveled ? coding_load_levels : coding_load_extras);
    for (int g = 0; !status && g < c->groups.count; g++)
        if (coding_has_first(c, g, share)) {
            double extras = 0.0;
            status = overhead_extras(&extras, &o, g);
            *bytes += extras;
        }
    if (!status && coding_has_first(c, groups_with(&c->groups, c->f->views / 2), share))
        status = count_preview(bytes, c, &o);
    if (!status && member == 0)
        status = count_common(bytes, c, &o);
    return status;
}

relume_status coding_count_rest(double *bytes, struct coding *c)
{
    return coding_sum(bytes, c, "rest", count_rest);
}
