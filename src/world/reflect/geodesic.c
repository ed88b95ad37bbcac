// geodesic.c - distances along a surface of triangles
//
// A wave runs over the vertices from near to far, as in Dijkstra's method (1959) and fast marching
// (Kimmel and Sethian 1998). Over a triangle two of whose corners are reached, the third is reached
// from where a source in the triangle's plane would lie that is as far from both (Novotni and Klein
// 2002): exact on a plane, for a source of rays rather than of flat waves. Where the straight way
// would leave the triangle, it goes along an edge.
#include "world/reflect/geodesic.h"

#include "core/base/memory.h"
#include "world/reflect/reflection.h"

#include <string.h>

// ---------------------------------------------------------------- joining

struct placed {
    float at[3];
    uint32_t vertex;
};

static int by_place(const void *a, const void *b)
{
    const struct placed *p = a, *q = b;
    for (int i = 0; i < 3; i++)
        if (p->at[i] != q->at[i])
            return p->at[i] < q->at[i] ? -1 : 1;
    return (p->vertex > q->vertex) - (p->vertex < q->vertex);
}

static relume_status join(struct geodesic_mesh *m, const struct relume_reflection_surface *s)
{
    struct placed *placed = mem_array(s->vertices, sizeof *placed);
    m->position = mem_array(s->vertices, sizeof *m->position);
    m->joined = mem_array(s->vertices, sizeof *m->joined);
    if (!placed || !m->position || !m->joined) {
        mem_free(placed);
        return RELUME_ENOMEM;
    }
    for (size_t i = 0; i < s->vertices; i++) {
        placed[i].vertex = (uint32_t)i;
        memcpy(placed[i].at, (const char *)s->position + i * s->stride, sizeof placed[i].at);
    }
    qsort(placed, s->vertices, sizeof *placed, by_place);
    for (size_t i = 0; i < s->vertices; i++) {
        const float *at = placed[i].at, *before = placed[i > 0 ? i - 1 : 0].at;
        if (i == 0 || at[0] != before[0] || at[1] != before[1] || at[2] != before[2])
            m->position[m->vertices++] = vec3_of((double)at[0], (double)at[1], (double)at[2]);
        m->joined[placed[i].vertex] = (uint32_t)m->vertices - 1;
    }
    mem_free(placed);
    return RELUME_OK;
}

static void list_around(struct geodesic_mesh *m)
{
    for (size_t i = 0; i < m->triangles; i++)
        for (int k = 0; k < 3; k++)
            m->first[m->triangle[i][k] + 1]++;
    for (size_t v = 0; v < m->vertices; v++)
        m->first[v + 1] += m->first[v];
    for (size_t i = m->triangles; i-- > 0;)
        for (int k = 0; k < 3; k++)
            m->around[--m->first[m->triangle[i][k] + 1]] = (uint32_t)i;
    memmove(m->first, m->first + 1, m->vertices * sizeof *m->first);
    m->first[m->vertices] = 3 * m->triangles;
}

static double mean_edge(const struct geodesic_mesh *m)
{
    double sum = 0.0;
    for (size_t i = 0; i < m->triangles; i++)
        for (int k = 0; k < 3; k++)
            sum += vec3_length(
                vec3_sub(m->position[m->triangle[i][k]], m->position[m->triangle[i][(k + 1) % 3]]));
    return sum / (double)(3 * m->triangles);
}

relume_status geodesic_mesh_create(struct geodesic_mesh *m,
                                   const struct relume_reflection_surface *s)
{
    *m = (struct geodesic_mesh){
        .triangles = s->triangles, .given = s->vertices, .given_triangle = s->triangle};
    const relume_status status = join(m, s);
    m->triangle = mem_array(m->triangles, sizeof *m->triangle);
    m->first = mem_zeroed(m->vertices + 1, sizeof *m->first);
    m->around = mem_array(3 * m->triangles, sizeof *m->around);
    if (status || !m->triangle || !m->first || !m->around)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < m->triangles; i++)
        for (int k = 0; k < 3; k++)
            m->triangle[i][k] = m->joined[s->triangle[i][k]];
    list_around(m);
    m->edge = mean_edge(m);
    return RELUME_OK;
}

void geodesic_mesh_free(struct geodesic_mesh *m)
{
    mem_free(m->position);
    mem_free(m->joined);
    mem_free(m->triangle);
    mem_free(m->first);
    mem_free(m->around);
    *m = (struct geodesic_mesh){0};
}

// ---------------------------------------------------------------- the nearest place

static vec3 on_segment(vec3 p, vec3 a, vec3 b)
{
    const vec3 ab = vec3_sub(b, a);
    const double length = vec3_dot(ab, ab);
    const double t = length > 0.0 ? vec3_dot(vec3_sub(p, a), ab) / length : 0.0;
    return vec3_along(a, ab, fmin(fmax(t, 0.0), 1.0));
}

// The place of a triangle that is nearest to p: below p where that is inside, else on an edge.
static vec3 on_triangle(vec3 p, const vec3 corner[3])
{
    const vec3 ab = vec3_sub(corner[1], corner[0]), ac = vec3_sub(corner[2], corner[0]);
    const vec3 n = vec3_cross(ab, ac), ap = vec3_sub(p, corner[0]);
    const double area = vec3_dot(n, n);
    const double b = area > 0.0 ? vec3_dot(vec3_cross(ap, ac), n) / area : -1.0;
    const double c = area > 0.0 ? vec3_dot(vec3_cross(ab, ap), n) / area : -1.0;
    if (b >= 0.0 && c >= 0.0 && b + c <= 1.0)
        return vec3_along(vec3_along(corner[0], ab, b), ac, c);
    vec3 best = on_segment(p, corner[2], corner[0]);
    for (int k = 0; k < 2; k++) {
        const vec3 other = on_segment(p, corner[k], corner[k + 1]);
        if (vec3_length(vec3_sub(other, p)) < vec3_length(vec3_sub(best, p)))
            best = other;
    }
    return best;
}

static double area_of(vec3 a, vec3 b, vec3 c)
{
    return vec3_length(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
}

bool geodesic_locate(struct relume_reflection_place *out, const struct geodesic_mesh *m, vec3 point)
{
    double least = INFINITY;
    vec3 corner[3];
    for (size_t i = 0; i < m->triangles; i++) {
        for (int k = 0; k < 3; k++)
            corner[k] = m->position[m->triangle[i][k]];
        const vec3 on = on_triangle(point, corner);
        const double distance = vec3_length(vec3_sub(on, point));
        const double all = area_of(corner[0], corner[1], corner[2]);
        if (!(distance < least) || !(all > 0.0))
            continue;
        least = distance;
        out->position = on;
        for (int k = 0; k < 3; k++) {
            out->vertex[k] = m->given_triangle[i][k];
            out->weight[k] = area_of(on, corner[(k + 1) % 3], corner[(k + 2) % 3]) / all;
        }
    }
    return least < INFINITY;
}

// ---------------------------------------------------------------- the wave

// Vertices that are reached but not settled, the nearest first: a binary heap, and where each
// vertex stands in it.
struct wave {
    const struct geodesic_mesh *mesh;
    double *distance;  // [vertices]
    uint32_t *heap, *place;
    size_t waiting;
    bool *settled;
};

static void put(struct wave *w, size_t at, uint32_t vertex)
{
    w->heap[at] = vertex;
    w->place[vertex] = (uint32_t)at;
}

static void rise(struct wave *w, uint32_t vertex)
{
    size_t at = w->place[vertex];
    for (; at > 0 && w->distance[w->heap[(at - 1) / 2]] > w->distance[vertex]; at = (at - 1) / 2)
        put(w, at, w->heap[(at - 1) / 2]);
    put(w, at, vertex);
}

static uint32_t take_nearest(struct wave *w)
{
    const uint32_t nearest = w->heap[0], moved = w->heap[--w->waiting];
    size_t at = 0, child;
    for (; (child = 2 * at + 1) < w->waiting; at = child) {
        if (child + 1 < w->waiting && w->distance[w->heap[child + 1]] < w->distance[w->heap[child]])
            child++;
        if (w->distance[w->heap[child]] >= w->distance[moved])
            break;
        put(w, at, w->heap[child]);
    }
    put(w, at, moved);
    return nearest;
}

static void reach(struct wave *w, uint32_t vertex, double distance)
{
    if (w->settled[vertex] || !(distance < w->distance[vertex]))
        return;
    if (w->distance[vertex] == INFINITY)
        put(w, w->waiting++, vertex);
    w->distance[vertex] = distance;
    rise(w, vertex);
}

// Over the edge from a to b, reached at `da` and `db`, to c: in the plane of the triangle a is
// (0, 0), b is (length, 0), c lies above and the source below.
static double over_edge(vec3 a, double da, vec3 b, double db, vec3 c)
{
    const vec3 ab = vec3_sub(b, a), ac = vec3_sub(c, a);
    const double length = vec3_length(ab);
    if (!(length > 0.0))
        return INFINITY;
    const double cx = vec3_dot(ac, ab) / length;
    const double cy = sqrt(fmax(vec3_dot(ac, ac) - cx * cx, 0.0));
    const double sx = 0.5 * (length + (da * da - db * db) / length);
    const double sy = sqrt(fmax(da * da - sx * sx, 0.0));
    const double crossing = sy + cy > 0.0 ? sx + (cx - sx) * sy / (sy + cy) : -1.0;
    return crossing >= 0.0 && crossing <= length ? hypot(cx - sx, cy + sy) : INFINITY;
}

static void settle(struct wave *w, uint32_t from)
{
    const struct geodesic_mesh *m = w->mesh;
    const vec3 a = m->position[from];
    w->settled[from] = true;
    for (size_t i = m->first[from]; i < m->first[from + 1]; i++)
        for (int k = 0; k < 3; k++) {
            const uint32_t *corner = m->triangle[m->around[i]];
            const uint32_t to = corner[k];
            const uint32_t other =
                corner[(k + 1) % 3] == from ? corner[(k + 2) % 3] : corner[(k + 1) % 3];
            const vec3 c = m->position[to];
            if (to == from)
                continue;
            reach(w, to, w->distance[from] + vec3_length(vec3_sub(c, a)));
            if (w->settled[other] && other != from)
                reach(w, to,
                      over_edge(a, w->distance[from], m->position[other], w->distance[other], c));
        }
}

static void start(struct wave *w, vec3 point)
{
    const struct geodesic_mesh *m = w->mesh;
    struct relume_reflection_place from;
    for (size_t v = 0; v < m->vertices; v++)
        w->distance[v] = INFINITY;
    if (!geodesic_locate(&from, m, point))
        return;
    for (int k = 0; k < 3; k++) {
        const uint32_t vertex = m->joined[from.vertex[k]];
        reach(w, vertex, vec3_length(vec3_sub(m->position[vertex], from.position)));
    }
}

relume_status geodesic_distances(float *distance, const struct geodesic_mesh *m, vec3 point)
{
    struct wave w = {.mesh = m,
                     .distance = mem_array(m->vertices, sizeof *w.distance),
                     .heap = mem_array(m->vertices, sizeof *w.heap),
                     .place = mem_array(m->vertices, sizeof *w.place),
                     .settled = mem_zeroed(m->vertices, sizeof *w.settled)};
    const bool there = w.distance && w.heap && w.place && w.settled;
    if (there) {
        start(&w, point);
        while (w.waiting)
            settle(&w, take_nearest(&w));
        for (size_t i = 0; i < m->given; i++)
            distance[i] = (float)w.distance[m->joined[i]];
    }
    mem_free(w.distance);
    mem_free(w.heap);
    mem_free(w.place);
    mem_free(w.settled);
    return there ? RELUME_OK : RELUME_ENOMEM;
}
