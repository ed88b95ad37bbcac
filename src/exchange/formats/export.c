// export.c - a view of a relume file in another format
#include "exchange/formats/export.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/params.h"

#include <math.h>
#include <string.h>

#include "core/base/names.h"
#include "core/math/vec.h"
#include "format/coder/coding.h"
#include "format/pack/views.h"

relume_status relume_exchange_parse(enum relume_exchange *out, const char *name)
{
    static const char *const names[] = {"relight", "ptm", "lptm", "rti", "deepzoom",
                                        "bc1",     "bc7", "bc6h", "olat"};
    const int i = name_find(name, names, sizeof names / sizeof *names);
    *out = (enum relume_exchange)(i < 0 ? 0 : i);
    return i < 0 ? RELUME_EINVAL : RELUME_OK;
}

double export_light_spacing(const struct source *s)
{
    double sum = 0.0;
    for (int i = 0; i < s->lights; i++) {
        double nearest = 2.0;
        for (int j = 0; j < s->lights; j++)
            if (j != i)
                nearest = fmin(nearest, vec3_length(vec3_sub(s->light[i], s->light[j])));
        sum += nearest;
    }
    return sum / s->lights;
}

static bool is_blocks(enum relume_exchange format)
{
    return format >= RELUME_EXCHANGE_BC1 && format <= RELUME_EXCHANGE_BC6H;
}

static bool is_folder(enum relume_exchange format)
{
    return format == RELUME_EXCHANGE_RELIGHT || format == RELUME_EXCHANGE_DEEPZOOM ||
           is_blocks(format);
}

static relume_status check(const relume_pack *pack, const char *path, enum relume_exchange format,
                           const struct relume_export_params *p)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    if (info->geometry.projection >= RELUME_CYLINDRICAL)
        return log_fail(
            p->log, RELUME_EUNSUPPORTED,
            "%s: panoramas cannot be exported to this format; expected a planar file or a slab",
            path);
    if (info->slabs)
        return log_fail(p->log, RELUME_EUNSUPPORTED,
                        "%s: slabs around an object cannot be exported to this format; expected a "
                        "planar file or one slab",
                        path);
    if (p->view < 0 || p->view >= info->views)
        return log_fail(p->log, RELUME_EINVAL, "view %d; expected 0 to %d", p->view,
                        info->views - 1);
    if (p->level < 0 || p->level > info->levels)
        return log_fail(p->log, RELUME_EINVAL,
                        info->levels ? "level %d; expected 0 to %d"
                                     : "level %d; the file has no pyramid (encode --pyramid yes), "
                                       "expected %d",
                        p->level, info->levels);
    if (p->writer && is_folder(format))
        return log_fail(p->log, RELUME_EINVAL, "this format is a folder; expected no writer");
    if ((p->bytes_per_pixel > 0.0) + (p->psnr_db > 0.0) + (p->quality > 0) > 1)
        return log_fail(p->log, RELUME_EINVAL,
                        "expected at most one of bytes per pixel, PSNR and quality");
    return RELUME_OK;
}

// Of the view, or of a level of it, which is the caller's then.
static relume_status read_codes(const struct relume_codes **out, struct relume_codes_part *level,
                                relume_pack *pack, const struct relume_export_params *p)
{
    struct relume_rect all = {0};
    if (!p->level)
        return relume_pack_codes(out, pack, p->view);
    relume_pack_level_size(&all.width, &all.height, pack, p->level);
    *out = &level->codes;
    return relume_pack_codes_level(level, pack, p->view, p->level, &all);
}

relume_status relume_export(relume_pack *pack, const char *path, enum relume_exchange format,
                            struct relume_export_report *report,
                            const struct relume_export_params *params)
{
    const struct relume_export_params p = PARAMS_WORK(relume_export_params, params);
    const struct relume_codes *codes;
    struct relume_codes_part level = {0};
    struct relume_export_report found = {0};
    struct source source = {0};
    path = infile_name(path);
    relume_status status = check(pack, path, format, &p);
    if (!status)
        status = read_codes(&codes, &level, pack, &p);
    if (!status && format == RELUME_EXCHANGE_OLAT)
        status = export_olat(codes, path, &found, &p);
    else if (!status)
        status = source_open(&source, codes, SOURCE_UPPER, p.log);
    const struct export e = {&source, &p, p.log, format == RELUME_EXCHANGE_DEEPZOOM};
    if (!status && format != RELUME_EXCHANGE_OLAT)
        status = is_blocks(format)   ? export_blocks(&e, path, format, &found)
                 : is_folder(format) ? export_web(&e, path, &found)
                                     : export_legacy(&e, path, format, &found);
    source_close(&source);
    relume_codes_part_destroy(&level);
    if (report)
        *report = found;
    return status;
}
