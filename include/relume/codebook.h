// codebook.h - vector quantisation of reflectance coefficients (Linde, Buzo, Gray 1980; Wong 1998,
// 9.2.1): every vector is replaced by the number of its nearest code vector
#ifndef RELUME_CODEBOOK_H
#define RELUME_CODEBOOK_H

#include <relume/base.h>

#ifdef __cplusplus
extern "C" {
#endif

// Code vectors of one length. Never changes after training. Thread-safety: safe.
typedef struct relume_codebook relume_codebook;

enum relume_codebook_start {
    RELUME_START_RANDOM =
        0,               // different vectors of the data, drawn by the seed (Wong 1998, Fig 9-10)
    RELUME_START_SPLIT,  // one code, split again and again along its cell's principal axis; no seed
};

struct relume_codebook_params {  // zero in a field means its default
    const struct relume_log *log;
    enum relume_codebook_start start;
    const float *initial;  // [codes][dim]: start from these vectors instead; finite
    uint64_t seed;         // equal seeds give equal books, whatever the CPU and the thread count
    int codes;             // code vectors, [1, 65536]; default 256
    int max_rounds;        // stop after this many Lloyd rounds; default 64
    double min_gain;       // stop when a round gains less than this part of the squared error,
                           // [0, 1); default 1e-4, negative: only when no vector changes its code
    size_t sample;         // learn from this many vectors, drawn by the seed; default: from all
    int threads;           // default: all cores
    unsigned cpu_off;      // RELUME_CPU_* features not to use; the result is the same
};
#define relume_codebook_params(...) (&(const struct relume_codebook_params){__VA_ARGS__})

// Train on `n` packed vectors of `dim` floats, read only until return; `params` may be NULL. Rounds
// assign every vector to its nearest code and replace every code by the mean of its cell. A code
// without vectors moves to the vector farthest from its code in the cell of the largest squared
// error, while any error is left. Returns RELUME_EINVAL (more codes than vectors, dim below 1, a
// value that is not finite), RELUME_ENOMEM, RELUME_ECANCEL; then `*out` is NULL.
RELUME_RESULT relume_status relume_codebook_train(relume_codebook **out, const float *vectors,
                                                  size_t n, int dim,
                                                  const struct relume_codebook_params *params);
RELUME_API void relume_codebook_destroy(relume_codebook **book);

// What a codebook is; pointers belong to it.
struct relume_codebook_info {
    int codes, dim;
    const float *vectors;  // [codes][dim]
    int rounds;            // Lloyd rounds of the training (splitting start: of its last level)
    double squared_error;  // sum over the training vectors, as the last round found it: before its
                           // codes moved to their means
    int moved;             // codes without vectors that were moved, over all rounds
};
RELUME_API const struct relume_codebook_info *relume_codebook_info(const relume_codebook *book);

struct relume_codebook_assign_params {
    const struct relume_log *log;
    int threads;       // default: all cores
    unsigned cpu_off;  // as above
};
#define relume_codebook_assign_params(...)                                                         \
    (&(const struct relume_codebook_assign_params){__VA_ARGS__})

// index[i] = the code nearest to vector i: the lowest of those whose squared distance, summed in
// double precision from the first component to the last, is smallest. Exact, whatever the CPU.
// `squared_error`, the sum over all vectors, may be NULL. RELUME_EINVAL for a value that is not
// finite, RELUME_ENOMEM.
RELUME_RESULT relume_status
relume_codebook_assign(const relume_codebook *book, const float *vectors, size_t n, uint16_t *index,
                       double *squared_error, const struct relume_codebook_assign_params *params);

#ifdef __cplusplus
}
#endif
#endif
