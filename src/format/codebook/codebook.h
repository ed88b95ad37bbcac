// codebook.h - the inside of a codebook and of its training
#ifndef CODEBOOK_CODEBOOK_H
#define CODEBOOK_CODEBOOK_H

#include "format/codebook/books.h"
#include "format/codebook/nearest.h"

#include <relume/format/codebook.h>

struct relume_codebook {
    struct relume_codebook_info info;
    float *vectors;
};

// A training in progress: cells[code] are the vectors order[begin[code]] ... order[begin[code +
// 1]), ascending.
struct training {
    const struct relume_log *log;
    const float *vectors;  // [n][dim]
    size_t n;
    int dim, codes, most_codes;
    float *code;       // [most_codes][dim]
    float *before;     // [most_codes][dim]: the codes before they moved last
    uint16_t *index;   // [n]
    double *distance;  // [n], squared
    float *apart;      // [n]: at most the distance to any code but index[i]
    uint32_t *order;   // [n]
    size_t *begin;     // [most_codes + 1]
    double *error;     // [most_codes]: squared error of each cell
    double total;
    double *drift;       // [most_codes]: how far each code has moved since `apart` was true
    double furthest[2];  // the two largest of these
    bool bounded;        // `apart` and `drift` belong to the present codes
    bool changed;        // by the last assignment
    int rounds, moved, threads;
    unsigned cpu_off;
    const struct relume_team *team;  // or NULL
};

// Every vector to its nearest of the present codes; fills all that describes cells. RELUME_ENOMEM.
relume_status training_assign(struct training *t);
// Every code to the mean of its cell, empty ones to where the error is.
void training_move(struct training *t);
// Assign and move until the gain is below `min_gain` of the error, or `max_rounds` are done.
relume_status training_run(struct training *t, int max_rounds, double min_gain);

// The principal axis of a cell, axis[2 dim] of which the second half is scratch, and the variance
// along it.
double training_axis(const struct training *t, int cell, double *axis);
// The code of the cell and `other` become the means of its halves.
void training_split(struct training *t, int cell, float *other, const double *axis,
                    double variance);
// Codes of cells that others could take over go to cells that are worth two, while that helps.
relume_status training_shift(struct training *t);

// Starts: fill t->code and t->codes.
void start_random(struct training *t, uint64_t seed);
relume_status start_split(struct training *t);

#endif
