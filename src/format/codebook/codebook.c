// codebook.c - the generalised Lloyd algorithm (Linde, Buzo, Gray 1980)
//
// Threads share out the search (code_search.c) and the means, each of which depends on one vector
// or one cell alone: sums run in the order of the data, whatever the threads. Distances are
// compared in double precision (nearest.c), so that books do not depend on the CPU either.
#include "format/codebook/codebook.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/random.h"
#include "format/codebook/books.h"
#include "format/codebook/code_search.h"

#include <math.h>
#include <string.h>

enum { DEFAULT_CODES = 256, DEFAULT_ROUNDS = 64, LAST_ROUNDS = 6 };
static const double DEFAULT_GAIN = 1e-4;

// ---------------------------------------------------------------- assignment

// Count, then place: the cells in one array, each in the order of the data.
static void sort_into_cells(struct training *t)
{
    memset(t->begin, 0, ((size_t)t->codes + 1) * sizeof *t->begin);
    for (size_t i = 0; i < t->n; i++)
        t->begin[t->index[i] + 1]++;
    for (int c = 0; c < t->codes; c++)
        t->begin[c + 1] += t->begin[c];
    for (size_t i = 0; i < t->n; i++)
        t->order[t->begin[t->index[i]]++] = (uint32_t)i;
    for (int c = t->codes; c > 0; c--)
        t->begin[c] = t->begin[c - 1];
    t->begin[0] = 0;
}

relume_status training_assign(struct training *t)
{
    struct code_search s = {
        .vectors = t->vectors,
        .codes = t->code,
        .n = t->n,
        .index = t->index,
        .distance = t->distance,
        .apart = t->apart,
        .drift = t->bounded ? t->drift : NULL,
        .furthest = t->furthest,
        .team = t->team,
    };
    const relume_status status =
        code_search_find(&s, t->codes, t->dim, t->threads, t->cpu_off, t->log);
    if (status)
        return status;
    t->bounded = true;
    t->changed = s.any_changed;
    sort_into_cells(t);
    t->total = 0.0;
    for (int c = 0; c < t->codes; c++) {
        t->error[c] = 0.0;
        for (size_t i = t->begin[c]; i < t->begin[c + 1]; i++)
            t->error[c] += t->distance[t->order[i]];
        t->total += t->error[c];
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- replacement

static void move_to_mean(void *context, size_t code, int worker)
{
    enum { PART = 64 };  // components at a time
    (void)worker;
    struct training *t = context;
    const size_t dim = (size_t)t->dim, from = t->begin[code], to = t->begin[code + 1];
    for (size_t first = 0; from < to && first < dim; first += PART) {
        const size_t n = dim - first < PART ? dim - first : PART;
        double sum[PART] = {0.0};
        for (size_t i = from; i < to; i++) {
            const float *v = t->vectors + (size_t)t->order[i] * dim + first;
            for (size_t k = 0; k < n; k++)
                sum[k] += (double)v[k];
        }
        for (size_t k = 0; k < n; k++)
            t->code[code * dim + first + k] = (float)(sum[k] / (double)(to - from));
    }
}

// An empty code becomes the farthest vector of the worst cell, which then no longer counts there.
// False when no error is left.
static bool fill_empty(struct training *t, int empty)
{
    int worst = 0;
    for (int c = 1; c < t->codes; c++)
        if (t->error[c] > t->error[worst])
            worst = c;
    if (!(t->error[worst] > 0.0))
        return false;
    uint32_t far = t->order[t->begin[worst]];
    for (size_t i = t->begin[worst]; i < t->begin[worst + 1]; i++)
        if (t->distance[t->order[i]] > t->distance[far])
            far = t->order[i];
    memcpy(t->code + (size_t)empty * (size_t)t->dim, t->vectors + (size_t)far * (size_t)t->dim,
           (size_t)t->dim * sizeof *t->code);
    t->error[worst] -= t->distance[far];
    t->distance[far] = 0.0;
    t->moved++;
    return true;
}

static void measure_drift(struct training *t)
{
    const size_t dim = (size_t)t->dim;
    t->furthest[0] = t->furthest[1] = 0.0;
    for (int c = 0; c < t->codes; c++) {
        const double d =
            sqrt(squared_distance(t->code + (size_t)c * dim, t->before + (size_t)c * dim, dim));
        t->drift[c] = d * (1.0 + 1e-6);
        if (t->drift[c] > t->furthest[0]) {
            t->furthest[1] = t->furthest[0];
            t->furthest[0] = t->drift[c];
        } else if (t->drift[c] > t->furthest[1]) {
            t->furthest[1] = t->drift[c];
        }
    }
}

void training_move(struct training *t)
{
    memcpy(t->before, t->code, (size_t)t->codes * (size_t)t->dim * sizeof *t->code);
    thread_for(t->threads, (size_t)t->codes, move_to_mean, t);
    bool more = true;
    for (int c = 0; more && c < t->codes; c++)
        if (t->begin[c] == t->begin[c + 1])
            more = fill_empty(t, c);
    measure_drift(t);
}

relume_status training_run(struct training *t, int max_rounds, double min_gain)
{
    double before = INFINITY;
    for (t->rounds = 0; t->rounds < max_rounds; t->rounds++) {
        const int moved = t->moved;
        const relume_status status = training_assign(t);
        if (status)
            return status;
        if (!log_progress(t->log, "training codes", (double)t->rounds / max_rounds))
            return RELUME_ECANCEL;
        const bool settled = t->rounds > 0 && !t->changed;
        training_move(t);
        const bool little = before - t->total < min_gain * t->total;
        before = t->total;
        if (t->moved == moved && (settled || (min_gain >= 0.0 && little))) {
            t->rounds++;
            break;
        }
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- interface

static bool all_finite(const float *v, size_t n, size_t *where)
{
    for (*where = 0; *where < n; ++*where)
        if (!isfinite(v[*where]))
            return false;
    return true;
}

static relume_status check(const float *vectors, size_t n, int dim,
                           const struct relume_codebook_params *p, int codes)
{
    size_t where;
    const size_t use = p->sample && p->sample < n ? p->sample : n;
    if (dim < 1 || codes < 1 || codes > 65536 || n > UINT32_MAX || p->max_rounds < 0 ||
        !(p->min_gain < 1.0))
        return log_fail(p->log, RELUME_EINVAL,
                        "a codebook of %d codes for %zu vectors of %d; expected 1 to 65536 codes, "
                        "less than 2^32 vectors of 1 or more, a gain below 1",
                        codes, n, dim);
    if ((size_t)codes > use)
        return log_fail(p->log, RELUME_EINVAL,
                        "a codebook of %d codes needs at least as many vectors; found %zu", codes,
                        use);
    if (!all_finite(vectors, n * (size_t)dim, &where))
        return log_fail(p->log, RELUME_EINVAL,
                        "vector %zu holds %g; expected finite numbers in every vector",
                        where / (size_t)dim, (double)vectors[where]);
    if (p->initial && !all_finite(p->initial, (size_t)codes * (size_t)dim, &where))
        return log_fail(p->log, RELUME_EINVAL, "start vector %zu holds %g; expected finite numbers",
                        where / (size_t)dim, (double)p->initial[where]);
    return RELUME_OK;
}

// `wanted` of `n` vectors, each choice equally likely, in their order (Knuth, algorithm 3.4.2 S).
static float *draw_sample(const float *vectors, size_t n, int dim, size_t wanted, uint64_t seed)
{
    float *sample = mem_array(wanted * (size_t)dim, sizeof *sample);
    struct random random = random_stream(seed, 1, 0);
    size_t taken = 0;
    for (size_t i = 0; sample && taken < wanted; i++)
        if ((double)(n - i) * random_next(&random) < (double)(wanted - taken))
            memcpy(sample + taken++ * (size_t)dim, vectors + i * (size_t)dim,
                   (size_t)dim * sizeof *sample);
    return sample;
}

static bool alloc_training(struct training *t)
{
    const size_t codes = (size_t)t->most_codes;
    t->code = mem_zeroed(codes * (size_t)t->dim, sizeof *t->code);
    t->index = mem_zeroed(t->n, sizeof *t->index);
    t->distance = mem_array(t->n, sizeof *t->distance);
    t->apart = mem_array(t->n, sizeof *t->apart);
    t->order = mem_array(t->n, sizeof *t->order);
    t->begin = mem_array(codes + 1, sizeof *t->begin);
    t->error = mem_array(codes, sizeof *t->error);
    t->before = mem_array(codes * (size_t)t->dim, sizeof *t->before);
    t->drift = mem_array(codes, sizeof *t->drift);
    return t->code && t->index && t->distance && t->apart && t->order && t->begin && t->error &&
           t->before && t->drift;
}

static void free_training(struct training *t)
{
    mem_free(t->code);
    mem_free(t->index);
    mem_free(t->distance);
    mem_free(t->order);
    mem_free(t->begin);
    mem_free(t->error);
    mem_free(t->apart);
    mem_free(t->before);
    mem_free(t->drift);
}

static relume_status train(struct training *t, const struct relume_codebook_params *p)
{
    relume_status status = RELUME_OK;
    if (p->initial) {
        memcpy(t->code, p->initial, (size_t)t->most_codes * (size_t)t->dim * sizeof *t->code);
        t->codes = t->most_codes;
    } else if (p->start == RELUME_START_SPLIT) {
        status = start_split(t);
    } else {
        start_random(t, p->seed);
    }
    if (!status)
        status = training_run(t, p->max_rounds ? p->max_rounds : DEFAULT_ROUNDS,
                              p->min_gain != 0.0 ? p->min_gain : DEFAULT_GAIN);
    return status;
}

static relume_status make_book(relume_codebook **out, struct training *t)
{
    relume_codebook *book = mem_zeroed(1, sizeof *book);
    if (!book)
        return RELUME_ENOMEM;
    book->vectors = t->code;
    t->code = NULL;
    book->info = (struct relume_codebook_info){
        .codes = t->codes,
        .dim = t->dim,
        .vectors = book->vectors,
        .rounds = t->rounds,
        .squared_error = t->total,
        .moved = t->moved,
    };
    *out = book;
    return RELUME_OK;
}

// The book of a sample of what `all` is trained on; to be freed.
static relume_status train_sample(float **book, const struct training *all,
                                  const struct relume_codebook_params *p)
{
    struct training t = *all;
    float *sample = draw_sample(all->vectors, all->n, all->dim, p->sample, p->seed);
    t.vectors = sample;
    t.n = p->sample;
    relume_status status = sample && alloc_training(&t) ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = train(&t, p);
    if (!status) {
        *book = t.code;
        t.code = NULL;
    }
    free_training(&t);
    mem_free(sample);
    return status;
}

relume_status relume_codebook_train(relume_codebook **out, const float *vectors, size_t n, int dim,
                                    const struct relume_codebook_params *params)
{
    struct relume_codebook_params p = PARAMS_WORK(relume_codebook_params, params);
    const int codes = p.codes ? p.codes : DEFAULT_CODES;
    *out = NULL;
    relume_status status = check(vectors, n, dim, &p, codes);
    if (status)
        return status;
    struct training t = {
        .log = p.log,
        .vectors = vectors,
        .n = n,
        .dim = dim,
        .most_codes = codes,
        .threads = p.threads,
        .cpu_off = p.cpu_off,
        .team = p.team && p.team->close ? p.team : NULL,
    };
    float *begun = NULL;
    if (p.sample && p.sample < n)
        status = train_sample(&begun, &t, &p);
    if (!status && !alloc_training(&t))
        status = RELUME_ENOMEM;
    if (begun) {
        p.initial = begun;
        p.max_rounds = p.max_rounds && p.max_rounds < LAST_ROUNDS ? p.max_rounds : LAST_ROUNDS;
    }
    if (!status)
        status = train(&t, &p);
    if (!status)
        status = make_book(out, &t);
    free_training(&t);
    mem_free(begun);
    return status;
}

void relume_codebook_destroy(relume_codebook **book)
{
    if (*book)
        mem_free((*book)->vectors);
    mem_free(*book);
    *book = NULL;
}

const struct relume_codebook_info *relume_codebook_info(const relume_codebook *book)
{
    return &book->info;
}

relume_status relume_codebook_assign(const relume_codebook *book, const float *vectors, size_t n,
                                     uint16_t *index, double *squared_error,
                                     const struct relume_codebook_assign_params *params)
{
    const struct relume_codebook_assign_params p =
        PARAMS_WORK(relume_codebook_assign_params, params);
    size_t where;
    if (!all_finite(vectors, n * (size_t)book->info.dim, &where))
        return log_fail(p.log, RELUME_EINVAL,
                        "vector %zu holds %g; expected finite numbers in every vector",
                        where / (size_t)book->info.dim, (double)vectors[where]);
    struct code_search s = {.vectors = vectors, .codes = book->vectors, .n = n, .index = index};
    s.distance = mem_array(n, sizeof *s.distance);
    s.apart = mem_array(n, sizeof *s.apart);
    memset(index, 0, n * sizeof *index);
    const relume_status status =
        s.distance && s.apart
            ? code_search_find(&s, book->info.codes, book->info.dim, p.threads, p.cpu_off, p.log)
            : RELUME_ENOMEM;
    double sum = 0.0;
    for (size_t i = 0; !status && i < n; i++)
        sum += s.distance[i];
    if (squared_error)
        *squared_error = sum;
    mem_free(s.distance);
    mem_free(s.apart);
    return status;
}
