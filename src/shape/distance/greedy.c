// greedy.c - planes for billboards by votes (Decoret, Durand, Sillion, Dorsey 2003)
//
// A plane is a direction and an offset. Of directions there are some hundred, evenly spread over a
// half of the sphere; offsets go by half the error. Each triangle votes for the cells whose plane
// all its vertices are near enough to, by its area as the plane shows it. The plane with most votes
// is taken, fitted to its triangles where that finds more of them; these withdraw their votes, and
// so on. What no cell's plane comes near to gets the plane of the largest triangle that is left.
//
// Of the paper's method this leaves out penalties for triangles that are just missed, and the
// subdivision of cells.
#include "shape/distance/partition.h"

#include "core/base/log.h"
#include "core/base/memory.h"

#include <math.h>

enum { VOTED_DIRECTIONS = 512 };

struct plane_votes {
    const struct soup *s;
    struct partition *out;
    double error, step, low;
    size_t offsets;
    vec3 direction[VOTED_DIRECTIONS];
    double *votes;  // [VOTED_DIRECTIONS][offsets]
    bool *taken;    // [triangles]
    size_t left;
    uint32_t largest;  // in `order`, which is not taken
    uint32_t *order;   // triangles by area
};

// A spiral over the upper half (Vogel 1979), axes first: buildings are made of them.
static void spread(vec3 *direction)
{
    direction[0] = vec3_of(1, 0, 0);
    direction[1] = vec3_of(0, 1, 0);
    direction[2] = vec3_of(0, 0, 1);
    for (int i = 3; i < VOTED_DIRECTIONS; i++) {
        const double z = 1.0 - (i - 2.5) / (VOTED_DIRECTIONS - 3);
        const double phi = i * M_PI * (3.0 - sqrt(5.0)), r = sqrt(1.0 - z * z);
        direction[i] = vec3_of(r * cos(phi), r * sin(phi), z);
    }
}

// The offsets of planes that a triangle may go to.
static struct range valid(const struct plane_votes *w, size_t triangle, vec3 direction)
{
    struct range r = range_none;
    for (int k = 0; k < 3; k++)
        range_add(&r, vec3_dot(w->s->corner[triangle][k], direction));
    return (struct range){r.high - w->error, r.low + w->error};
}

static void vote(struct plane_votes *w, size_t triangle, double sign)
{
    for (size_t d = 0; d < VOTED_DIRECTIONS; d++) {
        const struct range r = valid(w, triangle, w->direction[d]);
        const double area =
            sign * w->s->area[triangle] * fabs(vec3_dot(w->s->normal[triangle], w->direction[d]));
        const double first = ceil((r.low - w->low) / w->step);
        const double last = floor((r.high - w->low) / w->step);
        for (double i = fmax(first, 0.0); i <= last && i < (double)w->offsets; i++)
            w->votes[d * w->offsets + (size_t)i] += area;
    }
}

// The area that may go to a plane.
static double reach(const struct plane_votes *w, const struct plane *p)
{
    double area = 0.0;
    for (size_t i = 0; i < w->s->count; i++) {
        const struct range r = valid(w, i, p->normal);
        if (!w->taken[i] && r.low <= p->offset && p->offset <= r.high)
            area += w->s->area[i] * fabs(vec3_dot(w->s->normal[i], p->normal));
    }
    return area;
}

// In the middle of what goes to `p`, by least squares.
static struct plane fitted(const struct plane_votes *w, const struct plane *p)
{
    struct moments sum = {0};
    for (size_t i = 0; i < w->s->count; i++) {
        const struct range r = valid(w, i, p->normal);
        if (w->taken[i] || !(r.low <= p->offset && p->offset <= r.high))
            continue;
        const struct moments m = moments_of(w->s, i);
        sum = moments_sum(&sum, &m);
    }
    return sum.area > 0.0 ? moments_plane(&sum) : *p;
}

static struct plane choose(struct plane_votes *w)
{
    size_t best = 0;
    for (size_t i = 1; i < VOTED_DIRECTIONS * w->offsets; i++)
        best = w->votes[i] > w->votes[best] ? i : best;
    struct plane p =
        plane_of(w->direction[best / w->offsets], w->low + w->step * (double)(best % w->offsets));
    while (w->taken[w->order[w->largest]])
        w->largest++;
    const uint32_t t = w->order[w->largest];
    const struct plane own =
        plane_of(w->s->normal[t], vec3_dot(w->s->normal[t], w->s->corner[t][0]));
    const struct plane better = fitted(w, &p);
    const double voted = reach(w, &p);
    const struct plane *most = &p;
    if (reach(w, &better) > voted)
        most = &better;
    return reach(w, most) >= reach(w, &own) ? *most : own;
}

// Its triangles no longer vote. The plane's own triangle may lie off by rounding alone.
static void take_plane(struct plane_votes *w, struct plane p)
{
    const double rounding = 1e-9 * w->s->longest;
    uint32_t head = NOBODY;
    double facing = 0.0;
    for (size_t i = 0; i < w->s->count; i++) {
        const struct range r = valid(w, i, p.normal);
        if (w->taken[i] || r.low > p.offset + rounding || p.offset - rounding > r.high)
            continue;
        vote(w, i, -1.0);
        w->taken[i] = true;
        w->left--;
        w->out->next[i] = head;
        head = (uint32_t)i;
        facing += w->s->area[i] * vec3_dot(w->s->normal[i], p.normal);
    }
    if (facing < 0.0)
        p = plane_of(vec3_scale(p.normal, -1.0), -p.offset);
    w->out->head[w->out->count] = head;
    w->out->plane[w->out->count++] = p;
}

struct sized {
    double area;
    uint32_t triangle;
};

static int by_area(const void *a, const void *b)
{
    const struct sized *const p = a, *const q = b;
    if (p->area != q->area)
        return p->area > q->area ? -1 : 1;
    return (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

static bool sort(struct plane_votes *w)
{
    struct sized *sized = mem_array(w->s->count, sizeof *sized);
    for (size_t i = 0; sized && i < w->s->count; i++)
        sized[i] = (struct sized){w->s->area[i], (uint32_t)i};
    if (sized)
        qsort(sized, w->s->count, sizeof *sized, by_area);
    for (size_t i = 0; sized && i < w->s->count; i++)
        w->order[i] = sized[i].triangle;
    mem_free(sized);
    return sized != NULL;
}

relume_status greedy_planes(struct partition *out, const struct soup *s, double error,
                            const struct relume_log *log)
{
    enum { MOST_OFFSETS = 8192 };
    struct plane_votes w = {.s = s, .out = out, .error = error, .left = s->count};
    const double half = 0.5 * sqrt(3.0) * s->longest;  // of the ball about the box
    w.step = fmax(0.5 * error, 2.0 * half / MOST_OFFSETS);
    w.low = -half;
    w.offsets = (size_t)(2.0 * half / w.step) + 2;
    w.votes = mem_zeroed(VOTED_DIRECTIONS * w.offsets, sizeof *w.votes);
    w.taken = mem_zeroed(s->count, sizeof *w.taken);
    w.order = mem_array(s->count, sizeof *w.order);
    out->plane = mem_array(s->count, sizeof *out->plane);
    out->head = mem_array(s->count, sizeof *out->head);
    const bool good = w.votes && w.taken && w.order && out->plane && out->head && sort(&w);
    relume_status status = good ? RELUME_OK : RELUME_ENOMEM;
    spread(w.direction);
    for (size_t i = 0; !status && i < s->count; i++)
        vote(&w, i, 1.0);
    while (!status && w.left) {
        take_plane(&w, choose(&w));
        if (!log_progress(log, "planes", 1.0 - (double)w.left / (double)s->count))
            status = RELUME_ECANCEL;
    }
    mem_free(w.votes);
    mem_free(w.taken);
    mem_free(w.order);
    return status;
}
