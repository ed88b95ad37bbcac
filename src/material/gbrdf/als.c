// als.c - alternating least squares (Menzel 2011, section 6.3.2), with what the digest of its
// formulas corrects: the diffuse part and what is divided by D carry k1.n everywhere
//
//     L = k1.n cd / pi + q(h) (a + b X) k1.n / D,   X = (1 - k1.h)^5,   a = s r0,  b = s (1 - r0)
//
// Errors are divided by L, the derivative of the logarithm. For a given q the rest is a bounded
// linear problem of five numbers. q is bilinear between its cells; beside the others each cell goes
// by the quotient of its samples' errors, weighted by their shares in it (SIRT), which ends at
// least squares. s, a scale, goes into q, since only their product shows.
#include "material/gbrdf/als.h"

#include "core/math/bilinear.h"
#include "core/math/luminance.h"
#include "material/gbrdf/brdf.h"

#include <string.h>

// Directions lower than this over a texel are told by few pixels.
static const float LEAST_COSINE = 0.06f;
// Of the mean: what is darker counts as if it had this value, since logarithms have no end below.
static const double DARK = 0.2;
// Cells of less than this share of the usual support are filled from those around.
static const double WELL_KNOWN = 0.1;
// Cells share samples, so that a step of 1 falls short; below 2 none goes too far.
static const double STEP = 1.5;
enum { SWEEPS = 60 };

static void put(struct als_samples *out, const struct als_form *form, vec3 k1, vec3 k2,
                const float value[3])
{
    struct als_block *b = &out->block[out->count / ALS_LANES];
    const int i = out->count++ % ALS_LANES, side = form->side;
    const vec3 h = vec3_unit(vec3_add(k1, k2));
    double at[2];
    if (!i)
        memset(b, 0, sizeof *b);
    for (int c = 0; c < form->channels; c++)
        b->value[c][i] = form->channels == 1 ? luminance_709f(value) : value[c];
    b->cosine[i] = (float)k1.z;
    b->share[i] = (float)(k1.z / brdf_masking(k1.z, k2.z));
    b->grazing[i] = (float)brdf_grazing(vec3_dot(k1, h));
    // a normal that is slightly off matters most under low light; from the side few pixels tell a
    // texel
    b->trust[i] = (float)(k1.z * k1.z * k2.z);
    ndf_place(h, side, at);
    // a place beyond the middles of the outermost cells is theirs
    const double x = fmin(fmax(at[0] - 0.5, 0.0), side - 1.0),
                 y = fmin(fmax(at[1] - 0.5, 0.0), side - 1.0);
    const int column = index_clamped((int)x, side - 1), row = index_clamped((int)y, side - 1);
    const struct bilinear cells = {.across = x - column, .down = y - row};
    b->cell[i] = (uint16_t)(row * side + column);
    for (int k = 0; k < 4; k++)
        b->corner[k][i] = bilinear_sharef(&cells, k, 1.0f);
}

void als_gather(struct als_samples *out, const struct flat *flat, size_t texel, double turn,
                const float *values, const struct als_form *form)
{
    const struct relume_btf_info *info = relume_btf_info(flat->btf);
    const uint8_t *seen = flat->seen + texel * (size_t)flat->views;
    const uint8_t *lit = flat->lit + texel * (size_t)flat->lights;
    const vec3 n = flat->normal[texel];
    const struct gbrdf_texel frame = {.normal = {(float)n.x, (float)n.y, (float)n.z},
                                      .turn = {(float)cos(turn), (float)sin(turn)}};
    double sum = 0.0;
    out->count = 0;
    for (int v = 0; v < flat->views; v++) {
        const vec3 k2 = gbrdf_local(&frame, info->view[v]);
        if (!seen[v] || k2.z < (double)LEAST_COSINE)
            continue;
        // other lights in each view
        for (int l = v % form->stride; l < flat->lights; l += form->stride) {
            const vec3 k1 = gbrdf_local(&frame, info->light[l]);
            if (!lit[l] || k1.z < (double)LEAST_COSINE)
                continue;
            const float *from = values + 3 * ((size_t)v * (size_t)flat->lights + (size_t)l);
            const float scale =
                (float)((info->without_cosine ? info->light[l].z : 1.0) / (M_PI * form->light));
            const float value[3] = {fmaxf(from[0] * scale, 0.0f), fmaxf(from[1] * scale, 0.0f),
                                    fmaxf(from[2] * scale, 0.0f)};
            put(out, form, k1, k2, value);
            sum += form->channels == 1 ? luminance_709(value)
                                       : (double)(value[0] + value[1] + value[2]) / 3.0;
        }
    }
    out->least = out->count ? (float)(DARK * sum / out->count + 1e-9) : 1.0f;
}

void als_look(struct als_samples *samples, const float *q, const struct als_form *form)
{
    const size_t blocks = als_blocks((size_t)samples->count);
    const int channels = form->channels, below = channels * form->side;
    for (struct als_block *b = samples->block; b < samples->block + blocks; b++)
        for (int i = 0; i < ALS_LANES; i++) {
            const float *from = q + channels * b->cell[i];
            for (int c = 0; c < channels; c++, from++)
                b->shine[c][i] =
                    b->share[i] *
                    (b->corner[0][i] * from[0] + b->corner[1][i] * from[channels] +
                     b->corner[2][i] * from[below] + b->corner[3][i] * from[below + channels]);
        }
}

// What divides an error, squared.
static inline float weight_of(float value, float model, float least)
{
    const float more = value > model ? value : model, w = 1.0f / (more > least ? more : least);
    return w * w;
}

// ---------------------------------------------------------------- a texel beside its distribution

enum { CD, A = 3, B, UNKNOWNS };

struct normal_equations {
    double m[UNKNOWNS][UNKNOWNS], right[UNKNOWNS];
};

// Sums of one channel, lane by lane: products of cd's, a's and b's factors, and of these and the
// value.
enum { CC, CA, CB, AA, AB, BB, CV, AV, BV, SUMS };
// Of single precision, as many blocks as lose nothing.
enum { RUN = 16 };

static void add_block(float sum[SUMS][ALS_LANES], const struct als_block *b, int channel,
                      const struct als_texel *t, float scale, float least)
{
    const float *value = b->value[channel], *shine = b->shine[channel];
    const float diffuse = (float)t->diffuse[channel], r0 = (float)t->r0, rest = 1.0f - r0;
    for (int i = 0; i < ALS_LANES; i++) {
        const float v = value[i], c = b->cosine[i] * (float)(1.0 / M_PI), a = scale * shine[i];
        const float g = b->grazing[i],
                    w = weight_of(v, c * diffuse + a * (r0 + rest * g), least) * b->trust[i];
        const float wc = w * c, wa = w * a, wb = wa * g;
        sum[CC][i] += wc * c;
        sum[CA][i] += wc * a;
        sum[CB][i] += wc * a * g;
        sum[AA][i] += wa * a;
        sum[AB][i] += wb * a;
        sum[BB][i] += wb * a * g;
        sum[CV][i] += wc * v;
        sum[AV][i] += wa * v;
        sum[BV][i] += wb * v;
    }
}

static void flush(struct normal_equations *e, int c, float sum[SUMS][ALS_LANES])
{
    double all[SUMS] = {0.0};
    for (int k = 0; k < SUMS; k++)
        for (int i = 0; i < ALS_LANES; i++)
            all[k] += (double)sum[k][i];
    memset(sum, 0, SUMS * sizeof *sum);
    e->m[CD + c][CD + c] += all[CC];
    e->m[CD + c][A] = e->m[A][CD + c] += all[CA];
    e->m[CD + c][B] = e->m[B][CD + c] += all[CB];
    e->m[A][A] += all[AA];
    e->m[A][B] = e->m[B][A] += all[AB];
    e->m[B][B] += all[BB];
    e->right[CD + c] += all[CV];
    e->right[A] += all[AV];
    e->right[B] += all[BV];
}

static void gather_equations(struct normal_equations *e, const struct als_texel *t, float scale,
                             const struct als_form *form, const struct als_samples *samples)
{
    const size_t blocks = als_blocks((size_t)samples->count);
    float sum[3][SUMS][ALS_LANES] = {{{0.0f}}};
    for (size_t k = 0; k < blocks; k++)
        for (int c = 0; c < form->channels; c++) {
            add_block(sum[c], &samples->block[k], c, t, scale, samples->least);
            if (k % RUN == RUN - 1 || k + 1 == blocks)
                flush(e, c, sum[c]);
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

double als_fit_texel(struct als_texel *t, float scale, const struct als_form *form,
                     const struct als_samples *samples, bool fixed)
{
    static const double most[UNKNOWNS] = {1.0, 1.0, 1.0, 1.0, INFINITY};
    static const double any[UNKNOWNS] = {1.0, 1.0, 1.0, INFINITY, INFINITY};
    struct normal_equations e = {.right = {0.0}};
    gather_equations(&e, t, scale, form, samples);
    double x[UNKNOWNS] = {t->diffuse[0], t->diffuse[1], t->diffuse[2], t->r0, 1.0 - t->r0};
    if (fixed)
        tie(&e);
    descend(&e, x, fixed ? most : any, fixed ? B : UNKNOWNS);
    memcpy(t->diffuse, x, sizeof t->diffuse);
    if (fixed) {
        t->r0 = x[A];
        return 1.0;
    }
    const double both = x[A] + x[B];
    if (both > 1e-9)
        t->r0 = x[A] / both;
    return fmax(both, 1e-4);
}

// ---------------------------------------------------------------- the distribution beside texels

void als_add(struct als_sums *sums, const struct als_texel *t, float scale,
             const struct als_form *form, const struct als_samples *samples)
{
    const size_t blocks = als_blocks((size_t)samples->count);
    const float r0 = (float)t->r0, rest = 1.0f - r0, least = samples->least;
    const int corner[4] = {0, 1, form->side, form->side + 1};
    for (size_t k = 0; k < blocks; k++) {
        const struct als_block *b = &samples->block[k];
        float above[ALS_LANES], below[ALS_LANES];
        for (int c = 0; c < form->channels; c++) {
            const float diffuse = (float)(t->diffuse[c] / M_PI);
            for (int i = 0; i < ALS_LANES; i++) {
                const float fresnel = r0 + rest * b->grazing[i], lambda = b->share[i] * fresnel;
                const float value = b->value[c][i];
                const float model = b->cosine[i] * diffuse + scale * b->shine[c][i] * fresnel;
                const float w = weight_of(value, model, least) * b->trust[i] * lambda;
                above[i] = w * (value - model);
                below[i] = w * lambda;
            }
            for (int i = 0; i < ALS_LANES; i++)
                for (int n = 0; n < 4; n++) {
                    const int cell = b->cell[i] + corner[n];
                    sums->above[cell][c] += (double)(b->corner[n][i] * above[i]);
                    sums->below[cell][c] += (double)(b->corner[n][i] * below[i]);
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

// q = cs p: one distribution, and its share in each colour, of which the largest is 1.
struct tinted {
    double share[3];
    float p[NDF_SIDE * NDF_SIDE];
};

static void part(struct tinted *out, const float *q, const struct als_form *form)
{
    const int cells = form->side * form->side, channels = form->channels;
    int brightest = 0;
    double most = 0.0;
    for (int c = 0; c < channels; c++) {
        out->share[c] = 0.0;
        for (int i = 0; i < cells; i++)
            out->share[c] += (double)q[channels * i + c];
        brightest = out->share[c] > most ? c : brightest;
        most = fmax(most, out->share[c]);
    }
    for (int c = 0; c < channels; c++)
        out->share[c] = most > 0.0 ? out->share[c] / most : 1.0;
    for (int i = 0; i < cells; i++)
        out->p[i] = q[channels * i + brightest];
}

// The better p, with how well each cell is known, and what is left to explain then.
static void move_cells(struct tinted *t, float *weight, struct als_sums *sums,
                       const struct als_form *form)
{
    const int side = form->side, cells = side * side;
    double support[NDF_SIDE * NDF_SIDE], usual = 1e-12;
    for (int i = 0; i < cells; i++) {
        support[i] = 0.0;
        for (int c = 0; c < form->channels; c++)
            support[i] += t->share[c] * t->share[c] * sums->below[i][c];
        usual += support[i] / cells;
    }
    for (int i = 0; i < cells; i++) {
        double rest = 0.0;
        for (int c = 0; c < form->channels; c++)
            rest += t->share[c] * sums->above[i][c];
        const double change = support[i] > 1e-9 * usual ? STEP * rest / support[i] : 0.0,
                     p = fmin(fmax((double)t->p[i] + change, 0.0), 6e4);
        for (int c = 0; c < form->channels; c++)
            sums->above[i][c] -= sums->below[i][c] * t->share[c] * (p - (double)t->p[i]);
        weight[i] = (float)fmin(support[i] / (WELL_KNOWN * usual), 1.0);
        t->p[i] = (float)p;
    }
}

static void move_shares(struct tinted *t, const struct als_sums *sums, const struct als_form *form)
{
    const int cells = form->side * form->side;
    for (int c = 0; c < form->channels; c++) {
        double above = 0.0, below = 0.0;
        for (int i = 0; i < cells; i++) {
            above += (double)t->p[i] * sums->above[i][c];
            below += (double)t->p[i] * (double)t->p[i] * sums->below[i][c];
        }
        if (below > 0.0)
            t->share[c] = fmax(t->share[c] + above / below, 0.0);
    }
}

void als_solve(float *q, struct als_sums *sums, const struct als_form *form,
               const double diffuse[3])
{
    const int side = form->side, cells = side * side, channels = form->channels;
    struct tinted t;
    float weight[NDF_SIDE * NDF_SIDE] = {0.0f};
    double integral = 0.0;
    part(&t, q, form);
    move_cells(&t, weight, sums, form);
    move_shares(&t, sums, form);
    ndf_fill(t.p, weight, side);
    for (int i = 0; i < cells; i++)
        integral += solid_of(i, side) * (double)t.p[i];
    for (int c = 0; c < channels; c++) {
        const double most = fmax(1.0 - diffuse[c], 0.0),
                     share = fmin(t.share[c], integral > 0.0 ? most / integral : INFINITY);
        for (int i = 0; i < cells; i++) {
            const double solid = solid_of(i, side);
            q[channels * i + c] =
                (float)fmin(share * (double)t.p[i], solid > 0.0 ? 1.0 / solid : 6e4);
        }
    }
}

void als_fit_alone(struct als_texel *t, float *q, struct als_sums *scratch,
                   struct als_samples *samples, const struct als_form *form, int rounds)
{
    const int cells = form->side * form->side, values = cells * form->channels;
    for (int i = 0; i < values; i++)
        q[i] = 0.05f;
    *t = (struct als_texel){{0.2, 0.2, 0.2}, 0.3};
    for (int round = 0; round < rounds; round++) {
        als_look(samples, q, form);
        const float scale = (float)als_fit_texel(t, 1.0f, form, samples, false);
        for (int i = 0; i < values; i++)
            q[i] *= scale;
        memset(scratch->above, 0, (size_t)cells * sizeof *scratch->above);
        memset(scratch->below, 0, (size_t)cells * sizeof *scratch->below);
        als_add(scratch, t, scale, form, samples);
        als_solve(q, scratch, form, t->diffuse);
    }
}
