// pack_write.h - relume files are written: views of coefficients, or one part of the work
#ifndef RELUME_PACK_WRITE_H
#define RELUME_PACK_WRITE_H

#include <relume/pack.h>

#ifdef __cplusplus
extern "C" {
#endif

// What a part is. Plain data.
struct relume_pack_part {
    int part, parts;     // 1 .. parts
    int first, views;    // that it holds, of
    int all_views;       // of the whole
    int row, rows;       // of the view, where it holds no more; else 0
    char creator[64];    // "relume 0.1.0"
    char options[4096];  // as they were given to relume_pack_encode
    uint64_t file_bytes;
    bool coded;  // with loss: it holds groups of neighbours, of which `first` is the lowest view
    char capture[RELUME_DIGEST];  // relume_capture_digest of what it was made from
    int tiles, all_tiles;  // coded: that it holds of its groups, of how many; views of a group are
                           // cut alike
    bool has_sums;         // as relume_pack_info
};
// An input status with a sentence when `path` is no part. Of `params` log, limits and reader are
// used.
RELUME_RESULT relume_status relume_pack_part_read(struct relume_pack_part *out, const char *path,
                                                  const struct relume_pack_params *params);

#ifdef __cplusplus
}
#endif
#endif
