// colour.c - the matrix that brings what a camera saw of a target to what its patches are
//
// Linear least squares in linear light, where a patch counts by the inverse of its own brightness,
// as the eye counts it; in turn with the light on the target, a smooth function over it of three
// numbers. Then Gauss-Newton on differences of L*a*b* weighed as CIE94 weighs them, which are
// smooth where CIEDE2000 is not.
#include "capture/acquire/chart.h"

#include "core/math/lsq.h"
#include "image/compare/ciede2000.h"

#include <math.h>
#include <string.h>

enum { TURNS = 6, STEPS = 12, HALVINGS = 6, LIGHT = 3, FIRST_GREY = 18, LEAST_USED = 12 };
static const double DARKEST = 0.03;     // reflectance that counts as black
static const double LEAST_LIGHT = 0.3;  // of the light in the middle; less is a wrong fit
static const double GREY_COUNTS = 2.0;  // times a colour

struct fitting {
    const struct relume_chart *t;
    const double (*reference)[3];
    double lab[CHART_PATCHES][3];
    double light[CHART_PATCHES];  // at each patch, 1 in the middle
    double m[9];                  // photographed -> reflectance
};

static void multiply(double out[3], const double m[9], const float v[3], double scale)
{
    for (int c = 0; c < 3; c++)
        out[c] = scale * (m[3 * c] * (double)v[0] + m[3 * c + 1] * (double)v[1] +
                          m[3 * c + 2] * (double)v[2]);
}

static double luminance_of(const double v[3])
{
    return 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];
}

static double weight_of(const struct fitting *f, int i)
{
    return 1.0 / (DARKEST + fmax(luminance_of(f->reference[i]), 0.0));
}

// The matrix under the light as it is known.
static bool fit_matrix(struct fitting *f)
{
    double gram[9] = {0.0}, right[3][3] = {{0.0}};
    for (int i = 0; i < CHART_PATCHES; i++) {
        if (!f->t->patch[i].used)
            continue;
        double row[3];
        const double w = weight_of(f, i);
        for (int c = 0; c < 3; c++)
            row[c] = w * (double)f->t->patch[i].found[c] / f->light[i];
        lsq_add_gram(gram, 3, row, 1);
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++)
                right[c][k] += w * f->reference[i][c] * row[k];
    }
    const double trace = gram[0] + gram[4] + gram[8];
    for (int c = 0; c < 3; c++)
        gram[4 * c] += 1e-9 * trace;
    if (!(trace > 0.0) || !isfinite(trace) || !lsq_solve(gram, 3, right[0], 3))
        return false;
    memcpy(f->m, right, sizeof f->m);
    return true;
}

static void light_terms(double term[1 + LIGHT], int patch)
{
    const double u = (patch % CHART_COLUMNS - 0.5 * (CHART_COLUMNS - 1)) / CHART_COLUMNS;
    const double v = (patch / CHART_COLUMNS - 0.5 * (CHART_ROWS - 1)) / CHART_COLUMNS;
    term[0] = 1.0, term[1] = u, term[2] = v, term[3] = u * u + v * v;
}

// The light under the matrix as it is known; it stays where there is none that could be.
static void fit_light(struct fitting *f)
{
    double gram[(1 + LIGHT) * (1 + LIGHT)] = {0.0}, right[1 + LIGHT] = {0.0};
    for (int i = 0; i < CHART_PATCHES; i++) {
        if (!f->t->patch[i].used)
            continue;
        double shown[3], row[1 + LIGHT];
        multiply(shown, f->m, f->t->patch[i].found, 1.0);
        const double y = luminance_of(f->reference[i]), w = y * weight_of(f, i);
        light_terms(row, i);
        for (int k = 0; k <= LIGHT; k++)
            row[k] *= w;
        lsq_add_gram(gram, 1 + LIGHT, row, 1);
        for (int k = 0; k <= LIGHT; k++)
            right[k] += w * row[k] * luminance_of(shown) / y;
    }
    for (int k = 0; k <= LIGHT; k++)
        gram[k * (2 + LIGHT)] *= 1.0 + 1e-6;
    if (!lsq_solve(gram, 1 + LIGHT, right, 1) || !(right[0] > 0.0))
        return;
    double light[CHART_PATCHES];
    for (int i = 0; i < CHART_PATCHES; i++) {
        double term[1 + LIGHT];
        light[i] = 0.0;
        light_terms(term, i);
        for (int k = 0; k <= LIGHT; k++)
            light[i] += term[k] * right[k] / right[0];
        if (!(light[i] > LEAST_LIGHT && light[i] < 1.0 / LEAST_LIGHT))
            return;
    }
    memcpy(f->light, light, sizeof f->light);
}

// ---------------------------------------------------------------- as it is seen

// Lightness, chroma and hue of the difference, each in steps that are about equally seen.
static void seen_difference(double out[3], const struct fitting *f, const double m[9], int i)
{
    double rgb[3], lab[3];
    const double *ref = f->lab[i], chroma = hypot(ref[1], ref[2]);
    const double c = chroma > 1.0 ? ref[1] / chroma : 1.0, s = chroma > 1.0 ? ref[2] / chroma : 0.0;
    const double weight = i >= FIRST_GREY ? GREY_COUNTS : 1.0;
    multiply(rgb, m, f->t->patch[i].found, 1.0 / f->light[i]);
    chart_lab(lab, rgb);
    const double a = lab[1] - ref[1], b = lab[2] - ref[2];
    out[0] = weight * (lab[0] - ref[0]);
    out[1] = weight * (c * a + s * b) / (1.0 + 0.045 * chroma);
    out[2] = weight * (c * b - s * a) / (1.0 + 0.015 * chroma);
}

static double seen_sum(const struct fitting *f, const double m[9])
{
    double sum = 0.0;
    for (int i = 0; i < CHART_PATCHES; i++) {
        double d[3];
        if (!f->t->patch[i].used)
            continue;
        seen_difference(d, f, m, i);
        sum += d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    }
    return sum;
}

static bool newton_step(double step[9], const struct fitting *f)
{
    double gram[81] = {0.0}, size = 0.0;
    memset(step, 0, 9 * sizeof *step);
    for (int k = 0; k < 9; k++)
        size = fmax(size, fabs(f->m[k]));
    const double tiny = 1e-5 * size;
    for (int i = 0; i < CHART_PATCHES; i++) {
        double here[3], row[3][9];
        if (!f->t->patch[i].used)
            continue;
        seen_difference(here, f, f->m, i);
        for (int k = 0; k < 9; k++) {
            double moved[9], there[3];
            memcpy(moved, f->m, sizeof moved);
            moved[k] += tiny;
            seen_difference(there, f, moved, i);
            for (int c = 0; c < 3; c++)
                row[c][k] = (there[c] - here[c]) / tiny;
        }
        lsq_add_gram(gram, 9, row[0], 3);
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 9; k++)
                step[k] -= row[c][k] * here[c];
    }
    for (int k = 0; k < 9; k++)
        gram[10 * k] *= 1.0 + 1e-9;
    return lsq_solve(gram, 9, step, 1);
}

static void refine(struct fitting *f)
{
    double best = seen_sum(f, f->m), step[9], trial[9];
    for (int k = 0; k < STEPS && newton_step(step, f); k++) {
        double share = 1.0, sum = best;
        for (int h = 0; h < HALVINGS; h++, share *= 0.5) {
            for (int j = 0; j < 9; j++)
                trial[j] = f->m[j] + share * step[j];
            sum = seen_sum(f, trial);
            if (sum < best)
                break;
        }
        if (!(sum < best * (1.0 - 1e-9)))
            return;
        best = sum;
        memcpy(f->m, trial, sizeof f->m);
    }
}

// ---------------------------------------------------------------- what is reported

static double difference(const struct fitting *f, const double m[9], int i)
{
    double rgb[3], lab[3];
    multiply(rgb, m, f->t->patch[i].found, 1.0 / f->light[i]);
    chart_lab(lab, rgb);
    return ciede2000(lab, f->lab[i]);
}

static void judge(struct relume_chart *t, const struct fitting *f, const double *const m[3])
{
    double *const sums[] = {t->before, t->balanced, t->after};
    for (int k = 0; k < 3; k++) {
        sums[k][0] = sums[k][1] = 0.0;
        for (int i = 0; i < CHART_PATCHES; i++) {
            struct relume_chart_patch *p = &t->patch[i];
            const double e = difference(f, m[k], i);
            *(k == 0 ? &p->delta_e_before : k == 1 ? &p->delta_e_balance : &p->delta_e) = e;
            if (!p->used)
                continue;
            sums[k][0] += e / t->used;
            sums[k][1] = fmax(sums[k][1], e);
        }
    }
}

// What greys show: photographed, and what they are.
static void sum_greys(double found[3], double is[3], const struct fitting *f)
{
    memset(found, 0, 3 * sizeof *found);
    memset(is, 0, 3 * sizeof *is);
    for (int i = FIRST_GREY; i < CHART_PATCHES; i++)
        for (int c = 0; f->t->patch[i].used && c < 3; c++) {
            found[c] += (double)f->t->patch[i].found[c] / f->light[i];
            is[c] += f->reference[i][c];
        }
}

static bool report(struct relume_chart *t, const struct fitting *f)
{
    double found[3], is[3];
    sum_greys(found, is, f);
    if (!(found[0] > 0.0 && found[1] > 0.0 && found[2] > 0.0))
        return false;
    double gain[9] = {0.0}, balance[9] = {0.0}, grey[3];
    const double y = luminance_of(found), gained = luminance_of(is) / y;
    double least = INFINITY, most = 0.0;
    for (int c = 0; c < 3; c++) {
        gain[4 * c] = gained;
        balance[4 * c] = is[c] / found[c];
        t->white[c] = (float)(y / found[c]);
        grey[c] = f->m[3 * c] * found[0] + f->m[3 * c + 1] * found[1] + f->m[3 * c + 2] * found[2];
    }
    t->exposure = luminance_of(grey) / y;
    if (!(t->exposure > 0.0) || !isfinite(t->exposure))
        return false;
    for (int k = 0; k < 9; k++)
        t->matrix[k] = (float)(f->m[k] / t->exposure);
    for (int i = 0; i < CHART_PATCHES; i++) {
        least = fmin(least, f->light[i]);
        most = fmax(most, f->light[i]);
    }
    t->uneven = most / least - 1.0;
    judge(t, f, (const double *const[]){gain, balance, f->m});
    return isfinite(t->after[0]) && isfinite(t->before[0]);
}

bool chart_fit(struct relume_chart *t, const double (*reference)[3], bool carefully)
{
    struct fitting f = {.t = t, .reference = reference};
    t->used = 0;
    for (int i = 0; i < CHART_PATCHES; i++) {
        f.light[i] = 1.0;
        t->used += t->patch[i].used;
        chart_lab(f.lab[i], reference[i]);
        for (int c = 0; c < 3; c++)
            t->patch[i].is[c] = (float)reference[i][c];
    }
    bool good = t->used >= LEAST_USED && fit_matrix(&f);
    for (int k = 0; good && k < TURNS; k++) {
        fit_light(&f);
        good = fit_matrix(&f);
    }
    if (good && carefully)
        refine(&f);
    return good && report(t, &f);
}
