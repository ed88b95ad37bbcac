// lambert.c - robust photometric stereo of one pixel
#include "core/math/lambert.h"

#include <stdlib.h>

static const double dark_part = 0.25;    // of the samples: shadows
static const double bright_part = 0.10;  // highlights
enum { FEW = 48 };                       // samples: the ends count in the end, by their weights
static const int rounds = 10;
static const double tuning = 2.385;  // Cauchy: 95 % as good as least squares for normal errors
static const double black = 1e-3;    // albedo below which there is nothing but noise to fit

static int by_value(const void *a, const void *b)
{
    const struct lambert_sample *p = a, *q = b;
    if (p->value != q->value)
        return p->value < q->value ? -1 : 1;
    return p->light - q->light;
}

// Solve the symmetric system m x = b by cofactors; false when it is nearly singular.
static bool solve3(vec3 *x, const double m[6], vec3 b)
{
    const double c00 = m[3] * m[5] - m[4] * m[4];
    const double c01 = m[2] * m[4] - m[1] * m[5];
    const double c02 = m[1] * m[4] - m[2] * m[3];
    const double determinant = m[0] * c00 + m[1] * c01 + m[2] * c02;
    const double size = m[0] + m[3] + m[5];
    if (!(determinant > 1e-9 * size * size * size))
        return false;
    const double c11 = m[0] * m[5] - m[2] * m[2];
    const double c12 = m[1] * m[2] - m[0] * m[4];
    const double c22 = m[0] * m[3] - m[1] * m[1];
    *x = vec3_of((c00 * b.x + c01 * b.y + c02 * b.z) / determinant,
                 (c01 * b.x + c11 * b.y + c12 * b.z) / determinant,
                 (c02 * b.x + c12 * b.y + c22 * b.z) / determinant);
    return true;
}

static bool least_squares(vec3 *g, const vec3 *direction, const struct lambert_sample *s, int n)
{
    double m[6] = {0};
    vec3 b = {0, 0, 0};
    for (int i = 0; i < n; i++) {
        const vec3 l = direction[s[i].light];
        const double w = (double)s[i].weight;
        m[0] += w * l.x * l.x;
        m[1] += w * l.x * l.y;
        m[2] += w * l.x * l.z;
        m[3] += w * l.y * l.y;
        m[4] += w * l.y * l.z;
        m[5] += w * l.z * l.z;
        b = vec3_along(b, l, w * (double)s[i].value);
    }
    return solve3(g, m, b);
}

static int by_weight(const void *a, const void *b)
{
    const struct lambert_sample *p = a, *q = b;
    if (p->weight != q->weight)
        return p->weight < q->weight ? -1 : 1;
    return p->light - q->light;
}

// 1.4826 x the median absolute residual; weights hold the residuals meanwhile.
static double find_scale(const vec3 *direction, vec3 g, struct lambert_sample *s, int n)
{
    for (int i = 0; i < n; i++)
        s[i].weight = (float)fabs((double)s[i].value - vec3_dot(g, direction[s[i].light]));
    qsort(s, (size_t)n, sizeof *s, by_weight);
    return 1.4826 * (double)s[n / 2].weight;
}

static void weigh(const vec3 *direction, vec3 g, struct lambert_sample *s, int n)
{
    const double size = vec3_length(g);
    const double scale = tuning * fmax(find_scale(direction, g, s, n), 1e-4 * size);
    for (int i = 0; i < n; i++) {
        const double r = (double)s[i].weight / scale;
        const bool lit = vec3_dot(g, direction[s[i].light]) > LAMBERT_GRAZING * size;
        s[i].weight = lit ? (float)(1.0 / (1.0 + r * r)) : 0.0f;
    }
}

// Cuts the ends off the `*n` samples.
static struct lambert_sample *trim(struct lambert_sample *s, int *n)
{
    const int dark = (int)(dark_part * *n);
    const int bright = (int)(bright_part * *n);
    if (*n - dark - bright < 4)
        return s;
    qsort(s, (size_t)*n, sizeof *s, by_value);
    *n -= dark + bright;
    return s + dark;
}

static bool fit_robustly(vec3 *g, const vec3 *direction, struct lambert_sample *s, int n)
{
    vec3 better = *g;
    for (int i = 0; i < rounds; i++) {
        weigh(direction, *g, s, n);
        if (!least_squares(&better, direction, s, n))
            return i > 0;
        const double moved = vec3_length(vec3_sub(better, *g));
        *g = better;
        if (moved < 1e-5 * vec3_length(better))
            break;
    }
    return true;
}

struct lambert_sample *lambert_fit(vec3 *g, const vec3 *direction, struct lambert_sample *s, int *n,
                                   bool plain)
{
    struct lambert_sample *const all = s;
    const int given = *n;
    if (!plain)
        s = trim(s, n);
    if (!least_squares(g, direction, s, *n) || !(vec3_length(*g) > black))
        return NULL;
    if (!plain && !fit_robustly(g, direction, s, *n))
        return NULL;
    if (!plain && given <= FEW) {
        const vec3 middle = *g;
        s = all;
        *n = given;
        if (!fit_robustly(g, direction, s, *n))
            *g = middle;  // of the lights that it faces too few are left
    }
    return vec3_length(*g) > black ? s : NULL;
}

bool lambert_spans(const vec3 *direction, int n)
{
    double m[6] = {0};
    vec3 ignored;
    for (int i = 0; i < n; i++) {
        const vec3 l = direction[i];
        const double add[6] = {l.x * l.x, l.x * l.y, l.x * l.z, l.y * l.y, l.y * l.z, l.z * l.z};
        for (int k = 0; k < 6; k++)
            m[k] += add[k];
    }
    return solve3(&ignored, m, vec3_of(0, 0, 1));
}
