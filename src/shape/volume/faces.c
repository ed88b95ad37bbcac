// faces.c - the lines of a surface on the faces of boxes, shared by neighbours, and their loops
//
// Where boxes meet, each piece of the face that belongs to one box on either side is a rectangle of
// its own: of dikes, since these are nested, and simple. Both boxes draw the same lines on it, and
// every vertex on a box has one line that comes and one that goes: no cracks.
#include "shape/volume/faces.h"

#include "shape/volume/segments.h"

#include <string.h>

// Samples of a block are numbered as the bits of its rows, nodes by axes and their lower sample.
static const int step_of[3] = {1, FACE_ROW, FACE_ROW *BLOCK_POINTS};

void faces_begin(struct faces *f, const struct signs *g, bool share)
{
    f->g = g;
    f->share = share;
    f->touched = 0;
    f->ambiguous = 0;
    memset(f->next, -1, sizeof f->next);
    memset(f->sides, 0, sizeof f->sides);
}

void faces_begin_block(struct faces *f, const struct block *b, const struct neighbours *beyond)
{
    f->block = b;
    f->beyond = beyond;
    memset(f->placed, 0, sizeof f->placed);
}

static int sample_at(const int p[3])
{
    return p[0] + step_of[1] * p[1] + step_of[2] * p[2];
}

static bool is_inside(const struct block *b, int sample)
{
    return b->row[sample / FACE_ROW] >> sample % FACE_ROW & 1;
}

static void sample_place(const struct faces *f, int sample, int p[3])
{
    p[0] = f->block->origin[0] + sample % FACE_ROW;
    p[1] = f->block->origin[1] + sample / FACE_ROW % BLOCK_POINTS;
    p[2] = f->block->origin[2] + sample / FACE_ROW / BLOCK_POINTS;
}

static uint64_t key_of(const struct faces *f, int16_t node)
{
    int p[3];
    sample_place(f, node % FACE_SAMPLES, p);
    const uint64_t row = (uint64_t)p[2] * (uint64_t)f->g->size[1] + (uint64_t)p[1];
    return (3 * row + (uint64_t)(node / FACE_SAMPLES)) << 16 | (uint64_t)p[0];
}

// Boxes of a block share most vertices.
static const struct place *place_of(struct faces *f, int16_t node)
{
    uint64_t *word = &f->placed[node / 64];
    const uint64_t bit = (uint64_t)1 << node % 64;
    if (!(*word & bit)) {
        int p[3];
        sample_place(f, node % FACE_SAMPLES, p);
        f->place[node] = signs_place(f->g, node / FACE_SAMPLES, p[0], p[1], p[2]);
        *word |= bit;
    }
    return &f->place[node];
}

// A rectangle of a face across `axis`.
struct tile {
    int axis, end;  // which face
    int sample;     // its lower corner
    int length[2];  // along u and v
    int reach[2];   // the same, in samples of the block
};

// The edge of a side that is crossed, which is one.
static int16_t crossing(const struct block *b, const struct tile *t, enum side side)
{
    const int u = (t->axis + 1) % 3, v = (t->axis + 2) % 3;
    const int axis = side == SIDE_B || side == SIDE_T ? u : v, step = step_of[axis];
    int sample = t->sample;
    if (side == SIDE_T)
        sample += t->reach[1];
    if (side == SIDE_R)
        sample += t->reach[0];
    const bool first = is_inside(b, sample);
    for (int length = t->length[axis == v]; length > 1;) {
        const int half = length / 2;
        if (is_inside(b, sample + half * step) == first) {
            sample += half * step;
            length -= half;
        } else {
            length = half;
        }
    }
    return (int16_t)(axis * FACE_SAMPLES + sample);
}

// By the mean of the samples nearest to it: one, two or four.
static bool middle_inside(const struct faces *f, const struct tile *t)
{
    const relume_volume *volume = f->g->volume;
    const int u = (t->axis + 1) % 3, v = (t->axis + 2) % 3;
    float sum = 0.0f;
    for (int i = 0; i < 4; i++) {
        int p[3];
        sample_place(f, t->sample, p);
        p[u] += (t->length[0] + (i & 1)) / 2;
        p[v] += (t->length[1] + (i >> 1)) / 2;
        sum += volume_sample(volume, volume_at(volume, p[0], p[1], p[2]));
    }
    return 0.25f * sum >= f->g->threshold;
}

static bool is_first_plane(const struct faces *f, const struct tile *t)
{
    int p[3];
    sample_place(f, t->sample, p);
    return p[t->axis] == 0;
}

// Every node has a line that comes and one that goes.
static void touch(struct faces *f, int16_t node, uint8_t side)
{
    if (!f->sides[node])
        f->node[f->touched++] = node;
    f->sides[node] |= side;
}

static void draw_tile(struct faces *f, const struct tile *t)
{
    const struct block *b = f->block;
    const int corners = is_inside(b, t->sample) | is_inside(b, t->sample + t->reach[0]) << 1 |
                        is_inside(b, t->sample + t->reach[0] + t->reach[1]) << 2 |
                        is_inside(b, t->sample + t->reach[1]) << 3;
    if (corners == 0 || corners == 15)
        return;
    const bool open = segments_open(corners);
    const struct segments s = segments_of(corners, open && middle_inside(f, t));
    const uint8_t face = (uint8_t)(1 << (2 * t->axis + t->end));
    f->ambiguous += open && (t->end || is_first_plane(f, t));
    for (int i = 0; i < s.count; i++) {
        const int16_t from = crossing(b, t, s.from[i]), to = crossing(b, t, s.to[i]);
        touch(f, from, face);
        touch(f, to, face);
        f->next[t->end ? to : from] = t->end ? from : to;
    }
}

// The corners of a box that are inside, as bits x + 2 y + 4 z.
static int corners_of(const struct block *b, const struct box *box)
{
    const int sample = box->at[0] + step_of[1] * box->at[1] + step_of[2] * box->at[2];
    int corners = 0;
    for (int i = 0; i < 8; i++)
        corners |= is_inside(b, sample + ((i & 1) << box->level[0]) +
                                    ((i >> 1 & 1) * step_of[1] << box->level[1]) +
                                    ((i >> 2) * step_of[2] << box->level[2]))
                   << i;
    return corners;
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

static void set_length(struct tile *t, int c, int level)
{
    t->length[c] = 1 << level;
    t->reach[c] = step_of[(t->axis + 1 + c) % 3] << level;
}

static void draw_face(struct faces *f, const struct box *box, int axis, int end)
{
    const struct block *b = f->block;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    struct tile t = {.axis = axis, .end = end};
    int cell[3], at[3] = {box->at[0], box->at[1], box->at[2]};
    at[axis] += end ? 1 << box->level[axis] : 0;
    const box_owner *owner = beyond_face(f, axis, end, at[axis], &cell[axis]);
    if (!owner || !f->share || !(box->level[u] | box->level[v])) {
        t.sample = sample_at(at);
        set_length(&t, 0, box->level[u]);
        set_length(&t, 1, box->level[v]);
        draw_tile(f, &t);
        return;
    }
    for (int j = box->at[v]; j < box->at[v] + (1 << box->level[v]); j++)
        for (int i = box->at[u]; i < box->at[u] + (1 << box->level[u]); i += t.length[0]) {
            uint8_t level[3];
            cell[u] = at[u] = i;
            cell[v] = at[v] = j;
            owner_levels(
                level,
                owner[((size_t)cell[2] * (size_t)b->side + (size_t)cell[1]) * (size_t)b->side +
                      (size_t)cell[0]]);
            set_length(&t, 0, level[u] < box->level[u] ? level[u] : box->level[u]);
            set_length(&t, 1, level[v] < box->level[v] ? level[v] : box->level[v]);
            t.sample = sample_at(at);
            if (!(j & (t.length[1] - 1)))
                draw_tile(f, &t);
        }
}

// Faces whose corners are alike are crossed nowhere, since no line is crossed twice.
void faces_draw(struct faces *f, const struct box *box)
{
    static const uint8_t corners_on[6] = {0x55, 0xaa, 0x33, 0xcc, 0x0f, 0xf0};
    const int corners = corners_of(f->block, box);
    f->touched = 0;
    if (corners == 0 || corners == 0xff)
        return;
    for (int face = 0; face < 6; face++) {
        const int own = corners & corners_on[face];
        if (own && own != corners_on[face])
            draw_face(f, box, face / 2, face % 2);
    }
}

bool faces_loop(struct faces *f)
{
    struct loop *l = &f->loop;
    int16_t node[LOOP_MOST];
    while (f->touched && f->next[f->node[f->touched - 1]] < 0)
        f->touched--;
    l->count = 0;
    if (!f->touched)
        return false;
    for (int16_t at = f->node[f->touched - 1]; f->next[at] >= 0;) {
        const int16_t to = f->next[at];
        node[l->count] = at;
        l->key[l->count] = key_of(f, at);
        l->faces[l->count] = f->sides[at];
        l->count++;
        f->next[at] = -1;
        f->sides[at] = 0;
        at = to;
    }
    for (int i = 0; i < l->count && l->count > 3; i++)
        l->place[i] = place_of(f, node[i]);
    return true;
}
