// patches.c - squares of the sample, laid in rows so that they overlap and cut where it shows least
// (Meseth 2008, 4.1.4; Kwatra et al., "Graphcut Textures", 2003)
//
// Of the places of a square those are kept where the regular structure is right, then those that
// fit what is there already, and of these the one with the cheapest cut is taken. Squares whose
// left and upper neighbours are all there can be chosen at once: those of a diagonal of slope 1/2.
#include "material/synthesis/grow.h"
#include "material/synthesis/cut.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/random.h"
#include "core/math/scalar.h"

#include <math.h>
#include <string.h>

enum {
    PLACES = 8192,    // of the sample that are looked at for one square, at most
    RIGHT = 192,      // of these have the structure where it belongs
    FITTING = 12,     // of these are compared wherever the squares overlap
    TRIALS = 4,       // of these are cut
    PROBES = 160,     // texels at which a place is compared first, about
    CORNERS = 5,      // texels at which the structure is compared: the middle and the corners
    UNIT_COST = 100,  // of a difference as between neighbours in the sample
    LEAST_ACROSS = 6,
    LEAST_DOWN = 4,  // squares on a map that is done by several threads
};
#define EMPTY UINT32_MAX
// A square of which more goes on with what is there would repeat the sample, not add to it.
static const double MOST_SAME = 0.3;
// Part of the places that one square may have, so that not the same are taken always.
static const double OPEN = 0.6;

struct place {
    float wrong;
    uint32_t texel;  // the upper left one, of the sample
    uint64_t tie;
};

struct worker {
    struct place *place;  // [PLACES]
    int *probe;           // [size * size]: of the square, what is there already
    int *cost;            // [3][size * size]
    unsigned char *side;  // [2][size * size]
};

struct quilt {
    struct grow *g;
    int size, across, down, width, height;  // of squares; how many; of the canvas
    bool wrap;
    uint32_t *canvas;
    float *mask;  // of the sample
    float unit;   // the squared step between neighbours in the sample
    float weight;
    struct worker *worker;
    int diagonal, low;
    bool failed;  // set by any worker
};

static int wrapped(const struct quilt *q, int i, int n)
{
    return q->wrap && i >= n ? i % n : i;
}

static size_t cell(const struct quilt *q, int x, int y)
{
    return (size_t)wrapped(q, y, q->height) * (size_t)q->width + (size_t)wrapped(q, x, q->width);
}

static float apart(const struct quilt *q, uint32_t a, uint32_t b)
{
    const int n = q->g->values;
    const float *p = q->g->value + (size_t)a * (size_t)n, *r = q->g->value + (size_t)b * (size_t)n;
    float sum = 0.0f;
    for (int k = 0; k < n; k++)
        sum += (p[k] - r[k]) * (p[k] - r[k]);
    return sum;
}

// A square on the canvas, and where it may come from.
struct square {
    int x, y;
    uint64_t seed;
};

static uint32_t source(const struct quilt *q, uint32_t from, int in_square)
{
    return from + (uint32_t)(in_square / q->size * q->g->texture->width + in_square % q->size);
}

static uint32_t there(const struct quilt *q, const struct square *s, int in_square)
{
    return q->canvas[cell(q, s->x + in_square % q->size, s->y + in_square / q->size)];
}

// ---------------------------------------------------------------- places

static int by_wrong(const void *a, const void *b)
{
    const struct place *x = a, *y = b;
    if (x->wrong != y->wrong)
        return x->wrong < y->wrong ? -1 : 1;
    return x->tie < y->tie ? -1 : x->tie > y->tie;
}

// Brings the `most` best of a list to its front, in any order; how many these are.
static int keep_best(struct place *list, int count, int most)
{
    int low = 0, high = count - 1;
    while (most < count && low < high) {
        const struct place pivot = list[low + (high - low) / 2];
        int i = low, j = high;
        while (i <= j) {
            while (by_wrong(&list[i], &pivot) < 0)
                i++;
            while (by_wrong(&list[j], &pivot) > 0)
                j--;
            if (i <= j) {
                const struct place swapped = list[i];
                list[i++] = list[j];
                list[j--] = swapped;
            }
        }
        if (most <= j)
            high = j;
        else if (most >= i)
            low = i;
        else
            break;
    }
    return smaller_of(count, most);
}

static int corner(const struct quilt *q, int i)
{
    const int end = q->size - 1, middle = q->size / 2;
    const int x = i == 0 ? middle : i % 2 ? 0 : end, y = i == 0 ? middle : i < 3 ? 0 : end;
    return y * q->size + x;
}

static void structure_at(const struct quilt *q, const struct square *s, float *out)
{
    double turn[4];
    for (int i = 0; i < CORNERS; i++) {
        const int at = corner(q, i);
        mask_fill(out + i * MASK_VALUES, q->g->regular,
                  &(struct mask_area){.x = s->x + at % q->size,
                                      .y = s->y + at / q->size,
                                      .width = 1,
                                      .height = 1,
                                      .spacing = 1.0,
                                      .stretch_x = q->g->stretch_x,
                                      .stretch_y = q->g->stretch_y},
                  turn);
    }
}

// Places with the structure where the square wants it, the best first.
static int right_places(const struct quilt *q, const struct square *s, struct place *list)
{
    const struct relume_texture *t = q->g->texture;
    const int across = t->width - q->size + 1, down = t->height - q->size + 1;
    const int64_t all = (int64_t)across * down;
    const float *mask = q->mask;
    const int most = mask ? PLACES : 2 * RIGHT, count = (int)(all < most ? all : most);
    float wanted[CORNERS * MASK_VALUES];
    int n = 0;
    if (mask)
        structure_at(q, s, wanted);
    for (int i = 0; i < count; i++) {
        const uint64_t mixed = random_mix(s->seed ^ (uint64_t)i);
        const int64_t at = all <= most ? i : (int64_t)(mixed % (uint64_t)all);
        if (all > 64 && (double)(random_mix(mixed) >> 11) * 0x1p-53 > OPEN)
            continue;
        const uint32_t from = (uint32_t)(at / across * t->width + at % across);
        float wrong = 0.0f;
        for (int c = 0; mask && c < CORNERS; c++) {
            const float *a = mask + (size_t)source(q, from, corner(q, c)) * MASK_VALUES,
                        *b = wanted + c * MASK_VALUES;
            for (int k = 0; k < MASK_VALUES; k++)
                wrong += (a[k] - b[k]) * (a[k] - b[k]);
        }
        list[n++] = (struct place){q->weight * wrong / CORNERS, from, random_mix(~mixed)};
    }
    return keep_best(list, n, RIGHT);
}

// Texels of the square where something is already; their number.
static int find_probes(const struct quilt *q, const struct square *s, int *probe)
{
    int n = 0;
    for (int i = 0; i < q->size * q->size; i++)
        if (there(q, s, i) != EMPTY)
            probe[n++] = i;
    return n;
}

// Adds how wrong the places are where the square overlaps, every `step`-th texel, and sorts them.
static void compare(const struct quilt *q, const struct square *s, struct place *list, int count,
                    const int *probe, int probes, int step)
{
    for (int i = 0; i < count; i++) {
        int n = 0, same = 0;
        float sum = 0.0f;
        for (int p = 0; p < probes; p += step, n++) {
            const uint32_t old = there(q, s, probe[p]), new = source(q, list[i].texel, probe[p]);
            sum += apart(q, old, new);
            same += old == new;
        }
        if (n && same > MOST_SAME * n)
            sum += 1e6f;
        list[i].wrong += n ? sum / (float)n : 0.0f;
    }
    qsort(list, (size_t)count, sizeof *list, by_wrong);
}

// ---------------------------------------------------------------- cuts

// What a cut between two places costs: one more, so that of equal lines the shortest is cut.
static int cost_of(int a, int b)
{
    const int known = a < 0 ? b : a;
    return 1 + (known < 0 ? 0 : known + (b < 0 ? known : b));
}

// Which side has which texel of the square, and what the cut costs; false: no memory.
static bool cut(const struct quilt *q, const struct square *s, uint32_t from, int *cost,
                unsigned char *side, double *total)
{
    const int size = q->size, n = size * size;
    int *wrong = cost, *right = cost + n, *down = right + n;
    for (int i = 0; i < n; i++) {
        const uint32_t old = there(q, s, i);
        const int x = i % size, y = i / size;
        const bool rim = x == 0 || y == 0 || x == size - 1 || y == size - 1;
        wrong[i] =
            old == EMPTY
                ? -1
                : (int)fminf(apart(q, old, source(q, from, i)) / q->unit * (float)UNIT_COST, 1e6f);
        side[i] = (unsigned char)(old == EMPTY ? CUT_NEW : rim ? CUT_OLD : CUT_EITHER);
    }
    for (int i = 0; i < n; i++) {
        right[i] = (i + 1) % size ? cost_of(wrong[i], wrong[i + 1]) : 0;
        down[i] = i + size < n ? cost_of(wrong[i], wrong[i + size]) : 0;
    }
    if (cut_grid(side, size, size, right, down))
        return false;
    *total = 0.0;
    for (int i = 0; i < n; i++) {
        if ((i + 1) % size && side[i] != side[i + 1])
            *total += right[i];
        if (i + size < n && side[i] != side[i + size])
            *total += down[i];
    }
    return true;
}

static void paste(const struct quilt *q, const struct square *s, uint32_t from,
                  const unsigned char *side)
{
    for (int i = 0; i < q->size * q->size; i++)
        if (side[i] == CUT_NEW)
            q->canvas[cell(q, s->x + i % q->size, s->y + i / q->size)] = source(q, from, i);
}

static bool lay(struct quilt *q, const struct square *s, struct worker *w)
{
    const int n = q->size * q->size, probes = find_probes(q, s, w->probe);
    int count = right_places(q, s, w->place), best = 0;
    double least = INFINITY;
    if (probes == n && q->wrap)  // all is there, by the squares around
        return true;
    compare(q, s, w->place, count, w->probe, probes, larger_of(probes / PROBES, 1));
    count = smaller_of(count, FITTING);
    compare(q, s, w->place, count, w->probe, probes, larger_of(probes / (8 * PROBES), 1));
    for (int i = 0; i < smaller_of(count, probes ? TRIALS : 1); i++) {
        double total;
        unsigned char *side = w->side + (i == 0 ? 0 : n);
        if (!cut(q, s, w->place[i].texel, w->cost, side, &total))
            return false;
        if (total < least) {
            least = total;
            best = i;
            if (i)
                memcpy(w->side, side, (size_t)n);
        }
    }
    paste(q, s, w->place[best].texel, w->side);
    return true;
}

// ---------------------------------------------------------------- order

static void lay_one(struct quilt *q, int i, int j, int worker)
{
    const struct square s = {.x = (int)((int64_t)i * (q->wrap ? q->width : q->width - q->size) /
                                        (q->wrap ? q->across : larger_of(q->across - 1, 1))),
                             .y = (int)((int64_t)j * (q->wrap ? q->height : q->height - q->size) /
                                        (q->wrap ? q->down : larger_of(q->down - 1, 1))),
                             .seed = random_stream(q->g->params->seed, 11,
                                                   (uint64_t)j * (uint64_t)q->across + (uint64_t)i)
                                         .key};
    if (!lay(q, &s, &q->worker[worker]))
        __atomic_store_n(&q->failed, true, __ATOMIC_RELAXED);
}

static void lay_item(void *context, size_t item, int worker)
{
    struct quilt *q = context;
    const int j = q->low + (int)item;
    lay_one(q, q->diagonal - 2 * j, j, worker);
}

static relume_status lay_all(struct quilt *q)
{
    const bool several = q->across >= LEAST_ACROSS && q->down >= LEAST_DOWN;
    // where the map closes, the last column meets the first, and waits for all others
    const int columns = q->wrap ? q->across - 1 : q->across;
    const int last = columns - 1 + 2 * (q->down - 1);
    for (int d = 0; several && d <= last && !q->failed; d++) {
        const int low = larger_of(0, (d - columns + 2) / 2), high = smaller_of(q->down - 1, d / 2);
        q->diagonal = d;
        q->low = low;
        if (high >= low)
            thread_for(q->g->params->threads, (size_t)(high - low + 1), lay_item, q);
        if (!log_progress(q->g->params->log, "patches", (d + 1.0) / (last + 1.0)))
            return RELUME_ECANCEL;
    }
    for (int j = 0; several && q->wrap && j < q->down && !q->failed; j++)
        lay_one(q, columns, j, 0);
    for (int i = 0; !several && i < q->across * q->down && !q->failed; i++)
        lay_one(q, i % q->across, i / q->across, 0);
    return q->failed ? RELUME_ENOMEM : RELUME_OK;
}

static float mean_step(const struct quilt *q)
{
    const struct relume_texture *t = q->g->texture;
    double sum = 0.0;
    for (int y = 0; y + 1 < t->height; y++)
        for (int x = 0; x + 1 < t->width; x++) {
            const uint32_t at = (uint32_t)(y * t->width + x);
            sum += (double)apart(q, at, at + 1) + (double)apart(q, at, at + (uint32_t)t->width);
        }
    return (float)(sum / (2.0 * (t->width - 1.0) * (t->height - 1.0)));
}

static bool alloc_worker(struct worker *w, int size)
{
    const size_t n = (size_t)size * (size_t)size;
    w->place = mem_array(PLACES, sizeof *w->place);
    w->probe = mem_array(n, sizeof *w->probe);
    w->cost = mem_array(3 * n, sizeof *w->cost);
    w->side = mem_array(2 * n, sizeof *w->side);
    return w->place && w->probe && w->cost && w->side;
}

static void release(struct quilt *q, int workers)
{
    for (int i = 0; q->worker && i < workers; i++) {
        mem_free(q->worker[i].place);
        mem_free(q->worker[i].probe);
        mem_free(q->worker[i].cost);
        mem_free(q->worker[i].side);
    }
    mem_free(q->worker);
    mem_free(q->canvas);
    mem_free(q->mask);
}

static bool prepare(struct quilt *q, int workers)
{
    const size_t cells = (size_t)q->width * (size_t)q->height;
    bool good = true;
    q->canvas = mem_large(cells * sizeof *q->canvas);
    q->worker = mem_zeroed((size_t)workers, sizeof *q->worker);
    for (int i = 0; q->worker && i < workers; i++)
        good &= alloc_worker(&q->worker[i], q->size);
    if (q->g->regular)
        good &= (q->mask = mask_of_sample(q->g->regular)) != NULL;
    for (size_t i = 0; q->canvas && i < cells; i++)
        q->canvas[i] = EMPTY;
    return good && q->canvas && q->worker;
}

relume_status grow_patches(struct grow *g)
{
    const int workers = thread_count(g->params->threads);
    struct quilt q = {.g = g,
                      .size = g->params->patch,
                      .wrap = g->params->tile,
                      .weight = (float)(g->params->weight * g->params->weight)};
    if (q.wrap && (g->width < 2 * q.size || g->height < 2 * q.size))
        q.size = larger_of(4, smaller_of(g->width, g->height) / 4 * 2);
    const int step = q.size * 2 / 3;
    q.across = (g->width + step - 1) / step;
    q.down = (g->height + step - 1) / step;
    q.width = q.wrap ? g->width : (q.across - 1) * step + q.size;
    q.height = q.wrap ? g->height : (q.down - 1) * step + q.size;
    relume_status status = prepare(&q, workers) ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        q.unit = fmaxf(mean_step(&q), 1e-12f);
        status = lay_all(&q);
    }
    for (int y = 0; y < g->height && !status; y++)
        memcpy(g->texel + (size_t)y * (size_t)g->width, q.canvas + (size_t)y * (size_t)q.width,
               (size_t)g->width * sizeof *g->texel);
    release(&q, workers);
    return status;
}
