// coded_tiles.c - tiles of groups that a member of a team has coded and judged
#include "encode/parts/coded_tiles.h"

#include "core/base/memory.h"

relume_status coded_tiles_create(struct coded_tiles *out, const struct view_groups *groups,
                                 const int *number, const struct group_share *tiles, int count)
{
    *out = (struct coded_tiles){.group = mem_zeroed((size_t)count, sizeof *out->group)};
    bool good = out->group != NULL;
    out->groups = good ? count : 0;
    for (int i = 0; good && i < count; i++) {
        struct group_tiles *t = &out->group[i];
        const int begin = groups->begin[number[i]];
        t->view = groups->view + begin;
        t->views = groups->begin[number[i] + 1] - begin;
        t->tiles = tiles[i];
        t->sequence = mem_zeroed(tiles_in(t) * (size_t)t->views + 1, sizeof *t->sequence);
        t->square = mem_zeroed(tiles_in(t) * (size_t)t->views + 1, sizeof *t->square);
        good = t->sequence && t->square;
    }
    return good ? RELUME_OK : RELUME_ENOMEM;
}

void coded_tiles_destroy(struct coded_tiles *c)
{
    for (int i = 0; i < c->groups; i++) {
        struct group_tiles *t = &c->group[i];
        for (size_t k = 0; !c->fetched && t->sequence && k < tiles_in(t) * (size_t)t->views; k++)
            mem_free(t->sequence[k].byte);
        mem_free(t->sequence);
        mem_free(t->square);
    }
    mem_free(c->group);
    *c = (struct coded_tiles){.groups = 0};
}

// ---------------------------------------------------------------- as a piece

// Precedes the bytes of a tile of a view.
struct tile_head {
    struct encode_square square;
    uint64_t bytes;
};

static void put_tiles(struct piece_writer *to, const struct group_tiles *t)
{
    const size_t views = (size_t)t->views;
    for (size_t i = 0; i < tiles_in(t) * views; i++) {
        const struct av1_bytes *b = &t->sequence[i];
        const struct tile_head head = {t->square[i % views * tiles_in(t) + i / views], b->size};
        piece_put(to, &head, sizeof head);
        piece_put(to, b->byte, b->size);
    }
}

static bool get_tiles(struct piece_reader *from, struct group_tiles *t)
{
    const size_t views = (size_t)t->views;
    for (size_t i = 0; i < tiles_in(t) * views; i++) {
        struct tile_head head;
        if (!piece_get(from, &head, sizeof head) || !head.bytes ||
            !(head.square.sum >= 0.0 && head.square.sum < 0x1p60))
            return false;
        t->square[i % views * tiles_in(t) + i / views] = head.square;
        t->sequence[i].byte = piece_view(from, (size_t)head.bytes);
        t->sequence[i].size = (size_t)head.bytes;
    }
    return !from->damaged;
}

// A letter first, so that a piece is never empty.
static void hand_in(const void *results, struct piece_writer *to)
{
    const struct coded_tiles *c = results;
    piece_put(to, "w", 1);
    for (int i = 0; i < c->groups; i++)
        put_tiles(to, &c->group[i]);
}

static relume_status fetch(void *results, struct piece_reader *from)
{
    struct coded_tiles *c = results;
    bool good = piece_view(from, 1) != NULL;
    c->fetched = true;
    for (int i = 0; good && i < c->groups; i++)
        good = get_tiles(from, &c->group[i]);
    return good ? RELUME_OK : RELUME_EDAMAGED;
}

const struct team_bytes coded_tiles_bytes = {hand_in, fetch};
