// join_tiles.c - a group of coded views whose tiles lie in several parts
//
// Each part has the words of every view with its own tiles; those of the others have 0 bytes in the
// head. The whole has one head for all, the tiles of the first part, of the next, and so on, and
// the depth, which the first part has.
#include "encode/parts/join_tiles.h"

#include "format/pack/format.h"
#include "format/pack/words.h"

#include <string.h>

relume_status join_tiles_check(struct tiles_of_part *own, int count, const struct part_file **bad)
{
    int next = 0;
    for (int i = 0; i < count; i++) {
        struct lossy_held *t = &own[i].tiles;
        *bad = own[i].part;
        if (!part_tiles(t, own[i].part, own[i].exr) || t->first != next ||
            t->count != own[0].tiles.count)
            return RELUME_EDAMAGED;
        next = t->end;
    }
    return next == own[0].tiles.count ? RELUME_OK : RELUME_EDAMAGED;
}

// Where the words of the next view begin in a part.
struct place {
    const char *list;
    size_t at, end;
};

struct tiling {
    const struct tiles_of_part *own;  // [count]
    int count;
    struct place *place;  // [count]
    struct word_run *run;
    int runs;
    const char *list;  // of the whole
    const struct part_file **bad;
    struct arena *arena;
};

static bool begin(struct place *p, const struct tiles_of_part *own)
{
    const struct exr_part_info i = exr_part_info(own->part->file, own->exr);
    *p = (struct place){.list = exr_get_text(own->part->file, own->exr, ATTR_GROUP),
                        .end = (size_t)i.width * (size_t)i.height};
    return p->list && i.channels == 1 && i.uniform && i.sample == EXR_SAMPLE_UINT && !i.tile;
}

static int count_views(const char *list, int views)
{
    int n = 0;
    while (*list && part_next_member(&list, views, NULL) >= 0)
        n++;
    return n;
}

// The head of the words at a place, `words` of which belong to the view. Who joins names the part.
static relume_status read_head(uint32_t **out, struct lossy_held *held, const struct tiling *t,
                               int i, size_t words)
{
    const struct tiles_of_part *own = &t->own[i];
    uint32_t few[LOSSY_HEAD];
    if (words < LOSSY_HEAD)
        return RELUME_EDAMAGED;
    relume_status status =
        words_read(few, own->part->file, own->exr, t->place[i].at, LOSSY_HEAD, 1, NULL);
    if (status)
        return status;
    if (lossy_head(few) > words)
        return RELUME_EDAMAGED;
    uint32_t *head = *out = arena_array(t->arena, lossy_head(few), sizeof *head);
    status =
        head ? words_read(head, own->part->file, own->exr, t->place[i].at, lossy_head(few), 1, NULL)
             : RELUME_ENOMEM;
    if (!status)
        status = lossy_look(held, head, words);
    if (!status && (held->first != own->tiles.first || held->end != own->tiles.end ||
                    held->count != own->tiles.count || held->words != words))
        status = RELUME_EDAMAGED;
    return status;
}

static struct word_run *add_run(struct tiling *t, size_t count)
{
    struct word_run *run = &t->run[t->runs++];
    *run = (struct word_run){.count = count};
    return run;
}

static void add_of_part(struct tiling *t, int i, size_t first, size_t count)
{
    struct word_run *run = add_run(t, count);
    run->file = t->own[i].part->file;
    run->part = t->own[i].exr;
    run->first = first;
}

// The next view of all parts.
static relume_status add_view(struct tiling *t)
{
    const int views = t->own->part->info.all_views;
    uint32_t *head = NULL, *other;
    struct lossy_held held, first = {0};
    size_t depth = 0, words = 0, heads = 0;
    int view = -1;
    struct word_run *const all = add_run(t, 0);
    for (int i = 0; i < t->count; i++) {
        struct place *p = &t->place[i];
        size_t n[2];
        *t->bad = t->own[i].part;
        const int own = part_next_member(&p->list, views, n);
        if (own < 0 || (i && (own != view || n[1])) || n[0] > p->end - p->at ||
            n[1] > p->end - p->at - n[0])
            return RELUME_EDAMAGED;
        const relume_status status = read_head(&other, &held, t, i, n[0]);
        if (status)
            return status;
        if (i && held.side != first.side)
            return RELUME_EDAMAGED;
        const size_t size = lossy_head(other);
        if (i)
            lossy_add_tiles(head, other, &held);
        else
            head = other, heads = words = size, first = held, view = own, depth = n[1];
        add_of_part(t, i, p->at + size, n[0] - size);
        words += n[0] - size;
        p->at += n[0] + n[1];
    }
    *all = (struct word_run){.count = heads, .word = head};
    add_of_part(t, 0, t->place[0].at - depth, depth);
    t->list = arena_format(t->arena, FORMAT_MEMBER, t->list ? t->list : "", view, words, depth);
    return t->list ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status add_views(struct tiling *t, int views)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < views && !status; i++)
        status = add_view(t);
    for (int i = 0; i < t->count && !status; i++)
        if (*t->place[i].list) {
            *t->bad = t->own[i].part;
            status = RELUME_EDAMAGED;
        }
    return status;
}

relume_status join_tiles(struct exr_part *out, const struct tiles_of_part *own, int count,
                         const struct part_file **bad, struct arena *arena,
                         const struct relume_log *log)
{
    struct tiling t = {.own = own, .count = count, .bad = bad, .arena = arena};
    struct word_rows *words = arena_array(arena, 1, sizeof *words);
    t.place = arena_array(arena, (size_t)count, sizeof *t.place);
    if (!t.place || !words)
        return RELUME_ENOMEM;
    for (int i = 0; i < count; i++) {
        *bad = own[i].part;
        if (!begin(&t.place[i], &own[i]))
            return RELUME_EDAMAGED;
    }
    const int views = count_views(t.place[0].list, own->part->info.all_views);
    *bad = own->part;
    if (!views)
        return RELUME_EDAMAGED;
    t.run = arena_array(arena, (size_t)views * ((size_t)count + 2), sizeof *t.run);
    relume_status status = t.run ? add_views(&t, views) : RELUME_ENOMEM;
    if (status)
        return status;
    *words = (struct word_rows){.run = t.run, .runs = t.runs, .log = log};
    words_fill(out, words);
    out->from = NULL;
    for (int i = 0; i < out->attributes; i++) {
        struct exr_attribute *a = (struct exr_attribute *)(uintptr_t)&out->attribute[i];
        if (!strcmp(a->name, ATTR_GROUP))
            a->text = t.list;
    }
    return RELUME_OK;
}
