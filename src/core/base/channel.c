// channel.c - messages of a fixed size between two processes, each with at most one open file
#include "core/base/channel.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

bool channel_pair(int ends[2])
{
    return !socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends);
}

// Memory for one descriptor, aligned as its header must be.
union control {
    struct cmsghdr header;
    char buffer[CMSG_SPACE(sizeof(int))];
};

bool channel_send(int end, const void *message, size_t size, int file)
{
    union control control;
    struct iovec part = {(void *)(size_t)message, size};
    struct msghdr whole = {.msg_iov = &part, .msg_iovlen = 1};
    if (file >= 0) {
        memset(&control, 0, sizeof control);
        whole.msg_control = &control;
        whole.msg_controllen = sizeof control.buffer;
        struct cmsghdr *header = CMSG_FIRSTHDR(&whole);
        header->cmsg_level = SOL_SOCKET;
        header->cmsg_type = SCM_RIGHTS;
        header->cmsg_len = CMSG_LEN(sizeof file);
        memcpy(CMSG_DATA(header), &file, sizeof file);
    }
    ssize_t sent;
    do
        sent = sendmsg(end, &whole, MSG_NOSIGNAL);
    while (sent < 0 && errno == EINTR);
    return sent == (ssize_t)size;
}

bool channel_receive(int end, void *message, size_t size, int *file)
{
    union control control;
    struct iovec part = {message, size};
    struct msghdr whole = {.msg_iov = &part,
                           .msg_iovlen = 1,
                           .msg_control = file ? &control : NULL,
                           .msg_controllen = file ? CMSG_LEN(sizeof *file) : 0};  // one
    if (file)
        *file = -1;
    ssize_t came;
    do
        came = recvmsg(end, &whole, MSG_CMSG_CLOEXEC);
    while (came < 0 && errno == EINTR);
    const struct cmsghdr *header = came >= 0 && file ? CMSG_FIRSTHDR(&whole) : NULL;
    if (header && header->cmsg_type == SCM_RIGHTS)
        memcpy(file, CMSG_DATA(header), sizeof *file);
    if (came == (ssize_t)size && !(whole.msg_flags & MSG_TRUNC))
        return true;
    if (file && *file >= 0) {
        close(*file);
        *file = -1;
    }
    return false;
}

static const int fixed = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;

int channel_memory(size_t size)
{
    const int memory = memfd_create("relume", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (memory >= 0 && (ftruncate(memory, (off_t)size) || fcntl(memory, F_ADD_SEALS, fixed))) {
        close(memory);
        return -1;
    }
    return memory;
}

void *channel_map(int memory, size_t size)
{
    struct stat s;
    if (fstat(memory, &s) || s.st_size != (off_t)size || fcntl(memory, F_GET_SEALS) != fixed)
        return NULL;
    void *bytes = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0);
    return bytes == MAP_FAILED ? NULL : bytes;
}
