// piece.c - the bytes of a piece
#include "format/team/piece.h"

#include <string.h>

void piece_put(struct piece_writer *to, const void *bytes, size_t size)
{
    const struct relume_writer writer = relume_buffer_writer(to->out);
    if (size && !to->failed)
        to->failed = !writer.write(writer.user, bytes, size, to->out->size);
}

size_t piece_left(const struct piece_reader *from)
{
    return from->size - from->at;
}

unsigned char *piece_view(struct piece_reader *from, size_t size)
{
    from->damaged = from->damaged || size > piece_left(from);
    if (from->damaged)
        return NULL;
    from->at += size;
    return (unsigned char *)(uintptr_t)from->bytes + from->at - size;
}

bool piece_get(struct piece_reader *from, void *to, size_t size)
{
    const unsigned char *bytes = piece_view(from, size);
    if (bytes && size)
        memcpy(to, bytes, size);
    return bytes != NULL;
}
