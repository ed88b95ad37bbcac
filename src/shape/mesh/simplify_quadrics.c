// simplify_quadrics.c - what going costs, as quadratic forms: squared distances to planes (Garland,
// Heckbert 1997) and squared differences of values that are linear over triangles (Hoppe 1999, "New
// quadric metric for simplifying meshes with appearance attributes")
//
// Planes are summed per point in double precision, values per vertex in single: their weights are
// small. Features get planes that stand on the surface.
#include "shape/mesh/simplify.h"

#include <math.h>
#include <string.h>

enum { FORM = 10, AREA = 10, VALUES_FROM = 11 };  // places in a quadric

// Of features, per squared length.
#define FEATURE_WEIGHT 4.0

static size_t spread_floats(const struct simplify *s)
{
    return VALUES_FROM + 4 * (size_t)s->values;
}

size_t quadrics_bytes(const struct simplify *s, size_t points, size_t vertices)
{
    return points * sizeof *s->quadric + vertices * spread_floats(s) * sizeof *s->spread;
}

// w (g . p + d)^2
static void add_form(double q[FORM], vec3 g, double d, double w)
{
    const double form[FORM] = {g.x * g.x, g.x * g.y, g.x * g.z, g.y * g.y, g.y * g.z,
                               g.z * g.z, g.x * d,   g.y * d,   g.z * d,   d * d};
    for (int i = 0; i < FORM; i++)
        q[i] += w * form[i];
}

static double form_at(const double q[FORM], vec3 p)
{
    return q[0] * p.x * p.x + q[3] * p.y * p.y + q[5] * p.z * p.z +
           2.0 * (q[1] * p.x * p.y + q[2] * p.x * p.z + q[4] * p.y * p.z) +
           2.0 * (q[6] * p.x + q[7] * p.y + q[8] * p.z) + q[9];
}

// Values of a vertex, times their weights.
static void values_of(const struct simplify *s, uint32_t vertex, double value[VALUES])
{
    const struct relume_mesh *m = s->mesh;
    int n = 0;
    for (int k = 0; k < 3; k++)
        value[n++] = (double)m->normal[vertex][k];
    for (int k = 0; m->texture && k < 2; k++)
        value[n++] = (double)m->texture[vertex][k];
    for (int k = 0; m->colour && k < 3; k++)
        value[n++] = m->colour[vertex][k] / 255.0;
    for (int k = 0; k < n; k++)
        value[k] *= s->weight[k];
}

struct facet {
    vec3 p[3], normal;
    double area;
};

static bool facet_of(const struct simplify *s, uint32_t triangle, struct facet *f)
{
    const uint32_t *t = s->connect.triangle[triangle];
    if (t[0] == NOTHING)
        return false;
    for (int k = 0; k < 3; k++)
        f->p[k] = place(s, t[k]);
    f->normal = vec3_cross(vec3_sub(f->p[1], f->p[0]), vec3_sub(f->p[2], f->p[0]));
    const double length = vec3_length(f->normal);
    f->area = 0.5 * length;
    if (!(length > 1e-30))
        return false;
    f->normal = vec3_scale(f->normal, 1.0 / length);
    return true;
}

static void add_planes(struct simplify *s, const struct facet *f, const uint32_t t[3])
{
    for (int k = 0; k < 3; k++) {
        double *q = s->quadric[s->connect.point[t[k]]];
        add_form(q, f->normal, -vec3_dot(f->normal, f->p[0]), f->area);
        q[AREA] += f->area;
    }
}

// The gradient in the triangle's plane of what is v[k] at its corners.
static vec3 gradient(const struct facet *f, const double v[3])
{
    const double scale = 0.5 / f->area;
    const vec3 a = vec3_cross(f->normal, vec3_sub(f->p[2], f->p[1]));
    const vec3 b = vec3_cross(f->normal, vec3_sub(f->p[0], f->p[2]));
    const vec3 c = vec3_cross(f->normal, vec3_sub(f->p[1], f->p[0]));
    return vec3_scale(vec3_along(vec3_along(vec3_scale(a, v[0]), b, v[1]), c, v[2]), scale);
}

static void add_values(struct simplify *s, const struct facet *f, const uint32_t t[3])
{
    double value[3][VALUES], q[FORM] = {0}, linear[VALUES][4];
    for (int k = 0; k < 3; k++)
        values_of(s, t[k], value[k]);
    for (int j = 0; j < s->values; j++) {
        const vec3 g = gradient(f, (const double[]){value[0][j], value[1][j], value[2][j]});
        const double d = value[0][j] - vec3_dot(g, f->p[0]);
        add_form(q, g, d, f->area);
        memcpy(linear[j],
               (const double[]){f->area * g.x, f->area * g.y, f->area * g.z, f->area * d},
               sizeof linear[j]);
    }
    for (int k = 0; k < 3; k++) {
        float *to = s->spread + t[k] * spread_floats(s);
        for (int i = 0; i < FORM; i++)
            to[i] += (float)q[i];
        to[AREA] += (float)f->area;
        for (int j = 0; j < s->values; j++)
            for (int i = 0; i < 4; i++)
                to[VALUES_FROM + 4 * j + i] += (float)linear[j][i];
    }
}

static void add_features(struct simplify *s, uint32_t point, struct fan *fan)
{
    connect_fan(&s->connect, point, fan);
    for (int i = 0; i < fan->neighbours && fan->features && !fan->too_many; i++)
        for (int t = 0; fan->feature[i] && t < fan->triangles; t++) {
            struct facet f;
            if (!triangle_has(&s->connect, fan->triangle[t], fan->neighbour[i]) ||
                !facet_of(s, fan->triangle[t], &f))
                continue;
            const uint32_t *corner = s->connect.triangle[fan->triangle[t]];
            vec3 end[2] = {f.p[0], f.p[0]};
            for (int k = 0; k < 3; k++) {
                if (s->connect.point[corner[k]] == point)
                    end[0] = f.p[k];
                if (s->connect.point[corner[k]] == fan->neighbour[i])
                    end[1] = f.p[k];
            }
            const vec3 along = vec3_sub(end[1], end[0]), up = vec3_cross(along, f.normal);
            const double length = vec3_length(along);
            if (length > 0.0) {
                const vec3 n = vec3_scale(up, 1.0 / length);
                add_form(s->quadric[point], n, -vec3_dot(n, end[0]),
                         FEATURE_WEIGHT * length * length);
            }
        }
}

relume_status quadrics_create(struct simplify *s)
{
    struct fan fan;
    s->quadric = mem_zeroed(s->connect.points, sizeof *s->quadric);
    s->spread = mem_zeroed(s->mesh->vertex_count, spread_floats(s) * sizeof *s->spread);
    if (!s->quadric || !s->spread)
        return RELUME_ENOMEM;
    for (size_t t = 0; t < s->connect.triangles; t++) {
        struct facet f;
        if (!facet_of(s, (uint32_t)t, &f))
            continue;
        add_planes(s, &f, s->connect.triangle[t]);
        add_values(s, &f, s->connect.triangle[t]);
    }
    for (uint32_t p = 0; p < s->connect.points; p++)
        add_features(s, p, &fan);
    return RELUME_OK;
}

static double spread_at(const struct simplify *s, uint32_t vertex, vec3 p, const double *value)
{
    const float *q = s->spread + vertex * spread_floats(s);
    double form[FORM];
    for (int i = 0; i < FORM; i++)
        form[i] = (double)q[i];
    double sum = form_at(form, p);
    for (int j = 0; j < s->values; j++) {
        const float *l = q + VALUES_FROM + 4 * j;
        const double linear =
            (double)l[0] * p.x + (double)l[1] * p.y + (double)l[2] * p.z + (double)l[3];
        sum += (double)q[AREA] * value[j] * value[j] - 2.0 * value[j] * linear;
    }
    return fmax(sum, 0.0);
}

double quadrics_error(const struct simplify *s, uint32_t point, const struct moves *moves)
{
    const vec3 p = place(s, moves->to[0]);
    const double *q = s->quadric[point];
    double sum = fmax(form_at(q, p), 0.0), value[VALUES];
    for (int i = 0; i < moves->count; i++) {
        values_of(s, moves->to[i], value);
        sum += spread_at(s, moves->from[i], p, value);
    }
    return q[AREA] > 0.0 ? sqrt(sum / q[AREA]) : 0.0;
}

void quadrics_move(struct simplify *s, uint32_t point, uint32_t target, const struct moves *moves)
{
    const size_t floats = spread_floats(s);
    for (int i = 0; i <= AREA; i++)
        s->quadric[target][i] += s->quadric[point][i];
    for (int m = 0; m < moves->count; m++)
        for (size_t i = 0; i < floats; i++)
            s->spread[moves->to[m] * floats + i] += s->spread[moves->from[m] * floats + i];
}
