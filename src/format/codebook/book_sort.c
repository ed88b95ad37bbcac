// book_sort.c - an order in which neighbouring codes are alike
//
// Vectors are halved along their principal axis, the halves again, until one is left: the leaves of
// that tree from left to right. Each half is turned so that its near end touches its neighbour.
#include "format/codebook/books.h"

#include "core/base/memory.h"

#include <math.h>
#include <string.h>

enum { POWER_STEPS = 8 };

struct item {
    double along;
    int code;
};

struct sorting {
    const float *vectors;
    size_t dim;
    struct item *items;
    double *mean, *axis, *next;
};

static int by_place(const void *a, const void *b)
{
    const struct item *x = a, *y = b;
    return x->along != y->along ? (x->along > y->along) - (x->along < y->along)
                                : (x->code > y->code) - (x->code < y->code);
}

static void find_mean(struct sorting *s, int first, int last)
{
    memset(s->mean, 0, s->dim * sizeof *s->mean);
    for (int i = first; i < last; i++)
        for (size_t k = 0; k < s->dim; k++)
            s->mean[k] +=
                (double)s->vectors[(size_t)s->items[i].code * s->dim + k] / (last - first);
}

static double project(const struct sorting *s, int code)
{
    const float *v = s->vectors + (size_t)code * s->dim;
    double sum = 0.0;
    for (size_t k = 0; k < s->dim; k++)
        sum += ((double)v[k] - s->mean[k]) * s->axis[k];
    return sum;
}

static void normalise(double *v, size_t n)
{
    double length = 0.0;
    for (size_t k = 0; k < n; k++)
        length += v[k] * v[k];
    for (size_t k = 0; k < n && length > 0.0; k++)
        v[k] /= sqrt(length);
}

// By the power method, from the axis of the whole that this is a part of.
static void find_axis(struct sorting *s, int first, int last)
{
    for (int step = 0; step < POWER_STEPS; step++) {
        memset(s->next, 0, s->dim * sizeof *s->next);
        for (int i = first; i < last; i++) {
            const float *v = s->vectors + (size_t)s->items[i].code * s->dim;
            const double along = project(s, s->items[i].code);
            for (size_t k = 0; k < s->dim; k++)
                s->next[k] += ((double)v[k] - s->mean[k]) * along;
        }
        double length = 0.0;
        for (size_t k = 0; k < s->dim; k++)
            length += s->next[k] * s->next[k];
        if (!(length > 0.0))
            return;
        memcpy(s->axis, s->next, s->dim * sizeof *s->axis);
        normalise(s->axis, s->dim);
    }
}

static void begin_axis(struct sorting *s, int first, int last)
{
    int far = first;
    double most = -1.0;
    for (int i = first; i < last; i++) {
        double d = 0.0;
        for (size_t k = 0; k < s->dim; k++) {
            const double v = (double)s->vectors[(size_t)s->items[i].code * s->dim + k] - s->mean[k];
            d += v * v;
        }
        if (d > most) {
            most = d;
            far = i;
        }
    }
    for (size_t k = 0; k < s->dim; k++)
        s->axis[k] = (double)s->vectors[(size_t)s->items[far].code * s->dim + k] - s->mean[k];
    normalise(s->axis, s->dim);
}

// `towards`: the code that stands before, so that the part begins at the end near it; -1: none.
static void sort_part(struct sorting *s, int first, int last, int towards)
{
    if (last - first < 2)
        return;
    find_mean(s, first, last);
    begin_axis(s, first, last);
    find_axis(s, first, last);
    const double turn = towards >= 0 && project(s, towards) > 0.0 ? -1.0 : 1.0;
    for (int i = first; i < last; i++)
        s->items[i].along = turn * project(s, s->items[i].code);
    qsort(s->items + first, (size_t)(last - first), sizeof *s->items, by_place);
    const int middle = first + (last - first) / 2;
    sort_part(s, first, middle, towards);
    sort_part(s, middle, last, s->items[middle - 1].code);
}

relume_status book_sort(float *vectors, int codes, int dim)
{
    const size_t n = (size_t)dim, size = (size_t)codes * n;
    float *copy = mem_copy(vectors, size, sizeof *vectors);
    double *work = mem_array(3 * n, sizeof *work);
    struct item *items = mem_array((size_t)codes, sizeof *items);
    if (copy && work && items) {
        struct sorting s = {copy, n, items, work, work + n, work + 2 * n};
        for (int c = 0; c < codes; c++)
            items[c].code = c;
        sort_part(&s, 0, codes, -1);
        for (int c = 0; c < codes; c++)
            memcpy(vectors + (size_t)c * n, copy + (size_t)items[c].code * n, n * sizeof *vectors);
    }
    const bool good = copy && work && items;
    mem_free(copy);
    mem_free(work);
    mem_free(items);
    return good ? RELUME_OK : RELUME_ENOMEM;
}
