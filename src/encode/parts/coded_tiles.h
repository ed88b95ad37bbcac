// coded_tiles.h - tiles of groups that a member of a team has coded and judged
#ifndef PARTS_CODED_TILES_H
#define PARTS_CODED_TILES_H

#include "encode/parts/groups.h"
#include "format/coder/coefficients.h"
#include "format/team/share.h"

// The tiles of a group that are a member's, perhaps none.
struct group_tiles {
    const int *view;  // [views] of the group
    int views;
    struct group_share tiles;
    struct av1_bytes *sequence;    // [tiles][views]
    struct encode_square *square;  // [views][tiles]
};
static inline size_t tiles_in(const struct group_tiles *t)
{
    return (size_t)(t->tiles.end - t->tiles.first);
}

struct coded_tiles {
    struct group_tiles *group;  // [groups]
    int groups;
    bool fetched;  // bytes belong to a piece
};
// Memory for tiles[groups] of the groups that `number` names. To be destroyed also on failure.
// RELUME_ENOMEM.
relume_status coded_tiles_create(struct coded_tiles *out, const struct view_groups *groups,
                                 const int *number, const struct group_share *tiles, int count);
void coded_tiles_destroy(struct coded_tiles *t);

// Error and bytes of each tile and view, as a piece.
extern const struct team_bytes coded_tiles_bytes;  // of a struct coded_tiles

#endif
