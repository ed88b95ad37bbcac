// near.c - the nearest points by a balanced k-d tree (Bentley 1975) that is an order of the points:
// the middle of each stretch is its root, what is left of it is below its axis
#include "shape/distance/near.h"

#include "core/base/memory.h"

#include <math.h>

enum { MOST_NEAR = 256 };

struct tree {
    const vec3 *point;
    uint32_t *order;
    uint8_t *axis;  // that the root at this place of the order parts by
};

static double along(vec3 p, int axis)
{
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

static int widest(const struct tree *t, size_t from, size_t to)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    int axis = 0;
    for (size_t i = from; i < to; i++)
        for (int c = 0; c < 3; c++) {
            low[c] = fmin(low[c], along(t->point[t->order[i]], c));
            high[c] = fmax(high[c], along(t->point[t->order[i]], c));
        }
    for (int c = 1; c < 3; c++)
        if (high[c] - low[c] > high[axis] - low[axis])
            axis = c;
    return axis;
}

// Hoare's selection; what is equal is parted evenly.
static void part(const struct tree *t, size_t from, size_t to, size_t middle, int axis)
{
    uint32_t *o = t->order;
    while (to - from > 1) {
        const double pivot = along(t->point[o[from + (to - from) / 2]], axis);
        ptrdiff_t i = (ptrdiff_t)from, j = (ptrdiff_t)to - 1;
        while (i <= j) {
            while (along(t->point[o[i]], axis) < pivot)
                i++;
            while (along(t->point[o[j]], axis) > pivot)
                j--;
            if (i <= j) {
                const uint32_t swap = o[i];
                o[i++] = o[j];
                o[j--] = swap;
            }
        }
        if ((ptrdiff_t)middle <= j)
            to = (size_t)j + 1;
        else if ((ptrdiff_t)middle >= i)
            from = (size_t)i;
        else
            return;
    }
}

static void grow(struct tree *t, size_t from, size_t to)
{
    if (to - from < 2)
        return;
    const size_t middle = from + (to - from) / 2;
    const int axis = widest(t, from, to);
    part(t, from, to, middle, axis);
    t->axis[middle] = (uint8_t)axis;
    grow(t, from, middle);
    grow(t, middle + 1, to);
}

// The nearest so far, a heap with the farthest on top.
struct found {
    uint32_t item[MOST_NEAR];
    double square[MOST_NEAR];
    int count, most;
    size_t self;
};

static void swap_items(struct found *f, int a, int b)
{
    const uint32_t item = f->item[a];
    const double square = f->square[a];
    f->item[a] = f->item[b], f->square[a] = f->square[b];
    f->item[b] = item, f->square[b] = square;
}

static void sink(struct found *f)
{
    for (int i = 0, child; (child = 2 * i + 1) < f->count; i = child) {
        child += child + 1 < f->count && f->square[child + 1] > f->square[child];
        if (f->square[child] <= f->square[i])
            return;
        swap_items(f, i, child);
    }
}

static void offer(struct found *f, uint32_t item, double square)
{
    if (f->count < f->most) {
        int i = f->count++;
        f->item[i] = item, f->square[i] = square;
        for (; i && f->square[i] > f->square[(i - 1) / 2]; i = (i - 1) / 2)
            swap_items(f, i, (i - 1) / 2);
    } else if (square < f->square[0]) {
        f->item[0] = item, f->square[0] = square;
        sink(f);
    }
}

static void search(struct found *f, const struct tree *t, size_t from, size_t to)
{
    if (from >= to)
        return;
    const size_t middle = from + (to - from) / 2;
    const uint32_t item = t->order[middle];
    const vec3 at = t->point[f->self], d = vec3_sub(t->point[item], at);
    if (item != f->self)
        offer(f, item, vec3_dot(d, d));
    const double off = along(d, t->axis[middle]);
    const bool below = off > 0.0;
    search(f, t, below ? from : middle + 1, below ? middle : to);
    if (f->count < f->most || off * off <= f->square[0])
        search(f, t, below ? middle + 1 : from, below ? to : middle);
}

relume_status near_find(uint32_t *out, const vec3 *point, size_t count, int n)
{
    struct tree t = {point, mem_array(count, sizeof *t.order), mem_zeroed(count, sizeof *t.axis)};
    const bool good = t.order && t.axis;
    for (size_t i = 0; good && i < count; i++)
        t.order[i] = (uint32_t)i;
    if (good)
        grow(&t, 0, count);
    for (size_t i = 0; good && i < count; i++) {
        struct found f = {.most = n < MOST_NEAR ? n : MOST_NEAR, .self = i};
        search(&f, &t, 0, count);
        for (int k = 0; k < n; k++)
            out[i * (size_t)n + (size_t)k] = k < f.count ? f.item[k] : (uint32_t)count;
    }
    mem_free(t.order);
    mem_free(t.axis);
    return good ? RELUME_OK : RELUME_ENOMEM;
}
