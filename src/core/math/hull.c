// hull.c - incremental convex hull: every new point removes the faces that it sees and closes the
// horizon with a fan. Lights on common planes (grids, rings) are the rule here, so a face counts as
// seen only when the point is clearly in front of it: points within the tolerance of a plane are
// resolved by a tiny radial shift that depends on the index alone, which makes every input general
// and the result the same on every run.
#include "core/math/hull.h"

#include "core/base/memory.h"
#include "core/math/vec.h"

struct face {
    int corner[3];
    bool alive;
};

struct builder {
    const vec3 *original;
    vec3 *p;  // shifted
    int n;
    struct face *faces;
    int count;
    struct edge {
        int from, to;
    } * horizon;
    int horizon_count;
};

static double volume(const struct builder *b, const int c[3], vec3 d)
{
    const vec3 e1 = vec3_sub(b->p[c[1]], b->p[c[0]]), e2 = vec3_sub(b->p[c[2]], b->p[c[0]]);
    return vec3_dot(vec3_cross(e1, e2), vec3_sub(d, b->p[c[0]]));
}

static bool add_face(struct builder *b, int i, int j, int k)
{
    if (!mem_grow(&b->faces, (size_t)b->count, sizeof *b->faces))
        return false;
    b->faces[b->count++] = (struct face){{i, j, k}, true};
    return true;
}

// An edge seen twice in opposite directions is inside the hole, not on its rim.
static bool toggle_edge(struct builder *b, int from, int to)
{
    for (int i = 0; i < b->horizon_count; i++)
        if (b->horizon[i].from == to && b->horizon[i].to == from) {
            b->horizon[i] = b->horizon[--b->horizon_count];
            return true;
        }
    if (!mem_grow(&b->horizon, (size_t)b->horizon_count, sizeof *b->horizon))
        return false;
    b->horizon[b->horizon_count++] = (struct edge){from, to};
    return true;
}

static bool add_point(struct builder *b, int index)
{
    b->horizon_count = 0;
    for (int f = 0; f < b->count; f++) {
        struct face *face = &b->faces[f];
        if (!face->alive || volume(b, face->corner, b->p[index]) <= 0.0)
            continue;
        face->alive = false;
        for (int e = 0; e < 3; e++)
            if (!toggle_edge(b, face->corner[e], face->corner[(e + 1) % 3]))
                return false;
    }
    for (int e = 0; e < b->horizon_count; e++)
        if (!add_face(b, b->horizon[e].from, b->horizon[e].to, index))
            return false;
    int kept = 0;
    for (int f = 0; f < b->count; f++)
        if (b->faces[f].alive)
            b->faces[kept++] = b->faces[f];
    b->count = kept;
    return true;
}

// Four points that span a clear volume; false when there are none.
static bool find_seed(const struct builder *b, int seed[4])
{
    seed[0] = 0;
    double best = 0.0;
    for (int i = 1; i < b->n; i++) {
        const double d = vec3_length(vec3_sub(b->original[i], b->original[0]));
        if (d > best) {
            best = d;
            seed[1] = i;
        }
    }
    if (best < 1e-6)
        return false;
    const vec3 axis = vec3_sub(b->original[seed[1]], b->original[0]);
    best = 0.0;
    for (int i = 1; i < b->n; i++) {
        const double a = vec3_length(vec3_cross(axis, vec3_sub(b->original[i], b->original[0])));
        if (a > best) {
            best = a;
            seed[2] = i;
        }
    }
    if (best < 1e-6)
        return false;
    const vec3 normal = vec3_cross(axis, vec3_sub(b->original[seed[2]], b->original[0]));
    best = 0.0;
    for (int i = 1; i < b->n; i++) {
        const double v = fabs(vec3_dot(normal, vec3_sub(b->original[i], b->original[0])));
        if (v > best) {
            best = v;
            seed[3] = i;
        }
    }
    return best > 1e-5;
}

static bool is_repeated(const struct builder *b, int index)
{
    for (int i = 0; i < index; i++)
        if (vec3_length(vec3_sub(b->original[i], b->original[index])) < 1e-6)
            return true;
    return false;
}

static relume_status build(struct builder *b)
{
    int s[4];
    if (!find_seed(b, s))
        return RELUME_EUNFIT;
    if (volume(b, s, b->p[s[3]]) > 0.0) {  // the fourth point must lie behind the first face
        const int swap = s[1];
        s[1] = s[2];
        s[2] = swap;
    }
    if (!add_face(b, s[0], s[1], s[2]) || !add_face(b, s[0], s[3], s[1]) ||
        !add_face(b, s[1], s[3], s[2]) || !add_face(b, s[2], s[3], s[0]))
        return RELUME_ENOMEM;
    for (int i = 0; i < b->n; i++) {
        if (i == s[0] || i == s[1] || i == s[2] || i == s[3] || is_repeated(b, i))
            continue;
        if (!add_point(b, i))
            return RELUME_ENOMEM;
    }
    return RELUME_OK;
}

relume_status hull_build(const struct relume_vec3 *points, int n, struct hull_triangle **triangles,
                         int *count)
{
    *triangles = NULL;
    *count = 0;
    struct builder b = {.original = points, .n = n, .p = mem_array((size_t)n, sizeof *b.p)};
    if (!b.p)
        return RELUME_ENOMEM;
    for (int i = 0; i < n; i++) {
        // Distinct shifts of about 1e-7: far above rounding, far below any angle between lights.
        const uint32_t h = ((uint32_t)i + 1u) * 2654435761u;
        b.p[i] = vec3_scale(points[i], 1.0 + 1e-7 * ((h >> 8) / 16777216.0));
    }
    relume_status status = n < 4 ? RELUME_EUNFIT : build(&b);
    if (!status && !(*triangles = mem_array((size_t)b.count, sizeof **triangles)))
        status = RELUME_ENOMEM;
    for (int f = 0; !status && f < b.count; f++)
        (*triangles)[f] = (struct hull_triangle){
            {b.faces[f].corner[0], b.faces[f].corner[1], b.faces[f].corner[2]}};
    *count = status ? 0 : b.count;
    mem_free(b.p);
    mem_free(b.faces);
    mem_free(b.horizon);
    return status;
}

bool hull_weights(const struct relume_vec3 *points, struct hull_triangle t, struct relume_vec3 d,
                  double weights[3])
{
    const vec3 a = points[t.corner[0]], b = points[t.corner[1]], c = points[t.corner[2]];
    const double w0 = vec3_dot(d, vec3_cross(b, c));
    const double w1 = vec3_dot(d, vec3_cross(c, a));
    const double w2 = vec3_dot(d, vec3_cross(a, b));
    const double sum = w0 + w1 + w2;
    if (!(sum > 1e-12))
        return false;
    weights[0] = w0 / sum;
    weights[1] = w1 / sum;
    weights[2] = w2 / sum;
    return true;
}
