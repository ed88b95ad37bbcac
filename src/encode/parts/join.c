// join.c - the parts of a relume file become the file: blocks of rows are copied as they are
// packed, so that the bytes are those of a file that was written in one go
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "encode/parts/join_rows.h"
#include "encode/parts/join_tiles.h"
#include "format/coder/coefficients.h"
#include "format/pack/format.h"

#include <relume/encode/pack_encode.h>
#include <stdio.h>
#include <string.h>

struct joining {
    struct arena arena;
    struct part_file *part;  // [count], as they were named
    int count;
    const struct part_file **order;  // [parts], by their numbers
    struct exr_part *exr;
    int exrs;
    struct relume_fidelity *measured;  // [views]
    const struct relume_log *log;
};

// ---------------------------------------------------------------- do they belong together

static bool is_same(const struct exr_attribute *a, const struct exr_attribute *b)
{
    if (strcmp(a->name, b->name) || a->kind != b->kind)
        return false;
    switch (a->kind) {
    case EXR_INT: return a->integer == b->integer;
    case EXR_TEXT: return !strcmp(a->text, b->text);
    case EXR_FLOATS:
        return a->count == b->count &&
               !memcmp(a->floats, b->floats, (size_t)a->count * sizeof *a->floats);
    }
    return false;
}

// The first attribute of the header that differs, but for the place of the part; NULL: none.
static const char *difference(const struct exr_part *a, const struct exr_part *b)
{
    if (a->attributes != b->attributes || a->width != b->width || a->height != b->height ||
        a->codec != b->codec)
        return ATTR_VIEWS;
    for (int i = 0; i < a->attributes; i++)
        if (strcmp(a->attribute[i].name, ATTR_PART) != 0 &&
            !is_same(&a->attribute[i], &b->attribute[i]))
            return a->attribute[i].name;
    return NULL;
}

// What people call what the header's attributes say comes first.
static relume_status refuse_other(const struct part_file *p, const struct part_file *first,
                                  const char *what, const struct relume_log *log)
{
    const struct relume_pack_part *a = &p->info, *b = &first->info;
    if (strcmp(a->creator, b->creator))
        return log_fail(log, RELUME_EUNFIT,
                        "%s: made by %s; expected %s as in %s; run this part again", p->path,
                        a->creator, b->creator, first->path);
    if (strcmp(a->capture, b->capture))
        return log_fail(log, RELUME_EUNFIT,
                        "%s: a part of another capture than %s, or its photographs have changed; "
                        "run this part again",
                        p->path, first->path);
    if (strcmp(a->options, b->options))
        return log_fail(log, RELUME_EUNFIT,
                        "%s: made with other options than %s; expected '%s'; found '%s'", p->path,
                        first->path, b->options, a->options);
    if (a->parts != b->parts)
        return log_fail(log, RELUME_EUNFIT, "%s: part %d of %d; expected one of %d, as %s", p->path,
                        a->part, a->parts, b->parts, first->path);
    return log_fail(log, RELUME_EUNFIT,
                    "%s: differs from %s in %s, as between processors of different kinds; run the "
                    "parts again with RELUME_CPU=plain in the environment",
                    p->path, first->path, what);
}

// Codebooks that all views share are in all parts: they were trained to the same numbers.
static const char *difference_of_books(struct joining *j, const struct part_file *p,
                                       relume_status *status)
{
    struct exr_part own, first;
    for (int k = 1; k <= p->books && !*status; k++) {
        *status = exr_part_again(&own, p->file, k, &j->arena);
        if (!*status)
            *status = exr_part_again(&first, j->part->file, k, &j->arena);
        if (!*status && difference(&own, &first))
            return own.name;
    }
    return p->books == j->part->books ? NULL : ATTR_BOOKS;
}

static relume_status compare_headers(struct joining *j, const struct exr_part *first, int i)
{
    struct exr_part header;
    const struct part_file *p = &j->part[i];
    relume_status status = exr_part_again(&header, p->file, 0, &j->arena);
    const char *const books = status ? NULL : difference_of_books(j, p, &status);
    if (status)
        return status == RELUME_ENOMEM
                   ? status
                   : log_fail(j->log, status, "%s: damaged header; run this part again", p->path);
    const char *what = difference(&header, first);
    what = what ? what : books;
    if (what || p->info.parts != j->part->info.parts)
        return refuse_other(p, j->part, what, j->log);
    return RELUME_OK;
}

static relume_status refuse_missing(const struct joining *j)
{
    char list[256] = "";
    int missing = 0;
    for (int i = 0, n = 0, parts = j->part->info.parts; i < parts; i++) {
        missing += !j->order[i];
        if (!j->order[i] && n < 200)
            n += snprintf(list + n, sizeof list - (size_t)n, "%s%d", n ? ", " : " ", i + 1);
    }
    return log_fail(j->log, RELUME_EUNFIT, "%s: part%s%s%s of %d %s missing; expected all of them",
                    j->part->path, missing == 1 ? "" : "s", list, strlen(list) < 200 ? "" : ", ...",
                    j->part->info.parts, missing == 1 ? "is" : "are");
}

static relume_status put_in_order(struct joining *j)
{
    const int parts = j->part->info.parts;
    j->order = arena_array(&j->arena, (size_t)parts, sizeof *j->order);
    if (!j->order)
        return RELUME_ENOMEM;
    for (int i = 0; i < j->count; i++) {
        const struct part_file *p = &j->part[i], **place = &j->order[p->info.part - 1];
        if (*place)
            return log_fail(j->log, RELUME_EUNFIT,
                            "%s: part %d of %d, as %s is; expected each part once", p->path,
                            p->info.part, parts, (*place)->path);
        *place = p;
    }
    return j->count < parts ? refuse_missing(j) : RELUME_OK;
}

// ---------------------------------------------------------------- the file

// Attributes of the whole: those of a part alone go, and what is no attribute of ours.
static void keep_attributes(struct exr_part *part)
{
    struct exr_attribute *a = (struct exr_attribute *)(uintptr_t)part->attribute;
    int kept = 0;
    for (int i = 0; i < part->attributes; i++)
        if (!strncmp(a[i].name, "relume.", 7) &&
            strncmp(a[i].name, ATTR_PART, sizeof ATTR_PART - 1))
            a[kept++] = a[i];
    part->attributes = kept;
}

static struct exr_attribute *find_attribute(const struct exr_part *part, const char *name)
{
    struct exr_attribute *a = (struct exr_attribute *)(uintptr_t)part->attribute;
    for (int i = 0; i < part->attributes; i++)
        if (!strcmp(a[i].name, name))
            return &a[i];
    return NULL;
}

static relume_status damaged(const struct joining *j, const struct part_file *p)
{
    return log_fail(j->log, RELUME_EDAMAGED, "%s: damaged; run this part again", p->path);
}

static relume_status add_again(struct joining *j, const struct part_file *p, int exr)
{
    struct exr_part *to = &j->exr[j->exrs++];
    const relume_status status = exr_part_again(to, p->file, exr, &j->arena);
    keep_attributes(to);
    return status == RELUME_EDAMAGED ? damaged(j, p) : status;
}

static relume_status add_views(struct joining *j, const struct part_file *p)
{
    relume_status status = RELUME_OK;
    int view = p->info.first;
    for (int k = 1 + p->books; !status && k < exr_part_count(p->file); k++) {
        if (!strchr(exr_part_info(p->file, k).name, '.'))
            (void)!part_measured(&j->measured[view++], p,
                                 k);  // it has been when the part was opened
        status = add_again(j, p, k);
    }
    return status;
}

// ---------------------------------------------------------------- rows that are packed

static int count_lights(const struct joining *j)
{
    int count = 0;
    return exr_get_floats(j->part->file, 0, ATTR_LIGHTS, &count) ? count / 3 : 0;
}

static int height_of_views(const struct joining *j)
{
    return exr_part_info(j->part->file, 0).height;
}

// Part `exr` of a file as a piece of what those of the other parts of the view are.
static bool is_piece(const struct exr_part *piece, const struct exr_part *all,
                     const struct part_file *p)
{
    const struct exr_attribute *a = piece->attribute, *b = all->attribute;
    bool same = piece->height == p->info.rows && piece->width == all->width &&
                piece->codec == all->codec && piece->sample == all->sample &&
                piece->channels == all->channels && piece->attributes == all->attributes &&
                !piece->tile && p->info.row % exr_block_rows(piece->codec) == 0;
    for (int i = 0; same && i < piece->attributes; i++)
        same = !strncmp(a[i].name, ATTR_PART, sizeof ATTR_PART - 1) || is_same(&a[i], &b[i]);
    return same;
}

// The blocks of rows of a view from all its parts, the first of which is order[*i]; *i moves behind
// them.
static relume_status add_rows_of_view(struct joining *j, int *i)
{
    const struct part_file *first = j->order[*i];
    const int view = first->info.first, lights = count_lights(j), height = height_of_views(j);
    struct exr_part *to = &j->exr[j->exrs];
    struct exr_copied *source = arena_array(&j->arena, (size_t)j->count, sizeof *source);
    struct project_rows sums = {
        .error = arena_array(&j->arena, (size_t)height, sizeof *sums.error),
        .shown_error = arena_array(&j->arena, (size_t)lights, sizeof *sums.shown_error),
        .lit = arena_array(&j->arena, (size_t)lights, sizeof *sums.lit),
        .stored = arena_array(&j->arena, (size_t)height, sizeof *sums.stored),
    };
    struct relume_census census = {0};
    relume_status status = source && sums.error && sums.shown_error && sums.lit && sums.stored
                               ? exr_part_again(to, first->file, 1, &j->arena)
                               : RELUME_ENOMEM;
    int n = 0;
    for (; !status && *i < j->count && j->order[*i]->info.first == view; ++*i, n++) {
        const struct part_file *p = j->order[*i];
        struct exr_part piece;
        source[n] = (struct exr_copied){p->file, 1, p->info.row, 0};
        status = exr_part_again(&piece, p->file, 1, &j->arena);
        if (!status && (!is_piece(&piece, to, p) || !rows_add_errors(&sums, p, lights) ||
                        !rows_add_stored(&sums, p) || !rows_add_census(&census, &sums, p, lights)))
            status = RELUME_EDAMAGED;
        if (status == RELUME_EDAMAGED)
            return damaged(j, p);
    }
    if (status)
        return status;
    j->measured[view] = project_rows_fidelity(&sums, height, lights);
    j->measured[view].census = census;
    to->height = height;
    to->source = source;
    to->sources = n;
    keep_attributes(to);
    j->exrs++;
    for (int k = 2; !status && k < exr_part_count(first->file); k++)
        status = add_again(j, first, k);
    return status;
}

static relume_status add_rows(struct joining *j)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < j->count;)
        status = add_rows_of_view(j, &i);
    return status;
}

// Each part has its own rows of the preview.
static relume_status gather_preview(struct joining *j, const struct part_file *first)
{
    struct exr_copied *source = arena_array(&j->arena, (size_t)j->count, sizeof *source);
    if (!source)
        return RELUME_ENOMEM;
    j->exr->source = source;
    for (int i = 0; i < j->count; i++)
        if (j->order[i]->info.first == first->info.first) {
            const int row = j->order[i]->info.row;
            source[j->exr->sources++] = (struct exr_copied){j->order[i]->file, 0, row, row};
        }
    return RELUME_OK;
}

// All parts, or none; more of them than one process has made wait for the ranges of the others.
static relume_status find_packed(const struct joining *j, bool *packed)
{
    int count = 0;
    for (int i = 0; i < j->count; i++)
        count += exr_get_text(j->part[i].file, 1, ATTR_STORED) != NULL;
    *packed = count == j->count;
    return !count || *packed
               ? RELUME_OK
               : log_fail(j->log, RELUME_EUNFIT,
                          "%s: some parts hold packed rows and others do not; run all parts again "
                          "in the same way",
                          j->part->path);
}

// ---------------------------------------------------------------- planes with loss

// The parts that have tiles of a group, *count of them.
static relume_status find_tiles(struct joining *j, int group, struct tiles_of_part **out,
                                int *count)
{
    struct tiles_of_part *own = *out = arena_array(&j->arena, (size_t)j->count, sizeof *own);
    *count = 0;
    for (int i = 0; own && i < j->count; i++) {
        const struct part_file *p = j->order[i];
        const int k = 1 + group - p->first_group;
        if (k >= 1 && k <= p->groups)
            own[(*count)++] = (struct tiles_of_part){.part = p, .exr = k};
    }
    return own ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status add_group(struct joining *j, struct tiles_of_part *own, int count)
{
    const struct part_file *bad = own->part;
    relume_status status = join_tiles_check(own, count, &bad);
    if (!status && count == 1)
        return add_again(j, own->part, own->exr);
    struct exr_part *to = &j->exr[j->exrs++];
    if (!status)
        status = exr_part_again(to, own->part->file, own->exr, &j->arena);
    if (!status) {
        keep_attributes(to);
        status = join_tiles(to, own, count, &bad, &j->arena, j->log);
    }
    return status == RELUME_EDAMAGED ? damaged(j, bad) : status;
}

static relume_status see_views(struct joining *j, const struct tiles_of_part *own, char *seen)
{
    const struct part_file *p = own->part;
    const char *list = exr_get_text(p->file, own->exr, ATTR_GROUP);
    while (*list) {
        const int view = part_next_member(&list, p->info.all_views, NULL);
        if (view < 0 || seen[view]++)
            return damaged(j, p);
    }
    return RELUME_OK;
}

static relume_status add_groups(struct joining *j, char *seen)
{
    relume_status status = RELUME_OK;
    int groups = 0, count;
    for (int i = 0; i < j->count; i++) {
        const int end = j->part[i].first_group + j->part[i].groups;
        groups = j->part[i].groups && end > groups ? end : groups;
    }
    for (int g = 0; !status && g < groups; g++) {
        struct tiles_of_part *own;
        status = find_tiles(j, g, &own, &count);
        if (!status && !count)
            return damaged(j, j->part);
        if (!status)
            status = see_views(j, own, seen);
        if (!status)
            status = add_group(j, own, count);
    }
    for (int v = 0; !status && v < j->part->info.all_views; v++)
        if (!seen[v])
            return damaged(j, j->part);
    return status;
}

// Depth and mask of all views, or all their levels: groups are not in the order of their views.
static relume_status add_beside(struct joining *j, bool levels)
{
    relume_status status = RELUME_OK;
    char name[32];
    for (int v = 0; !status && v < j->part->info.all_views; v++) {
        const size_t length = (size_t)snprintf(name, sizeof name, "view%04d.", v);
        for (int i = 0; !status && i < j->count; i++)
            for (int k = 1 + j->order[i]->groups; !status && k < exr_part_count(j->order[i]->file);
                 k++) {
                const char *own = exr_part_info(j->order[i]->file, k).name;
                if (!strncmp(own, name, length) && !strncmp(own + length, "level", 5) == levels)
                    status = add_again(j, j->order[i], k);
            }
    }
    return status;
}

static relume_status add_coded(struct joining *j)
{
    char *seen = arena_array(&j->arena, (size_t)j->part->info.all_views, sizeof *seen);
    relume_status status = seen ? add_groups(j, seen) : RELUME_ENOMEM;
    if (!status)
        status = add_beside(j, false);
    return status ? status : add_beside(j, true);
}

// ---------------------------------------------------------------- all of it

static bool holds_view(const struct part_file *p, int view)
{
    for (int k = 1; k <= p->groups; k++) {
        const char *list = exr_get_text(p->file, k, ATTR_GROUP);
        while (*list) {
            const int own = part_next_member(&list, p->info.all_views, NULL);
            if (own < 0 || own == view)
                return own == view;
        }
    }
    return false;
}

// The part that holds the middle view made the preview.
static const struct part_file *with_preview(const struct joining *j)
{
    const int middle = j->part->info.all_views / 2;
    int i = 0;
    while (i + 1 < j->count &&
           (j->part->info.coded ? !holds_view(j->order[i], middle)
                                : j->order[i]->info.first + j->order[i]->info.views <= middle))
        i++;
    return j->order[i];
}

static relume_status add_header(struct joining *j)
{
    const struct part_file *const first = with_preview(j);
    relume_status status = add_again(j, first, 0);
    if (!status && first->info.rows)
        status = gather_preview(j, first);
    struct exr_attribute *format = status ? NULL : find_attribute(j->exr, ATTR_FORMAT);
    if (format)
        format->text = FORMAT_NAME;
    return status;
}

static relume_status set_report(struct joining *j, struct relume_fidelity *report)
{
    const struct relume_fidelity all = fidelity_mean(j->measured, j->part->info.all_views);
    struct exr_attribute *a = find_attribute(j->exr, ATTR_REPORT);
    float *v = arena_array(&j->arena, 2, sizeof *v);
    if (!v)
        return RELUME_ENOMEM;
    v[0] = (float)all.fit_rms;
    v[1] = (float)all.store_rms;
    if (!a || a->kind != EXR_FLOATS || a->count != 2)
        return damaged(j, j->part);
    a->floats = v;
    if (report)
        *report = all;
    return part_is_coarse(j->part, &all, j->log);
}

static relume_status gather(struct joining *j, struct relume_fidelity *report)
{
    size_t exrs = 0;
    for (int i = 0; i < j->count; i++)
        exrs += (size_t)exr_part_count(j->part[i].file);
    j->exr = arena_array(&j->arena, exrs, sizeof *j->exr);
    j->measured = arena_array(&j->arena, (size_t)j->part->info.all_views, sizeof *j->measured);
    relume_status status = j->exr && j->measured ? add_header(j) : RELUME_ENOMEM;
    if (!status && j->part->info.coded) {
        if (report)
            (void)!part_measured(report, j->part, 0);  // it has been when the part was opened
        return add_coded(j);
    }
    for (int k = 1; !status && k <= j->part->books; k++)
        status = add_again(j, j->part, k);
    if (!status && j->part->info.rows)
        status = add_rows(j);
    for (int i = 0; !status && !j->part->info.rows && i < j->count; i++)
        status = add_views(j, j->order[i]);
    return status ? status : set_report(j, report);
}

static void ignore(void *context, const struct relume_rect *at, const void *samples)
{
    (void)context, (void)at, (void)samples;
}

// Pictures and codebooks, which are copied from one part alone: damage to the others' would not be
// noticed.
static relume_status check_unused(const struct joining *j, const struct part_file *p, int threads)
{
    relume_status status = RELUME_OK;
    for (int k = 0; !status && k <= p->books; k++)
        status = exr_read(p->file, k, NULL, threads, ignore, NULL, NULL);
    return status == RELUME_EDAMAGED ? damaged(j, p) : status;
}

static relume_status check_parts(struct joining *j, int threads)
{
    struct exr_part first;
    relume_status status = exr_part_again(&first, j->part->file, 0, &j->arena);
    if (status == RELUME_EDAMAGED)
        return damaged(j, j->part);
    for (int i = 1; !status && i < j->count; i++)
        status = compare_headers(j, &first, i);
    for (int i = 0; !status && i < j->count; i++)
        status = check_unused(j, &j->part[i], threads);
    return status ? status : put_in_order(j);
}

relume_status relume_pack_join(const char *const *parts, int count, const char *path,
                               struct relume_fidelity *report,
                               const struct relume_pack_params *params)
{
    const struct relume_pack_params p = PARAMS_WORK(relume_pack_params, params);
    struct joining j = {.log = p.log};
    struct relume_fidelity ignored;
    int open = 0;
    if (count < 1 || (!path && !p.writer))
        return RELUME_EINVAL;
    j.part = arena_array(&j.arena, (size_t)count, sizeof *j.part);
    relume_status status = j.part ? RELUME_OK : RELUME_ENOMEM;
    while (!status && open < count) {
        status = part_open(&j.part[open], parts[open], NULL, p.limits, true, p.log);
        open += !status;
    }
    j.count = open;
    if (!status)
        status = check_parts(&j, p.threads);
    bool packed = true;
    if (!status && j.part->info.rows)
        status = find_packed(&j, &packed);
    if (!status && packed)
        status = gather(&j, report);
    if (!status && packed)
        status = exr_write(path, p.writer, j.exr, j.exrs, find_attribute(j.exr, ATTR_SUMS) != NULL,
                           p.threads, p.log);
    else if (!status)
        status = join_rows(j.order, j.count, path, report ? report : &ignored, &p);
    for (int i = 0; i < open; i++)
        part_close(&j.part[i]);
    arena_free(&j.arena);
    return status;
}
