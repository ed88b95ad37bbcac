// channel.h - messages of a fixed size between two processes, each with at most one open file
#ifndef BASE_CHANNEL_H
#define BASE_CHANNEL_H

#include <stdbool.h>
#include <stddef.h>

// Two ends of a channel (SOCK_SEQPACKET), closed on exec; false with errno set.
bool channel_pair(int ends[2]);

// One message of `size` bytes; `file`, or -1, travels with it and stays open here. False when the
// other end is gone. Never raises SIGPIPE.
bool channel_send(int end, const void *message, size_t size, int file);

// The next message, which must have `size` bytes. `*file` is what came with it, closed on exec, or
// -1; NULL refuses files. False: the other end is gone, or sends something else.
bool channel_receive(int end, void *message, size_t size, int *file);

// Shared memory of a size that neither side can change any more: a file that has no name, or -1.
int channel_memory(size_t size);
// Its bytes; NULL unless the file has that size and keeps it. Ends with munmap.
void *channel_map(int memory, size_t size);

#endif
