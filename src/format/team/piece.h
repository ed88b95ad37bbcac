// piece.h - the bytes of a piece: numbers and arrays one after another, as this machine keeps them
#ifndef TEAM_PIECE_H
#define TEAM_PIECE_H

#include <relume/context.h>

// A piece that is written. Zeroed but for `out`, it is empty.
struct piece_writer {
    struct relume_buffer *out;
    bool failed;  // memory is short
};
// Appends `size` bytes.
void piece_put(struct piece_writer *to, const void *bytes, size_t size);

// A piece that is read. It may come from another machine and hold anything.
struct piece_reader {
    const unsigned char *bytes;
    size_t size, at;
    bool damaged;
};
// The next `size` bytes into `to`; false and damaged where there are fewer.
bool piece_get(struct piece_reader *from, void *to, size_t size);
// The next `size` bytes themselves, which are the piece's; NULL and damaged where there are fewer.
unsigned char *piece_view(struct piece_reader *from, size_t size);
// Bytes that were not read yet.
size_t piece_left(const struct piece_reader *from);

#endif
