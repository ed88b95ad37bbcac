// integrable.c - integrability as a constraint on the lights (Yuille, Snow 1997)
//
// With surface vectors e that are known up to g = B e, slopes are g1/g3 and g2/g3, and their curl
// is
//     d/dy (g1/g3) - d/dx (g2/g3) = [ (b3 x b1) . (e x de/dy) - (b3 x b2) . (e x de/dx) ] / g3^2
// with b the rows of B: linear in the two cross products. Albedo cancels where e is divided by its
// third component, differences are central. What is minimised over A = B^-T is
//     sum w (curl / noise)^2 + |A - I|^2 / COMMON^2
// with Cauchy weights w for occlusions and shadows; the second term holds what has no curl at all.
// Noise of the vectors makes curl of any map, and less of some than of others: curls are counted in
// units of what noise makes of them (total least squares), v^T D v with v the two cross products.
#include "capture/acquire/integrable.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/sort.h"

#include <string.h>

enum { ROUNDS = 12, LEAST = 200 };
// What surfaces do against Lambert's law they do over wide parts: so many crossings speak for
// themselves.
static const double INDEPENDENT = 100.0;
static const double COMMON = 0.05;   // how far the lights may be off in common: 3 degrees
static const double UPRIGHT = 0.65;  // cosine: steeper surfaces end in occlusions, and are left out
static const double TUNING = 1.0;    // of the Cauchy weights: these outliers are many

struct curls {
    size_t n;
    double (*c)[6];  // curl = v . c
    double *weight, *sorted;
    double noise[9];  // D, for one of the two products: those of noise in (a, b) of (a, b, 1)
};

static double determinant(const double m[9])
{
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
           m[2] * (m[3] * m[7] - m[4] * m[6]);
}

static vec3 row(const double m[9], int i)
{
    return vec3_of(m[3 * i], m[3 * i + 1], m[3 * i + 2]);
}

// The rows of m^-T = cofactors / determinant.
static void inverse_transposed(vec3 out[3], const double m[9])
{
    const double d = determinant(m);
    for (int i = 0; i < 3; i++)
        out[i] = vec3_scale(vec3_cross(row(m, (i + 1) % 3), row(m, (i + 2) % 3)), 1.0 / d);
}

static double noise_of(const double noise[9], vec3 p)
{
    const double v[3] = {p.x, p.y, p.z};
    double sum = 0.0;
    for (int i = 0; i < 9; i++)
        sum += v[i / 3] * noise[i] * v[i % 3];
    return sum;
}

// (b3 x b1, b3 x b2), so long that noise makes curls of 1.
static void products(double v[6], const double a[9], const double noise[9])
{
    vec3 b[3];
    inverse_transposed(b, a);
    const vec3 p = vec3_cross(b[2], b[0]), q = vec3_cross(b[2], b[1]);
    const double s = 1.0 / sqrt(noise_of(noise, p) + noise_of(noise, q));
    const double all[6] = {p.x, p.y, p.z, q.x, q.y, q.z};
    for (int i = 0; i < 6; i++)
        v[i] = s * all[i];
}

// ---------------------------------------------------------------- crossings

static bool vector_at(vec3 *out, const struct lattice *l, int x, int y)
{
    const int i = l->slot[y * l->columns + x];
    if (i < 0 || !l->known[i])
        return false;
    const vec3 g = l->g[i];
    *out = vec3_scale(g, 1.0 / g.z);
    return g.z > UPRIGHT * vec3_length(g);
}

// The covariance of left x right for noise of 1 in their first two components, twice over.
static void add_noise(double noise[9], vec3 left, vec3 right)
{
    const double a = 0.5 * (left.x + right.x), b = 0.5 * (left.y + right.y);
    const double one[9] = {1, 0, -a, 0, 1, -b, -a, -b, a * a + b * b};
    for (int i = 0; i < 9; i++)
        noise[i] += one[i];
}

static void gather(struct curls *to, const struct lattice *l)
{
    for (int y = 1; y + 1 < l->rows; y++)
        for (int x = 1; x + 1 < l->columns; x++) {
            vec3 left, right, up, down;
            if (!vector_at(&left, l, x - 1, y) || !vector_at(&right, l, x + 1, y) ||
                !vector_at(&up, l, x, y - 1) || !vector_at(&down, l, x, y + 1))
                continue;
            const vec3 dx = vec3_cross(left, right), dy = vec3_cross(down, up);
            const double c[6] = {dy.x, dy.y, dy.z, -dx.x, -dx.y, -dx.z};
            memcpy(to->c[to->n], c, sizeof c);
            add_noise(to->noise, left, right);
            to->weight[to->n++] = 1.0;
        }
}

static double curl_at(const struct curls *s, const double v[6], size_t i)
{
    double sum = 0.0;
    for (int k = 0; k < 6; k++)
        sum += v[k] * s->c[i][k];
    return sum;
}

// Cauchy weights; returns the spread of the curls, by their median.
static double weigh(struct curls *s, const double v[6])
{
    for (size_t i = 0; i < s->n; i++)
        s->sorted[i] = s->weight[i] = fabs(curl_at(s, v, i));
    sort_doubles(s->sorted, s->n);
    const double spread = 1.4826 * s->sorted[s->n / 2] + 1e-9;
    for (size_t i = 0; i < s->n; i++)
        s->weight[i] = 1.0 / (1.0 + pow(s->weight[i] / (TUNING * spread), 2.0));
    return spread;
}

// ---------------------------------------------------------------- the map

static void add_gram(double m[36], const struct curls *s)
{
    for (size_t i = 0; i < s->n; i++)
        for (int j = 0; j < 36; j++)
            m[j] += s->weight[i] * s->c[i][j / 6] * s->c[i][j % 6];
}

// One step of Gauss and Newton.
static bool improve(double a[9], struct curls *s)
{
    double v[6], gram[36] = {0.0}, slope[54], m[81] = {0.0}, b[9];
    products(v, a, s->noise);
    const double spread = weigh(s, v);
    const double variance = spread * spread * fmax((double)s->n / INDEPENDENT, 1.0);
    add_gram(gram, s);
    for (int k = 0; k < 9; k++) {
        static const double small = 1e-5;
        double moved[9], w[6];
        memcpy(moved, a, sizeof moved);
        moved[k] += small;
        products(w, moved, s->noise);
        for (int i = 0; i < 6; i++)
            slope[6 * k + i] = (w[i] - v[i]) / small;
    }
    for (int k = 0; k < 9; k++) {
        double pulled[6];
        for (int i = 0; i < 6; i++) {
            pulled[i] = 0.0;
            for (int j = 0; j < 6; j++)
                pulled[i] += gram[6 * i + j] * slope[6 * k + j] / variance;
        }
        b[k] = -(a[k] - (k % 4 == 0)) / (COMMON * COMMON);
        for (int i = 0; i < 6; i++)
            b[k] -= pulled[i] * v[i];
        for (int l = 0; l < 9; l++)
            for (int i = 0; i < 6; i++)
                m[9 * k + l] += pulled[i] * slope[6 * l + i];
        m[10 * k] += 1.0 / (COMMON * COMMON);
    }
    if (!lsq_solve(m, 9, b, 1))
        return false;
    for (int k = 0; k < 9; k++)
        a[k] += b[k];
    return determinant(a) > 0.1;
}

// Over the lengths of the vectors that it is the difference of.
static double relative_curl(const struct curls *s, const double a[9])
{
    double v[6], sum = 0.0, all = 0.0;
    products(v, a, s->noise);
    for (size_t i = 0; i < s->n; i++) {
        const double r = curl_at(s, v, i);
        sum += s->weight[i] * r * r;
        for (int k = 0; k < 6; k++)
            all += s->weight[i] * s->c[i][k] * s->c[i][k];
    }
    return sqrt(sum / (all + 1e-30));
}

bool integrable_map(double a[9], double curl[2], const struct lattice *lattice)
{
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const size_t most = (size_t)lattice->columns * (size_t)lattice->rows;
    struct curls s = {.c = mem_array(most + 1, sizeof *s.c),
                      .weight = mem_array(most + 1, sizeof *s.weight),
                      .sorted = mem_array(most + 1, sizeof *s.sorted)};
    memcpy(a, identity, sizeof identity);
    if (s.c && s.weight && s.sorted)
        gather(&s, lattice);
    for (int i = 0; i < 9; i++)
        s.noise[i] /= (double)(s.n + 1);
    bool good = s.n >= LEAST;
    for (int i = 0; good && i < ROUNDS; i++)
        good = improve(a, &s);
    if (good) {
        curl[0] = relative_curl(&s, identity);
        curl[1] = relative_curl(&s, a);
    }
    mem_free(s.c);
    mem_free(s.weight);
    mem_free(s.sorted);
    return good;
}
