// trial.h - planes coded at one quantiser, and judged by the photographs
#ifndef ENCODE_TRIAL_H
#define ENCODE_TRIAL_H

#include "encode/parts/groups.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"
#include "format/lossy/lossy.h"

#include <relume/format/team.h>

// Members who share the tiles of groups (groups_share).
struct rate_team {
    const struct relume_team *team;
    // Makes the coefficients of some tiles of a group that may be missing so far.
    relume_status (*load)(void *user, int group, struct group_share tiles);
    void *user;
};

// Settings that trials share.
struct trial_plan {
    relume_coefficients *const *coefficients;  // [views]
    int first;                                 // which view of the capture they begin with
    const struct view_groups *groups;
    const relume_capture *capture;
    const struct relume_project_params *p;
    const struct rate_team *by;  // or NULL
    int tried;                   // of the groups, evenly spread
    enum av1_preset_number preset;
    bool own;  // as rate_target
};

// Results of a quantiser. Zeroed: not tried.
struct trial {
    struct lossy_words *words;     // [views], of the tiles of this member
    size_t *count;                 // [views]: words, with the tiles of all members
    struct encode_square *square;  // [views]
    bool *known;                   // [groups]
    double psnr_db, bytes;         // pooled over the captured images; sum over views
};

// Codes and judges the groups of the plan that `t` does not know yet. RELUME_ENOMEM, RELUME_EIO,
// RELUME_ESYSTEM, RELUME_ECANCEL, an input status, and what sharing returns.
relume_status trial_add_groups(struct trial *t, const struct trial_plan *plan, int quantiser);
void trial_destroy(struct trial *t, int views);

#endif
