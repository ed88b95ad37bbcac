// patch.c - where a patch comes from and where it is cut (Kwatra et al. 2003): the cut runs where
// old and new texels differ least on both of its sides
#include "material/surface/patch.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/random.h"
#include "material/synthesis/cut.h"
#include "material/surface/surface.h"

#include <string.h>

enum {
    PROBES = 1024,   // places at which a patch is compared, about
    TRIALS = 24,     // of the places that fit best are cut, and the cheapest cut is taken
    UNKNOWN = -1,    // a cost
    UNIT_COST = 100  // of a difference as between neighbours in the sample
};
// A patch of which more is there already at the same place would change little.
static const double MOST_SAME = 0.2;

static size_t place_of(const struct canvas *c, const struct patch *p, int i, int j)
{
    const int x = map_wrap(p->x + i, c->side), y = map_wrap(p->y + j, c->side);
    return (size_t)y * (size_t)c->side + (size_t)x;
}

static uint32_t source_of(const struct canvas *c, const struct patch *p, int i, int j)
{
    return (uint32_t)((p->sy + j) * c->f->width + p->sx + i);
}

static bool is_core(const struct patch *p, int i, int j)
{
    const int end = p->size - p->core;
    return p->core > 0 && i >= p->core && i < end && j >= p->core && j < end;
}

static bool is_border(const struct canvas *c, size_t place)
{
    const int x = (int)(place % (size_t)c->side), y = (int)(place / (size_t)c->side);
    const int end = c->side - PATCH_BORDER;
    return x < PATCH_BORDER || y < PATCH_BORDER || x >= end || y >= end;
}

// ---------------------------------------------------------------- one cut

struct trial {
    struct patch patch;
    unsigned char *side;  // [size][size]
    double cost;
};

// Who must have a texel: whatever is empty is filled, the rim stays as it was.
static enum cut_side wanted(const struct canvas *c, const struct patch *p, int i, int j)
{
    const size_t place = place_of(c, p, i, j);
    if (c->texel[place] == PATCH_EMPTY)
        return CUT_NEW;
    if (p->core > 0 && is_border(c, place))
        return CUT_OLD;
    if (i == 0 || j == 0 || i == p->size - 1 || j == p->size - 1)
        return CUT_OLD;
    return is_core(p, i, j) ? CUT_NEW : CUT_EITHER;
}

// How wrong the patch is at a place, as a cost; UNKNOWN where nothing is yet.
static int wrong_at(const struct canvas *c, const struct patch *p, int i, int j)
{
    const uint32_t old = c->texel[place_of(c, p, i, j)];
    if (old == PATCH_EMPTY)
        return UNKNOWN;
    const float d = features_apart(c->f, old, source_of(c, p, i, j));
    return (int)fminf(d / c->unit * (float)UNIT_COST, 1e6f);
}

// What a cut between two places costs: one more, so that of equal lines the shortest is cut.
static int cost_of(int a, int b)
{
    const int known = a == UNKNOWN ? b : a;
    return 1 + (known == UNKNOWN ? 0 : known + (b == UNKNOWN ? known : b));
}

static double total_cost(const struct trial *t, const int *right, const int *down)
{
    const int size = t->patch.size;
    double sum = 0.0;
    for (int i = 0; i < size * size; i++) {
        if ((i + 1) % size && t->side[i] != t->side[i + 1])
            sum += right[i];
        if (i + size < size * size && t->side[i] != t->side[i + size])
            sum += down[i];
    }
    return sum;
}

static bool cut(const struct canvas *c, struct trial *t)
{
    const struct patch *p = &t->patch;
    const int size = p->size;
    const size_t n = (size_t)size * (size_t)size;
    int *wrong = mem_array(3 * n, sizeof *wrong);
    t->side = mem_array(n, sizeof *t->side);
    if (!wrong || !t->side) {
        mem_free(wrong);
        return false;
    }
    int *right = wrong + n, *down = right + n;
    for (int i = 0; i < size * size; i++) {
        t->side[i] = (unsigned char)wanted(c, p, i % size, i / size);
        wrong[i] = wrong_at(c, p, i % size, i / size);
    }
    for (int i = 0; i < size * size; i++) {
        right[i] = (i + 1) % size ? cost_of(wrong[i], wrong[i + 1]) : 0;
        down[i] = i + size < size * size ? cost_of(wrong[i], wrong[i + size]) : 0;
    }
    const bool good = !cut_grid(t->side, size, size, right, down);
    t->cost = good ? total_cost(t, right, down) : INFINITY;
    mem_free(wrong);
    return good;
}

// ---------------------------------------------------------------- what fits

struct choice {
    double wrong;  // mean over what overlaps
    uint64_t tie;
    int sx, sy;
};

struct search {
    const struct canvas *c;
    const struct patch *patch;
    uint64_t seed;
    int across;           // places in a row of the sample
    struct choice *list;  // [rows][across]
    struct trial *trial;
    bool failed;  // set by any worker, read after all
};

static bool was_used(const struct canvas *c, const struct patch *p)
{
    const int near = p->size / 8;
    for (int i = 0; p->core > 0 && i < c->used_count; i++) {
        const struct patch *u = &c->used[i];
        if (u->x == p->x && u->y == p->y && abs(u->sx - p->sx) <= near &&
            abs(u->sy - p->sy) <= near)
            return true;
    }
    return false;
}

// How wrong the patch is where it overlaps; worst where it has been or would change little.
static double compare(const struct canvas *c, const struct patch *p)
{
    int step = 1, count = 0, same = 0, all = 0;
    while ((p->size / step) * (p->size / step) > PROBES)
        step++;
    double sum = 0.0;
    for (int j = 0; j < p->size; j += step)
        for (int i = 0; i < p->size; i += step, all++) {
            const uint32_t old = c->texel[place_of(c, p, i, j)];
            if (old == PATCH_EMPTY)
                continue;
            same += old == source_of(c, p, i, j);
            if (is_core(p, i, j))
                continue;
            sum += (double)features_apart(c->f, old, source_of(c, p, i, j));
            count++;
        }
    if (p->core > 0 && (same > MOST_SAME * all || was_used(c, p)))
        return INFINITY;
    return count ? sum / count : 0.0;
}

static void compare_row(void *context, size_t item, int worker)
{
    (void)worker;
    struct search *s = context;
    struct patch p = *s->patch;
    p.sy = (int)item;
    for (p.sx = 0; p.sx < s->across; p.sx++) {
        const size_t at = item * (size_t)s->across + (size_t)p.sx;
        s->list[at] = (struct choice){compare(s->c, &p), random_mix(s->seed ^ at), p.sx, p.sy};
    }
}

static int by_wrong(const void *a, const void *b)
{
    const struct choice *x = a, *y = b;
    if (x->wrong != y->wrong)
        return x->wrong < y->wrong ? -1 : 1;
    return x->tie < y->tie ? -1 : x->tie > y->tie;
}

static void run_trial(void *context, size_t item, int worker)
{
    (void)worker;
    struct search *s = context;
    if (!cut(s->c, &s->trial[item]))
        __atomic_store_n(&s->failed, true, __ATOMIC_RELAXED);
}

// ---------------------------------------------------------------- pasting

static bool remember(struct canvas *c, const struct patch *p)
{
    if (!mem_grow(&c->used, (size_t)c->used_count, sizeof *c->used))
        return false;
    c->used[c->used_count++] = *p;
    return true;
}

static bool apply(struct canvas *c, const struct trial *t)
{
    const int size = t->patch.size;
    for (int i = 0; i < size * size; i++)
        if (t->side[i] == CUT_NEW)
            c->texel[place_of(c, &t->patch, i % size, i / size)] =
                source_of(c, &t->patch, i % size, i / size);
    return t->patch.core == 0 || remember(c, &t->patch);
}

static bool try_best(struct search *s, struct canvas *c, size_t places)
{
    struct trial trial[TRIALS];
    size_t n = 0, best = 0;
    for (; n < TRIALS && n < places && isfinite(s->list[n].wrong); n++) {
        trial[n] = (struct trial){.patch = *s->patch};
        trial[n].patch.sx = s->list[n].sx, trial[n].patch.sy = s->list[n].sy;
    }
    if (n == 0)
        return !s->failed;  // no place would change something: all stays as it is
    s->trial = trial;
    thread_for(c->threads, n, run_trial, s);
    for (size_t i = 1; i < n; i++)
        best = trial[i].cost < trial[best].cost ? i : best;
    const bool good = !s->failed && apply(c, &trial[best]);
    for (size_t i = 0; i < n; i++)
        mem_free(trial[i].side);
    return good;
}

relume_status patch_paste(struct canvas *c, struct patch *patch, uint64_t seed)
{
    const int across = c->f->width - patch->size + 1, rows = c->f->height - patch->size + 1;
    const size_t places = (size_t)across * (size_t)rows;
    struct search s = {c, patch, seed, across, mem_array(places, sizeof *s.list), NULL, false};
    if (!s.list)
        return RELUME_ENOMEM;
    thread_for(c->threads, (size_t)rows, compare_row, &s);
    qsort(s.list, places, sizeof *s.list, by_wrong);
    const bool good = try_best(&s, c, places);
    mem_free(s.list);
    return good ? RELUME_OK : RELUME_ENOMEM;
}
