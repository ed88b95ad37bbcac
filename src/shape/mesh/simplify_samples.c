// simplify_samples.c - how far the new surface is from the vertices that have gone, and from how
// far away that is seen
//
// Every vertex that goes is remembered by the triangle that it lies on. A move sees those of the
// triangles around, each at the new triangle that it is nearest to: its distance; how far its place
// in the texture slides; its colour against that of the new surface there; and, of all around the
// target together, their normals (simplify_look.c). Guthe 2008, section 10.1: both against the mesh
// before and, since these are the vertices of the original, against that.
#include "image/compare/jnd.h"
#include "shape/mesh/simplify.h"

#include <math.h>
#include <relume/image.h>
#include <relume/image/jnd.h>
#include <string.h>

#define PI 3.14159265358979323846
// New triangles may not turn by more than this against the old one; cosine of 75 degrees.
#define LEAST_FACING 0.26
// A vertex lies on another side of a crease where normals differ by more.
#define OTHER_SIDE 0.5

// ---------------------------------------------------------------- new triangles

struct facet {
    uint32_t triangle, vertex[3];
    vec3 p[3];
};

static double area_of(const struct facet *f)
{
    return 0.5 * vec3_length(vec3_cross(vec3_sub(f->p[1], f->p[0]), vec3_sub(f->p[2], f->p[0])));
}

// The triangles that stay; false when one turns over or loses its area.
static bool find_facets(const struct simplify *s, const struct fan *fan, uint32_t target,
                        const struct moves *moves, struct facet *facet, int *count)
{
    *count = 0;
    for (int i = 0; i < fan->triangles; i++) {
        if (triangle_has(&s->connect, fan->triangle[i], target))
            continue;
        struct facet *f = &facet[(*count)++];
        const uint32_t *old = s->connect.triangle[fan->triangle[i]];
        vec3 was[3];
        f->triangle = fan->triangle[i];
        for (int k = 0; k < 3; k++) {
            f->vertex[k] = moved(moves, old[k]);
            f->p[k] = place(s, f->vertex[k]);
            was[k] = place(s, old[k]);
        }
        const vec3 before = vec3_cross(vec3_sub(was[1], was[0]), vec3_sub(was[2], was[0]));
        const vec3 now = vec3_cross(vec3_sub(f->p[1], f->p[0]), vec3_sub(f->p[2], f->p[0]));
        const double size = vec3_length(now) * vec3_length(before);
        if (!(vec3_length(now) > 1e-15) ||
            (size > 0.0 && vec3_dot(before, now) < LEAST_FACING * size))
            return false;
    }
    return *count > 0;
}

// Ericson 2005, 5.1.5.
void nearest_place(const vec3 t[3], vec3 p, double w[3])
{
    const vec3 ab = vec3_sub(t[1], t[0]), ac = vec3_sub(t[2], t[0]), ap = vec3_sub(p, t[0]);
    const double d1 = vec3_dot(ab, ap), d2 = vec3_dot(ac, ap);
    const vec3 bp = vec3_sub(p, t[1]), cp = vec3_sub(p, t[2]);
    const double d3 = vec3_dot(ab, bp), d4 = vec3_dot(ac, bp);
    const double d5 = vec3_dot(ab, cp), d6 = vec3_dot(ac, cp);
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    double v = 0.0, u = 0.0;  // of the second and third corner
    if (d1 <= 0.0 && d2 <= 0.0)
        v = u = 0.0;
    else if (d3 >= 0.0 && d4 <= d3)
        v = 1.0;
    else if (d6 >= 0.0 && d5 <= d6)
        u = 1.0;
    else if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0)
        v = d1 / (d1 - d3);
    else if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0)
        u = d2 / (d2 - d6);
    else if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        u = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        v = 1.0 - u;
    } else {
        v = vb / (va + vb + vc);
        u = vc / (va + vb + vc);
    }
    w[0] = 1.0 - v - u;
    w[1] = v;
    w[2] = u;
}

// ---------------------------------------------------------------- the original

// Of the original. The mean square of how fast normals turn along edges is (k1^2 + k2^2) / 2.
static void add_edge(struct simplify *s, uint32_t a, uint32_t b, float *edges)
{
    const uint32_t at = s->connect.point[a];
    const double length = vec3_length(vec3_sub(place(s, a), place(s, b)));
    if (!(length > 0.0))
        return;
    const double turn = vec3_length(vec3_sub(normal_of(s, a), normal_of(s, b))) / length;
    s->bend[at] += (float)(turn * turn);
    s->spacing[at] += (float)length;
    edges[at] += 1.0f;
}

// How much of the surface each vertex stands for, how far apart they are, and how it bends.
static relume_status find_areas(struct simplify *s)
{
    float *edges = mem_zeroed(s->connect.points, sizeof *edges);
    if (!edges)
        return RELUME_ENOMEM;
    for (size_t t = 0; t < s->mesh->triangle_count; t++) {
        struct facet f;
        memcpy(f.vertex, s->mesh->triangle[t], sizeof f.vertex);
        if (!connect_has_area(&s->connect, f.vertex))
            continue;
        for (int k = 0; k < 3; k++)
            f.p[k] = place(s, f.vertex[k]);
        for (int k = 0; k < 3; k++) {
            s->area[f.vertex[k]] += (float)(area_of(&f) / 3.0);
            add_edge(s, f.vertex[k], f.vertex[(k + 1) % 3], edges);
            add_edge(s, f.vertex[k], f.vertex[(k + 2) % 3], edges);
        }
    }
    for (uint32_t p = 0; p < s->connect.points; p++)
        if (edges[p] > 0.0f) {
            s->bend[p] = sqrtf(2.0f * s->bend[p] / edges[p]);
            s->spacing[p] /= edges[p];
        }
    mem_free(edges);
    return RELUME_OK;
}

relume_status samples_create(struct simplify *s, float (*shown)[3])
{
    s->bend = mem_zeroed(s->connect.points, sizeof *s->bend);
    s->area = mem_zeroed(s->connect.vertices, sizeof *s->area);
    s->shown = mem_copy(shown ? shown : s->mesh->normal, s->connect.vertices, sizeof *s->shown);
    s->spacing = mem_zeroed(s->connect.points, sizeof *s->spacing);
    s->sample_first = mem_array(s->connect.triangles, sizeof *s->sample_first);
    s->sample_next = mem_array(s->connect.vertices, sizeof *s->sample_next);
    if (!s->bend || !s->area || !s->shown || !s->spacing || !s->sample_first || !s->sample_next)
        return RELUME_ENOMEM;
    memset(s->sample_first, 0xff, s->connect.triangles * sizeof *s->sample_first);
    return find_areas(s);
}

// ---------------------------------------------------------------- errors

static double slide_of(const struct simplify *s, uint32_t vertex, const struct facet *f,
                       const double w[3])
{
    double sum = 0.0;
    for (int k = 0; s->mesh->texture && k < 2; k++) {
        double d = -(double)s->mesh->texture[vertex][k];
        for (int i = 0; i < 3; i++)
            d += w[i] * (double)s->mesh->texture[f->vertex[i]][k];
        sum += d * d;
    }
    return s->slide * sqrt(sum);
}

// From how far a colour is seen to differ; its pattern is as fine as its vertices lie.
static double colour_distance(const struct simplify *s, uint32_t vertex, const struct facet *f,
                              const double w[3])
{
    double was[3], now[3], a[RELUME_OPPONENTS], b[RELUME_OPPONENTS], most = 0.0;
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    if (!s->mesh->colour)
        return 0.0;
    for (int k = 0; k < 3; k++) {
        double code = 0.0;
        for (int i = 0; i < 3; i++)
            code += w[i] * s->mesh->colour[f->vertex[i]][k] / 255.0;
        was[k] = (double)relume_transfer_decode(srgb, s->mesh->colour[vertex][k] / 255.0f);
        now[k] = (double)relume_transfer_decode(srgb, (float)code);
    }
    relume_jnd_opponent(a, was, s->white);
    relume_jnd_opponent(b, now, s->white);
    for (int c = 0; c < RELUME_OPPONENTS; c++) {
        const double difference = fabs(a[c] - b[c]);
        if (difference > 0.0)
            most = fmax(most, relume_jnd_finest((enum relume_opponent)c, s->jnd / difference));
    }
    // cycles per degree = distance * pi / 180 / (2 spacing)
    return most * 360.0 / PI * (double)s->spacing[s->connect.point[vertex]];
}

static bool land(struct samples *to, uint32_t vertex, const struct facet *f, const double w[3])
{
    if (to->count == to->capacity) {
        const size_t capacity = to->capacity ? 2 * to->capacity : 64;
        struct landing *more = mem_resize(to->landing, capacity, sizeof *more);
        if (!more)
            return false;
        to->landing = more;
        to->capacity = capacity;
    }
    struct landing *l = &to->landing[to->count++];
    *l = (struct landing){.vertex = vertex, .triangle = f->triangle};
    for (int k = 0; k < 3; k++) {
        l->corner[k] = f->vertex[k];
        l->weight[k] = (float)w[k];
    }
    return true;
}

// The square of how far the original's normal is from the one that is shown there.
static double turn_of(const struct simplify *s, uint32_t vertex, const struct facet *f,
                      const double w[3])
{
    vec3 d = vec3_scale(normal_of(s, vertex), -1.0);
    for (int i = 0; i < 3; i++)
        d = vec3_along(d, shown_of(s, f->vertex[i]), w[i]);
    return vec3_dot(d, d);
}

// Where a vertex lies on the new triangles: nearest, of those that face as it does.
static bool try_vertex(const struct simplify *s, struct samples *to, struct error *error,
                       uint32_t vertex, const struct facet *facet, int count)
{
    const vec3 p = place(s, vertex);
    double least = INFINITY, best[3] = {1.0, 0.0, 0.0}, length = 0.0;
    const struct facet *at = facet;
    for (int i = 0; i < count; i++) {
        const struct facet *f = &facet[i];
        double w[3];
        nearest_place(f->p, p, w);
        vec3 there = vec3_scale(f->p[0], w[0]);
        there = vec3_along(vec3_along(there, f->p[1], w[1]), f->p[2], w[2]);
        const double off = vec3_length(vec3_sub(p, there));
        if (off >= least)
            continue;
        const double far = fmax(off, slide_of(s, vertex, f, w));
        const double cost = far + fmax(sqrt(turn_of(s, vertex, f, w)) - OTHER_SIDE, 0.0);
        if (cost < least) {
            least = cost;
            length = far;
            memcpy(best, w, sizeof best);
            at = f;
        }
    }
    error->length = fmax(error->length, length);
    error->distance = fmax(error->distance, colour_distance(s, vertex, at, best));
    return land(to, vertex, at, best);
}

// Whether the new triangles are near the original, too: at their middles and those of their new
// edges.
static bool stay_near(const struct simplify *s, uint32_t target, const struct facet *facet,
                      int count)
{
    for (int i = 0; i < count && s->near.radius > 0.0; i++) {
        const vec3 *p = facet[i].p;
        int k = 0;
        while (k < 2 && s->connect.point[facet[i].vertex[k]] != target)
            k++;
        const vec3 next = vec3_add(p[k], p[(k + 1) % 3]), last = vec3_add(p[k], p[(k + 2) % 3]);
        const vec3 all = vec3_add(next, p[(k + 2) % 3]);
        if (!near_is(&s->near, s, vec3_scale(all, 1.0 / 3.0)) ||
            !near_is(&s->near, s, vec3_scale(next, 0.5)) ||
            !near_is(&s->near, s, vec3_scale(last, 0.5)))
            return false;
    }
    return true;
}

static bool is_of(const struct fan *fan, uint32_t triangle)
{
    int i = 0;
    while (i < fan->triangles && fan->triangle[i] != triangle)
        i++;
    return i < fan->triangles;
}

// What lies on the triangles of a fan that are not of another.
static bool list_others(const struct simplify *s, struct samples *to, const struct fan *fan,
                        const struct fan *other)
{
    for (int i = 0; i < fan->triangles; i++) {
        struct facet f = {.triangle = fan->triangle[i]};
        if (is_of(other, f.triangle))
            continue;
        for (int k = 0; k < 3; k++) {
            f.vertex[k] = s->connect.triangle[f.triangle][k];
            f.p[k] = place(s, f.vertex[k]);
        }
        to->area += area_of(&f);
        for (uint32_t v = s->sample_first[f.triangle]; v != NOTHING; v = s->sample_next[v]) {
            double w[3];
            nearest_place(f.p, place(s, v), w);
            if (!land(to, v, &f, w))
                return false;
        }
    }
    return true;
}

static void list_target(const struct simplify *s, struct samples *to, uint32_t target,
                        const uint32_t vertex[3])
{
    for (int k = 0; k < 3; k++)
        if (s->connect.point[vertex[k]] == target)
            look_at_vertex(s, to, vertex[k]);
}

// All that lies around the target: what the move has landed there, and what stays.
static bool look_around(const struct simplify *s, struct samples *to, uint32_t target,
                        const struct facet *facet, int count, const struct fan *fan,
                        const struct fan *there)
{
    to->own = to->count;
    to->area = 0.0;
    to->fitted = 0;
    for (int i = 0; i < count; i++) {
        to->area += area_of(&facet[i]);
        list_target(s, to, target, facet[i].vertex);
    }
    for (int i = 0; i < there->triangles; i++)
        list_target(s, to, target, s->connect.triangle[there->triangle[i]]);
    if (!list_others(s, to, there, fan))
        return false;
    look_begin(to);
    if (s->fits && !(s->stays && s->stays[target]))
        look_fit(s, to);
    return true;
}

// Vertices that have gone and those that go. False when memory is short; gives up beyond `most`.
static bool try_vertices(const struct simplify *s, struct samples *to, struct error *error,
                         const struct facet *facet, int count, const struct fan *fan,
                         const struct moves *moves, const struct error *most)
{
    for (int i = 0; i < moves->count; i++)
        if (!try_vertex(s, to, error, moves->from[i], facet, count))
            return false;
    for (int i = 0; i < fan->triangles; i++)
        for (uint32_t v = s->sample_first[fan->triangle[i]]; v != NOTHING; v = s->sample_next[v]) {
            if (error->length > most->length || error->distance > most->distance)
                return true;
            if (!try_vertex(s, to, error, v, facet, count))
                return false;
        }
    return true;
}

bool samples_try(const struct simplify *s, struct samples *to, struct error *error,
                 const struct fan *fan, const struct fan *there, uint32_t target,
                 const struct moves *moves, const struct error *most)
{
    struct facet facet[FAN];
    int count;
    to->count = to->own = 0;
    to->fitted = 0;
    *error = (struct error){INFINITY, INFINITY};
    if (!find_facets(s, fan, target, moves, facet, &count))
        return true;
    *error = (struct error){0.0, 0.0};
    if (!s->tested)
        return true;
    if (!try_vertices(s, to, error, facet, count, fan, moves, most))
        return false;
    if (error->length > most->length || error->distance > most->distance)
        return true;
    if (!look_around(s, to, target, facet, count, fan, there))
        return false;
    error->distance = fmax(error->distance, look_distance(s, to));
    if (error->distance <= most->distance && !stay_near(s, target, facet, count))
        error->length = INFINITY;
    return true;
}

static void keep_normals(struct simplify *s, const struct samples *to)
{
    for (int i = 0; i < to->fitted; i++)
        memcpy(s->shown[to->fit[i].vertex], to->fit[i].normal, sizeof *s->shown);
}

void samples_move(struct simplify *s, const struct samples *to, const struct fan *fan)
{
    if (!s->tested)
        return;
    for (int i = 0; i < fan->triangles; i++)
        s->sample_first[fan->triangle[i]] = NOTHING;
    for (size_t i = 0; i < to->own; i++) {
        uint32_t *first = &s->sample_first[to->landing[i].triangle];
        s->sample_next[to->landing[i].vertex] = *first;
        *first = to->landing[i].vertex;
    }
    keep_normals(s, to);
}

bool samples_refit(struct simplify *s, struct samples *to, const struct fan *fan, uint32_t point)
{
    const struct fan none = {.triangles = 0};
    to->count = 0;
    if (!look_around(s, to, point, NULL, 0, &none, fan))
        return false;
    keep_normals(s, to);
    return true;
}
