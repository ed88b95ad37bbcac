// ball_matte.c - the direction of a light from the shading of a matte white ball
//
// Lit pixels show I (n.L) + A: four unknowns, the lamp's vector and what light there is besides.
// Reweighted least squares (Cauchy) leaves out the shadow line, highlights and reflections.
#include "capture/acquire/ball.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/sort.h"

#include <string.h>

enum { ROUNDS = 12, LEAST = 64, MOST = 16384 };
static const double DARK = 0.02;    // brightest value below which nothing is seen
static const double FACING = 0.25;  // n.v below which the surface is seen too obliquely
static const double LIT = 0.1;      // n.L below which it is shadow or nearly
static const double CLIPPED = 0.98;
static const double PIXEL_SIGMA = 0.2;  // of an outline, at least

struct patch {
    vec3 normal;
    float rgb[3];
    double value, weight, miss;
};

// Pixels of the ball, at most MOST of them, evenly.
static int gather(struct patch *out, const struct relume_ball *ball,
                  const struct relume_ball_camera *camera, const struct relume_image *image)
{
    const double side = 2.0 * ball->radius;
    const double step = fmax(side / sqrt((double)MOST), 1.0);
    int n = 0;
    for (double y = ball->y - ball->radius; y < ball->y + ball->radius; y += step)
        for (double x = ball->x - ball->radius; x < ball->x + ball->radius; x += step) {
            vec3 normal, eye;
            const int ix = relume_whole(floor(x)), iy = relume_whole(floor(y));
            if (ix < 0 || iy < 0 || ix >= image->width || iy >= image->height || n >= MOST ||
                !ball_normal(&normal, &eye, ball, camera, ix + 0.5, iy + 0.5) ||
                vec3_dot(normal, eye) < FACING)
                continue;
            struct patch *p = &out[n++];
            const float *from = image->data + (size_t)image->channels *
                                                  ((size_t)iy * (size_t)image->width + (size_t)ix);
            for (int c = 0; c < 3; c++)
                p->rgb[c] = from[image->channels == 3 ? c : 0];
            p->normal = normal;
            p->value = (double)ball_grey(image, ix, iy);
            p->weight = p->value < CLIPPED ? 1.0 : 0.0;
        }
    return n;
}

// Weighted least squares of one channel (-1: grey); lamp[0..2] and what is everywhere.
static bool solve(double lamp[4], const struct patch *p, int n, int channel)
{
    double m[16] = {0.0};
    memset(lamp, 0, 4 * sizeof *lamp);
    for (int i = 0; i < n; i++) {
        const double row[4] = {p[i].normal.x, p[i].normal.y, p[i].normal.z, 1.0};
        const double v = channel < 0 ? p[i].value : (double)p[i].rgb[channel];
        for (int j = 0; j < 16; j++)
            m[j] += p[i].weight * row[j / 4] * row[j % 4];
        for (int j = 0; j < 4; j++)
            lamp[j] += p[i].weight * row[j] * v;
    }
    for (int j = 0; j < 4; j++)
        m[5 * j] += 1e-9 * n;
    m[15] += 1e-3 * n;  // light from everywhere is the exception
    return lsq_solve(m, 4, lamp, 1);
}

// The median miss over the lit patches becomes the scale of the weights.
static double weigh(struct patch *p, int n, const double lamp[4], double *scratch)
{
    const vec3 l = vec3_of(lamp[0], lamp[1], lamp[2]);
    const double size = vec3_length(l);
    int lit = 0;
    for (int i = 0; i < n; i++) {
        const double cosine = vec3_dot(p[i].normal, l) / size;
        p[i].miss = fabs(p[i].value - cosine * size - lamp[3]);
        p[i].weight = cosine > LIT && p[i].value < CLIPPED;
        if (p[i].weight > 0.0)
            scratch[lit++] = p[i].miss;
    }
    sort_doubles(scratch, (size_t)lit);
    const double scale = fmax(2.385 * 1.4826 * (lit ? scratch[lit / 2] : 0.0), 1e-4 * size);
    for (int i = 0; i < n; i++)
        p[i].weight /= 1.0 + p[i].miss * p[i].miss / (scale * scale);
    return scale / 2.385;
}

static struct relume_ball_light fit(struct patch *p, int n, const struct relume_ball *ball,
                                    double *scratch)
{
    struct relume_ball_light light = {.finding = RELUME_BALL_DARK};
    double lamp[4], most = 0.0, clipped = 0.0, spread = 0.0;
    for (int i = 0; i < n; i++) {
        most = fmax(most, p[i].value);
        clipped += p[i].value >= CLIPPED;
    }
    if (n < LEAST || most < DARK)
        return light;
    light.finding = RELUME_BALL_FULL;
    if (clipped > 0.5 * n)
        return light;
    for (int round = 0; round < ROUNDS; round++) {
        if (!solve(lamp, p, n, -1) || !(hypot(hypot(lamp[0], lamp[1]), lamp[2]) > 1e-6))
            return light;
        spread = weigh(p, n, lamp, scratch);
    }
    const vec3 l = vec3_of(lamp[0], lamp[1], lamp[2]);
    double weight = 0.0;
    for (int i = 0; i < n; i++)
        weight += p[i].weight;
    light.finding = weight > LEAST / 4.0 ? RELUME_BALL_SEEN : RELUME_BALL_RIM;
    light.direction = vec3_unit(l);
    // Misses are texture and bounced light rather than noise: a patch in ten counts.
    const double of_fit = spread / vec3_length(l) * sqrt(2.0 * 10.0 / fmax(weight, 1.0));
    const double of_outline = fmax(ball->sigma, PIXEL_SIGMA) / ball->radius;
    light.sigma_deg = hypot(of_fit, of_outline) * 180.0 / M_PI;
    for (int c = 0; c < 3; c++)
        if (solve(lamp, p, n, c))
            light.intensity[c] =
                (float)fmax(vec3_dot(vec3_of(lamp[0], lamp[1], lamp[2]), light.direction), 0.0);
    return light;
}

relume_status relume_ball_matte(struct relume_ball_light *out, const struct relume_ball *ball,
                                const struct relume_ball_camera *camera,
                                const struct relume_image *photograph)
{
    *out = (struct relume_ball_light){.finding = RELUME_BALL_DARK};
    struct patch *patch = mem_array(MOST, sizeof *patch);
    double *scratch = mem_array(MOST, sizeof *scratch);
    const relume_status status = patch && scratch ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        *out = fit(patch, gather(patch, ball, camera, photograph), ball, scratch);
        out->x = ball->x;
        out->y = ball->y;
    }
    mem_free(patch);
    mem_free(scratch);
    return status;
}
