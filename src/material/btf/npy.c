// npy.c - arrays in NumPy's file format (NEP 1, version 1.0), mapped into memory
#include "material/btf/npy.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

// Little-endian, like every machine this builds on.
static const struct {
    const char *descr;
    size_t size;
} kinds[] = {[NPY_HALF] = {"<f2", 2},
             [NPY_FLOAT] = {"<f4", 4},
             [NPY_U8] = {"|u1", 1},
             [NPY_U16] = {"<u2", 2},
             [NPY_U32] = {"<u4", 4}};
enum { KINDS = sizeof kinds / sizeof *kinds, PREFIX = 10, ALIGN = 64, WRITE_AT_ONCE = 1 << 24 };
static const char MAGIC[] = "\x93NUMPY\x01";

size_t npy_item(enum npy_kind kind)
{
    return kinds[kind].size;
}

size_t npy_bytes(const struct npy *npy)
{
    size_t bytes = kinds[npy->kind].size;
    for (int i = 0; i < npy->dims; i++)
        if (__builtin_mul_overflow(bytes, npy->shape[i], &bytes))
            return SIZE_MAX;
    return bytes;
}

// ---------------------------------------------------------------- reading

// What follows `'key':` in the header; NULL when the key is not there.
static const char *member(const char *header, const char *key)
{
    char quoted[32];
    snprintf(quoted, sizeof quoted, "'%s':", key);
    const char *at = strstr(header, quoted);
    return at ? at + strlen(quoted) + strspn(at + strlen(quoted), " ") : NULL;
}

static bool read_kind(struct npy *npy, const char *at)
{
    for (int k = 0; at && k < KINDS; k++)
        if (at[0] == '\'' && !strncmp(at + 1, kinds[k].descr, 3) && at[4] == '\'') {
            npy->kind = (enum npy_kind)k;
            return true;
        }
    return false;
}

static bool read_shape(struct npy *npy, const char *at)
{
    if (!at || *at++ != '(')
        return false;
    for (npy->dims = 0; npy->dims < NPY_DIMS; npy->dims++) {
        at += strspn(at, " ,");
        if (*at < '0' || *at > '9')
            break;
        char *end;
        errno = 0;
        npy->shape[npy->dims] = strtoull(at, &end, 10);
        if (errno)
            return false;
        at = end;
    }
    at += strspn(at, " ,");
    return *at == ')' && npy->dims > 0;
}

static bool read_header(struct npy_file *f, size_t *offset)
{
    const unsigned char *bytes = f->map;
    if (f->map_size < PREFIX || memcmp(bytes, MAGIC, 7))
        return false;
    const size_t length = bytes[8] | (size_t)bytes[9] << 8;
    if (PREFIX + length > f->map_size)
        return false;
    char *header = mem_array(length + 1, 1);
    if (!header)
        return false;
    memcpy(header, bytes + PREFIX, length);
    header[length] = '\0';
    const char *order = member(header, "fortran_order");
    const bool good = read_kind(&f->npy, member(header, "descr")) && order &&
                      !strncmp(order, "False", 5) && read_shape(&f->npy, member(header, "shape"));
    mem_free(header);
    *offset = PREFIX + length;
    return good;
}

static relume_status map_file(struct npy_file *f, const char *path, const struct relume_log *log)
{
    const int fd = input_descriptor(path, log);
    struct stat info;
    if (fd < 0 || fstat(fd, &info)) {
        const int error = errno;
        if (fd >= 0)
            close(fd);
        return relume_input_fail(log, path, "cannot be read", error);
    }
    f->map_size = S_ISREG(info.st_mode) ? (size_t)info.st_size : 0;
    void *map = f->map_size ? mmap(NULL, f->map_size, PROT_READ, MAP_SHARED, fd, 0) : MAP_FAILED;
    close(fd);
    if (map == MAP_FAILED)
        return log_fail(log, RELUME_EFORMAT, "%s: cannot be read; expected a NumPy array", path);
    f->map = map;
    return RELUME_OK;
}

// Where an odd header leaves the values between the addresses of their kind, they are copied.
static relume_status align_values(struct npy_file *f, size_t offset, const struct relume_log *log)
{
    const size_t bytes = f->map_size - offset;
    f->data = (const char *)f->map + offset;
    if (!bytes || offset % npy_item(f->npy.kind) == 0)
        return RELUME_OK;
    void *copy = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (copy == MAP_FAILED)
        return log_fail(log, RELUME_ENOMEM, "no memory for %zu bytes of values", bytes);
    f->data = memcpy(copy, f->data, bytes);
    munmap(f->map, f->map_size);
    f->map = copy;
    f->map_size = bytes;
    return RELUME_OK;
}

relume_status npy_open(struct npy_file *file, const char *path, const struct relume_log *log)
{
    *file = (struct npy_file){.map = NULL};
    size_t offset = 0;
    relume_status status = map_file(file, path, log);
    if (!status && !read_header(file, &offset))
        status = log_fail(log, RELUME_EUNSUPPORTED,
                          "%s: this kind of array cannot be read; expected NumPy format 1.0, rows "
                          "first, of half, float, uint8, uint16 or uint32",
                          path);
    if (!status && file->map_size - offset != npy_bytes(&file->npy))
        status = log_fail(log, RELUME_EDAMAGED, "%s: expected %zu bytes of values; found %zu", path,
                          npy_bytes(&file->npy), file->map_size - offset);
    if (!status)
        status = align_values(file, offset, log);
    if (status)
        npy_close(file);
    return status;
}

void npy_close(struct npy_file *file)
{
    if (file->map)
        munmap(file->map, file->map_size);
    *file = (struct npy_file){.map = NULL};
}

// ---------------------------------------------------------------- writing

static size_t make_header(const struct npy *npy, char *out, size_t capacity)
{
    char shape[NPY_DIMS * 24] = "";
    for (int i = 0, n = 0; i < npy->dims; i++)
        n += snprintf(shape + n, sizeof shape - (size_t)n, "%zu,%s", npy->shape[i],
                      i + 1 < npy->dims ? " " : "");
    const int text = snprintf(out + PREFIX, capacity - PREFIX,
                              "{'descr': '%s', 'fortran_order': False, 'shape': (%s), }",
                              kinds[npy->kind].descr, shape);
    size_t size = PREFIX + (size_t)text + 1;
    size = (size + ALIGN - 1) / ALIGN * ALIGN;
    memset(out + PREFIX + text, ' ', size - PREFIX - (size_t)text);
    out[size - 1] = '\n';
    memcpy(out, MAGIC, 8);
    out[8] = (char)((size - PREFIX) & 255);
    out[9] = (char)((size - PREFIX) >> 8);
    return size;
}

relume_status npy_save(const struct npy *npy, const void *data, const char *path,
                       const struct relume_log *log)
{
    char header[512];
    const size_t start = make_header(npy, header, sizeof header), bytes = npy_bytes(npy);
    outfile *out;
    relume_status status = outfile_open(&out, path, NULL, log);
    if (status)
        return status;
    status = outfile_write(out, header, start, 0);
    for (size_t at = 0; at < bytes && !status; at += WRITE_AT_ONCE) {
        const size_t size = bytes - at < WRITE_AT_ONCE ? bytes - at : WRITE_AT_ONCE;
        status = outfile_write(out, (const char *)data + at, size, (off_t)(start + at));
    }
    if (!status)
        return outfile_commit(&out);
    outfile_abort(&out);
    return status;
}
