// hierarchy.c - points of surfaces as a tree of balls
//
// Points are halved across the longest side of the box about them, three times for each level
// (Ritschel et al. 2009, "Micro-rendering for scalable, parallel final gathering", build a complete
// binary tree so). Balls and cones are those of the points themselves, not of the children's.
#include "world/transport/hierarchy.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <string.h>

struct placed {
    float place[3];
    uint32_t piece;
};

struct building {
    struct hierarchy *h;
    const struct piece *pieces;
    struct placed *placed;
    size_t count, root;  // children of the root
};

// ---------------------------------------------------------------- halves

static int longest_side(const struct placed *p, size_t n)
{
    float least[3], most[3];
    memcpy(least, p[0].place, sizeof least);
    memcpy(most, p[0].place, sizeof most);
    for (size_t i = 1; i < n; i++)
        for (int c = 0; c < 3; c++) {
            least[c] = fminf(least[c], p[i].place[c]);
            most[c] = fmaxf(most[c], p[i].place[c]);
        }
    int axis = 0;
    for (int c = 1; c < 3; c++)
        if (most[c] - least[c] > most[axis] - least[axis])
            axis = c;
    return axis;
}

static void swap(struct placed *a, struct placed *b)
{
    const struct placed c = *a;
    *a = *b;
    *b = c;
}

// The lower `half` of them first (Hoare's selection).
static void halve(struct placed *p, size_t n, size_t half)
{
    const int axis = longest_side(p, n);
    size_t low = 0, high = n - 1;
    while (low < high) {
        const float pivot = p[low + (high - low) / 2].place[axis];
        size_t i = low, j = high;
        while (i <= j) {
            while (p[i].place[axis] < pivot)
                i++;
            while (p[j].place[axis] > pivot)
                j--;
            if (i > j)
                break;
            swap(&p[i], &p[j]);
            i++;
            if (!j)
                break;
            j--;
        }
        if (half <= j)
            high = j;
        else if (half >= i)
            low = i;
        else
            break;
    }
}

// Into `parts` of them, a power of two, of one size or one more; `begins` has where they begin.
static void divide(size_t *begins, struct placed *p, size_t begin, size_t end, size_t parts)
{
    if (parts == 1) {
        begins[0] = begin;
        return;
    }
    const size_t middle = begin + (end - begin) / 2;
    halve(p + begin, end - begin, middle - begin);
    divide(begins, p, begin, middle, parts / 2);
    divide(begins + parts / 2, p, middle, end, parts / 2);
}

// ---------------------------------------------------------------- nodes

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

struct totals {
    double area, middle[3], facing[3];
};

static double area_of(const struct piece *p)
{
    const double x = (double)p->area[0], y = (double)p->area[1], z = (double)p->area[2];
    return sqrt(x * x + y * y + z * z);
}

static struct totals totals_of(const struct building *b, size_t begin, size_t end)
{
    struct totals t = {0};
    for (size_t i = begin; i < end; i++) {
        const struct piece *p = &b->pieces[b->placed[i].piece];
        const double area = area_of(p);
        t.area += area;
        for (int c = 0; c < 3; c++) {
            t.middle[c] += area * (double)p->place[c];
            t.facing[c] += (double)p->area[c];
        }
    }
    for (int c = 0; c < 3; c++)
        t.middle[c] /= t.area;
    return t;
}

static void put_node(const struct building *b, size_t node, size_t begin, size_t end)
{
    struct group *g = &b->h->groups[node / HIERARCHY_WAYS];
    const size_t k = node % HIERARCHY_WAYS;
    const struct totals t = totals_of(b, begin, end);
    const double facing = length_of(t.facing);
    double radius = 0.0, least = 1.0, thick = 0.0;
    for (size_t i = begin; i < end; i++) {
        const struct piece *p = &b->pieces[b->placed[i].piece];
        const double area = area_of(p);
        double off[3], along = 0.0, over = 0.0;
        for (int c = 0; c < 3; c++) {
            off[c] = (double)p->place[c] - t.middle[c];
            along += (double)p->area[c] * t.facing[c];
            over += off[c] * t.facing[c];
        }
        thick = fmax(thick, fabs(over));
        radius = fmax(radius, length_of(off) + sqrt(area / M_PI));
        least = fmin(least, facing > 0.0 ? along / (area * facing) : -1.0);
    }
    g->x[k] = (float)t.middle[0], g->y[k] = (float)t.middle[1], g->z[k] = (float)t.middle[2];
    g->radius[k] = (float)radius;
    for (int c = 0; c < 3; c++)
        g->facing[c][k] = (float)t.facing[c];
    g->turned[k] = (float)(0.5 * fmax(t.area - facing, 0.0));
    // Rounding must not turn a plane's own pieces.
    const double tangent = sqrt(fmax(1.0 - least * least, 1e-8)) / least;
    g->cone[k] = least > 0.0 ? (float)(facing * tangent) : INFINITY;
    g->edge[k] = least > 0.0 ? (float)(facing * tangent * radius + thick) : 0.0f;
    b->h->area[node] = (float)t.area;
}

struct level {
    const struct building *b;
    int number;
    size_t parts;    // children of a node
    size_t *begins;  // where the nodes of the level above begin, and the end of the last
    size_t *next;    // the same of this level
};

static void put_group(void *context, size_t group, int worker)
{
    (void)worker;
    const struct level *l = context;
    const struct building *b = l->b;
    const size_t at = b->h->first[l->number] + group;
    size_t *begins = l->next + l->parts * group;
    divide(begins, b->placed, l->begins[group], l->begins[group + 1], l->parts);
    for (size_t k = 0; k < HIERARCHY_WAYS; k++) {
        const size_t end = k + 1 < l->parts ? begins[k + 1] : l->begins[group + 1];
        b->h->groups[at].radius[k] = -1.0f;
        if (k < l->parts)
            put_node(b, HIERARCHY_WAYS * at + k, begins[k], end);
    }
}

static relume_status put_levels(struct building *b, int threads)
{
    struct hierarchy *h = b->h;
    size_t groups = 1, parts = b->root;
    size_t *begins = mem_zeroed(h->leaves + 1, sizeof *begins);
    size_t *next = mem_zeroed(h->leaves + 1, sizeof *next);
    relume_status status = begins && next ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        begins[1] = b->count;
    for (int l = 0; l < h->levels && !status; l++) {
        struct level level = {b, l, parts, begins, next};
        thread_for(threads, groups, put_group, &level);
        groups *= parts, parts = HIERARCHY_WAYS;
        next[groups] = b->count;
        size_t *const done = next;
        next = begins, begins = done;
    }
    h->begins = begins;
    mem_free(next);
    return status;
}

// ---------------------------------------------------------------- all of it

void hierarchy_forget(struct hierarchy *h)
{
    mem_free(h->groups);
    mem_free(h->area);
    mem_free(h->sent);
    mem_free(h->order);
    mem_free(h->begins);
    *h = (struct hierarchy){0};
}

static bool is_there(const struct piece *p)
{
    const double MOST = 1e30;  // sums of many are single, too
    bool finite = true;
    for (int c = 0; c < 3; c++)
        finite = finite && isfinite(p->place[c]) && isfinite(p->area[c]);
    return finite && area_of(p) > 0.0 && area_of(p) < MOST;
}

static size_t place_pieces(struct placed *placed, const struct piece *pieces, size_t count)
{
    size_t n = 0;
    for (size_t i = 0; i < count; i++)
        if (is_there(&pieces[i])) {
            memcpy(placed[n].place, pieces[i].place, sizeof placed[n].place);
            placed[n++].piece = (uint32_t)i;
        }
    return n;
}

// As many leaves as there are points, or a half of that to all, but no more than are wanted.
static size_t count_levels(struct hierarchy *h, size_t count, size_t most)
{
    size_t groups = 1, total = 0, nodes;
    int doublings = 0;
    while (((size_t)2 << doublings) <= count && ((size_t)2 << doublings) <= most)
        doublings++;
    const size_t root = (size_t)1 << (doublings % 3 || !doublings ? doublings % 3 : 3);
    h->leaves = (size_t)1 << doublings;
    for (nodes = root;; nodes *= HIERARCHY_WAYS) {
        h->first[h->levels++] = total;
        total += groups;
        groups = nodes;
        if (nodes == h->leaves)
            break;
    }
    h->first[h->levels] = total;
    return root;
}

static relume_status reserve(struct hierarchy *h, size_t count)
{
    const size_t groups = h->first[h->levels];
    h->groups = mem_zeroed(groups, sizeof *h->groups);
    h->area = mem_zeroed(groups * HIERARCHY_WAYS, sizeof *h->area);
    h->sent = mem_zeroed(groups * HIERARCHY_WAYS, sizeof *h->sent);
    h->order = mem_array(count, sizeof *h->order);
    return h->groups && h->area && h->sent && h->order ? RELUME_OK : RELUME_ENOMEM;
}

relume_status hierarchy_create(struct hierarchy *out, const struct piece *pieces, size_t count,
                               size_t leaves, int threads)
{
    struct placed *placed = count ? mem_array(count, sizeof *placed) : NULL;
    struct building b = {out, pieces, placed, 0, 1};
    *out = (struct hierarchy){0};
    if (count && !placed)
        return RELUME_ENOMEM;
    b.count = place_pieces(placed, pieces, count);
    relume_status status = RELUME_OK;
    if (b.count) {
        b.root = count_levels(out, b.count, leaves);
        status = reserve(out, b.count);
        if (!status)
            status = put_levels(&b, threads);
    }
    for (size_t i = 0; i < b.count && !status; i++)
        out->order[i] = placed[i].piece;
    mem_free(placed);
    if (status)
        hierarchy_forget(out);
    return status;
}

// ---------------------------------------------------------------- light

static void add_sent(struct sent *sum, const struct sent *s, float weight)
{
    for (int c = 0; c < 3; c++) {
        sum->without[c] += weight * s->without[c];
        sum->with[c] += weight * s->with[c];
    }
}

void hierarchy_light(struct hierarchy *h)
{
    for (int l = h->levels - 2; l >= 0; l--) {
        const size_t nodes = HIERARCHY_WAYS * (h->first[l + 1] - h->first[l]);
        for (size_t i = 0; i < nodes; i++) {
            const size_t node = HIERARCHY_WAYS * h->first[l] + i;
            if (h->area[node] == 0.0f)
                continue;
            // children of the i-th node of a level are the i-th group of the next one
            const size_t below = HIERARCHY_WAYS * (h->first[l + 1] + i);
            h->sent[node] = (struct sent){{0}, {0}};
            for (size_t k = below; k < below + HIERARCHY_WAYS; k++)
                add_sent(&h->sent[node], &h->sent[k], h->area[k] / h->area[node]);
        }
    }
}
