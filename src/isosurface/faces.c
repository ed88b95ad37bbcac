// faces.c - the lines of a surface on the faces of boxes, shared by neighbours, and their loops
//
// Where boxes meet, each piece of the face that belongs to one box on either side is a rectangle of
// its own: of dikes, since these are nested, and simple. Both boxes draw the same lines on it, and
// every vertex on a box has one line that comes and one that goes: no cracks.
#include "isosurface/faces.h"

#include "isosurface/segments.h"

#include <string.h>

void faces_begin(struct faces *f, const struct signs *g, bool share)
{
    f->g = g;
    f->share = share;
    f->touched = 0;
    f->ambiguous = 0;
    memset(f->next, -1, sizeof f->next);
}

static int16_t node_at(int axis, const int p[3])
{
    return (int16_t)(((axis * BLOCK_POINTS + p[2]) * BLOCK_POINTS + p[1]) * BLOCK_POINTS + p[0]);
}

static uint64_t key_of(const struct faces *f, int16_t node, int *axis, int p[3])
{
    const int *origin = f->block->origin;
    int left = node;
    for (int c = 0; c < 3; c++, left /= BLOCK_POINTS)
        p[c] = origin[c] + left % BLOCK_POINTS;
    *axis = left;
    const uint64_t row = (uint64_t)p[2] * (uint64_t)f->g->size[1] + (uint64_t)p[1];
    return (3 * row + (uint64_t)left) << 16 | (uint64_t)p[0];
}

// A rectangle of a face across `axis`.
struct tile {
    int axis, end;  // which face
    int at[3];      // its lower corner
    int length[2];  // along u and v
};

// The edge of a side that is crossed, which is one.
static int16_t crossing(const struct block *b, const struct tile *t, enum side side)
{
    const int u = (t->axis + 1) % 3, v = (t->axis + 2) % 3;
    const int axis = side == SIDE_B || side == SIDE_T ? u : v;
    int p[3] = {t->at[0], t->at[1], t->at[2]}, low, high;
    if (side == SIDE_T)
        p[v] += t->length[1];
    if (side == SIDE_R)
        p[u] += t->length[0];
    low = p[axis];
    high = low + t->length[axis == v];
    const bool first = block_inside(b, p);
    while (high - low > 1) {
        p[axis] = (low + high) / 2;
        if (block_inside(b, p) == first)
            low = p[axis];
        else
            high = p[axis];
    }
    p[axis] = low;
    return node_at(axis, p);
}

// By the mean of the samples nearest to it: one, two or four.
static bool middle_inside(const struct faces *f, const struct tile *t)
{
    const relume_volume *volume = f->g->volume;
    const int u = (t->axis + 1) % 3, v = (t->axis + 2) % 3;
    float sum = 0.0f;
    for (int i = 0; i < 4; i++) {
        int p[3];
        for (int c = 0; c < 3; c++)
            p[c] = f->block->origin[c] + t->at[c];
        p[u] += (t->length[0] + (i & 1)) / 2;
        p[v] += (t->length[1] + (i >> 1)) / 2;
        sum += volume_sample(volume, volume_at(volume, p[0], p[1], p[2]));
    }
    return 0.25f * sum >= f->g->threshold;
}

static void touch(struct faces *f, int16_t node, const struct tile *t)
{
    const uint8_t side = (uint8_t)(1 << (2 * t->axis + t->end));
    // every node has a line that goes, and is first seen at one of its two
    for (int i = f->touched - 1; i >= 0; i--)
        if (f->node[i] == node) {
            f->sides[node] |= side;
            return;
        }
    f->node[f->touched++] = node;
    f->sides[node] = side;
}

static void draw_tile(struct faces *f, const struct tile *t)
{
    const int u = (t->axis + 1) % 3, v = (t->axis + 2) % 3;
    int p[4][3], corners = 0;
    for (int i = 0; i < 4; i++) {
        memcpy(p[i], t->at, sizeof p[i]);
        p[i][u] += i == 1 || i == 2 ? t->length[0] : 0;
        p[i][v] += i >= 2 ? t->length[1] : 0;
        corners |= block_inside(f->block, p[i]) << i;
    }
    if (corners == 0 || corners == 15)
        return;
    const bool open = segments_open(corners);
    const struct segments s = segments_of(corners, open && middle_inside(f, t));
    f->ambiguous += open && (t->end || f->block->origin[t->axis] + t->at[t->axis] == 0);
    for (int i = 0; i < s.count; i++) {
        const int16_t a = crossing(f->block, t, s.from[i]), b = crossing(f->block, t, s.to[i]);
        touch(f, a, t);
        touch(f, b, t);
        f->next[t->end ? b : a] = t->end ? a : b;
    }
}

static bool is_crossed(const struct block *b, const struct box *box)
{
    int inside = 0;
    for (int i = 0; i < 8; i++) {
        const int p[3] = {box->at[0] + ((i & 1) << box->level[0]),
                          box->at[1] + ((i >> 1 & 1) << box->level[1]),
                          box->at[2] + ((i >> 2) << box->level[2])};
        inside += block_inside(b, p);
    }
    return inside > 0 && inside < 8;
}

// Who owns the cell beyond a face.
static const box_owner *beyond_face(const struct faces *f, int axis, int end, int plane, int *cell)
{
    const struct block *b = f->block;
    *cell = end ? plane : plane - 1;
    if (*cell >= 0 && *cell < b->cells[axis])
        return b->owner;
    *cell = end ? 0 : b->side - 1;
    return f->beyond->alone[2 * axis + end] ? NULL : f->beyond->owner[2 * axis + end];
}

static void draw_face(struct faces *f, const struct box *box, int axis, int end)
{
    const struct block *b = f->block;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    struct tile t = {.axis = axis, .end = end};
    int cell[3];
    t.at[axis] = box->at[axis] + (end ? 1 << box->level[axis] : 0);
    const box_owner *owner = beyond_face(f, axis, end, t.at[axis], &cell[axis]);
    if (!owner || !f->share) {
        t.at[u] = box->at[u];
        t.at[v] = box->at[v];
        t.length[0] = 1 << box->level[u];
        t.length[1] = 1 << box->level[v];
        draw_tile(f, &t);
        return;
    }
    for (int j = box->at[v]; j < box->at[v] + (1 << box->level[v]); j++)
        for (int i = box->at[u]; i < box->at[u] + (1 << box->level[u]); i += t.length[0]) {
            uint8_t level[3];
            cell[u] = i;
            cell[v] = j;
            owner_levels(
                level,
                owner[((size_t)cell[2] * (size_t)b->side + (size_t)cell[1]) * (size_t)b->side +
                      (size_t)cell[0]]);
            t.length[0] = 1 << (level[u] < box->level[u] ? level[u] : box->level[u]);
            t.length[1] = 1 << (level[v] < box->level[v] ? level[v] : box->level[v]);
            t.at[u] = i;
            t.at[v] = j;
            if (!(j & (t.length[1] - 1)))
                draw_tile(f, &t);
        }
}

void faces_draw(struct faces *f, const struct block *b, const struct neighbours *beyond,
                const struct box *box)
{
    f->block = b;
    f->beyond = beyond;
    f->touched = 0;
    if (!is_crossed(b, box))
        return;
    for (int axis = 0; axis < 3; axis++)
        for (int end = 0; end < 2; end++)
            draw_face(f, box, axis, end);
}

bool faces_loop(struct faces *f)
{
    struct loop *l = &f->loop;
    while (f->touched && f->next[f->node[f->touched - 1]] < 0)
        f->touched--;
    l->count = 0;
    if (!f->touched)
        return false;
    for (int16_t at = f->node[f->touched - 1]; f->next[at] >= 0;) {
        int axis, p[3];
        const int16_t to = f->next[at];
        f->next[at] = -1;
        l->key[l->count] = key_of(f, at, &axis, p);
        l->faces[l->count] = f->sides[at];
        l->place[l->count] = signs_place(f->g, axis, p[0], p[1], p[2]);
        l->count++;
        at = to;
    }
    return true;
}
