// part.c - a part of a relume file, of which nothing is believed before it has been checked
#include "format/pack/part.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"
#include "format/pack/format.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// More than any command line names.
enum { MOST_PARTS = 1 << 20 };

static relume_status check_format(const struct part_file *p, const struct relume_log *log)
{
    const char *format = exr_get_text(p->file, 0, ATTR_FORMAT);
    int version;
    if (format && !strcmp(format, FORMAT_NAME))
        return log_fail(log, RELUME_EFORMAT,
                        "%s: a whole relume file; expected a part of one, made by 'relume encode "
                        "--part'",
                        p->path);
    if (!format || strcmp(format, FORMAT_PART))
        return log_fail(log, RELUME_EFORMAT,
                        "%s: an OpenEXR file, but not a part of a relume file; expected one made "
                        "by 'relume encode --part'",
                        p->path);
    if (!exr_get_int(p->file, 0, ATTR_VERSION, &version) || version < 1 || version > FORMAT_VERSION)
        return log_fail(log, RELUME_EUNSUPPORTED,
                        "%s: made by another version of relume; run this part again", p->path);
    return RELUME_OK;
}

static relume_status bad(const struct part_file *p, const char *what, const struct relume_log *log)
{
    return log_fail(log, RELUME_EDAMAGED, "%s: damaged %s; run this part again", p->path, what);
}

static bool copy_text(char *to, size_t size, const char *from)
{
    return from && (size_t)snprintf(to, size, "%s", from) < size;
}

// Of the views: that of the preview where that is not smaller.
static int height_of(const struct part_file *p)
{
    int height;
    return exr_get_int(p->file, 0, ATTR_HEIGHT, &height) && height > 0
               ? height
               : exr_part_info(p->file, 0).height;
}

static relume_status read_place(struct part_file *p, const struct relume_limits *limits,
                                const struct relume_log *log)
{
    struct relume_pack_part *i = &p->info;
    struct encode_share share;
    int count = 0;
    const float *v = exr_get_floats(p->file, 0, ATTR_PART, &count);
    for (int k = 0; k < 3; k++)
        if (!v || count != 3 || !(v[k] >= 0.0f && v[k] < 0x1p24f && v[k] == floorf(v[k])))
            return bad(p, "number", log);
    i->part = (int)v[0];
    i->parts = (int)v[1];
    p->free_storage = v[2] != 0.0f;
    p->info.coded = exr_get_text(p->file, 0, ATTR_CODING) != NULL;
    if (!exr_get_int(p->file, 0, ATTR_VIEWS, &i->all_views) || i->all_views < 1 ||
        i->all_views > limits->max_views || i->part < 1 || i->part > i->parts ||
        i->parts > MOST_PARTS ||
        (!p->info.coded && !encode_share_of(&share, i->part, i->parts, i->all_views, height_of(p))))
        return bad(p, "number of views", log);
    if (p->info.coded)
        return RELUME_OK;
    i->first = share.first;
    i->views = share.views;
    i->row = share.row;
    i->rows = share.rows;
    return RELUME_OK;
}

bool part_measured(struct relume_fidelity *out, const struct part_file *part, int exr)
{
    struct relume_census *c = &out->census;
    const char *text = exr_get_text(part->file, exr, ATTR_MEASURED);
    return text &&
           sscanf(text, SCAN_MEASURED, &out->fit_rms, &out->store_rms, &out->steps_rms,
                  &out->psnr_db, &out->typical, &c->pixels, &c->black, &c->clipped,
                  &c->always_clipped, &c->repaired, &c->black_images) == 11 &&
           isfinite(out->fit_rms) && isfinite(out->store_rms) && isfinite(out->steps_rms) &&
           isfinite(out->psnr_db) && isfinite(out->typical);
}

// "book0" and so on: codebooks of all views.
static void count_books(struct part_file *p)
{
    char name[32];
    p->books = 0;
    do
        snprintf(name, sizeof name, "book%d", p->books);
    while (1 + p->books < exr_part_count(p->file) &&
           !strcmp(exr_part_info(p->file, 1 + p->books).name, name) && ++p->books);
}

int part_next_member(const char **list, int views, size_t words[2])
{
    int view, read = 0;
    size_t own[2], *to = words ? words : own;
    if (sscanf(*list, FORMAT_MEMBER_SCAN, &view, &to[0], &to[1], &read) != 3 || view < 0 ||
        view >= views)
        return -1;
    *list += read;
    return view;
}

bool part_tiles(struct lossy_held *out, const struct part_file *part, int exr)
{
    int count;
    const float *v = exr_get_floats(part->file, exr, ATTR_TILES, &count);
    for (int k = 0; k < 3; k++)
        if (!v || count != 3 || !(v[k] >= 0.0f && v[k] < 0x1p24f && v[k] == floorf(v[k])))
            return false;
    *out = (struct lossy_held){.first = (int)v[0], .end = (int)v[1], .count = (int)v[2]};
    return out->first < out->end && out->end <= out->count;
}

// "group0003" and the next ones, whose views are counted, and then what belongs to views.
static relume_status check_groups(struct part_file *p, const struct relume_log *log)
{
    struct relume_fidelity measured;
    struct lossy_held tiles;
    char name[32];
    int k = 1, view, first = 0;
    if (!part_measured(&measured, p, 0))
        return bad(p, "report", log);
    for (; k < exr_part_count(p->file); k++, p->groups++) {
        const char *list = exr_get_text(p->file, k, ATTR_GROUP);
        if (!list)
            break;
        if (!p->groups && sscanf(exr_part_info(p->file, k).name, "group%d", &p->first_group) != 1)
            return bad(p, "list of groups", log);
        snprintf(name, sizeof name, "group%04d", p->first_group + p->groups);
        if (strcmp(exr_part_info(p->file, k).name, name) || p->first_group < 0 ||
            p->first_group > p->info.all_views || !part_tiles(&tiles, p, k) ||
            tiles.count > INT_MAX - p->info.all_tiles)
            return bad(p, "list of groups", log);
        p->info.tiles += tiles.end - tiles.first;
        p->info.all_tiles += tiles.count;
        for (; *list; p->info.views++) {
            view = part_next_member(&list, p->info.all_views, NULL);
            if (view < 0 || p->info.views >= p->info.all_views)
                return bad(p, "list of groups", log);
            first = !p->info.views || view < first ? view : first;
        }
    }
    p->info.first = first;
    for (; k < exr_part_count(p->file); k++) {
        const char *at = exr_part_info(p->file, k).name;
        if (sscanf(at, "view%d", &view) != 1 || view < 0 || view >= p->info.all_views ||
            snprintf(name, sizeof name, "view%04d.", view) < 0 ||
            strncmp(at, name, strlen(name)) != 0 || strlen(at) >= 48)
            return bad(p, "list of views", log);
    }
    return RELUME_OK;
}

// "view0007" and what belongs to it, "view0007.depth", in the order of their names.
static relume_status check_names(const struct part_file *p, const struct relume_log *log)
{
    const char *before = "preview";
    char view[32] = "";
    int next = p->info.first;
    for (int k = 1 + p->books; k < exr_part_count(p->file); k++) {
        const char *name = exr_part_info(p->file, k).name;
        const size_t length = strlen(view);
        if (length && !strncmp(name, view, length) && name[length] == '.' &&
            strcmp(before, name) < 0 && strlen(name) < 48) {
            before = name;
            continue;
        }
        struct relume_fidelity measured;
        snprintf(view, sizeof view, "view%04d", next++);
        if (strcmp(name, view) || !part_measured(&measured, p, k))
            return bad(p, "list of views", log);
        before = name;
    }
    return next == p->info.first + p->info.views ? RELUME_OK : bad(p, "list of views", log);
}

static relume_status use_sums(const struct part_file *p, const struct relume_log *log)
{
    enum exr_sums_found found;
    const relume_status status = exr_use_sums(p->file, &found);
    if (status)
        return status;
    if (found == EXR_SUMS_DAMAGED)
        return bad(p, "check sums", log);
    return found == EXR_SUMS_HEAD_CHANGED ||
                   (found == EXR_SUMS_NONE && exr_get_text(p->file, 0, ATTR_SUMS))
               ? bad(p, "header", log)
               : RELUME_OK;
}

relume_status part_open(struct part_file *out, const char *path, const struct relume_reader *from,
                        const struct relume_limits *limits, bool sums, const struct relume_log *log)
{
    const struct relume_limits most = limits_or_default(limits_of(limits, log));
    struct relume_pack_part *i = &out->info;
    *out = (struct part_file){.path = infile_name(path)};
    relume_status status = exr_open(&out->file, path, from, &most, log);
    if (!status && sums)
        status = use_sums(out, log);
    if (!status)
        status = check_format(out, log);
    if (!status)
        status = read_place(out, &most, log);
    if (!status &&
        (!copy_text(i->creator, sizeof i->creator, exr_get_text(out->file, 0, ATTR_CREATOR)) ||
         !copy_text(i->options, sizeof i->options, exr_get_text(out->file, 0, ATTR_OPTIONS)) ||
         !copy_text(i->capture, sizeof i->capture, exr_get_text(out->file, 0, ATTR_CAPTURE))))
        status = bad(out, "header", log);
    if (!status) {
        count_books(out);
        status = i->coded ? check_groups(out, log) : check_names(out, log);
    }
    if (status)
        part_close(out);
    else
        i->file_bytes = exr_bytes(out->file);
    i->has_sums = !status && exr_has_sums(out->file);
    return status;
}

relume_status part_is_coarse(const struct part_file *part, const struct relume_fidelity *all,
                             const struct relume_log *log)
{
    if (!part->free_storage || !relume_fidelity_is_coarse(all))
        return RELUME_OK;
    return log_fail(log, RELUME_EUNFIT,
                    "%s: very bright highlights: these bits will ruin the picture; run all parts "
                    "again with --bits half",
                    part->path);
}

void part_close(struct part_file *part)
{
    exr_close(&part->file);
}

relume_status relume_pack_part_read(struct relume_pack_part *out, const char *path,
                                    const struct relume_pack_params *params)
{
    const struct relume_pack_params p = PARAMS_WORK(relume_pack_params, params);
    struct part_file part;
    if (!path && !p.reader)
        return RELUME_EINVAL;
    const relume_status status = part_open(&part, path, p.reader, p.limits, false, p.log);
    *out = part.info;
    part_close(&part);
    return status;
}
