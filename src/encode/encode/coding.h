// coding.h - a lossy file in progress, shared by the sources that make it
#ifndef ENCODE_CODING_H
#define ENCODE_CODING_H

#include "encode/encode/coded_rows.h"
#include "format/lossy/av1.h"

struct coding {
    struct contents *f;
    struct view_groups groups;
    struct coded_rows rows;
    const struct relume_team *team;  // or NULL
    struct group_share own;          // tiles that this file gets
    double rest;                     // bytes that are not words
    struct av1_effort effort;        // of the levels
    double level_bytes;
    int *levels_by;  // [views]: the quantiser that coded them, or 0
    bool leveled;
};

// ---- shares of the work (coding_shares.c)

// The tiles of a member of the team.
struct group_share coding_share(const struct coding *c, int member);
// Returns true if the share has a group's first tile. It then makes all data of the group's views
// other than tiles.
bool coding_has_first(const struct coding *c, int group, struct group_share share);
// Calls `body` for the views whose first tile is in the share.
relume_status coding_each_view(struct coding *c, struct group_share share,
                               relume_status (*body)(struct coding *c, int view));
// The sum of the bytes that each member counts. What `count` and sharing return.
relume_status coding_sum(double *sum, struct coding *c, const char *what,
                         relume_status (*count)(struct coding *c, int member, double *bytes));

// ---- what a view has beside its planes (coding_extras.c, coding_levels.c)

// Depth, mask and what shadows move by, unless the view has them. Errors as contents_extras.
relume_status coding_load_extras(struct coding *c, int view);
// Bytes of the file that are not words of planes. An input status, RELUME_ENOMEM, RELUME_ECANCEL.
relume_status coding_count_rest(double *bytes, struct coding *c);
// Reduced levels of a view, not coded yet.
relume_status coding_load_levels(struct coding *c, int view);
// Codes the levels of the own views by c->effort, or more coarsely if all levels together take more
// bytes than are left. Errors as lossy_encode.
relume_status coding_find_levels(struct coding *c, double left);

// ---- the file (coding_file.c)

// Writes the tiles that are c->own, and what belongs to them. Errors as relume_pack_write.
relume_status coding_write(struct coding *c, const char *path,
                           const struct relume_fidelity *report);

#endif
