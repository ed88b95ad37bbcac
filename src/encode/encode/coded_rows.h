// coded_rows.h - coefficients of the rows that are needed, and the steps that all views share
#ifndef ENCODE_CODED_ROWS_H
#define ENCODE_CODED_ROWS_H

#include "encode/encode/contents.h"
#include "encode/parts/groups.h"
#include "encode/parts/row_counts.h"
#include "format/coder/coding.h"

// What was added up of the rows of a view.
struct rows_total {
    double root;
    size_t measured, lit;
    struct relume_census census;  // without black images
};

struct coded_rows {
    struct contents *f;
    const struct view_groups *groups;
    const struct relume_team *team;  // or NULL
    struct range *total;             // [planes]
    bool masked, settled;            // steps are known
    int most;                        // rows of tiles in a view
    bool *there;                     // [views][most]: rows of tiles that are encoded
    struct row_counts counts;        // of a share
    struct rows_total *sum;          // [views], of all shares
    bool *shone;                     // [views][lights]: a sample is above 0
    relume_coefficients *empty;      // with the steps of all views, for the header; or NULL
};

// To be destroyed also on failure. RELUME_ENOMEM.
relume_status coded_rows_create(struct coded_rows *out, struct contents *f,
                                const struct view_groups *groups, const struct relume_team *team);
void coded_rows_destroy(struct coded_rows *r);

// The coefficients that tiles of a group need, in all its views, or a whole view: encoded where
// they are not there yet. An input status, RELUME_ENOMEM, RELUME_EIO, RELUME_ECANCEL.
relume_status coded_rows_load(struct coded_rows *r, int group, struct group_share tiles);
relume_status coded_rows_load_view(struct coded_rows *r, int view);
// The steps, and the report of each view in f->report: each member of the team encodes the rows of
// tiles of its share. The first view has coefficients then, perhaps without any rows: a header says
// by it what the planes are like. Errors as above, and of sharing.
relume_status coded_rows_find_steps(struct coded_rows *r);
// The steps where all views have all coefficients already.
void coded_rows_settle(struct coded_rows *r);

#endif
