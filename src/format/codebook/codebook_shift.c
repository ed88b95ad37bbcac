// codebook_shift.c - codes that do little go to where they do more (Patane, Russo 2001)
//
// Lloyd's rounds only find the nearest hollow: they do not carry a code past others. Giving up code
// i to its nearest neighbour l raises the error by about n_i n_l / (n_i + n_l) |c_i - c_l|^2 (Ward
// 1963); splitting cell j along its axis lowers it by about 2 / pi n_j lambda_j, as in splitting a
// normal distribution. Pairs whose gain is above their cost are made, many at once, none of
// them near another; a few rounds follow, and the book before comes back where that was no gain.
#include "format/codebook/codebook.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <math.h>
#include <string.h>

// Neighbours are looked for among all: above 8192 codes that would take longer than the training.
enum { SHIFTS = 16, SHIFT_ROUNDS = 3, MOST_SHIFTED = 8192 };
static const double ENOUGH =
    1e-3;  // of the error: what a shift must gain to be followed by another

struct cell_worth {
    double cost, gain;  // of giving it up, of splitting it
    int cell, neighbour;
    bool touched;
};

struct shift {
    struct training *t;
    struct cell_worth *worth;   // [codes], by cell
    struct cell_worth **cheap;  // [codes], by cost
    struct cell_worth **poor;   // [codes], by gain
    float *best;                // [codes][dim]
    double *axis;               // [workers][2 dim]
};

static size_t members(const struct training *t, int cell)
{
    return t->begin[cell + 1] - t->begin[cell];
}

static void weigh_cell(void *context, size_t cell, int worker)
{
    const struct shift *s = context;
    const struct training *t = s->t;
    const size_t dim = (size_t)t->dim;
    const float *own = t->code + cell * dim;
    struct cell_worth w = {.cost = INFINITY, .cell = (int)cell, .neighbour = -1};
    double nearest = INFINITY;
    for (int c = 0; c < t->codes; c++) {
        const double d = squared_distance(own, t->code + (size_t)c * dim, dim);
        if ((size_t)c != cell && d < nearest) {
            nearest = d;
            w.neighbour = c;
        }
    }
    const double n = (double)members(t, w.cell);
    if (w.neighbour >= 0) {
        const double m = (double)members(t, w.neighbour);
        w.cost = n > 0.0 && m > 0.0 ? n * m / (n + m) * nearest : 0.0;
    }
    if (n > 1.0 && t->error[cell] > 0.0)
        w.gain = 2.0 / M_PI * n *
                 training_axis(t, w.cell, s->axis + (size_t)worker * 2 * (size_t)t->dim);
    s->worth[cell] = w;
}

static int by_cost(const void *a, const void *b)
{
    const struct cell_worth *x = *(struct cell_worth *const *)a,
                            *y = *(struct cell_worth *const *)b;
    return x->cost != y->cost ? (x->cost > y->cost) - (x->cost < y->cost) : x->cell - y->cell;
}

static int by_gain(const void *a, const void *b)
{
    const struct cell_worth *x = *(struct cell_worth *const *)a,
                            *y = *(struct cell_worth *const *)b;
    return x->gain != y->gain ? (x->gain < y->gain) - (x->gain > y->gain) : x->cell - y->cell;
}

// The neighbour becomes the mean of both; the code goes to the other cell.
static void move_code(struct shift *s, const struct cell_worth *from, int to)
{
    struct training *t = s->t;
    const size_t dim = (size_t)t->dim;
    const double n = (double)members(t, from->cell), m = (double)members(t, from->neighbour);
    float *own = t->code + (size_t)from->cell * dim;
    float *other = t->code + (size_t)from->neighbour * dim;
    for (size_t k = 0; n > 0.0 && k < dim; k++)
        other[k] = (float)((n * (double)own[k] + m * (double)other[k]) / (n + m));
    training_split(t, to, own, s->axis, training_axis(t, to, s->axis));
}

// At most `most` codes go elsewhere; how many did.
static int shift_codes(struct shift *s, int most)
{
    struct training *t = s->t;
    int moved = 0, b = 0;
    thread_for(t->threads, (size_t)t->codes, weigh_cell, s);
    for (int c = 0; c < t->codes; c++)
        s->cheap[c] = s->poor[c] = &s->worth[c];
    qsort(s->cheap, (size_t)t->codes, sizeof *s->cheap, by_cost);
    qsort(s->poor, (size_t)t->codes, sizeof *s->poor, by_gain);
    for (int a = 0; a < t->codes && moved < most; a++) {
        struct cell_worth *from = s->cheap[a];
        if (from->neighbour < 0 || from->touched || s->worth[from->neighbour].touched)
            continue;
        while (b < t->codes &&
               (s->poor[b]->touched || s->poor[b] == from || s->poor[b]->cell == from->neighbour))
            b++;
        if (b == t->codes || !(s->poor[b]->gain > from->cost))
            break;
        from->touched = s->worth[from->neighbour].touched = s->poor[b]->touched = true;
        move_code(s, from, s->poor[b]->cell);
        moved++;
    }
    t->bounded = t->bounded && !moved;
    return moved;
}

static bool alloc_shift(struct shift *s)
{
    const size_t codes = (size_t)s->t->codes, dim = (size_t)s->t->dim;
    s->worth = mem_array(codes, sizeof *s->worth);
    s->cheap = mem_array(codes, sizeof(void *));
    s->poor = mem_array(codes, sizeof(void *));
    s->best = mem_array(codes * dim, sizeof *s->best);
    s->axis = mem_array((size_t)thread_count(s->t->threads) * 2 * dim, sizeof *s->axis);
    return s->worth && s->cheap && s->poor && s->best && s->axis;
}

relume_status training_shift(struct training *t)
{
    struct shift s = {.t = t};
    const size_t size = (size_t)t->codes * (size_t)t->dim * sizeof *t->code;
    if (t->codes < 3 || t->codes > MOST_SHIFTED)
        return RELUME_OK;
    relume_status status = alloc_shift(&s) ? training_run(t, SHIFT_ROUNDS, 0.0) : RELUME_ENOMEM;
    if (!status)
        status = training_assign(t);
    for (int i = 0, most = t->codes; !status && most > 0 && i < SHIFTS; i++) {
        const double before = t->total;
        memcpy(s.best, t->code, size);
        const int shifted = shift_codes(&s, most);
        if (!shifted)
            break;
        status = training_run(t, SHIFT_ROUNDS, 0.0);
        if (!status)
            status = training_assign(t);
        if (!status && !(t->total < before)) {  // too many of them: the best few of these
            memcpy(t->code, s.best, size);
            t->bounded = false;
            most = shifted / 4;
            status = training_assign(t);
        } else if (!(t->total < before * (1.0 - ENOUGH))) {
            break;
        }
    }
    mem_free(s.worth);
    mem_free(s.cheap);
    mem_free(s.poor);
    mem_free(s.best);
    mem_free(s.axis);
    return status;
}
