// publish.c - relightable files as a folder of web pages
#include <relume/publish.h>

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/names.h"
#include "core/base/outdir.h"
#include "core/base/params.h"
#include "site/publish/annotations.h"
#include "site/publish/assets.h"
#include "site/publish/iiif.h"
#include "site/publish/names.h"
#include "site/publish/object.h"
#include "site/publish/page.h"
#include "site/publish/part.h"
#include "site/publish/picture.h"
#include "site/publish/published.h"

#include <relume/exchange.h>
#include <relume/world/bake.h>
#include <string.h>

enum { POSTER_SIDE = 800 };
// PSNR in dB below which differences from the original are visible.
static const double SEEN_DB = 38.0;

// All files of a site, and what is known of them.
struct site_build {
    const struct relume_publish_params *params;
    const char *const *files;
    int count;
    char **stems;              // [count], then NULL
    char (*names)[SITE_NAME];  // [count]
    struct page *pages;        // [count]
    jvalue *metadata;
    struct relume_publish_report *reports;  // or NULL
};

static relume_status work_begin(struct site_build *w)
{
    const size_t n = (size_t)w->count;
    w->stems = mem_zeroed(n + 1, sizeof *w->stems);
    w->names = mem_zeroed(n, sizeof *w->names);
    w->pages = mem_zeroed(n, sizeof *w->pages);
    if (!w->stems || !w->names || !w->pages)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++)
        if (!(w->stems[i] = names_stem(w->files[i])))
            return RELUME_ENOMEM;
    names_make(w->names, w->stems, w->count);
    return details_load(&w->metadata, w->params, (const char *const *)w->stems);
}

static void work_end(struct site_build *w)
{
    for (int i = 0; w->stems && i < w->count; i++)
        mem_free(w->stems[i]);
    mem_free(w->stems);
    mem_free(w->names);
    mem_free(w->pages);
    jvalue_free(&w->metadata);
}

// ---------------------------------------------------------------- one file

static relume_status write_poster(const struct published *f, struct page *page)
{
    struct relume_image still = {0};
    char name[128];
    snprintf(name, sizeof name, "%s/poster.jpg", f->name);
    relume_status status = picture_still(&still, f->pack, POSTER_SIDE, true, f->site);
    const struct relume_rect all = {0, 0, still.width, still.height};
    if (!status)
        status = picture_save_jpeg(f->site, name, &still, &all);
    page->poster_width = still.width;
    page->poster_height = still.height;
    relume_image_destroy(&still);
    return status;
}

static relume_status open_file(relume_pack **pack, const char *path,
                               const struct relume_publish_params *p)
{
    relume_status status = relume_open(
        pack, path,
        relume_open_params(.log = p->log, .limits = p->limits, .allow_outside = p->allow_outside,
                           .keep_going = p->keep_going, .threads = p->threads));
    if (!status && relume_pack_info(*pack)->slabs)
        status = log_fail(p->log, RELUME_EUNSUPPORTED,
                          "%s: slabs around an object cannot be published; expected a planar file, "
                          "one slab or a panorama",
                          path);
    return status;
}

static relume_status write_all(struct published *f, struct page *page, const char *path,
                               const char *site_title)
{
    relume_notes *notes = NULL;
    relume_status status = annotations_open(&notes, f->site, path, f->pack);
    if (!status)
        status = part_keep(f->report->crop, f->pack, &notes, f->site);
    f->notes = !status && relume_notes_count(notes) > 0;
    f->mm_per_pixel = f->site->params->mm_per_pixel > 0.0 ? f->site->params->mm_per_pixel
                      : status                            ? 0.0
                                                          : relume_notes_scale(notes);
    if (!status)
        status = published_write(f);
    if (!status)
        status = write_poster(f, page);
    if (!status)
        status = iiif_write(f->site, page, f->pack, f->notes);
    if (!status && f->notes)
        status = annotations_write(f->site, notes, path, relume_pack_info(f->pack)->notes, page,
                                   f->report->crop[2] > 0);
    if (!status)
        status = page_write(f->site, page, site_title);
    relume_notes_destroy(&notes);
    return status;
}

static enum relume_publish_advice advise(const struct relume_publish_report *r,
                                         const struct relume_publish_params *p)
{
    const bool wished =
        p->quality > 0 || p->psnr_db > 0.0 || p->bytes_per_pixel > 0.0 || p->coefficients > 0;
    if (!r->views || r->psnr_db >= SEEN_DB)
        return RELUME_PUBLISH_NO_ADVICE;
    if (r->linear)
        return RELUME_PUBLISH_CODE_DISPLAY;
    return wished ? RELUME_PUBLISH_NO_ADVICE : RELUME_PUBLISH_RAISE_QUALITY;
}

static relume_status publish_file(struct site_build *w, int i, const struct site *site)
{
    struct log_place place;
    struct site here = *site;
    struct relume_publish_report report = {.psnr_db = 0.0};
    struct page *page = &w->pages[i];
    here.log = log_at(&place, site->log, "%s: ", w->files[i]);
    *page = (struct page){.name = w->names[i],
                          .details =
                              details_of_file(w->metadata, w->params, w->stems[i], w->count == 1)};
    struct published f = {
        .site = &here, .name = w->names[i], .details = page->details, .report = &report};
    memcpy(report.name, w->names[i], sizeof report.name);
    const char *site_title = details_of_site(w->metadata, w->params).title;
    page->object = relume_kind_of(w->files[i]) == RELUME_KIND_BAKED;
    relume_status status = !page->object ? open_file(&f.pack, w->files[i], w->params)
                           : w->params->crop_auto || w->params->crop[2]
                               ? log_fail(here.log, RELUME_EUNFIT,
                                          "an object has no parts by themselves; --crop expects a "
                                          "planar file or one slab")
                               : object_write(&here, page, w->files[i], &report);
    if (!status && page->object) {
        status = page_write(&here, page, site_title);
    } else if (!status) {
        report.views = relume_pack_info(f.pack)->views;
        status = write_all(&f, page, w->files[i], site_title);
    }
    published_free(&f);
    report.advice = advise(&report, w->params);
    if (w->reports)
        w->reports[i] = report;
    return status;
}

// ---------------------------------------------------------------- the site

static relume_status write_assets(const struct site *site, const struct page *pages, int count)
{
    relume_status status = RELUME_OK;
    bool objects = false;
    for (int i = 0; i < count; i++)
        objects = objects || pages[i].object;
    for (const struct asset *a = site_assets; !status && a->name; a++) {
        if (!objects && !strcmp(a->name, ASSET_OBJECT))
            continue;
        char name[128];
        snprintf(name, sizeof name, "relume/%s", a->name);
        status = strcmp(a->name, ASSET_OPEN) ? site_save(site, name, a->bytes, a->size)
                                             : site_save_data(site, name, a->bytes, a->size);
    }
    return status;
}

static relume_status check(const char *const *files, int count, const char *path,
                           const struct relume_publish_params *p)
{
    bool named = path != NULL;
    for (int i = 0; i < count; i++)
        named = named && files[i];
    if (count < 1 || !named)
        return log_fail(p->log, RELUME_EINVAL,
                        "nothing to publish; expected a file or more, and a name for the site");
    if ((p->bytes_per_pixel > 0.0) + (p->psnr_db > 0.0) + (p->quality > 0) > 1)
        return log_fail(p->log, RELUME_EINVAL,
                        "publish: expected one of --quality, --psnr and --bytes-per-pixel");
    if (p->coefficients < 0 || p->coefficients > PUBLISH_MOST_PLANES)
        return log_fail(p->log, RELUME_EINVAL, "%d coefficients; expected 1 to %d", p->coefficients,
                        PUBLISH_MOST_PLANES);
    if (p->url && strncmp(p->url, "https://", 8) && strncmp(p->url, "http://", 7))
        return log_fail(p->log, RELUME_EINVAL,
                        "address '%s'; expected one that begins with https:// or http://", p->url);
    return RELUME_OK;
}

relume_status relume_publish_files(const char *path, const char *const *files, int count,
                                   const struct relume_publish_params *params,
                                   struct relume_publish_report *reports)
{
    const struct relume_publish_params p = PARAMS_WORK(relume_publish_params, params);
    struct site_build w = {.params = &p, .files = files, .count = count, .reports = reports};
    outdir *dir = NULL;
    relume_status status = check(files, count, path, &p);
    if (!status)
        status = work_begin(&w);
    if (!status)
        status = outdir_open(&dir, path, p.force, p.log);
    const struct site site = {.path = dir ? outdir_path(dir) : NULL, .params = &p, .log = p.log};
    for (int i = 0; !status && i < count; i++)
        status = publish_file(&w, i, &site);
    const struct details details = details_of_site(w.metadata, &p);
    if (!status)
        status = write_assets(&site, w.pages, count);
    if (!status)
        status = page_write_index(&site, w.pages, count, &details);
    if (!status)
        status = page_write_open(&site);
    work_end(&w);
    return outdir_end(&dir, status);
}
