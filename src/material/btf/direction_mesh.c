// direction_mesh.c - three measured directions for any direction: the convex hull of the set and
// the nadir
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/hull.h"
#include "core/math/vec.h"
#include "material/btf/values.h"

#include <relume/material/btf.h>
#include <string.h>

struct relume_direction_mesh {
    vec3 *point;  // [n + 1]; the last is the nadir, which closes the hull below the rim
    int n;
    struct hull_triangle *triangle;
    vec3 (*across)[3];  // [triangles]: the weight of corner c grows along across[c]
    int (*beside)[3];   // [triangles]: the one across the edge that faces corner c
    int *start;         // [CELLS * CELLS]: where to look first, by x and y
    int triangles;
};

static const double LOWEST = 1e-3;   // z of a direction that can be measured
static const double NOTHING = 1e-9;  // weights below are rounding
enum { CELLS = 16, MOST_STEPS = 24 };

static relume_status check(const struct relume_vec3 *d, int n, const struct relume_log *log)
{
    if (n < 3)
        return log_fail(log, RELUME_EUNFIT, "directions: expected 3 or more; found %d", n);
    for (int i = 0; i < n; i++)
        if (!(d[i].z >= LOWEST) || !(fabs(vec3_length(d[i]) - 1.0) < 1e-6))
            return log_fail(log, RELUME_EUNFIT,
                            "direction %d: expected a unit vector with z > 0; found %g, %g, %g", i,
                            d[i].x, d[i].y, d[i].z);
    return RELUME_OK;
}

static relume_status triangulate(relume_direction_mesh *d, const struct relume_vec3 *directions)
{
    d->point = mem_array((size_t)d->n + 1, sizeof *d->point);
    if (!d->point)
        return RELUME_ENOMEM;
    memcpy(d->point, directions, (size_t)d->n * sizeof *d->point);
    d->point[d->n] = vec3_of(0.0, 0.0, -1.0);
    const relume_status status = hull_build(d->point, d->n + 1, &d->triangle, &d->triangles);
    if (status)
        return status;
    d->across = mem_array((size_t)d->triangles, sizeof *d->across);
    for (int i = 0; d->across && i < d->triangles; i++)
        for (int c = 0; c < 3; c++)
            d->across[i][c] = vec3_cross(d->point[d->triangle[i].corner[(c + 1) % 3]],
                                         d->point[d->triangle[i].corner[(c + 2) % 3]]);
    return d->across ? RELUME_OK : RELUME_ENOMEM;
}

// The triangle that has the edge from `a` to `b` the other way round.
static int find_beside(const relume_direction_mesh *d, int a, int b)
{
    for (int i = 0; i < d->triangles; i++)
        for (int c = 0; c < 3; c++)
            if (d->triangle[i].corner[c] == b && d->triangle[i].corner[(c + 1) % 3] == a)
                return i;
    return 0;
}

static int cell_of(vec3 d)
{
    const int x = (int)fmin(fmax(0.5 * (d.x + 1.0), 0.0) * CELLS, CELLS - 1);
    const int y = (int)fmin(fmax(0.5 * (d.y + 1.0), 0.0) * CELLS, CELLS - 1);
    return y * CELLS + x;
}

// Barycentric weights of the ray's hit; false when the triangle faces away.
static bool weigh(const vec3 across[3], vec3 d, double weight[3])
{
    double sum = 0.0;
    for (int c = 0; c < 3; c++)
        sum += weight[c] = vec3_dot(d, across[c]);
    if (!(sum > 1e-12))
        return false;
    for (int c = 0; c < 3; c++)
        weight[c] /= sum;
    return true;
}

// The triangle that `d` points into: the one whose smallest weight is largest, for rays through
// edges.
static int search(const relume_direction_mesh *mesh, vec3 d, double weight[3])
{
    int best = 0;
    double most = -INFINITY;
    for (int i = 0; i < mesh->triangles && most < NOTHING; i++) {
        double w[3];
        if (!weigh(mesh->across[i], d, w))
            continue;
        const double least = fmin(w[0], fmin(w[1], w[2]));
        if (least > most) {
            most = least;
            best = i;
            memcpy(weight, w, sizeof w);
        }
    }
    return best;
}

// The same from the triangle at the middle of the cell, by the edge that `d` lies behind; what the
// ray only grazes is searched for, so that the answer does not depend on the way.
static const struct hull_triangle *find(const relume_direction_mesh *mesh, vec3 d, double weight[3])
{
    int i = mesh->start[cell_of(d)];
    for (int step = 0; step < MOST_STEPS && weigh(mesh->across[i], d, weight); step++) {
        const int least = weight[0] < weight[1]   ? weight[0] < weight[2] ? 0 : 2
                          : weight[1] < weight[2] ? 1
                                                  : 2;
        if (weight[least] >= NOTHING)
            return &mesh->triangle[i];
        if (weight[least] > -NOTHING)
            break;
        i = mesh->beside[i][least];
    }
    return &mesh->triangle[search(mesh, d, weight)];
}

static relume_status prepare_find(relume_direction_mesh *d)
{
    d->beside = mem_array((size_t)d->triangles, sizeof *d->beside);
    d->start = mem_array((size_t)CELLS * CELLS, sizeof *d->start);
    if (!d->beside || !d->start)
        return RELUME_ENOMEM;
    for (int i = 0; i < d->triangles; i++)
        for (int c = 0; c < 3; c++)
            d->beside[i][c] = find_beside(d, d->triangle[i].corner[(c + 1) % 3],
                                          d->triangle[i].corner[(c + 2) % 3]);
    for (int i = 0; i < CELLS * CELLS; i++) {
        double unused[3] = {0.0, 0.0, 0.0};
        const double x = 2.0 * (i % CELLS + 0.5) / CELLS - 1.0;
        const double y = 2.0 * (i / CELLS + 0.5) / CELLS - 1.0;
        const double z = sqrt(fmax(1.0 - x * x - y * y, 0.0));
        d->start[i] = search(d, vec3_unit(vec3_of(x, y, z)), unused);
    }
    return RELUME_OK;
}

relume_status relume_direction_mesh_create(relume_direction_mesh **out,
                                           const struct relume_vec3 *directions, int n,
                                           const struct relume_log *log)
{
    *out = NULL;
    relume_status status = check(directions, n, log);
    if (status)
        return status;
    relume_direction_mesh *d = mem_zeroed(1, sizeof *d);
    if (!d)
        return RELUME_ENOMEM;
    d->n = n;
    status = triangulate(d, directions);
    if (status == RELUME_EUNFIT)
        log_fail(log, status, "directions: expected some not on one great circle");
    if (!status)
        status = prepare_find(d);
    if (status)
        relume_direction_mesh_destroy(&d);
    *out = d;
    return status;
}

void relume_direction_mesh_destroy(relume_direction_mesh **mesh)
{
    if (*mesh) {
        mem_free((*mesh)->point);
        mem_free((*mesh)->triangle);
        mem_free((*mesh)->across);
        mem_free((*mesh)->beside);
        mem_free((*mesh)->start);
    }
    mem_free(*mesh);
    *mesh = NULL;
}

const int (*relume_direction_mesh_triangles(const relume_direction_mesh *mesh, int *n))[3]
{
    *n = mesh->triangles;
    return (const int(*)[3])mesh->triangle;
}

static void keep_real(struct relume_direction_blend *b, const relume_direction_mesh *mesh,
                      const struct hull_triangle *t, const double weight[3])
{
    for (int c = 0; c < 3; c++)
        if (t->corner[c] != mesh->n && weight[c] > NOTHING) {
            b->index[b->count] = t->corner[c];
            b->weight[b->count++] = weight[c];
        }
    for (int c = 0; c < 3 && b->count == 0; c++)  // straight down: any of the rim will do
        if (t->corner[c] != mesh->n) {
            b->index[b->count] = t->corner[c];
            b->weight[b->count++] = 1.0;
        }
}

static bool has_nadir(const relume_direction_mesh *mesh, const struct hull_triangle *t)
{
    return t->corner[0] == mesh->n || t->corner[1] == mesh->n || t->corner[2] == mesh->n;
}

struct relume_direction_blend relume_direction_mesh_at(const relume_direction_mesh *mesh,
                                                       struct relume_vec3 d)
{
    struct relume_direction_blend b = {.direction = d, .rim = 1.0, .length = 1.0};
    double weight[3] = {1.0, 0.0, 0.0}, sum = 0.0;
    vec3 middle = {0.0, 0.0, 0.0};
    const struct hull_triangle *t = find(mesh, d, weight);
    keep_real(&b, mesh, t, weight);
    for (int i = 0; i < b.count; i++)
        sum += b.weight[i];
    for (int i = 0; i < b.count; i++) {
        b.weight[i] /= sum;
        middle = vec3_along(middle, mesh->point[b.index[i]], b.weight[i]);
    }
    if (b.count == 1)
        middle = mesh->point[b.index[0]];
    b.length = vec3_length(middle);
    if (b.count == 1 || has_nadir(mesh, t)) {
        b.direction = vec3_unit(middle);
        b.rim = has_nadir(mesh, t) ? fmin(fmax(d.z, 0.0) / b.direction.z, 1.0) : 1.0;
    }
    return b;
}
