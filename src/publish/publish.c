// publish.c - relightable files as a folder of web pages
#include <relume/publish.h>

#include "base/infile.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/names.h"
#include "base/outdir.h"
#include "base/params.h"
#include "publish/scene.h"

#include <relume/exchange.h>
#include <string.h>

relume_status relume_publish_for_parse(enum relume_publish_for *out, const char *name)
{
    static const char *const names[] = {"both", "web", "disk"};
    const int i = name_find(name, names, sizeof names / sizeof *names);
    *out = (enum relume_publish_for)(i < 0 ? 0 : i);
    return i < 0 ? RELUME_EINVAL : RELUME_OK;
}

static relume_status publish_file(const struct site *site, const char *path, const char *name,
                                  struct relume_publish_report *report)
{
    const struct relume_publish_params *p = site->params;
    struct log_place place;
    struct site here = *site;
    here.log = log_at(&place, site->log, "%s", path);
    struct scene s = {.site = &here, .name = name, .report = report};
    relume_status status = relume_open(
        &s.pack, path,
        relume_open_params(.log = p->log, .limits = p->limits, .allow_outside = p->allow_outside,
                           .keep_going = p->keep_going, .threads = p->threads));
    if (!status && relume_pack_info(s.pack)->slabs)
        status = log_fail(p->log, RELUME_EUNSUPPORTED,
                          "%s: slabs around an object cannot be published; expected a planar file, "
                          "one slab or a panorama",
                          path);
    if (!status)
        status = scene_write(&s);
    if (!status)
        report->views = relume_pack_info(s.pack)->views;
    scene_free(&s);
    return status;
}

relume_status relume_publish(const char *const *files, int count, const char *path,
                             struct relume_publish_report *reports,
                             const struct relume_publish_params *params)
{
    const struct relume_publish_params p = PARAMS_WORK(relume_publish_params, params);
    outdir *dir = NULL;
    relume_status status = outdir_open(&dir, path, p.force, p.log);
    const struct site site = {.path = dir ? outdir_path(dir) : NULL, .params = &p, .log = p.log};
    for (int i = 0; !status && i < count; i++) {
        struct relume_publish_report found = {.name = "scene"};
        status = publish_file(&site, files[i], found.name, &found);
        if (reports)
            reports[i] = found;
    }
    return outdir_end(&dir, status);
}
