// codebook.h - vector quantisation of reflectance coefficients (Linde, Buzo, Gray 1980; Wong 1998,
// 9.2.1): every vector is replaced by the number of its nearest code vector
#ifndef RELUME_CODEBOOK_H
#define RELUME_CODEBOOK_H

#include <relume/base.h>
#include <relume/format/coder.h>

#ifdef __cplusplus
extern "C" {
#endif

// Code vectors of one length. Never changes after training. Thread-safety: safe.
typedef struct relume_codebook relume_codebook;

// Where training begins.
enum relume_codebook_start {
    RELUME_START_RANDOM =
        0,               // different vectors of the data, drawn by the seed (Wong 1998, Fig 9-10)
    RELUME_START_SPLIT,  // one code, split again and again along its cell's principal axis, then
                         // codes of up to 8192 moved to where they do more; no seed
};

struct relume_codebook_params {  // zero in a field means its default
    size_t struct_size;          // filled by the macro (base.h)
    const struct relume_log *log;
    enum relume_codebook_start start;  // where training begins
    const float *initial;              // [codes][dim]: start from these vectors instead; finite
    uint64_t seed;     // equal seeds give equal books, whatever the CPU and the thread count
    int codes;         // code vectors, [1, 65536]; default 256
    int max_rounds;    // stop after this many Lloyd rounds; default 64
    double min_gain;   // stop when a round gains less than this part of the squared error,
                       // [0, 1); default 1e-4, negative: only when no vector changes its code
    size_t sample;     // learn from this many vectors, drawn by the seed, and in at most six more
                       // rounds from all; default: from all
    int threads;       // default: all cores
    unsigned cpu_off;  // RELUME_CPU_* features not to use; the result is the same
    const struct relume_team *team;  // close ones share the search of each round; all members train
                                     // on the same vectors. Default: alone
};
#define relume_codebook_params(...)                                                                \
    (&(const struct relume_codebook_params){RELUME_SIZED(relume_codebook_params), __VA_ARGS__})

// Train on `n` packed vectors of `dim` floats, read only until return; `params` may be NULL. Rounds
// assign every vector to its nearest code and replace every code by the mean of its cell. A code
// without vectors moves to the vector farthest from its code in the cell of the largest squared
// error, while any error is left. Returns RELUME_EINVAL (more codes than vectors, dim below 1, a
// value that is not finite), RELUME_ENOMEM, RELUME_ECANCEL; then `*out` is NULL.
RELUME_RESULT relume_status relume_codebook_train(relume_codebook **out, const float *vectors,
                                                  size_t n, int dim,
                                                  const struct relume_codebook_params *params);
RELUME_API void relume_codebook_destroy(relume_codebook **book);

// How nearest codes are looked for. Borrowed during the call.
struct relume_codebook_assign_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;       // default: all cores
    unsigned cpu_off;  // as above
};
#define relume_codebook_assign_params(...)                                                         \
    (&(const struct relume_codebook_assign_params){RELUME_SIZED(relume_codebook_assign_params),    \
                                                   __VA_ARGS__})

// index[i] = the code nearest to vector i: the lowest of those whose squared distance, summed in
// double precision from the first component to the last, is smallest. Exact, whatever the CPU.
// `squared_error`, the sum over all vectors, may be NULL. RELUME_EINVAL for a value that is not
// finite, RELUME_ENOMEM.
RELUME_RESULT relume_status
relume_codebook_assign(const relume_codebook *book, const float *vectors, size_t n, uint16_t *index,
                       double *squared_error, const struct relume_codebook_assign_params *params);

enum { RELUME_MOST_BOOKS = 8 };

// How coefficients are shared out among books.
enum relume_book_split {
    RELUME_SPLIT_NONE = 0,  // all planes in one book
    RELUME_SPLIT_LUMA,      // a book for luminance, one for chrominance; not for joint bases
    RELUME_SPLIT_PRODUCT,   // `groups` books for as many groups of coefficients
};

struct relume_books_params {  // zero in a field means its default
    size_t struct_size;       // filled by the macro (base.h)
    const struct relume_log *log;
    int codes;                     // of each book; default 256
    int stages;                    // books one after another for the same planes, [1, 8]; default 1
    enum relume_book_split split;  // how coefficients are shared out; default: not at all
    int groups;                    // of RELUME_SPLIT_PRODUCT; default 2
    enum relume_codebook_start start;  // as for relume_codebook_train
    uint64_t seed;
    int max_rounds;  // default 24
    size_t sample;   // pixels to learn from; default: 40 a code, at least 65536
    float dither;  // [0, 1]: along contours in smooth ramps codes alternate in a fine pattern, the
                   // longest first, until the indices take about that part more bytes; 1: all,
                   // default 0: none
    int threads;
    const struct relume_team *team;  // as relume_codebook_params
};
#define relume_books_params(...)                                                                   \
    (&(const struct relume_books_params){RELUME_SIZED(relume_books_params), __VA_ARGS__})

#ifdef __cplusplus
}
#endif
#endif
