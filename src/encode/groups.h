// groups.h - which views are coded together
#ifndef ENCODE_GROUPS_H
#define ENCODE_GROUPS_H

#include <relume/capture.h>

struct view_groups {
    int count;
    int *begin;  // [count + 1]: where each begins in `view`
    int *view;   // [views], the anchor of each group first
};

// Views of a slab that stand side by side, at most `most` of them, with the one nearest to their
// middle as the anchor. Views of other captures are alone. Groups come in the order of their
// anchors. To be destroyed also on failure. RELUME_ENOMEM.
relume_status groups_make(struct view_groups *out, const struct relume_manifest *manifest,
                          int most);
// The first group of a member's share; that of the next member ends it, which may be at once.
int groups_first(const struct view_groups *groups, int member, int members);
void groups_destroy(struct view_groups *groups);

#endif
