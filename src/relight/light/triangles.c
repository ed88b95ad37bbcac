// triangles.c - the triangles of lights over which a basis is linear
//
// A direction's triangle is found by walking: from a triangle near by (one for each cell of an
// octahedral map of the sphere) over the edge behind which it lies farthest. In a Delaunay
// triangulation such a walk ends (De Floriani, Falcidieno, Nagy, Pienovi 1991). Directions become
// shares of the corners by the inverse of the matrix of these.
#include "relight/light/triangles.h"

#include "core/base/memory.h"
#include "format/coder/coding.h"
#include "relight/light/refit.h"

#include <string.h>

enum { SIDE = RELUME_WEIGHT_STARTS, MOST_STEPS = 64 };
// What rounding may leave of an edge.
static const float edge = -1e-6f;
// A sliver so thin that rounding would move shares by more than 1e-3.
static const double steepest = 1e4;

static bool invert(float out[3][3], const vec3 p[3])
{
    const vec3 row[3] = {vec3_cross(p[1], p[2]), vec3_cross(p[2], p[0]), vec3_cross(p[0], p[1])};
    const double volume = vec3_dot(p[0], row[0]);
    bool good = volume > 0.0;
    for (int i = 0; i < 3 && good; i++) {
        const vec3 r = vec3_scale(row[i], 1.0 / volume);
        good = vec3_length(r) < steepest;
        out[i][0] = (float)r.x;
        out[i][1] = (float)r.y;
        out[i][2] = (float)r.z;
    }
    return good;
}

// The triangle that has the edge from a to b in this order.
static int with_edge(const struct relume_coder_triangles *of, int a, int b)
{
    for (int t = 0; t < of->triangles; t++)
        for (int i = 0; i < 3; i++)
            if (of->corner[t][i] == a && of->corner[t][(i + 1) % 3] == b)
                return t;
    return -1;
}

static int nearest_light(const struct relume_coder_triangles *of, int lights, vec3 direction)
{
    int nearest = 0;
    for (int i = 1; i < lights; i++)
        if (vec3_dot(of->point[i], direction) > vec3_dot(of->point[nearest], direction))
            nearest = i;
    return nearest;
}

// Where no corner is a light, far from what was captured, the light nearest to its middle has the
// say.
static bool make_triangle(struct relume_weight_triangle *out,
                          const struct relume_coder_triangles *of, int lights, int t)
{
    const int *c = of->corner[t];
    const vec3 p[3] = {of->point[c[0]], of->point[c[1]], of->point[c[2]]};
    bool any = false, whole = lights > 0;
    for (int i = 0; i < 3; i++) {
        out->node[i] = c[i] < lights ? c[i] : -1;
        out->across[i] = with_edge(of, c[(i + 2) % 3], c[(i + 1) % 3]);
        any |= c[i] < lights;
        whole &= out->across[i] >= 0;
    }
    for (int i = 0; i < 3 && whole && !any; i++)
        out->node[i] = nearest_light(of, lights, vec3_add(p[0], vec3_add(p[1], p[2])));
    return whole && invert(out->inverse, p);
}

static int walk(float share[3], const struct triangles *m, int t, vec3 d)
{
    for (int step = 0;; step++) {
        const struct relume_weight_triangle *at = &m->triangle[t];
        int least = 0;
        for (int i = 0; i < 3; i++) {
            share[i] = at->inverse[i][0] * (float)d.x + at->inverse[i][1] * (float)d.y +
                       at->inverse[i][2] * (float)d.z;
            least = share[i] < share[least] ? i : least;
        }
        if (share[least] >= edge || step == MOST_STEPS)
            return t;
        t = at->across[least];
    }
}

static int cell_of(double at)
{
    const int i = relume_whole((0.5 * at + 0.5) * SIDE);
    return i < 0 ? 0 : i >= SIDE ? SIDE - 1 : i;
}

static int start_cell(vec3 d)
{
    const double sum = fabs(d.x) + fabs(d.y) + fabs(d.z);
    const double x = d.x / sum, y = d.y / sum;
    if (d.z >= 0.0)
        return cell_of(y) * SIDE + cell_of(x);
    return cell_of(copysign(1.0 - fabs(x), y)) * SIDE + cell_of(copysign(1.0 - fabs(y), x));
}

static vec3 cell_middle(int cell)
{
    const double x = 2.0 * (cell % SIDE + 0.5) / SIDE - 1.0;
    const double y = 2.0 * (cell / SIDE + 0.5) / SIDE - 1.0;
    const double z = 1.0 - fabs(x) - fabs(y);
    return vec3_unit(z >= 0.0 ? vec3_of(x, y, z)
                              : vec3_of(copysign(1.0 - fabs(y), x), copysign(1.0 - fabs(x), y), z));
}

relume_status triangles_create(struct triangles **out, const struct relume_coder_triangles *from,
                               int lights)
{
    const struct relume_coder_triangles of = *from;
    *out = NULL;
    if (of.triangles == 0)
        return RELUME_OK;
    struct triangles *m = mem_zeroed(1, sizeof *m);
    if (m)
        m->triangle = mem_array((size_t)of.triangles, sizeof *m->triangle);
    if (!m || !m->triangle) {
        triangles_destroy(&m);
        return RELUME_ENOMEM;
    }
    m->points = of.points;
    m->count = of.triangles;
    m->point = of.point;
    for (int t = 0; t < of.triangles; t++)
        if (!make_triangle(&m->triangle[t], &of, lights, t)) {
            triangles_destroy(&m);
            return RELUME_OK;
        }
    for (int cell = 0, t = 0; cell < SIDE * SIDE; cell++) {
        float share[3];
        m->start[cell] = t = walk(share, m, t, cell_middle(cell));
    }
    *out = m;
    return RELUME_OK;
}

void triangles_destroy(struct triangles **triangles)
{
    if (!*triangles)
        return;
    mem_free((*triangles)->triangle);
    mem_free(*triangles);
    *triangles = NULL;
}

void triangles_find(int node[3], float share[3], const struct triangles *m, vec3 d)
{
    const int t = walk(share, m, m->start[start_cell(d)], d);
    float sum = 0.0f;
    int last = 0;  // of the corners that count
    for (int i = 0; i < 3; i++) {
        node[i] = m->triangle[t].node[i];
        share[i] = node[i] < 0 ? 0.0f : fmaxf(share[i], 0.0f);
        sum += share[i];
        last = node[i] < 0 ? last : i;
    }
    for (int i = 0; i < 3; i++) {
        share[i] = sum > 0.0f ? share[i] / sum : i == last ? 1.0f : 0.0f;
        node[i] = node[i] < 0 ? node[last] : node[i];
    }
}
