// relight_fixture.h - small codes of every form, and what they say in closed form
#ifndef TESTS_RELIGHT_FIXTURE_H
#define TESTS_RELIGHT_FIXTURE_H

#include "test.h"

enum { SIDE = 8, K = 4 };

// SH of degree 1 without a transform, with the signs of Wong 1998, appendix A (P_11 = -sin theta):
// value = 0.2820948 c0 + 0.4886025 (-c1 y + c2 z - c3 x).
static const double Y0 = 0.28209479177387814, Y1 = 0.48860251190291992;

// Coefficients per colour, a luminance with colours, and components of all three colours.
enum form { SEPARATE, LUMINANCE, COMPONENTS, FORMS };
enum { LIGHTS = 6, PLANES = 3 * K };

static const struct relume_vec3 axes[LIGHTS] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                                {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};

struct setup {
    enum form form;
    relume_coder *coder;
    float transform[3 * K * LIGHTS], mean[3 * LIGHTS];  // of the components
    uint16_t words[PLANES][SIDE * SIDE];
    const void *plane[PLANES];
    float scale[PLANES], offset[PLANES];
    struct relume_codes codes;
};

static inline void make_coder(struct setup *s, uint32_t *state)
{
    struct relume_coder_params p = {.coefficients = K, .decode = true};
    if (s->form == COMPONENTS) {
        for (int i = 0; i < 3 * K * LIGHTS; i++)
            s->transform[i] = (float)test_uniform(state) - 0.3f;
        for (int i = 0; i < 3 * LIGHTS; i++)
            s->mean[i] = (float)test_uniform(state);
        p.transform = s->transform;
        p.mean = s->mean;
        p.interpolant = relume_interpolant_find("delaunay");
    }
    p.luminance = s->form == LUMINANCE;
    CHECK_OK(relume_coder_create(
        &s->coder, s->form == COMPONENTS ? &relume_basis_pca : &relume_basis_sh, axes, LIGHTS, &p));
}

static inline void make(struct setup *s, enum form form, enum relume_domain domain)
{
    uint32_t state = 7;
    s->form = form;
    make_coder(s, &state);
    for (int p = 0; p < PLANES; p++) {
        for (int i = 0; i < SIDE * SIDE; i++)
            s->words[p][i] = (uint16_t)(test_random(&state) & 0xffff);
        s->plane[p] = s->words[p];
        s->scale[p] = (p < 3 ? 2.0f : 0.2f) / 65535.0f;
        s->offset[p] = p < 3 ? 0.5f : -0.1f;
    }
    s->codes = (struct relume_codes){
        .coder = s->coder,
        .domain = domain,
        .display = {.curve = RELUME_CURVE_SRGB},
        .width = SIDE,
        .height = SIDE,
        .planes = relume_coder_info(s->coder)->planes,
        .storage = RELUME_STORE_16,
        .plane = s->plane,
        .scale = s->scale,
        .offset = s->offset,
    };
}

static inline double coefficient(const struct setup *s, int pixel, int plane)
{
    return (double)s->words[plane][pixel] * (double)s->scale[plane] + (double)s->offset[plane];
}

// The triangulation of the axes is the octahedron: weights |x|, |y|, |z| over their sum.
static inline double components(const struct setup *s, int pixel, int c, struct relume_vec3 l)
{
    const double sum = fabs(l.x) + fabs(l.y) + fabs(l.z);
    const double weight[LIGHTS] = {fmax(l.x, 0) / sum,  fmax(-l.x, 0) / sum, fmax(l.y, 0) / sum,
                                   fmax(-l.y, 0) / sum, fmax(l.z, 0) / sum,  fmax(-l.z, 0) / sum};
    double v = 0.0;
    for (int i = 0; i < LIGHTS; i++) {
        v += weight[i] * (double)s->mean[c * LIGHTS + i];
        for (int k = 0; k < K; k++)
            v += weight[i] * (double)s->transform[(c * K + k) * LIGHTS + i] *
                 coefficient(s, pixel, k);
    }
    return v;
}

static inline double harmonics(const struct setup *s, int pixel, int c, struct relume_vec3 l)
{
    const bool shared = s->form == LUMINANCE;
    double q[K];
    for (int k = 0; k < K; k++)
        q[k] = coefficient(s, pixel, shared ? k : 3 * k + c);
    const double v = Y0 * q[0] + Y1 * (-q[1] * l.y + q[2] * l.z - q[3] * l.x);
    return shared ? v * coefficient(s, pixel, K + c) : v;
}

static inline double closed_form(const struct setup *s, int pixel, int c, struct relume_vec3 l)
{
    const double v = s->form == COMPONENTS ? components(s, pixel, c, l) : harmonics(s, pixel, c, l);
    return s->codes.domain == RELUME_DOMAIN_DISPLAY
               ? (double)relume_transfer_decode(s->codes.display, (float)v)
               : v;
}

static inline struct relume_vec3 unit(double x, double y, double z)
{
    return vec3_unit(vec3_of(x, y, z));
}

// Single precision sums of a few values near 1: 1e-6.
static const double TOLERANCE = 2e-6;
// What the weight grid promises for light of value 1.
static const double GRID = 1e-3;

#endif
