// groups.h - which views are coded together, and who codes which of their tiles
#ifndef PARTS_GROUPS_H
#define PARTS_GROUPS_H

#include "format/lossy/lossy.h"

#include <relume/capture.h>

struct view_groups {
    int count;
    int *begin;             // [count + 1]: where each begins in `view`
    int *view;              // [views], the anchor of each group first
    int *tile;              // [count + 1]: the first of its tiles, where those of all are numbered
    struct lossy_cut *cut;  // [count]: the tiles of each
};

// Views of a slab that stand side by side, as many as `coder` can code together, with the one
// nearest to their middle as the anchor. Views of other captures are alone. Groups come in the
// order of their anchors. To be destroyed also on failure. RELUME_ENOMEM.
relume_status groups_make(struct view_groups *out, const relume_capture *capture,
                          const relume_coder *coder);
// One view of that size, number 0.
relume_status groups_alone(struct view_groups *out, const relume_coder *coder, int width,
                           int height);
void groups_destroy(struct view_groups *groups);

// What a member of a team codes: the tiles `first` .. `end` of all groups, which may be none.
struct group_share {
    int first, end;
};
struct group_share groups_share(const struct view_groups *groups, int member, int members);
// Those of a group, numbered in it; none: first is end.
struct group_share groups_tiles(const struct view_groups *groups, int group,
                                struct group_share share);
// Which group a tile is of, `count` for the end of all of them; and a view.
int groups_of_tile(const struct view_groups *groups, int tile);
int groups_with(const struct view_groups *groups, int view);

#endif
