// dome.c - three measured directions for any direction: the convex hull of the set and the nadir
#include "base/log.h"
#include "base/memory.h"
#include "math/hull.h"
#include "math/vec.h"

#include <relume/btf.h>
#include <string.h>

struct relume_dome {
    vec3 *point;  // [n + 1]; the last is the nadir, which closes the hull below the rim
    int n;
    struct hull_triangle *triangle;
    int triangles;
};

static const double LOWEST = 1e-3;     // z of a direction that can be measured
static const double NOTHING = 1e-9;    // weights below are rounding

static relume_status check(const struct relume_vec3 *d, int n, const struct relume_log *log)
{
    if (n < 3)
        return log_fail(log, RELUME_EDATA, "directions: expected 3 or more; found %d", n);
    for (int i = 0; i < n; i++)
        if (!(d[i].z >= LOWEST) || !(fabs(vec3_length(d[i]) - 1.0) < 1e-6))
            return log_fail(log, RELUME_EDATA,
                            "direction %d: expected a unit vector with z > 0; found %g, %g, %g", i,
                            d[i].x, d[i].y, d[i].z);
    return RELUME_OK;
}

relume_status relume_dome_create(relume_dome **out, const struct relume_vec3 *directions, int n,
                                 const struct relume_log *log)
{
    *out = NULL;
    relume_status status = check(directions, n, log);
    if (status)
        return status;
    relume_dome *d = mem_zeroed(1, sizeof *d);
    if (!d)
        return RELUME_ENOMEM;
    d->n = n;
    d->point = mem_array((size_t)n + 1, sizeof *d->point);
    status = d->point ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        memcpy(d->point, directions, (size_t)n * sizeof *d->point);
        d->point[n] = vec3_of(0.0, 0.0, -1.0);
        status = hull_build(d->point, n + 1, &d->triangle, &d->triangles);
    }
    if (status == RELUME_EDATA)
        log_fail(log, status, "directions: expected some not on one great circle");
    if (status)
        relume_dome_destroy(&d);
    *out = d;
    return status;
}

void relume_dome_destroy(relume_dome **dome)
{
    if (*dome) {
        free((*dome)->point);
        free((*dome)->triangle);
    }
    free(*dome);
    *dome = NULL;
}

static double least_of(const double w[3])
{
    return fmin(w[0], fmin(w[1], w[2]));
}

// The triangle that `d` meets: the one whose smallest weight is largest, for rays through edges.
static const struct hull_triangle *find(const relume_dome *dome, vec3 d, double weight[3])
{
    const struct hull_triangle *best = &dome->triangle[0];
    double most = -INFINITY;
    for (int i = 0; i < dome->triangles; i++) {
        double w[3];
        if (!hull_weights(dome->point, dome->triangle[i], d, w) || !(least_of(w) > most))
            continue;
        most = least_of(w);
        best = &dome->triangle[i];
        memcpy(weight, w, sizeof w);
    }
    return best;
}

static void keep_real(struct relume_dome_blend *b, const relume_dome *dome,
                      const struct hull_triangle *t, const double weight[3])
{
    for (int c = 0; c < 3; c++)
        if (t->corner[c] != dome->n && weight[c] > NOTHING) {
            b->index[b->count] = t->corner[c];
            b->weight[b->count++] = weight[c];
        }
    for (int c = 0; c < 3 && b->count == 0; c++)  // straight down: any of the rim will do
        if (t->corner[c] != dome->n) {
            b->index[b->count] = t->corner[c];
            b->weight[b->count++] = 1.0;
        }
}

static bool has_nadir(const relume_dome *dome, const struct hull_triangle *t)
{
    return t->corner[0] == dome->n || t->corner[1] == dome->n || t->corner[2] == dome->n;
}

struct relume_dome_blend relume_dome_at(const relume_dome *dome, struct relume_vec3 d)
{
    struct relume_dome_blend b = {.direction = d, .rim = 1.0};
    double weight[3] = {1.0, 0.0, 0.0}, sum = 0.0;
    vec3 middle = {0.0, 0.0, 0.0};
    const struct hull_triangle *t = find(dome, d, weight);
    keep_real(&b, dome, t, weight);
    for (int i = 0; i < b.count; i++)
        sum += b.weight[i];
    for (int i = 0; i < b.count; i++) {
        b.weight[i] /= sum;
        middle = vec3_add(middle, vec3_scale(dome->point[b.index[i]], b.weight[i]));
    }
    if (b.count == 1)
        middle = dome->point[b.index[0]];
    if (b.count == 1 || has_nadir(dome, t)) {
        b.direction = vec3_unit(middle);
        b.rim = has_nadir(dome, t) ? fmin(fmax(d.z, 0.0) / b.direction.z, 1.0) : 1.0;
    }
    return b;
}
