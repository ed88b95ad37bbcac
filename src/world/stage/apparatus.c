// apparatus.c - what a real apparatus does to the photographs of a goniometer
//
// In the order of the light: the lamp's strength, the lens, the sensor, the rectification.
#include "world/stage/apparatus.h"

#include "core/base/memory.h"
#include "core/math/fft2d.h"
#include "core/math/random.h"

#include <string.h>

static const double MOST_STRETCH = 10.0;  // of a tilted sample's blur

struct bench {  // of one worker
    fft2d *fft;
    float *spectrum, *copy;
};

struct apparatus {
    struct relume_btf_faults faults;
    int size, workers;
    uint64_t seed;
    struct bench *bench;
};

static double normal_deviate(struct random *r)  // Box and Muller 1958
{
    const double radius = sqrt(-2.0 * log(1.0 - random_next(r)));
    return radius * cos(2.0 * M_PI * random_next(r));
}

// ---------------------------------------------------------------- the lens

// The spread is round on the sensor. A sample that is tilted looks shorter, so that on the sample
// the spread is longer in the direction of the tilt.
struct spread {
    int size;
    double xx, xy, yy;  // covariance in texels, y downwards
    float *plane;       // [size][size] pairs
};

static void fill_row(void *context, int row, float *line)
{
    const struct spread *s = context;
    memcpy(line, s->plane + 2 * (size_t)row * (size_t)s->size, 2 * (size_t)s->size * sizeof *line);
}

static void take_row(void *context, int row, const float *line)
{
    const struct spread *s = context;
    float *to = s->plane + 2 * (size_t)row * (size_t)s->size;
    const float scale = 1.0f / ((float)s->size * (float)s->size);
    for (int i = 0; i < 2 * s->size; i++)
        to[i] = line[i] * scale;
}

static bool weaken(void *context, int column, int count, float *lines)
{
    const struct spread *s = context;
    const int n = s->size;
    for (int c = 0; c < count; c++)
        for (int k = 0; k < n; k++) {
            const int i = column + c;
            const double fx = (double)(i > n / 2 ? i - n : i) / n;
            const double fy = (double)(k > n / 2 ? k - n : k) / n;
            const double e = s->xx * fx * fx + 2.0 * s->xy * fx * fy + s->yy * fy * fy;
            const float keep = (float)exp(-2.0 * M_PI * M_PI * e);
            lines[2 * (c * n + k)] *= keep;
            lines[2 * (c * n + k) + 1] *= keep;
        }
    return true;
}

// Two colours at once: the filter is real and even, so a pair of numbers stays a pair.
static void blur_pair(const struct bench *b, struct spread *s, float *texels, int first, int second)
{
    const int n = s->size;
    for (int i = 0; i < n * n; i++) {
        s->plane[2 * i] = texels[3 * i + first];
        s->plane[2 * i + 1] = texels[3 * i + second];
    }
    fft2d_rows(b->fft, b->spectrum, 0, n, fill_row, s);
    const struct fft2d_step step = {0, n, 0, n, weaken, s, true};
    fft2d_step_columns(b->fft, b->spectrum, &step);
    fft2d_rows_back(b->fft, b->spectrum, 0, n, take_row, s);
    for (int i = 0; i < n * n; i++) {
        texels[3 * i + first] = s->plane[2 * i];
        texels[3 * i + second] = s->plane[2 * i + 1];
    }
}

static void blur(const apparatus *a, const struct bench *b, float *texels, vec3 view)
{
    const double flat = hypot(view.x, view.y), variance = a->faults.blur * a->faults.blur;
    const double stretch = fmin(MOST_STRETCH, 1.0 / fmax(view.z, 1e-3));
    const double x = flat > 0.0 ? view.x / flat : 1.0, y = flat > 0.0 ? -view.y / flat : 0.0;
    const double more = variance * (stretch * stretch - 1.0);
    struct spread s = {a->size, variance + more * x * x, more * x * y, variance + more * y * y,
                       b->copy};
    blur_pair(b, &s, texels, 0, 1);
    blur_pair(b, &s, texels, 2, 2);
}

// ---------------------------------------------------------------- the sensor

// Photons are counted: a variance in proportion to the light. A texel that looks smaller has fewer.
static void add_noise(const apparatus *a, float *texels, vec3 view, struct random *r)
{
    const double of_one = a->faults.noise / sqrt(fmax(view.z, 1.0 / MOST_STRETCH));
    for (int i = 0; i < 3 * a->size * a->size; i++) {
        const double value = fmax(0.0, (double)texels[i]);
        texels[i] = (float)fmax(0.0, value + of_one * sqrt(value) * normal_deviate(r));
    }
}

// ---------------------------------------------------------------- the rectification

// Bilinear, as pictures are resampled.
static void move(const struct bench *b, int n, float *texels, double dx, double dy)
{
    const double left = floor(dx), up = floor(dy);
    const float x = (float)(dx - left), y = (float)(dy - up);
    memcpy(b->copy, texels, 3 * (size_t)n * (size_t)n * sizeof *texels);
    const int i0 = (int)(fmod(left, n) + n) % n, j0 = (int)(fmod(up, n) + n) % n;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            const int row = (j + j0) % n, column = (i + i0) % n;
            const int below = (row + 1) % n, right = (column + 1) % n;
            for (int c = 0; c < 3; c++) {
                const float *from = b->copy + c;
                texels[3 * (j * n + i) + c] =
                    (1.0f - y) * ((1.0f - x) * from[3 * (row * n + column)] +
                                  x * from[3 * (row * n + right)]) +
                    y * ((1.0f - x) * from[3 * (below * n + column)] +
                         x * from[3 * (below * n + right)]);
            }
        }
}

// ---------------------------------------------------------------- all of it

void apparatus_spoil(const apparatus *a, float *texels, vec3 view, uint64_t number, int worker)
{
    const struct bench *b = &a->bench[worker];
    struct random r = random_stream(a->seed, 0x6c656e73, number);
    const double lamp = 1.0 + a->faults.flicker * normal_deviate(&r);
    const double dx = a->faults.shift * normal_deviate(&r);
    const double dy = a->faults.shift * normal_deviate(&r);
    if (a->faults.flicker > 0.0)
        for (int i = 0; i < 3 * a->size * a->size; i++)
            texels[i] *= (float)fmax(0.0, lamp);
    if (a->faults.blur > 0.0)
        blur(a, b, texels, view);
    if (a->faults.noise > 0.0)
        add_noise(a, texels, view, &r);
    if (a->faults.shift > 0.0)
        move(b, a->size, texels, dx, dy);
}

relume_status apparatus_create(apparatus **out, const struct relume_btf_faults *faults, int size,
                               uint64_t seed, int workers)
{
    *out = NULL;
    if (!(faults->blur > 0.0 || faults->noise > 0.0 || faults->shift > 0.0 ||
          faults->flicker > 0.0))
        return RELUME_OK;
    apparatus *a = mem_zeroed(1, sizeof *a);
    if (!a)
        return RELUME_ENOMEM;
    *a = (apparatus){*faults, size, workers, seed, mem_zeroed((size_t)workers, sizeof *a->bench)};
    const size_t floats = 3 * (size_t)size * (size_t)size;
    bool good = a->bench != NULL;
    for (int w = 0; w < workers && good; w++) {
        struct bench *b = &a->bench[w];
        good = !fft2d_create(&b->fft, size, size, false, 1) &&
               (b->spectrum = mem_array(fft2d_size(b->fft), sizeof *b->spectrum)) &&
               (b->copy = mem_array(floats, sizeof *b->copy));
    }
    *out = a;
    if (!good)
        apparatus_destroy(out);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

void apparatus_destroy(apparatus **a)
{
    if (!*a)
        return;
    for (int w = 0; (*a)->bench && w < (*a)->workers; w++) {
        fft2d_destroy(&(*a)->bench[w].fft);
        mem_free((*a)->bench[w].spectrum);
        mem_free((*a)->bench[w].copy);
    }
    mem_free((*a)->bench);
    mem_free(*a);
    *a = NULL;
}
