// join_tiles.h - a group of coded views whose tiles lie in several parts
#ifndef PACK_JOIN_TILES_H
#define PACK_JOIN_TILES_H

#include "format/pack/part.h"

// A part of the work that has tiles of a group, and which part of its file they are.
struct tiles_of_part {
    const struct part_file *part;
    int exr;
    struct lossy_held tiles;  // which join_tiles_check reads
};

// Whether they are the tiles of a group, in order, each once: else RELUME_EDAMAGED and which part
// is *bad.
relume_status join_tiles_check(struct tiles_of_part *own, int count, const struct part_file **bad);
// `out`, the part of the first, gets the words of all, which are read when they are written. Errors
// likewise, without a sentence; an input status, RELUME_ENOMEM.
relume_status join_tiles(struct exr_part *out, const struct tiles_of_part *own, int count,
                         const struct part_file **bad, struct arena *arena,
                         const struct relume_log *log);

#endif
