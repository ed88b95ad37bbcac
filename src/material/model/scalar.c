// scalar.c - numbers as one of a few levels, and such numbers of unlike widths in rows of bits
#include "material/model/scalar.h"

#include "core/base/memory.h"
#include "core/math/sort.h"

#include <math.h>

enum { SAMPLES = 4096 };  // levels are chosen by so many values at most

unsigned levels_number(const struct levels *s, int bits, float value)
{
    unsigned low = 0, high = (1u << bits) - 1;
    while (low < high) {
        const unsigned middle = (low + high) / 2;
        const float between =
            0.5f * (levels_value(s, bits, middle) + levels_value(s, bits, middle + 1));
        if (value < between)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

// Values in order, with sums from the first on.
struct sorted {
    float *value;
    double *sum, *squares;  // [count + 1]
    size_t count;
    double mean, deviation, reach;  // reach: greatest distance from the mean
};

static bool sort(struct sorted *s, const float *values, size_t count, size_t stride)
{
    const size_t every = (count + SAMPLES - 1) / SAMPLES;
    s->count = (count + every - 1) / every;
    s->value = mem_array(s->count, sizeof *s->value);
    s->sum = mem_zeroed(s->count + 1, sizeof *s->sum);
    s->squares = mem_zeroed(s->count + 1, sizeof *s->squares);
    if (!s->value || !s->sum || !s->squares)
        return false;
    for (size_t i = 0; i < s->count; i++)
        s->value[i] = values[i * every * stride];
    sort_floats(s->value, s->count);
    for (size_t i = 0; i < s->count; i++) {
        s->sum[i + 1] = s->sum[i] + (double)s->value[i];
        s->squares[i + 1] = s->squares[i] + (double)s->value[i] * (double)s->value[i];
    }
    const double n = (double)s->count;
    s->mean = s->sum[s->count] / n;
    s->deviation = sqrt(fmax(s->squares[s->count] / n - s->mean * s->mean, 0.0));
    s->reach = fmax((double)s->value[s->count - 1] - s->mean, s->mean - (double)s->value[0]);
    return true;
}

// How many values lie below `x`, of those from `from` on.
static size_t below(const struct sorted *s, size_t from, double x)
{
    size_t low = from, high = s->count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if ((double)s->value[middle] < x)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static double error_of(const struct sorted *s, const struct levels *levels, int bits)
{
    const unsigned n = 1u << bits;
    double error = 0.0, here = (double)levels_value(levels, bits, 0);
    size_t from = 0;
    for (unsigned q = 0; q < n; q++) {
        const double next = q + 1 < n ? (double)levels_value(levels, bits, q + 1) : 0.0;
        const size_t end = q + 1 < n ? below(s, from, 0.5 * (here + next)) : s->count;
        error += s->squares[end] - s->squares[from] - 2.0 * here * (s->sum[end] - s->sum[from]) +
                 here * here * (double)(end - from);
        from = end;
        here = next;
    }
    return fmax(error, 0.0) / (double)s->count;
}

// The best of some spans (in standard deviations) and bends.
static double choose_width(const struct sorted *s, int bits, struct levels *best)
{
    static const double spans[] = {0.8, 1.2, 1.6, 2.1, 2.7, 3.5, 4.5, 6.0, 8.0, 12.0, 20.0, 1e9};
    static const double bends[] = {0.0, 0.4, 1.0, 2.0, 4.0};
    double least = INFINITY;
    for (size_t i = 0; i < sizeof spans / sizeof *spans; i++) {
        const double top = fmin(spans[i] * s->deviation, s->reach);
        for (size_t j = 0; j < (bits > 1 ? sizeof bends / sizeof *bends : 1); j++) {
            const struct levels levels = {(float)s->mean, (float)(top / (1.0 + bends[j])),
                                          (float)(top * bends[j] / (1.0 + bends[j]))};
            const double error = error_of(s, &levels, bits);
            if (error >= least)
                continue;
            least = error;
            *best = levels;
        }
        if (top >= s->reach)
            break;
    }
    return least;
}

bool levels_choose(const float *values, size_t count, size_t stride, struct levels *best,
                   double *error)
{
    struct sorted s = {.value = NULL};
    const bool good = sort(&s, values, count, stride);
    for (int bits = 0; bits <= LEVELS_BITS && good; bits++) {
        best[bits] = (struct levels){(float)s.mean, 0.0f, 0.0f};
        error[bits] = s.deviation * s.deviation;
        if (bits && s.deviation > 0.0)
            error[bits] = choose_width(&s, bits, &best[bits]);
    }
    mem_free(s.value);
    mem_free(s.sum);
    mem_free(s.squares);
    return good;
}

void bits_put(uint8_t *row, size_t at, int bits, unsigned number)
{
    for (int i = 0; i < bits; i++, at++)
        row[at / 8] |= (uint8_t)((number >> i & 1u) << (at % 8));
}
