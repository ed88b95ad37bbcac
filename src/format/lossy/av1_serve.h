// av1_serve.h - sequences coded in other processes: what one is asked, and what it answers
//
// Pictures travel by memory that both processes share, which holds one picture, and later a piece
// of the bytes. So neither process has a second copy of a tile.
#ifndef LOSSY_AV1_SERVE_H
#define LOSSY_AV1_SERVE_H

#include "core/base/helper.h"
#include "format/lossy/av1.h"

// Messages to the process, each of which is answered.
enum av1_ask_what {
    AV1_BEGIN,    // with the memory: a group, as av1_writer_open
    AV1_PICTURE,  // a picture is in the memory, as av1_writer_add
    AV1_TAKE,     // bytes of `member` from `offset` on are put into the memory
    AV1_END,      // the group is freed
};
struct av1_ask {
    int what;
    int width, height, components, pictures, members;  // AV1_BEGIN
    int quantiser, preset, threads;                    // AV1_BEGIN
    int picture, member, halved;
    uint64_t offset;
};
struct av1_answer {
    int status;      // relume_status
    uint64_t bytes;  // in the whole sequence, for AV1_TAKE
    char why[HELPER_WHY];
};

// Bytes of the shared memory: one picture.
size_t av1_shared_bytes(const struct av1_shape *shape);

// Codes until the channel is closed; `bridge` is not used.
void av1_serve(int channel, const void *bridge);

#endif
