// stepped.c - the height of a surface that has steps, from its normals
//
// A pixel's slope holds towards its neighbours on both sides of each axis, but at a step on one
// side only (bilateral normal integration, Cao et al. 2022). With e+ and e- what the height misses
// on either side of the mean slope of both pixels, in pixels along the normal, the sides weigh
//     w+ = share(k (e-^2 - e+^2)) / (1 + (e+ / s)^2)^2,   w- likewise,
// in which `share` goes from 0 to 1 and is half for equal misses, so that smooth surfaces keep
// central differences; they are compared by what they miss and not, as in the paper, by their
// heights, which keeps steep ones too. The second factor (Geman and McClure 1987) gives up both
// sides of a pixel that neither fits. Its s shrinks from round to round: at first a step is spread
// over many pixels, of which none stands out. Each round solves for the heights under the weights
// of the one before. Weights also fall with the normal's cosine beyond 60 degrees, where slopes are
// known worse (sooner is no better: the steep sides of grooves would count less than the others),
// and with the confidence of the normals.
#include "capture/acquire/stepped.h"

#include "capture/acquire/photometric.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/grid.h"

#include <math.h>
#include <string.h>

// Pictures of so many pixels a side take all rounds: s = 4, 2, 1, .5 and .25, EACH rounds of each.
// Larger ones begin with the heights of a picture half as large, and take s = 1, .5 and .25.
enum { COARSEST = 128, EACH = 4, ROUNDS = 5 * EACH, FINE_ROUNDS = 3 };
enum { STEPS = 3, LAST_STEPS = 40 };  // of the conjugate gradients
enum { BAND = 16 };                   // rows
static const float coarse_size = 4.0f, fine_size = 1.0f;
static const float sharpness = 2.0f;    // k
static const float torn = 1e-6f;        // what is left between known pixels
static const float bridge = 1e-3f;      // between pixels of which one is unknown, sloping by 0
static const float least_sure = 0.05f;  // no pixel counts less for its confidence
static const double share = 1e-3, last_share = 1e-5;

struct facet {
    float slope[2], weight, cosine2;  // weight 0: unknown
};

struct stepped {
    const struct relume_image *normal, *confidence;
    struct grid grid;
    float s;              // 0: all sides weigh the same
    struct facet *facet;  // [workers][BAND + 3][width + 2]
};

static struct facet facet_at(const struct stepped *j, size_t at)
{
    struct facet f = {.weight = 0.0f};
    if (!slopes_of(f.slope, j->normal->data + 3 * at))
        return f;
    f.cosine2 = 1.0f / (1.0f + f.slope[0] * f.slope[0] + f.slope[1] * f.slope[1]);
    f.weight = fminf(2.0f * sqrtf(f.cosine2), 1.0f);
    if (j->confidence)
        f.weight *= fmaxf(j->confidence->data[at], least_sure);
    return f;
}

// What the heights of a pair miss of the slopes at both; 0 where one is unknown.
static float miss_of(const float *z, size_t step, const struct facet *a, const struct facet *b,
                     int axis)
{
    if (a->weight == 0.0f || b->weight == 0.0f)
        return 0.0f;
    return z[step] - z[0] - 0.5f * (a->slope[axis] + b->slope[axis]);
}

// The weights of a pixel's slope towards the pixels before and after it, `step` values and `beside`
// facets away.
static void weigh(float side[2], const struct stepped *j, const float *z, size_t step,
                  const struct facet *f, size_t beside, int axis)
{
    const struct facet *const before = f - beside, *const after = f + beside;
    side[0] = side[1] = 0.5f * f->weight;
    if (j->s == 0.0f || f->weight == 0.0f)
        return;
    float miss[2] = {miss_of(z - step, step, before, f, axis), miss_of(z, step, f, after, axis)};
    for (int i = 0; i < 2; i++)
        miss[i] *= miss[i] * f->cosine2;
    if (before->weight > 0.0f && after->weight > 0.0f) {
        const float t = 0.5f * sharpness * (miss[1] - miss[0]), lean = t / sqrtf(1.0f + t * t);
        side[0] *= 1.0f + lean;
        side[1] *= 1.0f - lean;
    }
    for (int i = 0; i < 2; i++) {
        const float fits = 1.0f / (1.0f + miss[i] / (j->s * j->s));
        side[i] *= fits * fits;
    }
}

// The pair of two neighbours, each with the weight of its own slope.
static void join(float *weight, float *difference, const struct facet *a, const struct facet *b,
                 float from_a, float from_b, int axis)
{
    const float p = a->slope[axis], q = b->slope[axis];
    if (a->weight > 0.0f && b->weight > 0.0f) {
        *weight = from_a + from_b + torn;
        *difference = from_a * p + from_b * q + 0.5f * torn * (p + q);
    } else {
        *weight = from_a + from_b + bridge;
        *difference = from_a * p + from_b * q;
    }
}

// The pairs of a row with each other and with the next row.
static void weigh_row(struct stepped *j, size_t y, const struct facet *f)
{
    struct grid *const g = &j->grid;
    const size_t w = (size_t)g->width;
    float from_last = 0.0f;
    for (size_t x = 0, at = y * w; x < w; x++, at++, f++) {
        float side[2], below[2];
        weigh(side, j, g->z + at, 1, f, 1, 0);
        if (x > 0)
            join(g->right + at - 1, g->across + at - 1, f - 1, f, from_last, side[0], 0);
        from_last = side[1];
        if (y + 1 == (size_t)g->height)
            continue;
        weigh(side, j, g->z + at, w, f, w + 2, 1);
        weigh(below, j, g->z + at + w, w, f + w + 2, w + 2, 1);
        join(g->down + at, g->below + at, f, f + w + 2, side[1], below[0], 1);
    }
}

static void weigh_rows(void *context, size_t item, int worker)
{
    struct stepped *const j = context;
    const size_t w = (size_t)j->grid.width, h = (size_t)j->grid.height, stride = w + 2;
    const size_t from = item * BAND, to = from + BAND < h ? from + BAND : h;
    struct facet *const facet = j->facet + (size_t)worker * (BAND + 3) * stride;
    memset(facet, 0, (BAND + 3) * stride * sizeof *facet);
    for (size_t y = from ? from - 1 : 0; y < to + 2 && y < h; y++)
        for (size_t x = 0; x < w; x++)
            facet[(y + 1 - from) * stride + x + 1] = facet_at(j, y * w + x);
    for (size_t y = from; y < to; y++)
        weigh_row(j, y, facet + (y + 1 - from) * stride + 1);
}

static void improve(struct stepped *j, int steps, double enough)
{
    thread_for(j->grid.threads, ((size_t)j->grid.height + BAND - 1) / BAND, weigh_rows, j);
    grid_solve(&j->grid, steps, enough);
}

// ---------------------------------------------------------------- from coarse to fine

// Four pixels by their mean slope; `confidence` is the sum of theirs, over four.
static void merge_pixel(float *normal, float *confidence, const struct stepped *fine, size_t x,
                        size_t y)
{
    const size_t w = (size_t)fine->normal->width, h = (size_t)fine->normal->height;
    float p = 0.0f, q = 0.0f, sum = 0.0f;
    for (size_t v = 2 * y; v < 2 * y + 2 && v < h; v++)
        for (size_t u = 2 * x; u < 2 * x + 2 && u < w; u++) {
            float slope[2];
            const size_t at = v * w + u;
            if (!slopes_of(slope, fine->normal->data + 3 * at))
                continue;
            const float sure =
                fine->confidence ? fmaxf(fine->confidence->data[at], least_sure) : 1.0f;
            p += sure * slope[0];
            q += sure * slope[1];
            sum += sure;
        }
    if (sum == 0.0f)
        return;
    *confidence = 0.25f * sum;
    const float up = 1.0f / sqrtf(p * p + q * q + sum * sum);
    normal[0] = -p * up;
    normal[1] = q * up;
    normal[2] = sum * up;
}

static relume_status merge(struct relume_image *normal, struct relume_image *confidence,
                           const struct stepped *fine)
{
    const int w = (fine->normal->width + 1) / 2, h = (fine->normal->height + 1) / 2;
    relume_status status = relume_image_create(normal, w, h, 3);
    if (!status)
        status = relume_image_create(confidence, w, h, 1);
    for (size_t i = 0; !status && i < (size_t)w * (size_t)h; i++)
        merge_pixel(normal->data + 3 * i, confidence->data + i, fine, i % (size_t)w, i / (size_t)w);
    return status;
}

// What the coarse heights are for finer pixels, each cell sloping as its own.
static void extend(struct stepped *j, const struct relume_image *coarse)
{
    const size_t w = (size_t)j->grid.width, h = (size_t)j->grid.height;
    for (size_t y = 0; y < h; y++)
        for (size_t x = 0; x < w; x++) {
            float slope[2] = {0.0f, 0.0f};
            slopes_of(slope, j->normal->data + 3 * (y * w + x));
            j->grid.z[y * w + x] =
                2.0f * coarse->data[y / 2 * (size_t)coarse->width + x / 2] +
                0.5f * ((x & 1 ? slope[0] : -slope[0]) + (y & 1 ? slope[1] : -slope[1]));
        }
}

static relume_status integrate(struct relume_image *z, struct stepped j,
                               const struct relume_height_params *p);

static relume_status begin(struct relume_image *z, const struct stepped *j,
                           const struct relume_height_params *p)
{
    struct relume_image normal = {0}, confidence = {0};
    relume_status status = merge(&normal, &confidence, j);
    if (!status) {
        struct relume_height_params half = *p;
        half.screen *= 4.0;
        status =
            integrate(z, (struct stepped){.normal = &normal, .confidence = &confidence}, &half);
    }
    relume_image_destroy(&normal);
    relume_image_destroy(&confidence);
    return status;
}

// The first heights, and how far steps are spread over pixels; then round by round.
static bool refine(struct stepped *j, const struct relume_image *coarse,
                   const struct relume_log *log)
{
    const int rounds = coarse->data ? FINE_ROUNDS : ROUNDS, each = coarse->data ? 1 : EACH;
    if (coarse->data)
        extend(j, coarse);
    else
        improve(j, LAST_STEPS, last_share);
    for (int i = 0; i < rounds; i++) {
        j->s = ldexpf(coarse->data ? fine_size : coarse_size, -i / each);
        const bool is_last = i + 1 == rounds;
        improve(j, is_last ? LAST_STEPS : STEPS, is_last ? last_share : share);
        if (!log_progress(log, "heights", (i + 1.0) / rounds))
            return false;
    }
    return true;
}

static relume_status integrate(struct relume_image *z, struct stepped j,
                               const struct relume_height_params *p)
{
    const int w = j.normal->width, h = j.normal->height;
    const int threads = thread_count(p->threads);
    struct relume_image coarse = {0};
    relume_status status = RELUME_OK;
    if ((w > h ? w : h) > COARSEST)
        status = begin(&coarse, &j, p);
    if (status)
        return status;
    j.facet = mem_array((size_t)threads * (BAND + 3) * ((size_t)w + 2), sizeof *j.facet);
    status = grid_create(&j.grid, w, h, (float)p->screen, threads);
    if (!status)
        status = j.facet ? RELUME_OK : RELUME_ENOMEM;
    if (!status && !refine(&j, &coarse, p->log))
        status = RELUME_ECANCEL;
    if (!status)
        status = relume_image_create(z, w, h, 1);
    if (!status)
        memcpy(z->data, j.grid.z, (size_t)w * (size_t)h * sizeof *z->data);
    grid_destroy(&j.grid);
    mem_free(j.facet);
    relume_image_destroy(&coarse);
    return status;
}

relume_status stepped_integrate(struct relume_image *out, const struct relume_image *normal,
                                const struct relume_height_params *p)
{
    return integrate(out, (struct stepped){.normal = normal, .confidence = p->confidence}, p);
}
