// block.c - skeleton climbing within a block (Poston, Wong, Heng 1998; Wong 1998, chapter 3)
//
// Lines: which dikes are crossed more than once. Slabs between two planes: bricks of one sample's
// thickness, each as long as its strip allows, then as wide as the strips beside it. Boxes: bricks
// piled up. All by masks, since what is simple in a union of lines is the union of what is not.
// Where the printed algorithm is lost or contradicts itself, boxes are simple in every line.
#include "shape/volume/block.h"

#include <string.h>

// ---------------------------------------------------------------- lines

void block_load(struct block *b, const struct signs *g, int side, const int at[3])
{
    b->side = side;
    b->levels = __builtin_ctz((unsigned)side);
    for (int c = 0; c < 3; c++) {
        const int left = g->size[c] - 1 - at[c] * side;
        b->origin[c] = at[c] * side;
        b->cells[c] = left < side ? left : side;
    }
    const int w = b->origin[0] >> 6, shift = b->origin[0] & 63;
    const uint32_t own = ((uint32_t)2 << b->cells[0]) - 1;
    for (int z = 0; z <= b->cells[2]; z++)
        for (int y = 0; y <= b->cells[1]; y++) {
            const uint64_t *row = signs_row(g, b->origin[1] + y, b->origin[2] + z);
            uint64_t bits = row[w] >> shift;
            if (shift + side == 64 && w + 1 < g->words)
                bits |= row[w + 1] << side;
            b->row[z * BLOCK_POINTS + y] = (uint32_t)bits & own;
        }
}

// Dikes of a line along x: of two halves, each crossed at most once, one may be crossed.
static void climb_x(struct block *b, int z, int y)
{
    static const uint32_t begins[BLOCK_LEVELS] = {0xffff, 0x5555, 0x1111, 0x0101, 0x0001};
    const uint32_t bits = b->row[z * BLOCK_POINTS + y], own = ((uint32_t)1 << b->cells[0]) - 1;
    uint32_t once = (bits ^ bits >> 1) & own, twice = 0;
    b->along_x[0][z][y] = 0;
    for (int l = 1; l <= b->levels; l++) {
        const int half = 1 << (l - 1), ends = b->cells[0] - 2 * half;
        const uint32_t fits = ends >= 0 ? ((uint32_t)2 << ends) - 1 : 0;
        twice |= twice >> half | (once & once >> half);
        once |= once >> half;
        twice &= begins[l];
        once &= begins[l];
        b->along_x[l][z][y] = twice | ~fits;
    }
}

// Dikes of all lines of a plane along y or z; `crossed` are those of level 0, one mask for each
// place where they begin, of which there are `cells`.
static void climb_plane(uint32_t *dike[BLOCK_LEVELS], uint32_t once[BLOCK_SIDE], int cells,
                        int levels)
{
    uint32_t twice[BLOCK_SIDE] = {0};
    memset(dike[0], 0, BLOCK_SIDE * sizeof *dike[0]);
    for (int l = 1; l <= levels; l++) {
        const int half = 1 << (l - 1);
        for (int p = 0; p < 1 << levels; p += 2 * half) {
            const int q = p + half;
            twice[p] |= twice[q] | (once[p] & once[q]);
            once[p] |= once[q];
            dike[l][p] = p + 2 * half <= cells ? twice[p] : ~(uint32_t)0;
        }
    }
}

static void climb_y(struct block *b, int z)
{
    uint32_t once[BLOCK_SIDE] = {0}, *dike[BLOCK_LEVELS];
    for (int y = 0; y < b->cells[1]; y++)
        once[y] = b->row[z * BLOCK_POINTS + y] ^ b->row[z * BLOCK_POINTS + y + 1];
    for (int l = 0; l < BLOCK_LEVELS; l++)
        dike[l] = b->along_y[l][z];
    climb_plane(dike, once, b->cells[1], b->levels);
}

static void climb_z(struct block *b, int y)
{
    uint32_t once[BLOCK_SIDE] = {0}, *dike[BLOCK_LEVELS];
    for (int z = 0; z < b->cells[2]; z++)
        once[z] = b->row[z * BLOCK_POINTS + y] ^ b->row[(z + 1) * BLOCK_POINTS + y];
    for (int l = 0; l < BLOCK_LEVELS; l++)
        dike[l] = b->along_z[l][y];
    climb_plane(dike, once, b->cells[2], b->levels);
}

static bool is_simple(const struct block *b)
{
    uint32_t broken = 0;
    for (int i = 0; i <= b->side; i++) {
        broken |= b->along_y[b->levels][i][0] | b->along_z[b->levels][i][0];
        for (int k = 0; k <= b->side; k++)
            broken |= b->along_x[b->levels][i][k] & 1;
    }
    return !broken;
}

static bool is_whole(const struct block *b)
{
    return b->cells[0] == b->side && b->cells[1] == b->side && b->cells[2] == b->side;
}

// ---------------------------------------------------------------- boxes among boxes

static bool holds(const uint8_t outer[3], const uint8_t inner[3])
{
    return outer[0] >= inner[0] && outer[1] >= inner[1] && outer[2] >= inner[2];
}

enum { FREE, COVERED, SPLIT };

// Whether nobody has any of the 2^level cells from there on; copies of known sizes are loads.
static bool is_free_row(const box_owner *owner, int level)
{
    uint64_t cells[2] = {0};
    switch (level) {
    case 0: return !*owner;
    case 1: memcpy(cells, owner, 2); break;
    case 2: memcpy(cells, owner, 4); break;
    case 3: memcpy(cells, owner, 8); break;
    default: memcpy(cells, owner, 16); break;
    }
    return !(cells[0] | cells[1]);
}

static bool is_free(const box_owner *owner, int side, const struct box *r)
{
    for (int z = r->at[2]; z < r->at[2] + (1 << r->level[2]); z++)
        for (int y = r->at[1]; y < r->at[1] + (1 << r->level[1]); y++)
            if (!is_free_row(owner + ((size_t)z * (size_t)side + (size_t)y) * (size_t)side +
                                 r->at[0],
                             r->level[0]))
                return false;
    return true;
}

// What of the cells of `r` is taken: all by one box, or so that `r` must be split along `*axis`.
static int look_at(const box_owner *owner, int side, const struct box *r, int *axis)
{
    for (int z = r->at[2]; z < r->at[2] + (1 << r->level[2]); z++)
        for (int y = r->at[1]; y < r->at[1] + (1 << r->level[1]); y++)
            for (int x = r->at[0]; x < r->at[0] + (1 << r->level[0]); x++) {
                const box_owner own =
                    owner[((size_t)z * (size_t)side + (size_t)y) * (size_t)side + (size_t)x];
                uint8_t level[3];
                if (!own)
                    continue;
                owner_levels(level, own);
                if (holds(level, r->level))
                    return COVERED;
                if (holds(r->level, level))
                    continue;
                *axis = r->level[0] > level[0] ? 0 : r->level[1] > level[1] ? 1 : 2;
                return SPLIT;
            }
    return FREE;
}

static void paint_row(box_owner *owner, int level, box_owner own)
{
    switch (level) {
    case 0: *owner = own; break;
    case 1: memset(owner, own, 2); break;
    case 2: memset(owner, own, 4); break;
    case 3: memset(owner, own, 8); break;
    default: memset(owner, own, 16); break;
    }
}

static void paint(box_owner *owner, int side, const struct box *r)
{
    const box_owner own = owner_of(r->level);
    for (int z = r->at[2]; z < r->at[2] + (1 << r->level[2]); z++)
        for (int y = r->at[1]; y < r->at[1] + (1 << r->level[1]); y++)
            paint_row(block_owner(owner, side, r->at[0], y, z), r->level[0], own);
}

// Older boxes stay, unless they lie within the new one; what they leave of it becomes dikes again.
static void place_box(box_owner *owner, int side, struct box r)
{
    struct box stack[3 * BLOCK_LEVELS + 2];
    int count = 1, axis = 0;
    if (is_free(owner, side, &r)) {
        paint(owner, side, &r);
        return;
    }
    stack[0] = r;
    while (count) {
        r = stack[--count];
        const int found = look_at(owner, side, &r, &axis);
        if (found == FREE)
            paint(owner, side, &r);
        if (found != SPLIT)
            continue;
        r.level[axis]--;
        stack[count++] = r;
        r.at[axis] = (uint8_t)(r.at[axis] + (1 << r.level[axis]));
        stack[count++] = r;
    }
}

static int dike_level(int begin, int levels)
{
    const int aligned = begin ? __builtin_ctz((unsigned)begin) : levels;
    return aligned < levels ? aligned : levels;
}

// ---------------------------------------------------------------- bricks

// The slab between two planes: masks of dikes that are not simple in both.
struct slab {
    uint32_t x[BLOCK_LEVELS][BLOCK_SIDE];  // [level][strip], bit: where it begins
    uint32_t y[BLOCK_LEVELS][BLOCK_SIDE];  // [level][begin], bit: the column
};

static void make_slab(struct slab *s, const struct block *b, int z)
{
    for (int l = 0; l <= b->levels; l++)
        for (int i = 0; i < b->cells[1]; i++) {
            const uint32_t *low = b->along_x[l][z], *high = b->along_x[l][z + 1];
            const uint32_t line = b->along_y[l][z][i] | b->along_y[l][z + 1][i];
            s->x[l][i] = low[i] | low[i + 1] | high[i] | high[i + 1];
            s->y[l][i] = line | line >> 1;
        }
}

static int longest_x(const struct slab *s, int strip, int begin, int levels)
{
    int l = dike_level(begin, levels);
    while (s->x[l][strip] >> begin & 1)
        l--;
    return l;
}

static void make_bricks(box_owner *brick, const struct block *b, int z)
{
    struct slab s;
    make_slab(&s, b, z);
    for (int j = 0; j < b->cells[1]; j++)
        for (int p = 0, l; p < b->cells[0]; p += 1 << l) {
            int top = j + 1;
            l = longest_x(&s, j, p, b->levels);
            while (top < b->cells[1] && !(s.x[l][top] >> p & 1))
                top++;
            const uint32_t columns = (((uint32_t)1 << (1 << l)) - 1) << p;
            for (int q = j, k; q < top; q += 1 << k) {
                k = dike_level(q, b->levels);
                while (q + (1 << k) > top || s.y[k][q] & columns)
                    k--;
                place_box(brick, b->side,
                          (struct box){{(uint8_t)p, (uint8_t)q, 0}, {(uint8_t)l, (uint8_t)k, 0}});
            }
        }
}

// ---------------------------------------------------------------- boxes

static bool is_straight(const struct block *b, const struct box *r, int begin, int level)
{
    const uint32_t lines = (((uint32_t)2 << (1 << r->level[0])) - 1) << r->at[0];
    for (int y = r->at[1]; y <= r->at[1] + (1 << r->level[1]); y++)
        if (b->along_z[level][y][begin] & lines)
            return false;
    return true;
}

// A brick of the slab `z` and what stands on it, of at least its size in each slab above.
static void pile_up(struct block *b, const box_owner *bricks, struct box r, int z)
{
    const size_t slab = (size_t)b->side * (size_t)b->side;
    const size_t at = (size_t)r.at[1] * (size_t)b->side + r.at[0];
    uint8_t level[3];
    int top = z + 1;
    for (; top < b->cells[2]; top++) {
        owner_levels(level, bricks[(size_t)top * slab + at]);
        if (level[0] < r.level[0] || level[1] < r.level[1])
            break;
    }
    for (int q = z, l; q < top; q += 1 << l) {
        l = dike_level(q, b->levels);
        while (q + (1 << l) > top || !is_straight(b, &r, q, l))
            l--;
        r.at[2] = (uint8_t)q;
        r.level[2] = (uint8_t)l;
        place_box(b->owner, b->side, r);
    }
}

static void climb_boxes(struct block *b)
{
    box_owner bricks[BLOCK_SIDE * BLOCK_SIDE * BLOCK_SIDE];
    const size_t slab = (size_t)b->side * (size_t)b->side;
    memset(bricks, 0, slab * (size_t)b->side);
    memset(b->owner, 0, slab * (size_t)b->side);
    for (int z = 0; z < b->cells[2]; z++)
        make_bricks(bricks + (size_t)z * slab, b, z);
    for (int z = 0; z < b->cells[2]; z++)
        for (int y = 0; y < b->cells[1]; y++)
            for (int x = 0; x < b->cells[0]; x++) {
                struct box r = {{(uint8_t)x, (uint8_t)y, 0}, {0}};
                owner_levels(r.level,
                             bricks[(size_t)z * slab + (size_t)y * (size_t)b->side + (size_t)x]);
                if (!(x & ((1 << r.level[0]) - 1)) && !(y & ((1 << r.level[1]) - 1)))
                    pile_up(b, bricks, r, z);
            }
}

bool block_climb(struct block *b)
{
    for (int z = 0; z <= b->cells[2]; z++) {
        for (int y = 0; y <= b->cells[1]; y++)
            climb_x(b, z, y);
        climb_y(b, z);
    }
    for (int y = 0; y <= b->cells[1]; y++)
        climb_z(b, y);
    if (is_whole(b) && is_simple(b)) {
        const uint8_t level = (uint8_t)b->levels, all[3] = {level, level, level};
        memset(b->owner, owner_of(all), (size_t)b->side * (size_t)b->side * (size_t)b->side);
        return true;
    }
    climb_boxes(b);
    return false;
}
