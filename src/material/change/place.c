// place.c - see place.h
#include "material/change/place.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "image/image/footprint.h"
#include "material/change/smooth.h"

#include <math.h>
#include <string.h>

static const double least_correlation = 0.15;
static const double bend_sigma = 1.5;  // pixels, over which normals are taken together

void place_free(struct place *p)
{
    mem_free(p->d);
    *p = (struct place){0};
}

void place_of(double out[2], const struct place *p, double x, double y)
{
    const double(*m)[3] = (const double(*)[3])p->m;
    double u = x, v = y;
    if (p->d) {
        const struct bilinear b =
            bilinear_at(x / p->step, y / p->step, p->columns, p->rows, EDGE_CLAMPED);
        for (int k = 0; k < 4; k++) {
            u += bilinear_share(&b, k, p->d[b.at[k]][0]);
            v += bilinear_share(&b, k, p->d[b.at[k]][1]);
        }
    }
    const double z = m[2][0] * u + m[2][1] * v + m[2][2];
    out[0] = (m[0][0] * u + m[0][1] * v + m[0][2]) / z;
    out[1] = (m[1][0] * u + m[1][1] * v + m[1][2]) / z;
}

// ---------------------------------------------------------------- sampling

struct sampling {
    struct surface *out;
    const struct surface *b;
    const struct place *p;
};

// Catmull and Rom's weights across 4 x 4 pixels; false where one of them is not known.
static bool sample_cubic(float normal[3], float colour[3], const struct surface *b, double x,
                         double y)
{
    const double left = floor(x), above = floor(y);
    double across[4], down[4];
    footprint_cubic(across, x - left);
    footprint_cubic(down, y - above);
    memset(normal, 0, 3 * sizeof *normal);
    memset(colour, 0, 3 * sizeof *colour);
    for (int k = 0; k < 16; k++) {
        const int i = index_clamped((int)left - 1 + k % 4, b->width),
                  j = index_clamped((int)above - 1 + k / 4, b->height);
        const size_t at = (size_t)j * (size_t)b->width + (size_t)i;
        const float w = (float)(across[k % 4] * down[k / 4]);
        if (!surface_knows(b, at))
            return false;
        for (size_t c = 0; c < 3; c++) {
            normal[c] += w * b->normal.data[3 * at + c];
            colour[c] += w * b->colour.data[3 * at + c];
        }
    }
    const float length =
        sqrtf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int c = 0; c < 3; c++)
        normal[c] /= length;
    return length > 0.0f;
}

static void sample_row(void *context, size_t y, int worker)
{
    (void)worker;
    const struct sampling *s = context;
    const struct surface *b = s->b;
    for (int x = 0; x < s->out->width; x++) {
        const size_t at = 3 * (y * (size_t)s->out->width + (size_t)x);
        double q[2];
        place_of(q, s->p, x + 0.5, (double)y + 0.5);
        if (!(q[0] >= 0.5 && q[1] >= 0.5 && q[0] <= b->width - 0.5 && q[1] <= b->height - 0.5))
            continue;
        float normal[3], colour[3];
        if (!sample_cubic(normal, colour, b, q[0] - 0.5, q[1] - 0.5))
            continue;
        memcpy(s->out->normal.data + at, normal, sizeof normal);
        memcpy(s->out->colour.data + at, colour, sizeof colour);
        // Means of neighbours have less noise than they: the nearest one has all of it.
        const size_t nearest = 3 * ((size_t)index_clamped((int)q[1], b->height) * (size_t)b->width +
                                    (size_t)index_clamped((int)q[0], b->width));
        if (b->gloss.data)  // its differences are smoothed anyhow
            memcpy(s->out->gloss.data + at, b->gloss.data + nearest, sizeof normal);
        if (b->gloss.data)
            memcpy(s->out->gloss_noise.data + at, b->gloss_noise.data + nearest, sizeof normal);
        memcpy(s->out->normal_noise.data + at, b->normal_noise.data + nearest, sizeof normal);
        memcpy(s->out->colour_noise.data + at, b->colour_noise.data + nearest, sizeof colour);
    }
}

relume_status place_sample(struct surface *out, const struct surface *b, const struct place *p,
                           int width, int height, int threads)
{
    *out = (struct surface){.width = width, .height = height};
    struct relume_image *const of[] = {&out->normal,       &out->colour, &out->normal_noise,
                                       &out->colour_noise, &out->gloss,  &out->gloss_noise};
    const size_t images = b->gloss.data ? 6 : 4;
    struct sampling s = {out, b, p};
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && i < images; i++)
        status = relume_image_create(of[i], width, height, 3);
    if (status)
        surface_free(out);
    else
        thread_for(threads, (size_t)height, sample_row, &s);
    return status;
}

// ---------------------------------------------------------------- registration

// How much a picture says beyond its noise, and its scale: values are worth `weight` each.
struct worth {
    double mean, weight;
};

static struct worth worth_of(const float *v, size_t n, double noise)
{
    double sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += (double)v[i], squares += (double)v[i] * (double)v[i];
    const double mean = sum / (double)n, variance = fmax(squares / (double)n - mean * mean, 0.0);
    const double deviation = sqrt(variance);
    const double signal = fmax(variance - noise * noise, 0.0);
    return (struct worth){mean, variance > 0.0 ? signal / variance / deviation : 0.0};
}

static double noise_of(const struct relume_image *noise, size_t channel)
{
    const size_t n = (size_t)noise->width * (size_t)noise->height;
    double sum = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += (double)noise->data[3 * i + channel] * (double)noise->data[3 * i + channel];
    return sqrt(sum / (double)n);
}

// The brightness of the albedo, and how the surface bends (the divergence of its normals): neither
// changes with the light, nor with a turn of the camera.
static relume_status picture_of(struct relume_image *out, const struct surface *s, int threads)
{
    const int width = s->width, height = s->height;
    const size_t n = (size_t)width * (size_t)height;
    struct relume_image normal = {0}, bend = {0}, bright = {0};
    relume_status status = smooth_copy(&normal, &s->normal, bend_sigma, threads);
    if (!status)
        status = relume_image_create(&bend, width, height, 1);
    if (!status)
        status = relume_image_create(&bright, width, height, 1);
    if (!status)
        status = relume_image_create(out, width, height, 3);
    for (int y = 0; !status && y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t at = (size_t)y * (size_t)width + (size_t)x;
            const float *row = normal.data + 3 * (size_t)y * (size_t)width;
            const size_t left = 3 * (size_t)index_clamped(x - 1, width),
                         right = 3 * (size_t)index_clamped(x + 1, width);
            const float *above =
                normal.data +
                3 * ((size_t)index_clamped(y - 1, height) * (size_t)width + (size_t)x) + 1;
            const float *below =
                normal.data +
                3 * ((size_t)index_clamped(y + 1, height) * (size_t)width + (size_t)x) + 1;
            bend.data[at] = row[right] - row[left] + *above - *below;
            bright.data[at] = s->colour.data[3 * at];
        }
    if (!status) {
        // smoothing over 1.5 pixels leaves of independent noise this much in a difference
        const double left = 0.19 * noise_of(&s->normal_noise, 0) * 2.0;
        const struct worth a = worth_of(bright.data, n, noise_of(&s->colour_noise, 0)),
                           b = worth_of(bend.data, n, left);
        for (size_t i = 0; i < n; i++) {
            const double v = 2.0 + 0.2 * (a.weight * ((double)bright.data[i] - a.mean) +
                                          b.weight * ((double)bend.data[i] - b.mean));
            const double kept = fmin(fmax(v, 0.5), 4.0);
            for (size_t c = 0; c < 3; c++)  // its root is what is aligned
                out->data[3 * i + c] = (float)(kept * kept);
        }
    }
    relume_image_destroy(&normal);
    relume_image_destroy(&bend);
    relume_image_destroy(&bright);
    return status;
}

// `b` on a canvas of the size of `a`: as large as it fits, in the middle.
static struct place canvas(const struct surface *a, const struct surface *b)
{
    const double scale = fmax((double)b->width / a->width, (double)b->height / a->height);
    struct place p = {.m = {{scale, 0, 0.5 * (b->width - scale * a->width)},
                            {0, scale, 0.5 * (b->height - scale * a->height)},
                            {0, 0, 1}}};
    if (a->width == b->width && a->height == b->height)
        p = (struct place){.m = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return p;
}

static void multiply(double out[3][3], const double a[3][3], const double b[3][3])
{
    double m[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            m[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = m[i][j] / m[2][2];
}

relume_status place_register(struct place *out, double *correlation, const struct surface *a,
                             const struct surface *b, double max_roll_deg, int threads,
                             const struct relume_log *log)
{
    struct relume_image picture[2] = {{0}, {0}};
    struct surface laid = {0};
    struct relume_homography h = {0};
    const struct place on = canvas(a, b);
    // what fails is said below
    const struct relume_log quiet = {.context = log ? log->context : NULL};
    *out = (struct place){0};
    relume_status status = place_sample(&laid, b, &on, a->width, a->height, threads);
    if (!status)
        status = picture_of(&picture[0], a, threads);
    if (!status)
        status = picture_of(&picture[1], &laid, threads);
    surface_free(&laid);
    if (!status)
        status = relume_align_homography(
            &h, &picture[0], &picture[1],
            relume_align_params(.log = &quiet, .threads = threads, .max_roll_deg = max_roll_deg));
    relume_image_destroy(&picture[0]);
    relume_image_destroy(&picture[1]);
    *correlation = h.correlation;
    if (status == RELUME_EUNFIT || (!status && h.correlation < least_correlation))
        return log_fail(log, RELUME_EUNFIT,
                        "the two captures do not lie on each other (similarity %.2f); expected the "
                        "same object from the same side, turned by at most %g degrees",
                        status ? 0.0 : h.correlation, max_roll_deg);
    multiply(out->m, on.m, (const double(*)[3])h.m);
    return status;
}
