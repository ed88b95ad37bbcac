// row_counts.h - what is counted in the rows that a member of a team encodes
#ifndef PARTS_ROW_COUNTS_H
#define PARTS_ROW_COUNTS_H

#include "format/coder/coefficients.h"
#include "format/team/share.h"

// Sums over rows of a view.
struct row_sums {
    double root;
    uint64_t measured, lit, pixels, black, clipped, always_clipped, repaired;
};
struct view_counts {
    int row, rows;  // in the share
    struct row_sums sums;
};
struct row_counts {
    int views, lights, planes, height;
    const int *order;          // [views], in which a piece has them
    struct view_counts *view;  // [views]
    bool *lit;                 // [views][lights]: a sample of the share is above 0
    double *error;             // [views][height], squared, of each row, of all members in the end
    struct range *range;       // [planes], of the share
};
// To be destroyed also on failure. RELUME_ENOMEM.
relume_status row_counts_create(struct row_counts *out, const relume_capture *capture,
                                const relume_coder *coder, const int *order);
void row_counts_destroy(struct row_counts *c);

// Sums, lights and errors of each view that has rows, and then the ranges.
extern const struct team_bytes row_counts_bytes;  // of a struct row_counts

#endif
