// unpack.c - the bytes of a file, unpacked where gzip has packed them
#include "shape/volume/unpack.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <errno.h>
#include <string.h>
#include <zlib.h>

enum { CHUNK = 1 << 16 };

struct unpack {
    struct infile in;
    uint64_t at;  // in the file
    uint64_t given;
    bool packed, ended;
    z_stream z;
    uint8_t chunk[CHUNK];
    char *path;
    const struct relume_log *log;
};

static void *allocate(void *user, unsigned count, unsigned size)
{
    (void)user;
    return mem_array(count, size);
}

static void release(void *user, void *memory)
{
    (void)user;
    mem_free(memory);
}

relume_status unpack_open(unpack **out, const char *path, uint64_t offset, const bool *packed,
                          const struct relume_log *log)
{
    uint8_t head[2] = {0};
    unpack *u = mem_zeroed(1, sizeof *u);
    char *name = mem_text(path);
    *out = NULL;
    if (!u || !name) {
        mem_free(u);
        mem_free(name);
        return RELUME_ENOMEM;
    }
    if (!infile_open(&u->in, path, NULL, log)) {
        const int error = errno;
        infile_close(&u->in);
        mem_free(u);
        mem_free(name);
        return relume_input_fail(log, path, "cannot be opened", error);
    }
    u->at = offset;
    u->path = name;
    u->log = log;
    u->z = (z_stream){.zalloc = allocate, .zfree = release};
    u->packed = packed ? *packed
                       : infile_read(&u->in, head, sizeof head, offset) == sizeof head &&
                             head[0] == 0x1f && head[1] == 0x8b;
    if (u->packed && inflateInit2(&u->z, 15 + 32) != Z_OK) {
        u->packed = false;
        unpack_close(&u);
        return RELUME_ENOMEM;
    }
    *out = u;
    return RELUME_OK;
}

void unpack_close(unpack **u)
{
    if (!*u)
        return;
    if ((*u)->packed)
        inflateEnd(&(*u)->z);
    infile_close(&(*u)->in);
    mem_free((*u)->path);
    mem_free(*u);
    *u = NULL;
}

bool unpack_left(const unpack *u, uint64_t *bytes)
{
    *bytes = u->in.size > u->at ? u->in.size - u->at : 0;
    return !u->packed && u->in.regular;
}

// A byte that zlib has packed is at most 1032: pairs of a length of 258 take two bits. What it
// holds already is less than another 64.
relume_status unpack_expect(const unpack *u, uint64_t bytes, const char *expected)
{
    const uint64_t left = u->in.size > u->at ? u->in.size - u->at : 0;
    const uint64_t most = u->packed ? (u->z.avail_in + left + 64) * 1032 : left;
    if (!u->in.regular || most >= bytes)
        return RELUME_OK;
    return log_fail(u->log, RELUME_EUNFIT, "%s: ends after %s%llu bytes; expected %s", u->path,
                    u->packed ? "less than " : "", (unsigned long long)(u->given + most), expected);
}

static relume_status read_file(unpack *u, void *bytes, size_t size, size_t *got)
{
    *got = 0;
    const ssize_t n = infile_read(&u->in, bytes, size, u->at);
    if (n < 0)
        return relume_input_fail(u->log, u->path, "cannot be read", errno);
    u->at += (uint64_t)n;
    *got = (size_t)n;
    return RELUME_OK;
}

// More of the file behind what is left of the chunk; `*more` is false at the end.
static relume_status fill_chunk(unpack *u, bool *more)
{
    size_t n = 0;
    const size_t left = u->z.avail_in;
    if (left)
        memmove(u->chunk, u->z.next_in, left);
    const relume_status status = read_file(u, u->chunk + left, sizeof u->chunk - left, &n);
    u->z.next_in = u->chunk;
    u->z.avail_in = (unsigned)(left + n);
    *more = n > 0;
    return status;
}

// Files that gzip has packed in pieces, as bgzip and `cat` make them, are what all members give
// (RFC 1952, 2.2). What follows the last one and is no member is passed over, as gzip does.
static relume_status next_member(unpack *u)
{
    bool more = true;
    relume_status status = RELUME_OK;
    while (u->z.avail_in < 2 && more && !status)
        status = fill_chunk(u, &more);
    if (status)
        return status;
    u->ended = u->z.avail_in < 2 || u->z.next_in[0] != 0x1f || u->z.next_in[1] != 0x8b;
    if (!u->ended)
        inflateReset(&u->z);
    return RELUME_OK;
}

// One step of zlib; more of the file first when it has used up what there was.
static relume_status inflate_some(unpack *u)
{
    if (!u->z.avail_in) {
        bool more;
        const relume_status status = fill_chunk(u, &more);
        if (status)
            return status;
        if (!more)
            return log_fail(u->log, RELUME_EDAMAGED,
                            "%s: ends too early; expected more of what gzip has packed", u->path);
    }
    const int result = inflate(&u->z, Z_NO_FLUSH);
    if (result == Z_STREAM_END)
        return next_member(u);
    if (result == Z_OK || result == Z_BUF_ERROR)
        return RELUME_OK;
    return result == Z_MEM_ERROR
               ? RELUME_ENOMEM
               : log_fail(u->log, RELUME_EDAMAGED, "%s: cannot be unpacked; damaged", u->path);
}

relume_status unpack_read(unpack *u, void *bytes, size_t size, size_t *got)
{
    relume_status status = RELUME_OK;
    *got = 0;
    if (!u->packed) {
        status = read_file(u, bytes, size, got);
        u->given += *got;
        return status;
    }
    while (*got < size && !u->ended && !status) {
        const size_t left = size - *got, part = left < 1u << 30 ? left : 1u << 30;
        u->z.next_out = (uint8_t *)bytes + *got;
        u->z.avail_out = (unsigned)part;
        status = inflate_some(u);
        *got += part - u->z.avail_out;
        u->given += part - u->z.avail_out;
    }
    return status;
}

relume_status unpack_all(unpack *u, void *bytes, size_t size, const char *expected)
{
    size_t got;
    const relume_status status = unpack_read(u, bytes, size, &got);
    if (status || got == size)
        return status;
    return log_fail(u->log, RELUME_EUNFIT, "%s: ends after %llu bytes; expected %s", u->path,
                    (unsigned long long)u->given, expected);
}

relume_status unpack_skip(unpack *u, uint64_t bytes, const char *expected)
{
    char passed[4096];
    relume_status status = RELUME_OK;
    if (!u->packed) {
        u->at += bytes < UINT64_MAX - u->at ? bytes : UINT64_MAX - u->at;
        return RELUME_OK;
    }
    for (size_t part; bytes && !status; bytes -= part) {
        part = bytes < sizeof passed ? (size_t)bytes : sizeof passed;
        status = unpack_all(u, passed, part, expected);
    }
    return status;
}
