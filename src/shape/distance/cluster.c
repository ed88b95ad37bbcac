// cluster.c - hierarchical face clustering for billboards (Meseth 2008, 7.2, after Garland,
// Willmott, Heckbert 2001): neighbours are what is near, connected or not
//
// Of all pairs of clusters that are near each other the cheapest is merged, until none is left. One
// error sets the order, the others reject: a pair whose triangles turn from its plane by more than
// an angle, or whose rectangle is emptier than allowed, is never merged. What is left costs the
// wasted share (Eq. 7.2 as 1 - area / rectangle) plus, while the plane is farther from the
// triangles than the finest error, a whole step for each doubling of that (Eq. 7.3).
//
// Costs go by the vertices of each cluster that are farthest along fixed directions, of which there
// are so few that a pair is weighed at once. Before two are merged all vertices are asked, and the
// pair is dropped where they say otherwise: so bounds hold exactly, the order nearly.
#include "shape/distance/near.h"
#include "shape/distance/partition.h"

#include "core/base/log.h"
#include "core/base/memory.h"

#include <math.h>
#include <string.h>

enum { DIRECTIONS = 13, POINTS = 2 * DIRECTIONS, MOST_NEIGHBOURS = 256, TURNS = 8 };

// Towards the corners, edges and faces of a cube; unit length does not matter for what is farthest.
static const signed char direction[DIRECTIONS][3] = {
    {1, 0, 0}, {0, 1, 0},  {0, 0, 1}, {1, 1, 0},  {1, -1, 0}, {1, 0, 1},  {1, 0, -1},
    {0, 1, 1}, {0, 1, -1}, {1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1},
};

struct cluster {
    struct moments moments;
    uint32_t point[POINTS];  // 3 * triangle + corner
    int points;
    uint32_t *near;  // clusters, maybe merged since
    int nears;
    uint32_t head, tail;  // of its triangles
    uint32_t version;     // grows when it changes
    uint32_t into;        // what it has been merged into; itself: it is there
};

struct pair {
    double cost;
    uint32_t a, b, version_a, version_b;
};

struct clustering {
    const struct soup *s;
    struct cluster *cluster;
    struct partition *out;
    struct pair *heap;
    size_t pairs;
    uint32_t *seen;  // [triangles]: the round in which it was
    uint32_t round;
    size_t left;
    double error, finest, least_cosine, waste;
    int neighbours;
};

static vec3 point_at(const struct soup *s, uint32_t point)
{
    return s->corner[point / 3][point % 3];
}

static uint32_t root(struct clustering *w, uint32_t c)
{
    while (w->cluster[c].into != c) {
        w->cluster[c].into = w->cluster[w->cluster[c].into].into;
        c = w->cluster[c].into;
    }
    return c;
}

// ---------------------------------------------------------------- the heap

static bool dearer(const struct pair *a, const struct pair *b)
{
    if (a->cost != b->cost)
        return a->cost > b->cost;
    return a->a != b->a ? a->a > b->a : a->b > b->b;
}

static bool push(struct clustering *w, struct pair p)
{
    if (!mem_grow(&w->heap, w->pairs, sizeof *w->heap))
        return false;
    size_t i = w->pairs++;
    for (; i && dearer(&w->heap[(i - 1) / 2], &p); i = (i - 1) / 2)
        w->heap[i] = w->heap[(i - 1) / 2];
    w->heap[i] = p;
    return true;
}

static struct pair pop(struct clustering *w)
{
    const struct pair top = w->heap[0], last = w->heap[--w->pairs];
    size_t i = 0;
    for (size_t child; (child = 2 * i + 1) < w->pairs; i = child) {
        child += child + 1 < w->pairs && dearer(&w->heap[child], &w->heap[child + 1]);
        if (!dearer(&last, &w->heap[child]))
            break;
        w->heap[i] = w->heap[child];
    }
    w->heap[i] = last;
    return top;
}

// ---------------------------------------------------------------- what a pair costs

static const double turns[TURNS][2] = {{1, 0},
                                       {0.98078528040323, 0.195090322016128},
                                       {0.923879532511287, 0.38268343236509},
                                       {0.831469612302545, 0.555570233019602},
                                       {0.707106781186548, 0.707106781186547},
                                       {0.555570233019602, 0.831469612302545},
                                       {0.38268343236509, 0.923879532511287},
                                       {0.195090322016128, 0.98078528040323}};

// The least rectangle about points of a plane, of some that are turned by parts of a quarter.
static double rectangle_area(const vec3 *p, int n, const struct plane *plane)
{
    double least = INFINITY, u[2 * POINTS], v[2 * POINTS];
    for (int i = 0; i < n; i++) {
        u[i] = vec3_dot(p[i], plane->x);
        v[i] = vec3_dot(p[i], plane->y);
    }
    for (int t = 0; t < TURNS; t++) {
        const double c = turns[t][0], s = turns[t][1];
        struct range x = range_none, y = range_none;
        for (int i = 0; i < n; i++) {
            range_add(&x, c * u[i] + s * v[i]);
            range_add(&y, c * v[i] - s * u[i]);
        }
        least = fmin(least, (x.high - x.low) * (y.high - y.low));
    }
    return least;
}

// Whether mean normals alone forbid it: they lie within the cone of the triangles' normals.
static bool turned_off(const struct clustering *w, const struct cluster *c, vec3 normal)
{
    const double length = vec3_length(c->moments.normal);
    return vec3_dot(c->moments.normal, normal) < (w->least_cosine - 1e-9) * length;
}

// Infinite: never.
static double cost_of(const struct clustering *w, const struct cluster *a, const struct cluster *b)
{
    const struct moments sum = moments_sum(&a->moments, &b->moments);
    const struct plane plane = moments_plane(&sum);
    vec3 p[2 * POINTS];
    struct range height = range_none;
    int n = 0;
    if (turned_off(w, a, plane.normal) || turned_off(w, b, plane.normal))
        return INFINITY;
    for (int i = 0; i < a->points; i++)
        p[n++] = point_at(w->s, a->point[i]);
    for (int i = 0; i < b->points; i++)
        p[n++] = point_at(w->s, b->point[i]);
    for (int i = 0; i < n; i++)
        range_add(&height, vec3_dot(p[i], plane.normal));
    const double off = 0.5 * (height.high - height.low);
    if (off > w->error)
        return INFINITY;
    const double waste = 1.0 - sum.area / rectangle_area(p, n, &plane);
    if (waste > w->waste)
        return INFINITY;
    const double step = off > w->finest ? ceil(log2(off / w->finest)) : 0.0;
    return fmax(waste, 0.0) + step * w->waste;
}

static bool weigh(struct clustering *w, uint32_t a, uint32_t b)
{
    const struct cluster *const ca = &w->cluster[a], *const cb = &w->cluster[b];
    const double cost = cost_of(w, ca, cb);
    return cost == INFINITY || push(w, (struct pair){cost, a, b, ca->version, cb->version});
}

// By all triangles: within the bounds?
static bool fits(const struct clustering *w, const struct cluster *a, const struct cluster *b)
{
    const struct moments sum = moments_sum(&a->moments, &b->moments);
    const vec3 normal = moments_plane(&sum).normal;
    const uint32_t head[2] = {a->head, b->head};
    struct fit f = fit_none();
    bool good = true;
    for (int k = 0; k < 2; k++)
        for (uint32_t t = head[k]; good && t != NOBODY; t = w->out->next[t]) {
            fit_add(&f, w->s, t, normal);
            good = 0.5 * (f.height.high - f.height.low) <= w->error &&
                   f.least_cosine >= w->least_cosine - 1e-9;
        }
    return good;
}

// ---------------------------------------------------------------- merging

// The vertices of both that are farthest along the directions.
static void farthest(struct cluster *to, const struct soup *s, const struct cluster *b)
{
    uint32_t from[2 * POINTS], kept[POINTS] = {0};
    int n = 0, count = 0;
    for (int i = 0; i < to->points; i++)
        from[n++] = to->point[i];
    for (int i = 0; i < b->points; i++)
        from[n++] = b->point[i];
    for (int d = 0; d < DIRECTIONS; d++) {
        const vec3 v = vec3_of(direction[d][0], direction[d][1], direction[d][2]);
        double low = INFINITY, high = -INFINITY;
        uint32_t end[2] = {0, 0};
        for (int i = 0; i < n; i++) {
            const double at = vec3_dot(point_at(s, from[i]), v);
            if (at < low)
                low = at, end[0] = from[i];
            if (at > high)
                high = at, end[1] = from[i];
        }
        for (int e = 0; e < 2; e++) {
            int k = 0;
            while (k < count && kept[k] != end[e])
                k++;
            kept[k] = end[e];
            count = k == count ? count + 1 : count;
        }
    }
    memcpy(to->point, kept, sizeof *kept * (size_t)count);
    to->points = count;
}

static vec3 middle_of(const struct cluster *c)
{
    return vec3_scale(c->moments.first, 1.0 / c->moments.area);
}

struct distant {
    double square;
    uint32_t cluster;
};

static int by_distance(const void *a, const void *b)
{
    const struct distant *const p = a, *const q = b;
    if (p->square != q->square)
        return p->square < q->square ? -1 : 1;
    return (p->cluster > q->cluster) - (p->cluster < q->cluster);
}

// How far the ends of a cluster come to a place.
static double square_to(const struct clustering *w, const struct cluster *c,
                        const struct cluster *to)
{
    double least = INFINITY;
    const vec3 middle = middle_of(to);
    for (int i = 0; i < c->points; i++) {
        const vec3 d = vec3_sub(point_at(w->s, c->point[i]), middle);
        least = fmin(least, vec3_dot(d, d));
    }
    return least;
}

// Neighbours of both, the nearest of them where there are too many.
static bool join_neighbours(struct clustering *w, uint32_t a, uint32_t b)
{
    struct cluster *const pair[2] = {&w->cluster[a], &w->cluster[b]};
    struct distant found[2 * MOST_NEIGHBOURS];
    int n = 0;
    w->round++;
    w->seen[a] = w->round;
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < pair[k]->nears; i++) {
            const uint32_t c = root(w, pair[k]->near[i]);
            if (w->seen[c] == w->round)
                continue;
            w->seen[c] = w->round;
            found[n++] = (struct distant){0.0, c};
        }
    if (n > w->neighbours) {
        for (int i = 0; i < n; i++)
            found[i].square = square_to(w, &w->cluster[found[i].cluster], pair[0]);
        qsort(found, (size_t)n, sizeof *found, by_distance);
        n = w->neighbours;
    }
    uint32_t *near = mem_array((size_t)n, sizeof *near);
    if (!near)
        return false;
    for (int i = 0; i < n; i++)
        near[i] = found[i].cluster;
    for (int k = 0; k < 2; k++) {
        mem_free(pair[k]->near);
        pair[k]->near = NULL;
        pair[k]->nears = 0;
    }
    pair[0]->near = near;
    pair[0]->nears = n;
    return true;
}

static bool merge(struct clustering *w, uint32_t a, uint32_t b)
{
    struct cluster *const to = &w->cluster[a], *const from = &w->cluster[b];
    farthest(to, w->s, from);
    to->moments = moments_sum(&to->moments, &from->moments);
    w->out->next[to->tail] = from->head;
    to->tail = from->tail;
    to->version++;
    from->version++;
    from->into = a;
    w->left--;
    bool good = join_neighbours(w, a, b);
    for (int i = 0; i < to->nears && good; i++)
        good = weigh(w, a, to->near[i]);
    return good;
}

static relume_status merge_clusters(struct clustering *w, size_t wanted,
                                    const struct relume_log *log)
{
    enum { TOLD_EVERY = 1024 };
    bool good = true;
    for (size_t i = 0; good && w->pairs && w->left > wanted; i++) {
        const struct pair p = pop(w);
        if (i % TOLD_EVERY == 0 &&
            !log_progress(log, "clusters", 1.0 - (double)w->left / (double)w->s->count))
            return RELUME_ECANCEL;
        const struct cluster *const a = &w->cluster[p.a], *const b = &w->cluster[p.b];
        const bool is_old = a->version != p.version_a || b->version != p.version_b;
        if (!is_old && fits(w, a, b))
            good = merge(w, p.a, p.b);
    }
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- begin and end

static void begin_cluster(struct clustering *w, uint32_t i)
{
    w->cluster[i] = (struct cluster){.moments = moments_of(w->s, i),
                                     .point = {3 * i, 3 * i + 1, 3 * i + 2},
                                     .points = 3,
                                     .head = i,
                                     .tail = i,
                                     .into = i};
    w->out->next[i] = NOBODY;
}

// Neighbours at the beginning, and what they cost. A pair is weighed once, where both name each
// other; by the first that names it.
static bool begin(struct clustering *w)
{
    const size_t n = w->s->count, most = (size_t)w->neighbours;
    vec3 *middle = mem_array(n, sizeof *middle);
    uint32_t *near = mem_array(n * most, sizeof *near);
    bool good = middle && near;
    for (uint32_t i = 0; good && i < n; i++) {
        begin_cluster(w, i);
        middle[i] = middle_of(&w->cluster[i]);
    }
    good = good && !near_find(near, middle, n, (int)most);
    for (uint32_t i = 0; good && i < n; i++) {
        struct cluster *const c = &w->cluster[i];
        good = (c->near = mem_array(most, sizeof *c->near)) != NULL;
        for (size_t k = 0; good && k < most; k++) {
            const uint32_t other = near[i * most + k];
            bool again = other >= n;
            for (size_t j = 0; !again && other < i && j < most; j++)
                again = near[other * most + j] == i;
            if (other < n)
                c->near[c->nears++] = other;
            good = again || weigh(w, i, other);
        }
    }
    mem_free(middle);
    mem_free(near);
    return good;
}

static bool end(struct clustering *w)
{
    size_t count = 0;
    w->out->plane = mem_array(w->left, sizeof *w->out->plane);
    w->out->head = mem_array(w->left, sizeof *w->out->head);
    if (!w->out->plane || !w->out->head)
        return false;
    for (uint32_t i = 0; i < w->s->count; i++) {
        const struct cluster *const c = &w->cluster[i];
        if (c->into != i)
            continue;
        w->out->plane[count] = moments_plane(&c->moments);
        w->out->head[count++] = c->head;
    }
    w->out->count = count;
    return true;
}

relume_status cluster_planes(struct partition *out, const struct soup *s, double error,
                             const struct relume_billboards_params *params)
{
    // The finest error: coarse ones come in three doublings, as the thesis's levels of detail do.
    const double finest = params->count ? s->longest / 4096.0 : error / 8.0;
    struct clustering w = {.s = s,
                           .out = out,
                           .left = s->count,
                           .error = error,
                           .finest = finest,
                           .least_cosine = cos(params->angle_deg * M_PI / 180.0),
                           .waste = params->waste,
                           .neighbours = params->neighbours};
    w.cluster = mem_zeroed(s->count, sizeof *w.cluster);
    w.seen = mem_zeroed(s->count, sizeof *w.seen);
    relume_status status = w.cluster && w.seen && begin(&w) ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = merge_clusters(&w, (size_t)params->count, params->log);
    if (!status && !end(&w))
        status = RELUME_ENOMEM;
    for (size_t i = 0; w.cluster && i < s->count; i++)
        mem_free(w.cluster[i].near);
    mem_free(w.cluster);
    mem_free(w.seen);
    mem_free(w.heap);
    return status;
}
