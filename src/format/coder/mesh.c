// mesh.c - the captured lights as a triangulated sphere
//
// Lights rarely surround the scene: below a dome there are none. The hull of the lights alone would
// bridge such a gap with long triangles, so the gap gets a helper point, whose weight is dropped
// afterwards: what remains is the value on the border at the same side of the gap.
#include "format/coder/basis.h"

#include "core/base/memory.h"
#include "core/math/hull.h"
#include "format/coder/coding.h"

struct mesh {
    int lights, points;  // points beyond `lights` are helpers
    vec3 *point;
    struct hull_triangle *triangle;
    int triangles;
};

void mesh_destroy(mesh **m)
{
    if (!*m)
        return;
    mem_free((*m)->point);
    mem_free((*m)->triangle);
    mem_free(*m);
    *m = NULL;
}

static int nearest(const vec3 *p, int n, vec3 d)
{
    int best = 0;
    double most = -2.0;
    for (int j = 0; j < n; j++) {
        const double cosine = vec3_dot(d, p[j]);
        best = cosine > most ? j : best;
        most = fmax(cosine, most);
    }
    return best;
}

// Directions among which gaps are looked for: a spiral that starts at the south pole.
enum { CANDIDATES = 2048 };
static void fill_spiral(vec3 spiral[CANDIDATES + 1])
{
    for (int i = 0; i <= CANDIDATES; i++) {
        const double z = 2.0 * i / CANDIDATES - 1.0, r = sqrt(1.0 - z * z);
        const double phi = i * (M_PI * (3.0 - sqrt(5.0)));
        spiral[i] = vec3_of(r * cos(phi), r * sin(phi), z);
    }
}

static vec3 widest_gap(const vec3 spiral[CANDIDATES + 1], const vec3 *p, int n, double *angle)
{
    static const double tie = 0.02, rounding = 1e-9;
    vec3 best = vec3_of(0.0, 0.0, -1.0);
    double enough = 2.0;  // no wider gap where the nearest has a larger cosine
    *angle = 0.0;
    for (int i = 0; i <= CANDIDATES; i++) {
        const vec3 d = spiral[i];
        double most = -2.0;
        for (int j = 0; j < n; j++)
            most = fmax(most, vec3_dot(d, p[j]));
        if (most > enough)
            continue;
        const double gap = vec3_angle(d, p[nearest(p, n, d)]);
        if (gap > *angle + tie) {  // ties go to the pole
            *angle = gap;
            best = d;
            enough = cos(fmin(gap + tie, M_PI)) + rounding;
        }
    }
    return best;
}

vec3 mesh_widest_gap(const vec3 *p, int n, double *angle)
{
    vec3 spiral[CANDIDATES + 1];
    fill_spiral(spiral);
    return widest_gap(spiral, p, n, angle);
}

relume_status mesh_create(mesh **out, const vec3 *lights, int n)
{
    enum { MAX_HELPERS = 6 };
    vec3 spiral[CANDIDATES + 1];
    *out = NULL;
    mesh *m = mem_zeroed(1, sizeof *m);
    if (!m)
        return RELUME_ENOMEM;
    m->lights = m->points = n;
    m->point = mem_array((size_t)n + MAX_HELPERS, sizeof *m->point);
    if (!m->point) {
        mesh_destroy(&m);
        return RELUME_ENOMEM;
    }
    for (int i = 0; i < n; i++)
        m->point[i] = lights[i];
    fill_spiral(spiral);
    while (m->points < n + MAX_HELPERS) {
        double angle;
        const vec3 gap = widest_gap(spiral, m->point, m->points, &angle);
        if (angle < MESH_WIDE)
            break;
        m->point[m->points++] = gap;
    }
    const relume_status status = hull_build(m->point, m->points, &m->triangle, &m->triangles);
    if (status == RELUME_ENOMEM) {
        mesh_destroy(&m);
        return status;
    }
    *out = m;  // lights that span no volume leave no triangles: the nearest light answers
    return RELUME_OK;
}

struct relume_coder_triangles mesh_triangles(const mesh *m)
{
    const struct hull_triangle *first = m->triangle;
    return (struct relume_coder_triangles){
        .points = m->points,
        .triangles = m->triangles,
        .point = m->point,
        .corner = first ? &first->corner : NULL,
    };
}

static struct blend nearest_light(const mesh *m, vec3 d)
{
    int best = 0;
    for (int i = 1; i < m->lights; i++)
        if (vec3_dot(d, m->point[i]) > vec3_dot(d, m->point[best]))
            best = i;
    return (struct blend){1, {best}, {1.0}};
}

struct blend mesh_blend(const mesh *m, vec3 d)
{
    double best_min = -1e-6, best[3];
    const struct hull_triangle *hit = NULL;
    for (int t = 0; t < m->triangles; t++) {
        double w[3];
        if (!hull_weights(m->point, m->triangle[t], d, w))
            continue;
        const double least = fmin(w[0], fmin(w[1], w[2]));
        if (least > best_min) {
            best_min = least;
            hit = &m->triangle[t];
            for (int i = 0; i < 3; i++)
                best[i] = fmax(w[i], 0.0);
        }
        if (best_min >= 0.0)
            break;
    }
    struct blend blend = {0};
    double sum = 0.0;
    for (int i = 0; hit && i < 3; i++)
        if (hit->corner[i] < m->lights && best[i] > 0.0) {
            blend.light[blend.count] = hit->corner[i];
            blend.weight[blend.count++] = best[i];
            sum += best[i];
        }
    if (sum < 1e-9)
        return nearest_light(m, d);
    for (int i = 0; i < blend.count; i++)
        blend.weight[i] /= sum;
    return blend;
}
