// measure.c - a target in a photograph: found or given by its corners, its patches averaged
#include "capture/acquire/chart.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/luminance.h"

#include <math.h>
#include <relume/image/photograph.h>
#include <string.h>

enum { SMALL = 1024, PHOTOGRAPHS = 8, SAMPLES = 4, MOST_STEPS = 200 };
static const char *const names[CHART_PATCHES] = {
    "dark skin", "light skin",    "blue sky",     "foliage",   "blue flower",  "bluish green",
    "orange",    "purplish blue", "moderate red", "purple",    "yellow green", "orange yellow",
    "blue",      "green",         "red",          "yellow",    "magenta",      "cyan",
    "white",     "neutral 8",     "neutral 6.5",  "neutral 5", "neutral 3.5",  "black",
};
static const double WHITE = 0.998, BLACK = 1e-6, MOST_CLIPPED = 0.01;
static const double PART = 0.25;   // of the way between patches that is averaged, to either side
static const double SAMPLE = 0.1;  // the same on the small picture
// Of the cube root of light: what neighbours in an even region differ by at most. Noise needs the
// larger, dark patches in a dark frame the smaller ones.
static const float evenness[] = {0.02f, 0.04f, 0.08f, 0.012f};

static const double LEAST_FALL = 1.05, GREY_RANGE = 4.0;  // of greys, in any light
enum { FIRST_GREY = 18 };

// Corners of the patches' field, in cells.
static const double corners[4][2] = {
    {-CHART_HALF, -CHART_HALF},
    {CHART_COLUMNS - 1 + CHART_HALF, -CHART_HALF},
    {CHART_COLUMNS - 1 + CHART_HALF, CHART_ROWS - 1 + CHART_HALF},
    {-CHART_HALF, CHART_ROWS - 1 + CHART_HALF},
};

// ---------------------------------------------------------------- patches

struct patch_sums {
    double n, clipped, colour[3], y, yy;
};

static bool inside(const struct relume_image *image, const double at[2])
{
    return at[0] >= 0.0 && at[1] >= 0.0 && at[0] < image->width && at[1] < image->height;
}

// The even middle of a patch, `part` of a cell to either side, at steps of about a pixel, at most
// so many.
static bool sum_patch(struct patch_sums *s, const struct relume_image *image,
                      const struct homography *h, int patch, double part, int most, bool ends_at_1)
{
    const double x = patch % CHART_COLUMNS, y = patch / CHART_COLUMNS;
    double a[2], b[2];
    *s = (struct patch_sums){0};
    homography_apply(a, h, x - part, y - part);
    homography_apply(b, h, x + part, y + part);
    const double reach = hypot(b[0] - a[0], b[1] - a[1]);
    const int steps = reach + 2.0 < most ? (int)reach + 2 : most;
    for (int j = 0; j < steps; j++)
        for (int i = 0; i < steps; i++) {
            double at[2];
            homography_apply(at, h, x + part * (2.0 * (i + 0.5) / steps - 1.0),
                             y + part * (2.0 * (j + 0.5) / steps - 1.0));
            if (!inside(image, at))
                return false;
            const float *p =
                image->data + 3 * ((size_t)at[1] * (size_t)image->width + (size_t)at[0]);
            const double v = luminance_709(p);
            for (int c = 0; c < 3; c++)
                s->colour[c] += (double)p[c];
            s->clipped += ends_at_1 && (double)fmaxf(fmaxf(p[0], p[1]), p[2]) >= WHITE;
            s->n += 1.0, s->y += v, s->yy += v * v;
        }
    return true;
}

// All patches as they are seen through `h`; false where one is outside of the picture.
static bool sum_patches(struct relume_chart *t, const struct relume_image *image,
                        const struct homography *h, double part, int most, bool ends_at_1)
{
    for (int i = 0; i < CHART_PATCHES; i++) {
        struct relume_chart_patch *p = &t->patch[i];
        struct patch_sums s;
        if (!sum_patch(&s, image, h, i, part, most, ends_at_1))
            return false;
        const double mean = s.y / s.n;
        *p = (struct relume_chart_patch){.name = names[i]};
        homography_apply(p->place, h, i % CHART_COLUMNS, i / CHART_COLUMNS);
        for (int c = 0; c < 3; c++)
            p->found[c] = (float)(s.colour[c] / s.n);
        p->used = s.clipped <= MOST_CLIPPED * s.n && mean > BLACK && isfinite(mean);
        p->noise = mean > BLACK ? sqrt(fmax(s.yy / s.n - mean * mean, 0.0)) / mean : 0.0;
    }
    return true;
}

// ---------------------------------------------------------------- finding

struct search {
    const struct relume_image *small;
    const double (*reference)[3];
    bool ends_at_1;
    double least;  // of mean differences so far
    struct homography best;
};

// Whether the last row falls from white to black, which few other things do.
static bool has_greys(const struct relume_chart *t)
{
    double before = INFINITY, first = 0.0, y = 0.0;
    for (int i = FIRST_GREY; i < CHART_PATCHES; i++, before = y) {
        y = luminance_709(t->patch[i].found);
        first = i == FIRST_GREY ? y : first;
        if (!(y < LEAST_FALL * before))
            return false;
    }
    return first > GREY_RANGE * y;
}

static bool look(void *context, const struct homography *h)
{
    struct search *s = context;
    struct relume_chart t;
    if (!sum_patches(&t, s->small, h, SAMPLE, SAMPLES, s->ends_at_1) || !has_greys(&t) ||
        !chart_fit(&t, s->reference, false))
        return false;
    if (t.after[0] < s->least) {
        s->least = t.after[0];
        s->best = *h;
    }
    return t.after[0] < CHART_LIKE;
}

static relume_status shrink(struct relume_image *out, const struct relume_image *image)
{
    const int most = image->width > image->height ? image->width : image->height;
    const double scale = most > SMALL ? (double)SMALL / most : 1.0;
    const int w = (int)fmax(image->width * scale, 1.0), h = (int)fmax(image->height * scale, 1.0);
    return relume_image_scale(out, image, w, h, NULL);
}

// Bring what is bright to 1, so that steps mean the same in all photographs; the rest is as it was.
static void expose(struct relume_image *image)
{
    const size_t n = 3 * (size_t)image->width * (size_t)image->height;
    double sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < n; i++) {
        const double v = fmax((double)image->data[i], 0.0);
        sum += v;
        squares += v * v;
    }
    const float scale = sum > 0.0 ? (float)(0.5 * sum / squares) : 1.0f;
    for (size_t i = 0; i < n; i++)
        image->data[i] *= scale;
}

static relume_status search(struct search *s)
{
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && i < sizeof evenness / sizeof *evenness; i++) {
        struct blob *blob;
        int n;
        if (s->least < 0.6 * CHART_LIKE)
            break;
        status = blobs_find(&blob, &n, s->small, evenness[i]);
        if (!status && n)
            status = lattice_find(blob, n, look, s);
        mem_free(blob);
    }
    return status;
}

static relume_status find(struct homography *h, double *like, const struct relume_image *image,
                          const double (*reference)[3])
{
    struct relume_image small;
    relume_status status = shrink(&small, image);
    if (status)
        return status;
    expose(&small);
    struct search s = {.small = &small, .reference = reference, .least = INFINITY};
    status = search(&s);
    // of the small picture -> of the photograph
    const double across = (double)image->width / small.width;
    const double along = (double)image->height / small.height;
    *h = s.best;
    *like = s.least;
    for (int k = 0; k < 3; k++) {
        h->h[k] *= across;
        h->h[3 + k] *= along;
    }
    relume_image_destroy(&small);
    return status;
}

// The corners in all eight orders that go around the target; its colours say which is right.
static bool from_corners(struct homography *h, double *like, const struct relume_image *image,
                         const double (*corner)[2], const double (*reference)[3])
{
    struct search s = {.small = image, .reference = reference, .least = INFINITY};
    for (int order = 0; order < 8; order++) {
        double plane[4][2];
        struct homography trial;
        for (int i = 0; i < 4; i++)
            memcpy(plane[i], corners[(order < 4 ? order + i : order - i) & 3], sizeof plane[i]);
        if (homography_fit(&trial, (const double(*)[2])plane, corner, 4))
            (void)look(&s, &trial);
    }
    *h = s.best;
    *like = s.least;
    return isfinite(s.least);
}

static relume_status say_unlike(const char *name, bool given, const struct relume_log *log)
{
    if (!given)
        return log_fail(log, RELUME_EUNFIT,
                        "%s: no colour target found; expected a ColorChecker 24, whole, in focus "
                        "and evenly lit; or give its corners",
                        name);
    return log_fail(log, RELUME_EUNFIT,
                    "%s: no ColorChecker 24 between the corners given; expected the outer corners "
                    "of its four corner patches, in order around it, inside of the picture",
                    name);
}

relume_status relume_chart_measure(struct relume_chart *out, const struct relume_image *photograph,
                                   const char *name, const struct relume_chart_params *params)
{
    const struct relume_chart_params p = PARAMS(relume_chart_params, params);
    struct homography h;
    double colours[CHART_PATCHES][3], like = INFINITY;
    const double(*reference)[3] = (const double(*)[3])colours;
    *out = (struct relume_chart){0};
    if (photograph->channels != 3)
        return RELUME_EINVAL;
    relume_chart_colours(colours, p.reference);
    relume_status status = RELUME_OK;
    if (p.corner)
        (void)from_corners(&h, &like, photograph, p.corner, reference);
    else
        status = find(&h, &like, photograph, reference);
    if (!status && !(like < CHART_LIKE))
        status = say_unlike(name, p.corner != NULL, p.log);
    if (!status && (!sum_patches(out, photograph, &h, PART, MOST_STEPS, p.ends_at_1) ||
                    !chart_fit(out, reference, true)))
        status = log_fail(p.log, RELUME_EUNFIT,
                          "%s: %d patches of the colour target can be used; expected at least 12, "
                          "and greys, neither black nor overexposed",
                          name, out->used);
    for (int i = 0; !status && i < 4; i++)
        homography_apply(out->corner[i], &h, corners[i][0], corners[i][1]);
    if (status)
        *out = (struct relume_chart){0};
    return status;
}

// ---------------------------------------------------------------- of files

static relume_status load_one(struct relume_chart *out, const char *path,
                              const struct relume_chart_params *params)
{
    struct relume_chart_params p = *params;
    struct relume_image image;
    struct relume_exif notes;
    relume_status status = relume_photograph_load(
        &image, &notes, path,
        relume_photograph_params(.log = p.log, .limits = p.limits, .transfer = p.transfer));
    p.ends_at_1 = !notes.floats;
    if (!status)
        status = relume_chart_measure(out, &image, path, &p);
    relume_image_destroy(&image);
    return status;
}

relume_status relume_chart_load(struct relume_chart *out, const char *const *paths, int n,
                                const struct relume_chart_params *params)
{
    const struct relume_chart_params p = PARAMS(relume_chart_params, params);
    struct relume_chart_params quiet = p;
    *out = (struct relume_chart){0};
    if (n < 1)
        return RELUME_EINVAL;
    if (n == 1)
        return load_one(out, paths[0], &p);
    const int tries = n < PHOTOGRAPHS ? n : PHOTOGRAPHS;
    struct relume_log silent = p.log ? *p.log : (struct relume_log){0};
    silent.message = NULL;
    quiet.log = &silent;
    bool found = false;
    for (int k = 0; k < tries; k++) {
        struct relume_chart one;
        const int i = (int)((int64_t)k * n / tries);
        const relume_status status = load_one(&one, paths[i], &quiet);
        if (status == RELUME_ENOMEM || status == RELUME_ECANCEL)
            return status;
        if (status || (found && !(one.after[0] < out->after[0])))
            continue;
        *out = one;
        out->photograph = i;
        found = true;
    }
    if (found)
        return RELUME_OK;
    return log_fail(p.log, RELUME_EUNFIT,
                    "%s: no colour target found in it and %d of the other photographs; expected a "
                    "ColorChecker 24, whole, in focus and evenly lit; or give a photograph of it, "
                    "or its corners",
                    paths[0], tries - 1);
}

void relume_chart_apply(struct relume_image *image, const float matrix[9], bool ends_at_1)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    float white = 0.0f;
    for (int c = 0; c < 3; c++)
        white = fmaxf(white, matrix[3 * c] + matrix[3 * c + 1] + matrix[3 * c + 2]);
    for (size_t i = 0; i < pixels; i++) {
        float *p = image->data + 3 * i;
        const float r = p[0], g = p[1], b = p[2];
        const bool full = ends_at_1 && r >= 1.0f && g >= 1.0f && b >= 1.0f;
        for (int c = 0; c < 3; c++)
            p[c] = full ? white : matrix[3 * c] * r + matrix[3 * c + 1] * g + matrix[3 * c + 2] * b;
    }
}
