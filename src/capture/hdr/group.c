// group.c - which photographs of a memory card belong to one bracket
#include <relume/image/photograph.h>

#include "core/base/memory.h"

#include <math.h>
#include <string.h>

static const double default_pause_s = 10.0;
static const double same_exposure = 1.01;

struct entry {
    int index;
    int64_t taken_s;
};

static int by_time(const void *a, const void *b)
{
    const struct entry *x = a, *y = b;
    if (x->taken_s != y->taken_s)
        return x->taken_s < y->taken_s ? -1 : 1;
    return x->index < y->index ? -1 : x->index > y->index;
}

static bool have_times(const struct relume_exif *notes, int n)
{
    for (int i = 0; i < n; i++)
        if (!notes[i].taken_s)
            return false;
    return true;
}

static bool is_same_exposure(const struct relume_exif *a, const struct relume_exif *b)
{
    const double ea = relume_exif_exposure(a), eb = relume_exif_exposure(b);
    return ea > 0.0 && fmax(ea, eb) <= same_exposure * fmin(ea, eb);
}

static bool is_same_camera(const struct relume_exif *a, const struct relume_exif *b)
{
    return a->width == b->width && a->height == b->height && !strcmp(a->camera, b->camera);
}

// Whether order[i] continues the group that began at order[first].
static bool continues(const struct relume_exif *notes, const struct entry *order, int first, int i,
                      double pause_s)
{
    const struct relume_exif *now = &notes[order[i].index], *last = &notes[order[i - 1].index];
    const double gap_s = (double)(order[i].taken_s - order[i - 1].taken_s);
    if (!is_same_camera(now, last) || gap_s > pause_s + now->time_s + last->time_s)
        return false;
    for (int j = first; j < i; j++)
        if (is_same_exposure(now, &notes[order[j].index]))
            return false;
    return true;
}

int relume_exif_brackets(int *group, const struct relume_exif *notes, int n, double pause_s)
{
    struct entry *order = mem_array((size_t)n, sizeof *order);
    if (!order || n < 1) {
        mem_free(order);
        return 0;
    }
    const bool timed = have_times(notes, n);
    for (int i = 0; i < n; i++)
        order[i] = (struct entry){i, timed ? notes[i].taken_s : 0};
    qsort(order, (size_t)n, sizeof *order, by_time);
    int groups = 0, first = 0;
    for (int i = 0; i < n; i++) {
        if (i > 0 && !continues(notes, order, first, i, pause_s > 0.0 ? pause_s : default_pause_s))
            first = i;
        groups += first == i;
        group[order[i].index] = groups - 1;
    }
    mem_free(order);
    return groups;
}
