// normals.c - normals by reciprocity, and heights that suit them (Menzel 2011, section 6.3.1)
//
// With rho = L / (k1.n) the same when k1 and k2 change places, each pair of values says
//     log L12 - log L21 - log k1.n + log k2.n = 0,   n ~ (-a, -b, 1),
// and Levenberg-Marquardt finds a and b. It begins where the pairs' linear equations
// (L12 k2 - L21 k1) . n = 0 end (Zickler, Belhumeur, Kriegman 2002).
#include "material/gbrdf/depth.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/luminance.h"

#include <string.h>

enum { LEAST_PAIRS = 8, MOST_PAIRS = 1100, ROUNDS = 20, MOST_STEPS = 200 };
// Errors of the logarithm beyond this are of shadows and of what other parts send.
static const double OUTLIER = 0.3;
static const double LEAST_COSINE = 0.1, STEEPEST = 3.0;
static const double DARK = 0.1;  // of the mean: darker values are of shadows
// lambda; the thesis has 0.2, which lets the steps of the layers through: on a planted relief of
// 64 x 64 texels normals are off by 3.6 degrees with it, and by 1.8 with this.
static const double DEPTH_WEIGHT = 0.01;

struct normal_search {
    vec3 *out;
    const struct flat *flat;
    const struct picture_pair *pairs;
    int count, stride;  // every so manieth pair: many more say the same
};

struct equation {
    vec3 k1, k2;
    double ratio;  // log L12 - log L21
};

static double value_of(const struct normal_search *w, const float *values, int view, int light)
{
    const struct relume_btf_info *info = relume_btf_info(w->flat->btf);
    const double scale = info->without_cosine ? info->light[light].z : 1.0;
    return scale *
           luminance_709(values + 3 * ((size_t)view * (size_t)info->lights + (size_t)light));
}

// Pairs that are seen from both sides and light enough; *start is the linear solution.
static int collect(struct equation *out, const struct normal_search *w, size_t texel,
                   const float *values, vec3 *start)
{
    const struct relume_btf_info *info = relume_btf_info(w->flat->btf);
    const uint8_t *seen = w->flat->seen + texel * (size_t)w->flat->views;
    double mean = 0.0, gram[9] = {0.0}, size[3], axis[9];
    int n = 0, looked = 0;
    for (int i = 0; i < w->count; i += w->stride, looked++)
        mean += value_of(w, values, w->pairs[i].view[0], w->pairs[i].light[0]);
    mean /= looked;
    for (int i = 0; i < w->count; i += w->stride) {
        const struct picture_pair *p = &w->pairs[i];
        // the first picture is lit from where the second is seen
        const vec3 k1 = info->view[p->view[1]], k2 = info->view[p->view[0]];
        const double one = value_of(w, values, p->view[0], p->light[0]),
                     other = value_of(w, values, p->view[1], p->light[1]);
        if (!seen[p->view[0]] || !seen[p->view[1]] || !(one > DARK * mean) ||
            !(other > DARK * mean))
            continue;
        const vec3 row = vec3_sub(vec3_scale(k2, one), vec3_scale(k1, other));
        const double r[3] = {row.x, row.y, row.z};
        for (int k = 0; k < 9; k++)
            gram[k] += r[k / 3] * r[k % 3];
        out[n++] = (struct equation){k1, k2, log(one / other)};
    }
    if (n >= LEAST_PAIRS && lsq_eigenvectors(gram, 3, 3, size, axis)) {
        const double *last = axis + 6, sign = last[2] < 0.0 ? -1.0 : 1.0;
        if (sign * last[2] > 1.0 / STEEPEST)
            *start = vec3_scale(vec3_of(last[0], last[1], last[2]), sign);
    }
    return n;
}

// Cauchy's weights; sums of the 2 x 2 problem, and the error.
static double gather(const struct equation *e, int n, const double x[2], double m[4],
                     double right[2])
{
    // the logarithm of a product of a few errors takes as long as that of one
    double error = 0.0, errors = 1.0;
    memset(m, 0, 4 * sizeof *m);
    memset(right, 0, 2 * sizeof *right);
    for (int i = 0; i < n; i++) {
        const double c1 = e[i].k1.z - x[0] * e[i].k1.x - x[1] * e[i].k1.y,
                     c2 = e[i].k2.z - x[0] * e[i].k2.x - x[1] * e[i].k2.y;
        if (c1 < LEAST_COSINE || c2 < LEAST_COSINE) {
            errors *= 2.0;
            continue;
        }
        const double r = e[i].ratio - log(c1 / c2), relative = r / OUTLIER;
        const double weight = 1.0 / (1.0 + relative * relative);
        const double d[2] = {e[i].k1.x / c1 - e[i].k2.x / c2, e[i].k1.y / c1 - e[i].k2.y / c2};
        errors *= 1.0 + relative * relative;
        if (errors > 1e200) {
            error += log(errors);
            errors = 1.0;
        }
        for (int a = 0; a < 2; a++) {
            right[a] -= weight * d[a] * r;
            for (int b = 0; b < 2; b++)
                m[2 * a + b] += weight * d[a] * d[b];
        }
    }
    return error + log(errors);
}

static void improve(const struct equation *e, int n, double x[2])
{
    double m[4], right[2], error = gather(e, n, x, m, right), damping = 1e-3;
    for (int round = 0; round < ROUNDS; round++) {
        const double a = m[0] * (1.0 + damping) + 1e-9, d = m[3] * (1.0 + damping) + 1e-9;
        const double det = a * d - m[1] * m[2];
        const double step[2] = {(d * right[0] - m[1] * right[1]) / det,
                                (a * right[1] - m[2] * right[0]) / det};
        double next[2], next_m[4], next_right[2];
        for (int i = 0; i < 2; i++)
            next[i] = fmin(fmax(x[i] + step[i], -STEEPEST), STEEPEST);
        const double next_error = gather(e, n, next, next_m, next_right);
        if (next_error < error) {
            memcpy(x, next, sizeof next);
            memcpy(m, next_m, sizeof next_m);
            memcpy(right, next_right, sizeof next_right);
            error = next_error;
            damping *= 0.3;
        } else
            damping *= 10.0;
        if (damping > 1e6 || fabs(step[0]) + fabs(step[1]) < 1e-6)
            break;
    }
}

static void find_normal(void *context, size_t texel, const float *values)
{
    const struct normal_search *w = context;
    struct equation *e = mem_array((size_t)w->count, sizeof *e);
    vec3 start = w->flat->normal[texel];
    w->out[texel] = start;
    const int n = e ? collect(e, w, texel, values, &start) : 0;
    if (n >= LEAST_PAIRS) {
        double x[2] = {-start.x / start.z, -start.y / start.z};
        improve(e, n, x);
        w->out[texel] = vec3_unit(vec3_of(-x[0], -x[1], 1.0));
    }
    mem_free(e);
}

relume_status depth_normals(vec3 *out, const struct flat *flat, const struct picture_pair *pairs,
                            int count, int threads, const struct relume_log *log)
{
    struct normal_search w = {out, flat, pairs, count, 1 + count / MOST_PAIRS};
    return btf_for_texels(flat->btf, threads, log, "normals", &w, find_normal);
}

// ---------------------------------------------------------------- fusion

// Heights and normals (Nehab, Rusinkiewicz, Davis, Ramamoorthi 2005):
//     lambda sum (z - z0)^2 + (1 - lambda) sum [ (n.x + n.z dz/du)^2 + (n.y + n.z dz/dv)^2 ]
// with differences between neighbours and the mean of their normals, by conjugate gradients.

struct slopes {
    int width, height;
    const vec3 *normal;
};

// The neighbour to the right (axis 0) or below.
static size_t next_to(const struct slopes *s, int x, int y, int axis)
{
    return (size_t)index_wrapped(y + axis, s->height) * (size_t)s->width +
           (size_t)index_wrapped(x + !axis, s->width);
}

// What z gives of the sum's gradient; with `constant` also what the normals do.
static void gradient(float *out, const float *z, const struct slopes *s, bool constant)
{
    const size_t texels = (size_t)s->width * (size_t)s->height;
    for (size_t i = 0; i < texels; i++)
        out[i] = constant ? 0.0f : (float)DEPTH_WEIGHT * z[i];
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++)
            for (int axis = 0; axis < 2; axis++) {
                const size_t i = (size_t)y * (size_t)s->width + (size_t)x,
                             j = next_to(s, x, y, axis);
                const vec3 n = vec3_scale(vec3_add(s->normal[i], s->normal[j]), 0.5);
                // rows run against y
                const double side = axis ? -n.y : n.x;
                const double error = constant ? side : n.z * ((double)z[j] - (double)z[i]);
                const float g = (float)((1.0 - DEPTH_WEIGHT) * n.z * error);
                out[j] += g;
                out[i] -= g;
            }
}

static double product(const float *a, const float *b, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += (double)a[i] * (double)b[i];
    return sum;
}

relume_status depth_fuse(float *z, const vec3 *normal, int width, int height)
{
    const struct slopes s = {width, height, normal};
    const size_t n = (size_t)width * (size_t)height;
    float *rest = mem_array(3 * n, sizeof *rest);
    if (!rest)
        return RELUME_ENOMEM;
    float *way = rest + n, *image = way + n;
    // begins at z0, where the depth's own gradient is 0
    gradient(way, z, &s, true);
    gradient(rest, z, &s, false);
    for (size_t i = 0; i < n; i++)
        way[i] = rest[i] = (float)DEPTH_WEIGHT * z[i] - rest[i] - way[i];
    double size = product(rest, rest, n);
    const double enough = 1e-10 * (size + 1e-12);
    for (int i = 0; i < MOST_STEPS && size > enough; i++) {
        gradient(image, way, &s, false);
        const double step = size / product(way, image, n), before = size;
        for (size_t k = 0; k < n; k++) {
            z[k] += (float)step * way[k];
            rest[k] -= (float)step * image[k];
        }
        size = product(rest, rest, n);
        for (size_t k = 0; k < n; k++)
            way[k] = rest[k] + (float)(size / before) * way[k];
    }
    mem_free(rest);
    return RELUME_OK;
}
