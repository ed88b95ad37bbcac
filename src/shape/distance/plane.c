// plane.c - planes through triangles, by sums that add up
#include "shape/distance/plane.h"

#include "core/base/log.h"
#include "core/base/memory.h"

#include <math.h>

void soup_free(struct soup *s)
{
    mem_free(s->corner);
    mem_free(s->normal);
    mem_free(s->area);
    mem_free(s->number);
    *s = (struct soup){.corner = NULL};
}

static vec3 place(const struct relume_mesh *m, uint32_t vertex)
{
    const float *p = m->position[vertex];
    return vec3_of((double)p[0], (double)p[1], (double)p[2]);
}

// The box about all triangles.
static relume_status find_box(struct soup *s, const struct relume_mesh *m)
{
    struct range box[3] = {range_none, range_none, range_none};
    for (size_t i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            if (m->triangle[i][k] >= m->vertex_count)
                return RELUME_EINVAL;
            const float *p = m->position[m->triangle[i][k]];
            for (int c = 0; c < 3; c++) {
                if (!isfinite(p[c]))
                    return RELUME_EINVAL;
                range_add(&box[c], (double)p[c]);
            }
        }
    s->middle = vec3_of(0.5 * (box[0].low + box[0].high), 0.5 * (box[1].low + box[1].high),
                        0.5 * (box[2].low + box[2].high));
    for (int c = 0; c < 3; c++)
        s->longest = fmax(s->longest, box[c].high - box[c].low);
    return RELUME_OK;
}

static void add(struct soup *s, const struct relume_mesh *m, size_t triangle)
{
    vec3 *p = s->corner[s->count];
    for (int k = 0; k < 3; k++)
        p[k] = vec3_sub(place(m, m->triangle[triangle][k]), s->middle);
    const vec3 across = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
    const double twice = vec3_length(across);
    // what is thinner than a float's rounding has no normal to go by
    if (!(twice > 1e-13 * s->longest * s->longest))
        return;
    s->normal[s->count] = vec3_scale(across, 1.0 / twice);
    s->area[s->count] = 0.5 * twice;
    s->number[s->count++] = (uint32_t)triangle;
}

relume_status soup_create(struct soup *out, const struct relume_mesh *mesh,
                          const struct relume_log *log)
{
    const size_t n = mesh->triangle_count;
    *out = (struct soup){.corner = NULL};
    if (find_box(out, mesh))
        return log_fail(log, RELUME_EINVAL,
                        "a triangle of vertices that are not there, or are not finite");
    out->corner = mem_array(n, sizeof *out->corner);
    out->normal = mem_array(n, sizeof *out->normal);
    out->area = mem_array(n, sizeof *out->area);
    out->number = mem_array(n, sizeof *out->number);
    const bool good = out->corner && out->normal && out->area && out->number;
    for (size_t i = 0; good && i < n; i++)
        add(out, mesh, i);
    const relume_status status = !good        ? RELUME_ENOMEM
                                 : out->count ? RELUME_OK
                                              : log_fail(log, RELUME_EUNFIT,
                                                         "the mesh has no surface: no triangle has "
                                                         "an extent");
    if (status)
        soup_free(out);
    return status;
}

// ---------------------------------------------------------------- sums

static void add_square(double square[6], vec3 p, double weight)
{
    square[0] += weight * p.x * p.x, square[1] += weight * p.x * p.y;
    square[2] += weight * p.x * p.z, square[3] += weight * p.y * p.y;
    square[4] += weight * p.y * p.z, square[5] += weight * p.z * p.z;
}

struct moments moments_of(const struct soup *s, size_t triangle)
{
    const vec3 *p = s->corner[triangle];
    const vec3 sum = vec3_add(vec3_add(p[0], p[1]), p[2]);
    const double area = s->area[triangle];
    struct moments m = {.area = area,
                        .first = vec3_scale(sum, area / 3.0),
                        .normal = vec3_scale(s->normal[triangle], area)};
    for (int k = 0; k < 3; k++)
        add_square(m.square, p[k], area / 12.0);
    add_square(m.square, sum, area / 12.0);
    return m;
}

struct moments moments_sum(const struct moments *a, const struct moments *b)
{
    struct moments m = {.area = a->area + b->area,
                        .first = vec3_add(a->first, b->first),
                        .normal = vec3_add(a->normal, b->normal)};
    for (int i = 0; i < 6; i++)
        m.square[i] = a->square[i] + b->square[i];
    return m;
}

// One rotation of Jacobi's method over axes p and q of a symmetric matrix.
static void rotate(double m[3][3], double v[3][3], int p, int q)
{
    if (m[p][q] == 0.0)
        return;
    const double half = 0.5 * (m[q][q] - m[p][p]) / m[p][q];
    const double t = copysign(1.0, half) / (fabs(half) + sqrt(half * half + 1.0));
    const double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
    for (int k = 0; k < 3; k++) {
        const double a = m[k][p], b = m[k][q];
        m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
    }
    for (int k = 0; k < 3; k++) {
        const double a = m[p][k], b = m[q][k];
        m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
        const double x = v[k][p], y = v[k][q];
        v[k][p] = c * x - s * y, v[k][q] = s * x + c * y;
    }
}

struct plane plane_of(vec3 normal, double offset)
{
    const vec3 any = fabs(normal.x) < 0.7 ? vec3_of(1, 0, 0) : vec3_of(0, 1, 0);
    const vec3 x = vec3_unit(vec3_cross(any, normal));
    return (struct plane){x, vec3_cross(normal, x), normal, offset};
}

struct plane moments_plane(const struct moments *m)
{
    enum { SWEEPS = 6 };  // quadratic convergence: four are enough for doubles
    const vec3 mean = vec3_scale(m->first, 1.0 / m->area);
    double own[6] = {0};
    add_square(own, mean, -m->area);
    for (int i = 0; i < 6; i++)
        own[i] += m->square[i];
    double a[3][3] = {{own[0], own[1], own[2]}, {own[1], own[3], own[4]}, {own[2], own[4], own[5]}};
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < SWEEPS; i++) {
        rotate(a, v, 0, 1);
        rotate(a, v, 0, 2);
        rotate(a, v, 1, 2);
    }
    int least = 0, most = 0;
    for (int i = 1; i < 3; i++) {
        least = a[i][i] < a[least][least] ? i : least;
        most = a[i][i] >= a[most][most] ? i : most;
    }
    most = most == least ? (least + 1) % 3 : most;
    vec3 normal = vec3_unit(vec3_of(v[0][least], v[1][least], v[2][least]));
    if (vec3_dot(normal, m->normal) < 0.0)
        normal = vec3_scale(normal, -1.0);
    const vec3 x = vec3_unit(vec3_of(v[0][most], v[1][most], v[2][most]));
    return (struct plane){x, vec3_cross(normal, x), normal, vec3_dot(normal, mean)};
}

void fit_add(struct fit *f, const struct soup *s, size_t triangle, vec3 normal)
{
    for (int k = 0; k < 3; k++)
        range_add(&f->height, vec3_dot(s->corner[triangle][k], normal));
    f->least_cosine = fmin(f->least_cosine, vec3_dot(s->normal[triangle], normal));
}
