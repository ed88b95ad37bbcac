// places.c - marked pixels that touch each other are one place
#include "core/base/memory.h"
#include "core/math/scalar.h"
#include "material/change/judge.h"

#include <stdlib.h>
#include <string.h>

struct filling {
    struct relume_change *out;
    unsigned char *open;  // marked, and of no place yet
    size_t *waiting;      // pixels of the place whose neighbours are to be seen
    size_t count;
};

static bool push(struct filling *f, size_t at)
{
    if (!mem_grow(&f->waiting, f->count, sizeof *f->waiting))
        return false;
    f->open[at] = 0;
    f->waiting[f->count++] = at;
    return true;
}

static bool gather(struct filling *f, size_t first)
{
    const int width = f->out->width, height = f->out->height;
    f->count = 0;
    if (!push(f, first))
        return false;
    for (size_t k = 0; k < f->count; k++) {
        const int x = (int)(f->waiting[k] % (size_t)width),
                  y = (int)(f->waiting[k] / (size_t)width);
        for (int j = larger_of(y - 1, 0); j <= smaller_of(y + 1, height - 1); j++)
            for (int i = larger_of(x - 1, 0); i <= smaller_of(x + 1, width - 1); i++) {
                const size_t at = (size_t)j * (size_t)width + (size_t)i;
                if (f->open[at] && !push(f, at))
                    return false;
            }
    }
    return true;
}

static struct relume_change_place measure(const struct filling *f)
{
    const struct relume_change *out = f->out;
    struct relume_change_place p = {.area = (int)f->count};
    int left = out->width, top = out->height, right = 0, bottom = 0;
    for (size_t k = 0; k < f->count; k++) {
        const size_t at = f->waiting[k];
        const int x = (int)(at % (size_t)out->width), y = (int)(at / (size_t)out->width);
        const float *of = out->significance.data + 3 * at;
        left = smaller_of(left, x), right = larger_of(right, x);
        top = smaller_of(top, y), bottom = larger_of(bottom, y);
        p.shape += out->changed.data[3 * at] > 0.5f;
        p.colour += out->changed.data[3 * at + 1] > 0.5f;
        p.gloss += !(out->changed.data[3 * at] > 0.5f) && !(out->changed.data[3 * at + 1] > 0.5f);
        p.gloss_by += (double)out->gloss.data[at] / p.area;
        p.deg += (double)out->degrees.data[at] / p.area;
        p.delta_e += (double)out->delta_e.data[at] / p.area;
        for (int c = 0; c < 3; c++)
            p.significance = (double)of[c] > p.significance ? (double)of[c] : p.significance;
    }
    p.box = (struct relume_rect){left, top, right - left + 1, bottom - top + 1};
    return p;
}

static void forget(const struct filling *f)
{
    for (size_t k = 0; k < f->count; k++)
        memset(f->out->changed.data + 3 * f->waiting[k], 0, 3 * sizeof(float));
}

static int larger_first(const void *a, const void *b)
{
    const struct relume_change_place *p = a, *q = b;
    if (p->area != q->area)
        return p->area > q->area ? -1 : 1;
    return p->box.top != q->box.top ? p->box.top - q->box.top : p->box.left - q->box.left;
}

static bool add(struct relume_change *out, struct relume_change_place place)
{
    if (!mem_grow(&out->place, (size_t)out->places, sizeof *out->place))
        return false;
    out->place[out->places++] = place;
    out->area += (size_t)place.area;
    out->shape += (size_t)place.shape;
    out->colour += (size_t)place.colour;
    out->gloss_area += (size_t)place.gloss;
    return true;
}

relume_status places_find(struct relume_change *out, int least)
{
    const size_t n = (size_t)out->width * (size_t)out->height;
    struct filling f = {.out = out, .open = mem_array(n, 1)};
    bool allocated = f.open;
    for (size_t i = 0; allocated && i < n; i++)
        f.open[i] = out->changed.data[3 * i + 2] > 0.5f;
    for (size_t i = 0; allocated && i < n; i++) {
        if (!f.open[i])
            continue;
        allocated = gather(&f, i);
        if (allocated && f.count >= (size_t)least)
            allocated = add(out, measure(&f));
        else
            forget(&f);
    }
    if (allocated && out->places)
        qsort(out->place, (size_t)out->places, sizeof *out->place, larger_first);
    mem_free(f.open);
    mem_free(f.waiting);
    return allocated ? RELUME_OK : RELUME_ENOMEM;
}
