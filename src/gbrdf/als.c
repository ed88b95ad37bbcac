// als.c - alternating least squares (Menzel 2011, section 6.3.2), with what the digest of its
// formulas corrects: the diffuse part and what is divided by D carry k1.n everywhere
//
//     L = k1.n cd / pi + q(h) (a + b X) k1.n / D,   X = (1 - k1.h)^5,   a = s r0,  b = s (1 - r0)
//
// Errors are divided by L, the derivative of the logarithm. For a given q the rest is a bounded
// linear problem of five numbers. q is bilinear between its cells; beside the others each cell goes
// by the quotient of its samples' errors, weighted by their shares in it (SIRT), which ends at
// least squares. s, a scale, goes into q, since only their product shows.
#include "gbrdf/als.h"

#include "gbrdf/brdf.h"
#include "math/luminance.h"

#include <string.h>

// Directions lower than this over a texel are told by few pixels.
static const float LEAST_COSINE = 0.06f;
// Of the mean: what is darker counts as if it had this value, since logarithms have no end below.
static const double DARK = 0.2;
// Cells of less than this share of the usual support are filled from those around.
static const double WELL_KNOWN = 0.1;
enum { SWEEPS = 60 };

int als_gather(struct als_sample *out, const struct flat *flat, size_t texel, double turn,
               const float *values, const struct als_form *form)
{
    const struct relume_btf_info *info = relume_btf_info(flat->btf);
    const uint8_t *seen = flat->seen + texel * (size_t)flat->views;
    const uint8_t *lit = flat->lit + texel * (size_t)flat->lights;
    const vec3 n = flat->normal[texel];
    const struct gbrdf_texel frame = {.normal = {(float)n.x, (float)n.y, (float)n.z},
                                      .turn = {(float)cos(turn), (float)sin(turn)}};
    int count = 0;
    for (int v = 0; v < flat->views; v++) {
        const vec3 k2 = gbrdf_local(&frame, info->view[v]);
        if (!seen[v] || k2.z < (double)LEAST_COSINE)
            continue;
        // other lights in each view
        for (int l = v % form->stride; l < flat->lights; l += form->stride) {
            const vec3 k1 = gbrdf_local(&frame, info->light[l]);
            if (!lit[l] || k1.z < (double)LEAST_COSINE)
                continue;
            const vec3 h = vec3_unit(vec3_add(k1, k2));
            const float *from = values + 3 * ((size_t)v * (size_t)flat->lights + (size_t)l);
            const double scale =
                (info->without_cosine ? info->light[l].z : 1.0) / (M_PI * form->light);
            struct als_sample *s = &out[count++];
            double at[2];
            for (int c = 0; c < 3; c++)
                s->value[c] = fmaxf(from[c] * (float)scale, 0.0f);
            if (form->channels == 1)
                s->value[0] = luminance_709f(s->value);
            s->cosine = (float)k1.z;
            s->share = (float)(k1.z / brdf_masking(k1.z, k2.z));
            s->grazing = (float)brdf_grazing(vec3_dot(k1, h));
            ndf_place(h, form->side, at);
            s->place[0] = (float)at[0] - 0.5f;
            s->place[1] = (float)at[1] - 0.5f;
        }
    }
    return count;
}

// What is added to values before they divide.
static double floor_of(const struct als_sample *sample, int n, int channels)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        for (int c = 0; c < channels; c++)
            sum += (double)sample[i].value[c];
    return n ? DARK * sum / (channels * n) + 1e-9 : 1.0;
}

static double weight_of(double value, double model, double least)
{
    const double w = 1.0 / fmax(fmax(value, model), least);
    return w * w;
}

static struct bilinear cells_of(const struct als_sample *s, int side)
{
    return bilinear_at((double)s->place[0], (double)s->place[1], side, side, EDGE_CLAMPED);
}

// ---------------------------------------------------------------- a texel beside its distribution

enum { CD, A = 3, B, UNKNOWNS };

struct normal_equations {
    double m[UNKNOWNS][UNKNOWNS], right[UNKNOWNS];
};

static void add_row(struct normal_equations *e, int channel, const double lambda[3], double value,
                    double weight)
{
    const int at[3] = {CD + channel, A, B};
    for (int i = 0; i < 3; i++) {
        e->right[at[i]] += weight * lambda[i] * value;
        for (int j = 0; j < 3; j++)
            e->m[at[i]][at[j]] += weight * lambda[i] * lambda[j];
    }
}

// One unknown after the other, each within its bounds.
static void descend(const struct normal_equations *e, double *x, const double *most, int unknowns)
{
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int i = 0; i < unknowns; i++) {
            double rest = e->right[i];
            for (int j = 0; j < unknowns; j++)
                rest -= j == i ? 0.0 : e->m[i][j] * x[j];
            if (e->m[i][i] > 1e-12)
                x[i] = fmin(fmax(rest / e->m[i][i], 0.0), most[i]);
        }
}

// a = r0 and b = 1 - r0: the equations of r0 alone, in the place of a.
static void tie(struct normal_equations *e)
{
    struct normal_equations tied = *e;
    for (int i = 0; i < A; i++) {
        tied.right[i] -= e->m[i][B];
        tied.m[i][A] = tied.m[A][i] = e->m[i][A] - e->m[i][B];
    }
    tied.right[A] = e->right[A] - e->right[B] - e->m[A][B] + e->m[B][B];
    tied.m[A][A] = e->m[A][A] - 2.0 * e->m[A][B] + e->m[B][B];
    *e = tied;
}

double als_fit_texel(struct als_texel *t, const float *q, const struct als_form *form,
                     const struct als_sample *sample, int n, bool fixed)
{
    static const double most[UNKNOWNS] = {1.0, 1.0, 1.0, 1.0, INFINITY};
    static const double any[UNKNOWNS] = {1.0, 1.0, 1.0, INFINITY, INFINITY};
    const double least = floor_of(sample, n, form->channels);
    struct normal_equations e = {.right = {0.0}};
    for (int i = 0; i < n; i++) {
        const struct bilinear b = cells_of(&sample[i], form->side);
        for (int c = 0; c < form->channels; c++) {
            const double shine = (double)sample[i].share *
                                 (double)bilinear_valuef(&b, q, (size_t)form->channels, (size_t)c);
            const double lambda[3] = {(double)sample[i].cosine / M_PI, shine,
                                      shine * (double)sample[i].grazing};
            const double value = (double)sample[i].value[c];
            const double model = lambda[0] * t->diffuse[c] +
                                 shine * (t->r0 + (1.0 - t->r0) * (double)sample[i].grazing);
            add_row(&e, c, lambda, value, weight_of(value, model, least));
        }
    }
    double x[UNKNOWNS] = {t->diffuse[0], t->diffuse[1], t->diffuse[2], t->r0, 1.0 - t->r0};
    if (fixed)
        tie(&e);
    descend(&e, x, fixed ? most : any, fixed ? B : UNKNOWNS);
    memcpy(t->diffuse, x, sizeof t->diffuse);
    if (fixed) {
        t->r0 = x[A];
        return 1.0;
    }
    const double scale = x[A] + x[B];
    if (scale > 1e-9)
        t->r0 = x[A] / scale;
    return fmax(scale, 1e-4);
}

// ---------------------------------------------------------------- the distribution beside texels

void als_add(struct als_sums *sums, const struct als_texel *t, const float *q,
             const struct als_form *form, const struct als_sample *sample, int n)
{
    const double least = floor_of(sample, n, form->channels);
    for (int i = 0; i < n; i++) {
        const struct als_sample *s = &sample[i];
        const struct bilinear b = cells_of(s, form->side);
        const double lambda = (double)s->share * (t->r0 + (1.0 - t->r0) * (double)s->grazing);
        const size_t channels = (size_t)form->channels;
        for (size_t c = 0; c < channels; c++) {
            const double value = (double)s->value[c];
            const double model = (double)s->cosine * t->diffuse[c] / M_PI +
                                 lambda * (double)bilinear_valuef(&b, q, channels, c);
            const double w = weight_of(value, model, least), delta = value - model;
            for (int k = 0; k < 4; k++) {
                const double share = bilinear_share(&b, k, w);
                sums->above[b.at[k]][c] += share * lambda * delta;
                sums->below[b.at[k]][c] += share * lambda * lambda;
            }
        }
    }
}

static double solid_of(int cell, int side)
{
    vec3 h;
    return ndf_direction(cell % side, cell / side, side, &h)
               ? ndf_solid_angle((1.0 - h.z) / (1.0 + h.z), side)
               : 0.0;
}

void als_solve(float *q, const struct als_sums *sums, const struct als_form *form,
               const double diffuse[3])
{
    const int side = form->side, cells = side * side, channels = form->channels;
    float value[NDF_SIDE * NDF_SIDE], weight[NDF_SIDE * NDF_SIDE];
    for (int c = 0; c < channels; c++) {
        double integral = 0.0;
        double usual = 1e-12;
        for (int i = 0; i < cells; i++)
            usual += sums->below[i][c] / cells;
        for (int i = 0; i < cells; i++) {
            const double support = sums->below[i][c],
                         change = support > 1e-9 * usual ? sums->above[i][c] / support : 0.0;
            weight[i] = (float)fmin(support / (WELL_KNOWN * usual), 1.0);
            value[i] = (float)fmin(fmax((double)q[channels * i + c] + change, 0.0), 6e4);
        }
        ndf_fill(value, weight, side);
        for (int i = 0; i < cells; i++) {
            const double solid = solid_of(i, side);
            value[i] = (float)fmin((double)value[i], solid > 0.0 ? 1.0 / solid : 6e4);
            integral += solid * (double)value[i];
        }
        const double most = fmax(1.0 - diffuse[c], 0.0);
        for (int i = 0; i < cells; i++)
            q[channels * i + c] = value[i] * (float)(integral > most ? most / integral : 1.0);
    }
}

void als_fit_alone(struct als_texel *t, float *q, struct als_sums *scratch,
                   const struct als_sample *sample, int n, const struct als_form *form, int rounds)
{
    const int cells = form->side * form->side, values = cells * form->channels;
    for (int i = 0; i < values; i++)
        q[i] = 0.05f;
    *t = (struct als_texel){{0.2, 0.2, 0.2}, 0.3};
    for (int round = 0; round < rounds; round++) {
        const float scale = (float)als_fit_texel(t, q, form, sample, n, false);
        for (int i = 0; i < values; i++)
            q[i] *= scale;
        memset(scratch->above, 0, (size_t)cells * sizeof *scratch->above);
        memset(scratch->below, 0, (size_t)cells * sizeof *scratch->below);
        als_add(scratch, t, q, form, sample, n);
        als_solve(q, scratch, form, t->diffuse);
    }
}
