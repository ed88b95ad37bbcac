// base.c - base frequencies, x and y by themselves (Meseth 2008, Eq. 4.7 and 4.8): whole multiples
// of them are where the waves are, nearly
#include "material/synthesis/base.h"

#include "core/math/scalar.h"

#include <stdlib.h>

enum { SAMPLES = 4000, NARROWER = 30 };
// Periods of the sample that a structure has at least, and how far beyond the lowest wave a base is
// looked for (delta). Waves below STILL do not change that way; small ones, which may be no part of
// the structure, do not say what the lowest is.
static const double LEAST = 2.0, BEYOND = 4.0, STILL = 0.5, COUNTS = 0.2;

static double size_of(const struct relume_wave *w)
{
    return sqrt(w->re * w->re + w->im * w->im);
}

static double place_of(const struct relume_wave *w, bool along_x)
{
    return along_x ? w->x : w->y;
}

int base_multiple(double b, double base)
{
    return base > 0.0 ? (int)lround(b / base) : 0;
}

struct line {
    const struct relume_wave *wave;
    int count;
    bool along_x;
};

// How far the waves are from multiples of b, squared, in b^2.
static double wrong_by(const struct line *l, double b)
{
    double sum = 0.0, all = 1e-30;
    for (int i = 0; i < l->count; i++) {
        const double at = place_of(&l->wave[i], l->along_x), size = size_of(&l->wave[i]),
                     off = at - b * base_multiple(at, b);
        sum += size * off * off;
        all += size;
    }
    return sum / (b * b * all);
}

// With the multiples as they are at b: where the waves say the base is, by power, those aside that
// are no multiples.
static double settle(const struct line *l, double b)
{
    for (int round = 0; round < NARROWER; round++) {
        double sum = 0.0, all = 0.0;
        for (int i = 0; i < l->count; i++) {
            const double at = place_of(&l->wave[i], l->along_x), size = size_of(&l->wave[i]);
            const double n = base_multiple(at, b);
            if (fabs(n * b - at) > BASE_FAR)
                continue;
            sum += size * size * n * at;
            all += size * size * n * n;
        }
        const double next = all > 0.0 ? sum / all : b;
        if (next == b)
            break;
        b = next;
    }
    return b;
}

struct candidate {
    double base, wrong;
};

static int by_wrong(const void *a, const void *b)
{
    const double x = ((const struct candidate *)a)->wrong, y = ((const struct candidate *)b)->wrong;
    return x < y ? -1 : x > y;
}

static void keep(struct candidate *list, int *count, struct candidate new)
{
    for (int i = 0; i < *count; i++)
        if (fabs(list[i].base - new.base) < 0.02)
            return;
    if (*count < BASE_MOST)
        list[(*count)++] = new;
    else if (new.wrong < list[*count - 1].wrong)
        list[*count - 1] = new;
    qsort(list, (size_t)*count, sizeof *list, by_wrong);
}

int base_candidates(double out[BASE_MOST], const struct relume_wave *wave, int count, bool along_x)
{
    const struct line l = {wave, count, along_x};
    struct candidate list[BASE_MOST];
    double lowest = INFINITY, largest = 0.0;
    int found = 0;
    for (int i = 0; i < count; i++)
        if (fabs(place_of(&wave[i], along_x)) > STILL)
            largest = fmax(largest, size_of(&wave[i]));
    for (int i = 0; i < count; i++) {
        const double at = fabs(place_of(&wave[i], along_x));
        if (at > STILL && size_of(&wave[i]) >= COUNTS * largest)
            lowest = fmin(lowest, at);
    }
    if (lowest == INFINITY) {
        out[0] = 0.0;
        return 1;
    }
    const double step = (lowest + BEYOND - LEAST) / SAMPLES;
    double before = INFINITY, here = wrong_by(&l, LEAST);
    for (int i = 0; step > 0.0 && i <= SAMPLES; i++) {
        const double b = LEAST + step * i, after = i < SAMPLES ? wrong_by(&l, b + step) : INFINITY;
        if (here <= before && here <= after) {
            const double base = fmax(settle(&l, b), LEAST * 0.98);
            keep(list, &found, (struct candidate){base, wrong_by(&l, base)});
        }
        before = here;
        here = after;
    }
    for (int i = 0; i < found; i++)
        out[i] = list[i].base;
    return found;
}
