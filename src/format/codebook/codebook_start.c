// codebook_start.c - where a codebook begins
//
// Random: k different vectors of the data (Wong 1998, Fig 9-10). Split (Linde, Buzo, Gray 1980):
// the mean of everything becomes two codes, these four, and so on. A cell is split along its
// principal axis, into the means that the halves of a normal distribution have: mean +- sqrt(2
// lambda / pi) e with e, lambda the axis and its variance. When fewer codes are left to make than
// there are cells, the cells of the largest squared error are split; then codes move from where
// they do little to where they do more (codebook_shift.c).
#include "format/codebook/codebook.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/random.h"

#include <math.h>
#include <string.h>

enum { LEVEL_ROUNDS = 4, POWER_STEPS = 6 };
static const double LEVEL_GAIN = 1e-2;

void start_random(struct training *t, uint64_t seed)
{
    struct random random = random_stream(seed, 0, 0);
    const size_t wanted = (size_t)t->most_codes, dim = (size_t)t->dim;
    size_t taken = 0;
    for (size_t i = 0; taken < wanted; i++)
        if ((double)(t->n - i) * random_next(&random) < (double)(wanted - taken))
            memcpy(t->code + taken++ * dim, t->vectors + i * dim, dim * sizeof *t->code);
    t->codes = t->most_codes;
}

struct cell_error {
    double error;
    int cell;
};

struct split {
    struct training *t;
    const struct cell_error *cells;  // to be split
    double *axis;                    // [workers][2 dim]
};

// One step of the power method on the covariance of a cell; returns its eigenvalue's estimate.
static double power_step(const struct training *t, int cell, double *axis, double *next)
{
    const size_t dim = (size_t)t->dim;
    const float *mean = t->code + (size_t)cell * dim;
    memset(next, 0, dim * sizeof *next);
    for (size_t i = t->begin[cell]; i < t->begin[cell + 1]; i++) {
        const float *v = t->vectors + (size_t)t->order[i] * dim;
        double along = 0.0;
        for (size_t k = 0; k < dim; k++)
            along += ((double)v[k] - (double)mean[k]) * axis[k];
        for (size_t k = 0; k < dim; k++)
            next[k] += ((double)v[k] - (double)mean[k]) * along;
    }
    double length = 0.0;
    for (size_t k = 0; k < dim; k++)
        length += next[k] * next[k];
    length = sqrt(length);
    for (size_t k = 0; k < dim && length > 0.0; k++)
        axis[k] = next[k] / length;
    return length / (double)(t->begin[cell + 1] - t->begin[cell]);
}

static void begin_axis(const struct training *t, int cell, double *axis)
{
    const size_t dim = (size_t)t->dim;
    uint32_t far = t->order[t->begin[cell]];
    for (size_t i = t->begin[cell]; i < t->begin[cell + 1]; i++)
        if (t->distance[t->order[i]] > t->distance[far])
            far = t->order[i];
    double length = 0.0;
    for (size_t k = 0; k < dim; k++) {
        axis[k] =
            (double)t->vectors[(size_t)far * dim + k] - (double)t->code[(size_t)cell * dim + k];
        length += axis[k] * axis[k];
    }
    length = sqrt(length);
    for (size_t k = 0; k < dim && length > 0.0; k++)
        axis[k] /= length;
}

double training_axis(const struct training *t, int cell, double *axis)
{
    double variance = 0.0;
    begin_axis(t, cell, axis);
    for (int step = 0; step < POWER_STEPS; step++)
        variance = power_step(t, cell, axis, axis + t->dim);
    return variance;
}

void training_split(struct training *t, int cell, float *other, const double *axis, double variance)
{
    float *code = t->code + (size_t)cell * (size_t)t->dim;
    const double reach = sqrt(2.0 * variance / M_PI);
    for (int k = 0; k < t->dim; k++) {
        const double mean = (double)code[k];
        code[k] = (float)(mean - reach * axis[k]);
        other[k] = (float)(mean + reach * axis[k]);
    }
}

static void split_cell(void *context, size_t item, int worker)
{
    const struct split *s = context;
    struct training *t = s->t;
    const size_t dim = (size_t)t->dim;
    double *axis = s->axis + (size_t)worker * 2 * dim;
    const int cell = s->cells[item].cell;
    float *code = t->code + (size_t)cell * dim;
    float *other = t->code + ((size_t)t->codes + item) * dim;
    memcpy(other, code, dim * sizeof *other);
    if (t->begin[cell] == t->begin[cell + 1] || !(t->error[cell] > 0.0))
        return;
    training_split(t, cell, other, axis, training_axis(t, cell, axis));
}

static int larger_first(const void *a, const void *b)
{
    const struct cell_error *x = a, *y = b;
    return x->error != y->error ? (x->error < y->error) - (x->error > y->error)
                                : (x->cell > y->cell) - (x->cell < y->cell);
}

relume_status start_split(struct training *t)
{
    struct cell_error *cells = mem_array((size_t)t->most_codes, sizeof *cells);
    double *axis = mem_array((size_t)thread_count(t->threads) * 2 * (size_t)t->dim, sizeof *axis);
    struct split s = {t, cells, axis};
    relume_status status = cells && axis ? RELUME_OK : RELUME_ENOMEM;
    t->codes = 1;
    while (!status && t->codes < t->most_codes) {
        status = training_run(t, t->codes == 1 ? 2 : LEVEL_ROUNDS, LEVEL_GAIN);
        if (!status)
            status = training_assign(t);
        if (status)
            break;
        const int left = t->most_codes - t->codes, split = left < t->codes ? left : t->codes;
        for (int c = 0; c < t->codes; c++)
            cells[c] = (struct cell_error){t->error[c], c};
        qsort(cells, (size_t)t->codes, sizeof *cells, larger_first);
        thread_for(t->threads, (size_t)split, split_cell, &s);
        t->codes += split;
        t->bounded = false;
    }
    mem_free(cells);
    mem_free(axis);
    return status ? status : training_shift(t);
}
