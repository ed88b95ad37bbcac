// contents.c - what goes into a file while it is made
#include "encode/encode/contents.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/memory.h"
#include "encode/levels/pyramid.h"
#include "format/codebook/books.h"
#include "format/coder/coding.h"
#include "format/pack/pack_write.h"
#include "relight/shadow/moving.h"

#include <math.h>

void contents_destroy(struct contents *f)
{
    for (int i = 0; i < f->views; i++) {
        if (f->levels)
            relume_pack_levels_destroy(&f->levels[i]);
        if (f->coefficients)
            relume_coefficients_destroy(&f->coefficients[i]);
        if (f->depth)
            relume_image_destroy(&f->depth[i]);
        if (f->mask)
            relume_image_destroy(&f->mask[i]);
        if (f->shadow)
            relume_image_destroy(&f->shadow[i]);
        if (f->books)
            relume_books_destroy(&f->books[i]);
        if (f->words)
            mem_free(f->words[i].word);
        for (int b = 0; f->index && b < RELUME_MOST_BOOKS; b++)
            mem_free(f->index[i * RELUME_MOST_BOOKS + b]);
    }
    mem_free(f->books);
    mem_free(f->words);
    mem_free(f->report);
    mem_free(f->index);
    mem_free(f->view);
    mem_free(f->levels);
    mem_free(f->coefficients);
    mem_free(f->depth);
    mem_free(f->mask);
    mem_free(f->shadow);
}

// Where the views are is known of all of them.
static void place_views(struct contents *f, const struct relume_manifest *manifest)
{
    for (int i = 0; i < f->views; i++) {
        f->view[i].uv[0] = manifest->view[i].uv[0];
        f->view[i].uv[1] = manifest->view[i].uv[1];
        f->view[i].slab = manifest->view[i].slab;
    }
}

relume_status contents_create(struct contents *f, const struct encode_share *share)
{
    const struct relume_manifest *manifest = relume_capture_manifest(f->capture);
    const size_t n = (size_t)manifest->views;
    f->views = manifest->views;
    f->first = share->first;
    f->end = share->first + share->views;
    f->row = share->row;
    f->rows = share->rows;
    f->view = mem_zeroed(n, sizeof *f->view);
    f->levels = mem_zeroed(n, sizeof *f->levels);
    f->coefficients = mem_zeroed(n, sizeof *f->coefficients);
    f->depth = mem_zeroed(n, sizeof *f->depth);
    f->mask = mem_zeroed(n, sizeof *f->mask);
    f->shadow = mem_zeroed(n, sizeof *f->shadow);
    f->books = mem_zeroed(n, sizeof *f->books);
    f->index = mem_zeroed(n * RELUME_MOST_BOOKS, sizeof *f->index);
    f->words = mem_zeroed(n, sizeof *f->words);
    f->report = mem_zeroed(n, sizeof *f->report);
    if (!f->report || !f->words || !f->view || !f->levels || !f->coefficients || !f->depth ||
        !f->mask || !f->shadow || !f->books || !f->index)
        return RELUME_ENOMEM;
    place_views(f, manifest);
    return RELUME_OK;
}

relume_status contents_encode(struct contents *f, int i)
{
    const relume_status status =
        project_some_rows(&f->coefficients[i], f->coder, f->capture, i, f->row, f->rows, f->encode);
    if (!status)
        f->report[i] = relume_coefficients_report(f->coefficients[i]);
    f->view[i].coefficients = f->coefficients[i];
    return status;
}

// Bytes a pixel of highlights at a PSNR: a 32nd costs 0.06 dB between the lights, and a quarter of
// a small file less; the double for each 3 dB above, up to what all of it takes.
static double highlight_bytes(double psnr_db)
{
    return fmin(fmax(exp2((psnr_db - 42.0) / 3.0), 1.0), 4.0) / 32.0;
}

// Bytes of what moves with the light, a view: little beside its planes, or beside the header.
// Where the quality is left open it has what it takes, since unseen lights are not to suffer.
static double model_bytes(const struct contents *f)
{
    const struct relume_pack_encode_params *p = f->p;
    if (p->least_db > 0.0)
        return 0.0;
    const double pixels =
        (double)relume_capture_width(f->capture) * relume_capture_height(f->capture);
    const double eighth = (p->psnr_db > 0.0 ? 1.0 : p->bytes_per_pixel) / 8.0, least = 4096.0;
    const double each = p->psnr_db > 0.0 && p->gloss ? highlight_bytes(p->psnr_db) : eighth;
    return each > 0.0 ? fmax(each * pixels, least) : 0.0;
}

relume_status contents_extras(struct contents *f, int i)
{
    relume_status status = RELUME_OK;
    if (!f->p->no_depth && f->row == 0)
        status = relume_capture_depth(&f->depth[i], f->capture, i, f->p->log);
    if (!status && f->row == 0)
        status = relume_capture_mask(&f->mask[i], f->capture, i, f->p->log);
    if (!status && f->p->shadows)
        status =
            relume_shadows_learn(&f->shadow[i], f->capture, i,
                                 relume_shadows_params(.log = f->p->log, .threads = f->p->threads));
    f->view[i].gloss = f->p->gloss;
    f->view[i].model_bytes = model_bytes(f);
    f->view[i].shadow = f->shadow[i].data ? &f->shadow[i] : NULL;
    f->view[i].depth = f->depth[i].data ? &f->depth[i] : NULL;
    f->view[i].mask = f->mask[i].data ? &f->mask[i] : NULL;
    return status;
}

relume_status contents_reduce(struct contents *f, int i)
{
    struct relume_pack_contents contents;
    contents_describe(&contents, f);
    const relume_status status =
        relume_pack_reduce(&f->levels[i], &contents, &f->view[i], f->p->pyramid, f->encode);
    f->view[i].levels = f->levels[i].levels ? &f->levels[i] : NULL;
    return status;
}

void contents_describe(struct relume_pack_contents *contents, const struct contents *f)
{
    const struct relume_manifest *manifest = relume_capture_manifest(f->capture);
    *contents = (struct relume_pack_contents){
        .coder = f->coder,
        .domain = relume_capture_domain(f->capture, f->p->domain),
        .display = relume_encode_curve(f->capture, f->p->display),
        .geometry = manifest->geometry,
        .slabs = manifest->slabs,
        .slab = manifest->slab,
        .views = manifest->views,
        .view = f->view,
        .preview = relume_pack_preview,
        .preview_user = contents,
        .provenance = manifest->provenance,
    };
}

relume_status contents_share(struct relume_pack_share *out, char digest[RELUME_DIGEST],
                             const struct contents *f)
{
    const struct relume_pack_encode_params *p = f->p;
    *out = (struct relume_pack_share){
        .part = p->part,
        .parts = p->parts,
        .first = f->first,
        .views = f->end - f->first,
        .capture = digest,
        .options = p->options ? p->options : "",
        .free_storage = p->free_storage,
        .step = p->step,
        .pyramid = p->pyramid,
        .shared_books = p->books && p->share,
        .measured = f->report + f->first,
    };
    return relume_capture_digest(digest, f->capture, p->log);
}

relume_status contents_write(const struct relume_pack_contents *contents, const char *path,
                             const struct relume_pack_encode_params *p)
{
    return relume_pack_write(contents, path,
                             relume_pack_params(.log = p->log, .compression = p->compression,
                                                .threads = p->threads, .writer = p->writer));
}
