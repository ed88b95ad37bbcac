// material.c - what goes into a file while it is made
#include "encode/encode/material.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/memory.h"
#include "encode/levels/pyramid.h"
#include "format/codebook/books.h"
#include "format/coder/coding.h"
#include "format/pack/pack_write.h"
#include "relight/shadow/moving.h"

#include <math.h>

void material_destroy(struct material *m)
{
    for (int i = 0; i < m->views; i++) {
        if (m->levels)
            relume_pack_levels_destroy(&m->levels[i]);
        if (m->coefficients)
            relume_coefficients_destroy(&m->coefficients[i]);
        if (m->depth)
            relume_image_destroy(&m->depth[i]);
        if (m->mask)
            relume_image_destroy(&m->mask[i]);
        if (m->shadow)
            relume_image_destroy(&m->shadow[i]);
        if (m->books)
            relume_books_destroy(&m->books[i]);
        if (m->words)
            mem_free(m->words[i].word);
        for (int b = 0; m->index && b < RELUME_MOST_BOOKS; b++)
            mem_free(m->index[i * RELUME_MOST_BOOKS + b]);
    }
    mem_free(m->books);
    mem_free(m->words);
    mem_free(m->report);
    mem_free(m->index);
    mem_free(m->view);
    mem_free(m->levels);
    mem_free(m->coefficients);
    mem_free(m->depth);
    mem_free(m->mask);
    mem_free(m->shadow);
}

// Where the views are is known of all of them.
static void place_views(struct material *m, const struct relume_manifest *manifest)
{
    for (int i = 0; i < m->views; i++) {
        m->view[i].uv[0] = manifest->view[i].uv[0];
        m->view[i].uv[1] = manifest->view[i].uv[1];
        m->view[i].slab = manifest->view[i].slab;
    }
}

relume_status material_create(struct material *m, const struct encode_share *share)
{
    const struct relume_manifest *manifest = relume_capture_manifest(m->capture);
    const size_t n = (size_t)manifest->views;
    m->views = manifest->views;
    m->first = share->first;
    m->end = share->first + share->views;
    m->row = share->row;
    m->rows = share->rows;
    m->view = mem_zeroed(n, sizeof *m->view);
    m->levels = mem_zeroed(n, sizeof *m->levels);
    m->coefficients = mem_zeroed(n, sizeof *m->coefficients);
    m->depth = mem_zeroed(n, sizeof *m->depth);
    m->mask = mem_zeroed(n, sizeof *m->mask);
    m->shadow = mem_zeroed(n, sizeof *m->shadow);
    m->books = mem_zeroed(n, sizeof *m->books);
    m->index = mem_zeroed(n * RELUME_MOST_BOOKS, sizeof *m->index);
    m->words = mem_zeroed(n, sizeof *m->words);
    m->report = mem_zeroed(n, sizeof *m->report);
    if (!m->report || !m->words || !m->view || !m->levels || !m->coefficients || !m->depth ||
        !m->mask || !m->shadow || !m->books || !m->index)
        return RELUME_ENOMEM;
    place_views(m, manifest);
    return RELUME_OK;
}

relume_status material_encode(struct material *m, int i)
{
    const relume_status status =
        project_some_rows(&m->coefficients[i], m->coder, m->capture, i, m->row, m->rows, m->encode);
    if (!status)
        m->report[i] = relume_coefficients_report(m->coefficients[i]);
    m->view[i].coefficients = m->coefficients[i];
    return status;
}

// Bytes a pixel of highlights at a PSNR: a 32nd costs 0.06 dB between the lights, and a quarter of
// a small file less; the double for each 3 dB above, up to what all of it takes.
static double highlight_bytes(double psnr_db)
{
    return fmin(fmax(exp2((psnr_db - 42.0) / 3.0), 1.0), 4.0) / 32.0;
}

// Of what moves with the light, a view: little beside its planes, or beside the header.
static double model_bytes(const struct material *m)
{
    const struct relume_pack_encode_params *p = m->p;
    const double pixels =
        (double)relume_capture_width(m->capture) * relume_capture_height(m->capture);
    const double eighth = (p->psnr_db > 0.0 ? 1.0 : p->bytes_per_pixel) / 8.0, least = 4096.0;
    const double each = p->psnr_db > 0.0 && p->gloss ? highlight_bytes(p->psnr_db) : eighth;
    return each > 0.0 ? fmax(each * pixels, least) : 0.0;
}

relume_status material_extras(struct material *m, int i)
{
    relume_status status = RELUME_OK;
    if (!m->p->no_depth && m->row == 0)
        status = relume_capture_depth(&m->depth[i], m->capture, i, m->p->log);
    if (!status && m->row == 0)
        status = relume_capture_mask(&m->mask[i], m->capture, i, m->p->log);
    if (!status && m->p->shadows)
        status =
            relume_shadows_learn(&m->shadow[i], m->capture, i,
                                 relume_shadows_params(.log = m->p->log, .threads = m->p->threads));
    m->view[i].gloss = m->p->gloss;
    m->view[i].model_bytes = model_bytes(m);
    m->view[i].shadow = m->shadow[i].data ? &m->shadow[i] : NULL;
    m->view[i].depth = m->depth[i].data ? &m->depth[i] : NULL;
    m->view[i].mask = m->mask[i].data ? &m->mask[i] : NULL;
    return status;
}

relume_status material_reduce(struct material *m, int i)
{
    struct relume_pack_contents contents;
    material_contents(&contents, m);
    const relume_status status =
        relume_pack_reduce(&m->levels[i], &contents, &m->view[i], m->p->pyramid, m->encode);
    m->view[i].levels = m->levels[i].levels ? &m->levels[i] : NULL;
    return status;
}

void material_contents(struct relume_pack_contents *contents, const struct material *m)
{
    const struct relume_manifest *manifest = relume_capture_manifest(m->capture);
    *contents = (struct relume_pack_contents){
        .coder = m->coder,
        .domain = relume_capture_domain(m->capture, m->p->domain),
        .display = relume_encode_curve(m->capture, m->p->display),
        .geometry = manifest->geometry,
        .slabs = manifest->slabs,
        .slab = manifest->slab,
        .views = manifest->views,
        .view = m->view,
        .preview = relume_pack_preview,
        .preview_user = contents,
        .provenance = manifest->provenance,
    };
}

relume_status material_share(struct relume_pack_share *out, char digest[RELUME_DIGEST],
                             const struct material *m)
{
    const struct relume_pack_encode_params *p = m->p;
    *out = (struct relume_pack_share){
        .part = p->part,
        .parts = p->parts,
        .first = m->first,
        .views = m->end - m->first,
        .capture = digest,
        .options = p->options ? p->options : "",
        .free_storage = p->free_storage,
        .step = p->step,
        .pyramid = p->pyramid,
        .shared_books = p->books && p->share,
        .measured = m->report + m->first,
    };
    return relume_capture_digest(digest, m->capture, p->log);
}

relume_status material_write(const struct relume_pack_contents *contents, const char *path,
                             const struct relume_pack_encode_params *p)
{
    return relume_pack_write(contents, path,
                             relume_pack_params(.log = p->log, .compression = p->compression,
                                                .threads = p->threads, .writer = p->writer));
}
