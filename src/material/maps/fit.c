// fit.c - one pixel's colour, gloss and normal from what it shows
//
// Terms of some lights are found first, and their sums run over lanes of lights, so that compilers
// make vector code of both without reordering.
#include "material/maps/fit.h"

#include "core/math/scalar.h"

static const float DARKER = 0.12f, BRIGHTER = 0.2f;  // residuals, coded, that count a quarter
static const float GRAZING = 0.02f;                  // cosines below are no evidence
static const float TOE2 = CODE_TOE * CODE_TOE;
enum { FIRST_ROUNDS = 4, ROUNDS = 2 };
static const float WORTH = 0.995f;  // a turn that takes less off a loss is the last

// Sums of the terms of at most so many lights at a time.
enum { CHUNK = 64 };
struct lanes {
    float lane[LOOK_LANES];
};

static void add(struct lanes *sum, const float *restrict term, int n)
{
    for (int i = 0; i < n; i += LOOK_LANES)
        for (int l = 0; l < LOOK_LANES; l++)
            sum->lane[l] += term[i + l];
}

static float sum_of(const struct lanes *s)
{
    float sum = 0.0f;
    for (int l = 0; l < LOOK_LANES; l++)
        sum += s->lane[l];
    return sum;
}

// Of one channel of some lights.
struct part {
    const float *restrict base, *restrict slope, *restrict cosine, *restrict clipped;
    const float *restrict value, *restrict coded;
    int n;
};

static struct part part_of(const struct look *k, int channel, int first)
{
    return (struct part){k->base + first,
                         k->slope + first,
                         k->cosine + first,
                         k->clipped + first,
                         k->value[channel] + first,
                         k->coded[channel] + first,
                         smaller_of(k->lights - first, CHUNK)};
}

// What is known of a sample by its residual.
struct judged {
    float weight, loss;
    float counts;  // 1: it is evidence
};

// Bounds, at which a sample counts a quarter, are multiplied by `wide`. Nothing branches.
static inline struct judged judge(float residual, float cosine, float clipped, float wide)
{
    const float bound = wide * (residual < 0.0f ? DARKER : BRIGHTER), s2 = bound * bound;
    const float seen = cosine > GRAZING ? residual < 0.0f ? 1.0f - clipped : 1.0f : 0.0f;
    const float r2 = residual * residual, part = s2 / (s2 + r2);
    return (struct judged){seen * part * part, seen * part * r2, cosine > GRAZING ? 1.0f : 0.0f};
}

// One round of reweighted least squares of one channel.
static float refit(float colour, const struct look *k, int c, float wide)
{
    struct lanes top = {{0}}, bottom = {{0}};
    for (int first = 0; first < k->lights; first += CHUNK) {
        const struct part p = part_of(k, c, first);
        float above[CHUNK], below[CHUNK];
        for (int i = 0; i < p.n; i++) {
            const float model = p.base[i] + colour * p.slope[i] + TOE2;
            const struct judged j =
                judge(p.coded[i] + CODE_TOE - sqrtf(model), p.cosine[i], p.clipped[i], wide);
            const float w = j.weight * p.slope[i] / model;
            above[i] = w * (p.value[i] - p.base[i]);
            below[i] = w * p.slope[i];
        }
        add(&top, above, p.n);
        add(&bottom, below, p.n);
    }
    const float most = sum_of(&bottom);
    const float found = most > 1e-12f ? sum_of(&top) / most : colour;
    return found < 0.0f ? 0.0f : found > 1.0f ? 1.0f : found;
}

static float loss_of(const float colour[3], const struct look *k, float wide)
{
    struct lanes sum = {{0}}, count = {{0}};
    for (int c = 0; c < 3; c++)
        for (int first = 0; first < k->lights; first += CHUNK) {
            const struct part p = part_of(k, c, first);
            float loss[CHUNK], counts[CHUNK];
            for (int i = 0; i < p.n; i++) {
                const float model = p.base[i] + colour[c] * p.slope[i] + TOE2;
                const struct judged j =
                    judge(p.coded[i] + CODE_TOE - sqrtf(model), p.cosine[i], p.clipped[i], wide);
                loss[i] = j.loss;
                counts[i] = j.counts;
            }
            add(&sum, loss, p.n);
            add(&count, counts, p.n);
        }
    const float n = sum_of(&count);
    return n > 0.0f ? sum_of(&sum) / n : 0.0f;
}

// For a look that has its base and slope.
static float fit_colour(float colour[3], const struct look *k, int rounds, float wide)
{
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < rounds; r++)
            colour[c] = refit(colour[c], k, c, wide);
    return loss_of(colour, k, wide);
}

static void begin(float colour[3], const struct look *k, const struct gloss *g,
                  const float albedo[3])
{
    for (int c = 0; c < 3; c++) {
        float top = 0.0f, bottom = 1e-9f;
        for (int i = 0; g->metal && i < k->lights; i++) {
            top += k->coded[c][i];
            bottom += code_of(k->lobe[i]);
        }
        const float found = g->metal ? top * top / (bottom * bottom) : albedo[c];
        colour[c] = found < 1.0f ? found : 1.0f;
    }
}

float gloss_try(float colour[3], const struct look *k, const struct gloss *g, const float normal[3],
                const float albedo[3])
{
    look_turn(k, normal, g->roughness);
    look_gloss(k, g);
    begin(colour, k, g, albedo);
    return fit_colour(colour, k, FIRST_ROUNDS, 1.0f);
}

// ---------------------------------------------------------------- normals

static const float STEP = 0.01f;   // radians, of differences
static const float LOOSE = 0.15f;  // radians: a turn as costly as ...
static const float HELD = 1e-4f;   // ... this loss

// `normal` turned by small angles about two axes across it.
static void tilt(float out[3], const float n[3], float a, float b)
{
    const float sign = n[2] >= 0.0f ? 1.0f : -1.0f, p = -1.0f / (sign + n[2]), q = n[0] * n[1] * p;
    const float u[3] = {1.0f + sign * n[0] * n[0] * p, sign * q, -sign * n[0]};
    const float v[3] = {q, sign + n[1] * n[1] * p, -n[1]};
    float length = 0.0f;
    for (int c = 0; c < 3; c++) {
        out[c] = n[c] + a * u[c] + b * v[c];
        length += out[c] * out[c];
    }
    for (int c = 0; c < 3; c++)
        out[c] /= sqrtf(length);
}

static float turned(const float a[3], const float b[3])
{
    const float d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return HELD * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / (LOOSE * LOOSE);
}

// The normal equations of both tilts.
struct slopes {
    struct lanes aa, ab, bb, a, b;
};

static void add_lights(struct slopes *s, const struct look *k, const struct look beside[2],
                       float colour, int c, float wide)
{
    for (int first = 0; first < k->lights; first += CHUNK) {
        const struct part p = part_of(k, c, first), a = part_of(&beside[0], c, first),
                          b = part_of(&beside[1], c, first);
        float aa[CHUNK], ab[CHUNK], bb[CHUNK], ar[CHUNK], br[CHUNK];
        for (int i = 0; i < p.n; i++) {
            const float model = sqrtf(p.base[i] + colour * p.slope[i] + TOE2);
            const float r = p.coded[i] + CODE_TOE - model;
            const float da = (sqrtf(a.base[i] + colour * a.slope[i] + TOE2) - model) / STEP;
            const float db = (sqrtf(b.base[i] + colour * b.slope[i] + TOE2) - model) / STEP;
            const float w = judge(r, p.cosine[i], p.clipped[i], wide).weight;
            aa[i] = w * da * da, ab[i] = w * da * db, bb[i] = w * db * db;
            ar[i] = w * da * r, br[i] = w * db * r;
        }
        add(&s->aa, aa, p.n), add(&s->ab, ab, p.n), add(&s->bb, bb, p.n);
        add(&s->a, ar, p.n), add(&s->b, br, p.n);
    }
}

// Of a look that has been turned to `normal`.
static void find_step(float step[2], const struct look *k, const struct gloss *g,
                      const float normal[3], const float colour[3], float wide)
{
    struct look beside[2] = {*k, *k};
    struct slopes s = {0};
    for (int t = 0; t < 2; t++) {
        float n[3], *const *aside = k->aside + 4 * t;
        beside[t].cosine = aside[0], beside[t].lobe = aside[1];
        beside[t].base = aside[2], beside[t].slope = aside[3];
        tilt(n, normal, t ? 0.0f : STEP, t ? STEP : 0.0f);
        look_turn(&beside[t], n, g->roughness);
        look_gloss(&beside[t], g);
    }
    for (int c = 0; c < 3; c++)
        add_lights(&s, k, beside, colour[c], c, wide);
    const float damp = 3.0f * (float)k->known * HELD / (LOOSE * LOOSE);
    const float aa = 1.01f * sum_of(&s.aa) + damp, bb = 1.01f * sum_of(&s.bb) + damp;
    const float ab = sum_of(&s.ab), a = sum_of(&s.a), b = sum_of(&s.b), det = aa * bb - ab * ab;
    const float most = 0.2f;
    step[0] = (bb * a - ab * b) / det, step[1] = (aa * b - ab * a) / det;
    const float length = sqrtf(step[0] * step[0] + step[1] * step[1]);
    for (int t = 0; t < 2 && length > most; t++)
        step[t] *= most / length;
}

static float refit_at(float colour[3], const struct look *k, const struct gloss *g,
                      const float normal[3], const float start[3], float wide)
{
    look_turn(k, normal, g->roughness);
    look_gloss(k, g);
    return fit_colour(colour, k, ROUNDS, wide) + turned(normal, start);
}

static void straighten(float normal[3], float colour[3], const struct look *k,
                       const struct gloss *g, const float start[3], int turns, float wide)
{
    float best = refit_at(colour, k, g, normal, start, wide);
    for (int turn = 0; turn < turns; turn++) {
        float step[2];
        const float before = best;
        bool better = false;
        find_step(step, k, g, normal, colour, wide);
        for (int half = 0; half < 3 && !better; half++) {
            float n[3], c[3] = {colour[0], colour[1], colour[2]};
            tilt(n, normal, step[0], step[1]);
            const float loss = refit_at(c, k, g, n, start, wide);
            better = loss < best;
            for (int i = 0; better && i < 3; i++)
                normal[i] = n[i], colour[i] = c[i];
            best = better ? loss : best;
            step[0] *= 0.4f, step[1] *= 0.4f;
        }
        if (!(best < WORTH * before))
            return;
        look_turn(k, normal, g->roughness);
        look_gloss(k, g);
    }
}

// Of a metal the first guess may be so far off that its highlights do not meet the true ones, so
// that they are all outliers: bounds begin wide.
float gloss_straighten(float normal[3], float colour[3], const struct look *k,
                       const struct gloss *g, const float start[3], int turns)
{
    for (float wide = g->metal ? 8.0f : 1.0f; wide > 1.0f; wide *= 0.35f)
        straighten(normal, colour, k, g, start, turns, wide);
    straighten(normal, colour, k, g, start, turns, 1.0f);
    return refit_at(colour, k, g, normal, normal, 1.0f);
}

void gloss_start(float normal[3], const struct look *k, const struct gloss *g, const float matte[3])
{
    float length = 0.0f;
    for (int c = 0; c < 3; c++) {
        normal[c] = matte[c] + (g->metal ? k->view[c] : 0.0f);
        length += normal[c] * normal[c];
    }
    for (int c = 0; c < 3; c++)
        normal[c] /= sqrtf(length + 1e-20f);
}
