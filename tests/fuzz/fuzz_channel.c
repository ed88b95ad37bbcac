// fuzz_channel.c - messages between the library and its helper, which says anything: of any size,
// with any files, in any order, or ends. No descriptor may be left, nothing be written beyond a
// message, and nothing wait for ever.
#define FUZZ_HELPER
#include "fuzz.h"

#include "core/base/channel.h"
#include "core/base/module.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>

static int start_fake(int end);

// The library's side, with this file in place of the program.
#define kill(process, number)                            ((void)(process), (void)(number))
#define waitpid(process, how, options)                   ((void)(process), 0)
#define module_program(name, path)                       ((void)(name), !!strcpy(path, "relume-helper"))
#define posix_spawn_file_actions_adddup2(files, end, to) (fake = start_fake(end))
#define posix_spawn(process, path, files, attributes, arguments, environment)                      \
    ((void)(path), (void)(arguments), *(process) = 1, fake)
static int fake;
#include "core/base/helper.c"
#undef kill
#undef waitpid

static struct bytes said;  // what the other side has still to say

static unsigned take(void)
{
    return said.size ? (said.size--, *said.data++) : 0;
}

// A file as sent memory is, or nearly.
static int some_memory(unsigned kind)
{
    if (kind % 4 == 0)
        return channel_memory(64);
    if (kind % 4 == 1)
        return open("/dev/null", O_RDWR | O_CLOEXEC);
    const int memory = memfd_create("any", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (memory >= 0 && (ftruncate(memory, kind % 4 == 2 ? 64 : 63) ||
                        fcntl(memory, F_ADD_SEALS, (int)(kind >> 2 & 15))))
        abort();
    return memory;
}

// The next message: its size, how many files of which kind, and its bytes. False when it ends.
static bool say_one(int end)
{
    enum { MOST = 1024, FILES = 4 };
    static uint8_t text[MOST];
    union {
        struct cmsghdr header;
        char buffer[CMSG_SPACE(FILES * sizeof(int))];
    } with = {{0}};
    if (!said.size)
        return false;
    const unsigned form = take();
    const size_t files = form % 16 % (FILES + 1), size = (form >> 4) * 64 + take() % 64;
    int file[FILES];
    for (size_t i = 0; i < size; i++)
        text[i] = (uint8_t)take();
    for (size_t i = 0; i < files; i++)
        file[i] = some_memory(take());
    struct iovec part = {text, size};
    struct msghdr whole = {.msg_iov = &part, .msg_iovlen = 1};
    if (files) {
        whole.msg_control = &with;
        whole.msg_controllen = CMSG_SPACE(files * sizeof *file);
        with.header = (struct cmsghdr){.cmsg_level = SOL_SOCKET,
                                       .cmsg_type = SCM_RIGHTS,
                                       .cmsg_len = CMSG_LEN(files * sizeof *file)};
        memcpy(CMSG_DATA(&with.header), file, files * sizeof *file);
    }
    const bool sent = sendmsg(end, &whole, MSG_NOSIGNAL | MSG_DONTWAIT) >= 0;
    for (size_t i = 0; i < files; i++)
        close(file[i]);
    return sent;
}

// As many messages as the bytes say, then the end: the library must not wait for more.
static void say_all(int end)
{
    for (unsigned n = take() % 4; n && say_one(end); n--)
        ;
    shutdown(end, SHUT_WR);
}

static int other_end = -1;  // of the channel to the program

static void stop_fake(void)
{
    if (other_end >= 0)
        close(other_end);
    other_end = -1;
}

static int start_fake(int end)
{
    stop_fake();
    if (take() % 16 == 15)
        return ENOENT;
    other_end = dup(end);
    say_all(other_end);
    return 0;
}

// The process' end of a job's channel, which came with the order.
static int job_end(void)
{
    struct helper_order order;
    int end;
    return other_end >= 0 && channel_receive(other_end, &order, sizeof order, &end) ? end : -1;
}

// As for a process that has ended, and the program.
static void drop_all(void)
{
    struct helper_reply reply;
    for (struct helper_process *p = table; p; p = table) {
        table = p->next;
        free_process(p);
    }
    if (control >= 0)
        drop_program(&reply, false);
    stop_fake();
}

static bool try_job(void)
{
    struct helper_job job;
    uint8_t *answer = malloc(128);
    int heard = 0;
    if (!answer)
        abort();
    if (!helper_start(&job, take() % 2 ? HELPER_PICTURE : HELPER_MESH, "a file", NULL)) {
        const int end = job_end();
        job.processor_s = 10;
        if (end >= 0)
            say_all(end);
        while (heard < 8 && !helper_ask(&job, "message", 7, -1, answer, 128))
            heard++;
        if (end >= 0)
            close(end);
    }
    if (!memchr(job.why, 0, sizeof job.why))
        abort();
    helper_end(&job);
    drop_all();
    free(answer);
    return heard > 0;
}

static bool try_messages(size_t size)
{
    uint8_t *message = malloc(size);
    int ends[2], file = -1, heard = 0;
    if (!message || !channel_pair(ends))
        abort();
    say_all(ends[1]);
    for (int i = 0; i < 4; i++) {
        const bool good = channel_receive(ends[0], message, size, i % 2 ? NULL : &file);
        if (!good && file >= 0)
            abort();
        void *memory = file >= 0 ? channel_map(file, 64) : NULL;
        if (memory) {
            memset(memory, 1, 64);
            munmap(memory, 64);
        }
        if (file >= 0)
            close(file);
        file = -1;
        heard += good;
    }
    close(ends[0]);
    close(ends[1]);
    free(message);
    return heard > 0;
}

static int open_files(void)
{
    int n = 0;
    for (int file = 0; file < 64; file++)
        n += fcntl(file, F_GETFD) >= 0;
    return n;
}

static bool one(struct fuzz *f, struct bytes b)
{
    const int before = open_files();
    (void)f;
    said = (struct bytes){b.data + 1, b.size - 1};
    const bool heard = b.data[0] % 2 ? try_job() : try_messages(1 + b.data[0] / 2);
    if (open_files() != before)
        abort();
    return heard;
}

// `size` bytes with `files` files of a kind: as say_one takes them apart.
static void put(struct bytes *to, size_t size, unsigned files, uint8_t kind, uint8_t value)
{
    to->data = realloc(to->data, to->size + 2 + size + files);
    if (!to->data)
        abort();
    to->data[to->size++] = (uint8_t)(size / 64 * 16 + files);
    to->data[to->size++] = (uint8_t)(size % 64);
    memset(to->data + to->size, value, size);
    memset(to->data + to->size + size, kind, files);
    to->size += size + files;
}

static struct bytes begin(const char *text, size_t size)
{
    struct bytes b = {malloc(size), size};
    if (!b.data)
        abort();
    memcpy(b.data, text, size);
    return b;
}

int main(int argc, char **argv)
{
    struct fuzz f = {0};
    struct bytes job = begin("\1\1\0\3", 4), memory = begin("\76\2", 2), many = begin("\76\1", 2);
    fuzz_begin(&f, "fuzz_channel", argc, argv);
    for (int i = 0; i < 3; i++)
        put(&job, sizeof(struct helper_reply), 0, 0, 1);
    job.data = realloc(job.data, job.size + 1);
    job.data[job.size++] = 2;
    put(&job, 128, 0, 0, 7);
    put(&job, 128, 0, 0, 8);
    put(&memory, 32, 1, 0, 1);
    put(&memory, 32, 0, 0, 2);
    put(&many, 32, 3, 0, 1);
    fuzz_add(&f, job);
    fuzz_add(&f, memory);
    fuzz_add(&f, many);
    return fuzz_run(&f, argc, argv, one);
}
