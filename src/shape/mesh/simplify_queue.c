// simplify_queue.c - points in the order of what it costs to do without them
#include "shape/mesh/simplify.h"

#include <string.h>

relume_status queue_create(struct queue *q, uint32_t points)
{
    *q = (struct queue){
        .heap = mem_array(points, sizeof *q->heap),
        .at = mem_array(points, sizeof *q->at),
        .key = mem_zeroed(points, sizeof *q->key),
    };
    if (!q->heap || !q->at || !q->key)
        return RELUME_ENOMEM;
    memset(q->at, 0xff, points * sizeof *q->at);
    return RELUME_OK;
}

void queue_free(struct queue *q)
{
    mem_free(q->heap);
    mem_free(q->at);
    mem_free(q->key);
    *q = (struct queue){0};
}

// Equal keys in the order of the points, so that nothing depends on history.
static bool is_before(const struct queue *q, uint32_t a, uint32_t b)
{
    const float first = q->key[a], second = q->key[b];
    return first < second || (first == second && a < b);
}

static void set(struct queue *q, uint32_t i, uint32_t point)
{
    q->heap[i] = point;
    q->at[point] = i;
}

static void up(struct queue *q, uint32_t i)
{
    const uint32_t point = q->heap[i];
    for (; i && is_before(q, point, q->heap[(i - 1) / 2]); i = (i - 1) / 2)
        set(q, i, q->heap[(i - 1) / 2]);
    set(q, i, point);
}

static void down(struct queue *q, uint32_t i)
{
    const uint32_t point = q->heap[i];
    for (uint32_t child; (child = 2 * i + 1) < q->count; i = child) {
        if (child + 1 < q->count && is_before(q, q->heap[child + 1], q->heap[child]))
            child++;
        if (!is_before(q, q->heap[child], point))
            break;
        set(q, i, q->heap[child]);
    }
    set(q, i, point);
}

void queue_put(struct queue *q, uint32_t point, double key)
{
    q->key[point] = (float)key;
    if (q->at[point] == NOTHING) {
        set(q, q->count, point);
        up(q, q->count++);
        return;
    }
    up(q, q->at[point]);
    down(q, q->at[point]);
}

uint32_t queue_take(struct queue *q)
{
    const uint32_t point = q->heap[0];
    q->at[point] = NOTHING;
    if (--q->count) {
        set(q, 0, q->heap[q->count]);
        down(q, 0);
    }
    return point;
}
