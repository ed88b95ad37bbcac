// memory.c - allocation with checked sizes, and the limits of sizes read from files
#include "core/base/memory.h"

#include "core/base/context.h"
#include "core/base/log.h"
#include "core/base/params.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

static atomic_long countdown;  // test hook only; 0 is off

// The application's allocator, constant from the first allocation on; without one `release` is
// NULL. The only state of the process besides: whether that first allocation has been.
static struct relume_allocator_params application;
static atomic_bool used;

relume_status relume_set_allocator(const struct relume_allocator_params *params)
{
    const struct relume_allocator_params p = PARAMS(relume_allocator_params, params);
    const int given = (p.allocate != NULL) + (p.resize != NULL) + (p.release != NULL);
    if ((given != 0 && given != 3) || atomic_load(&used))
        return RELUME_EINVAL;
    application = p;
    return RELUME_OK;
}

void mem_fail_after(long n)
{
    atomic_store(&countdown, n);
}

bool mem_fail_pending(void)
{
    return atomic_load(&countdown) > 0;
}

// From now on the allocator stays. Only read, once it is true: the threads share its cache line.
static void note_use(void)
{
    if (!atomic_load_explicit(&used, memory_order_relaxed))
        atomic_store(&used, true);
}

// As malloc does, it says why in errno.
static bool refuse(void)
{
    note_use();
    const bool refused = atomic_load_explicit(&countdown, memory_order_relaxed) > 0 &&
                         atomic_fetch_sub(&countdown, 1) == 1;
    if (refused)
        errno = ENOMEM;
    return refused;
}

// Never none: there is an address for every size.
static void *allocate(void *old, size_t bytes)
{
    bytes = bytes ? bytes : 1;
    if (!application.release)
        return old ? realloc(old, bytes) : malloc(bytes);
    void *memory = old ? application.resize(application.user, old, bytes)
                       : application.allocate(application.user, bytes);
    if (!memory)
        errno = ENOMEM;
    return memory;
}

void *mem_lend(size_t bytes)
{
    note_use();
    return allocate(NULL, bytes);
}

void *mem_resize(void *old, size_t count, size_t size)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes) || refuse())
        return NULL;
    return allocate(old, bytes);
}

void *mem_array(size_t count, size_t size)
{
    return mem_resize(NULL, count, size);
}

void *mem_zeroed(size_t count, size_t size)
{
    if (!application.release)
        return refuse() ? NULL : calloc(count ? count : 1, size ? size : 1);
    void *memory = mem_array(count, size);
    return memory ? memset(memory, 0, count * size) : NULL;
}

bool mem_grow(void *array, size_t count, size_t size)
{
    enum { LEAST = 16 };
    void *items;
    if ((count && count < LEAST) || count & (count - 1))
        return true;
    memcpy(&items, array, sizeof items);
    items = mem_resize(items, count ? 2 * count : LEAST, size);
    if (items)
        memcpy(array, &items, sizeof items);
    return items;
}

void *mem_copy(const void *from, size_t count, size_t size)
{
    void *copy = mem_array(count, size);
    return copy ? memcpy(copy, from, count * size) : NULL;
}

char *mem_text(const char *text)
{
    return mem_copy(text, strlen(text) + 1, 1);
}

void *mem_large(size_t bytes)
{
    enum { LARGE_PAGE = 2 << 20 };
    void *memory = NULL;
    if (application.release || bytes < LARGE_PAGE)
        return mem_array(bytes, 1);
    if (refuse() || posix_memalign(&memory, LARGE_PAGE, bytes))
        return NULL;
    madvise(memory, bytes, MADV_HUGEPAGE);
    return memory;
}

void mem_free(void *memory)
{
    if (!application.release)
        free(memory);
    else if (memory)
        application.release(application.user, memory);
}

void relume_free(void *memory)
{
    mem_free(memory);
}

void mem_free_libc(void *memory)
{
    free(memory);
}

char *mem_take(char *text)
{
    char *copy = text ? mem_text(text) : NULL;
    mem_free_libc(text);
    return copy;
}

char *mem_format(const char *format, ...)
{
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    const int n = vsnprintf(NULL, 0, format, args);
    char *text = n < 0 ? NULL : mem_array((size_t)n + 1, 1);
    if (text)
        vsnprintf(text, (size_t)n + 1, format, again);
    va_end(again);
    va_end(args);
    return text;
}

relume_status relume_size_parse(uint64_t *out, const char *text)
{
    static const char units[] = "kMGT";
    char *end;
    errno = 0;
    const unsigned long long n = strtoull(text, &end, 10);
    const char *unit = *end ? strchr(units, *end == 'K' ? 'k' : *end) : NULL;
    const int bits = unit ? 10 * (int)(unit - units + 1) : 0;
    if (text[0] < '0' || text[0] > '9' || errno || (*end && !unit) || (unit && end[1]) || n < 1 ||
        n > (UINT64_MAX >> 1) >> bits)
        return RELUME_EINVAL;
    *out = (uint64_t)n << bits;
    return RELUME_OK;
}

const struct relume_limits *limits_of(const struct relume_limits *own, const struct relume_log *log)
{
    return own ? own : context_of(log) ? log->context->limits : NULL;
}

// What this process may have: the machine's memory, less where somebody has said so (ulimit -v).
static uint64_t memory_there_is(void)
{
    struct rlimit l;
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    const uint64_t machine = pages > 0 && page > 0 ? (uint64_t)pages * (uint64_t)page : UINT64_MAX;
    const bool limited = !getrlimit(RLIMIT_AS, &l) && l.rlim_cur < machine;
    return limited ? l.rlim_cur : machine;
}

struct relume_limits limits_or_default(const struct relume_limits *limits)
{
    struct relume_limits l = limits ? *limits : (struct relume_limits){0};
    l.max_side = l.max_side ? l.max_side : 65536;
    l.max_pixels = l.max_pixels ? l.max_pixels : (uint64_t)1 << 30;
    l.max_lights = l.max_lights ? l.max_lights : 65536;
    l.max_views = l.max_views ? l.max_views : 65536;
    l.max_memory = l.max_memory ? l.max_memory : memory_there_is() / 2;
    return l;
}

bool limits_allow(const struct relume_limits *limits, int64_t width, int64_t height)
{
    const struct relume_limits l = limits_or_default(limits);
    return width >= 1 && height >= 1 && width <= l.max_side && height <= l.max_side &&
           (uint64_t)width * (uint64_t)height <= l.max_pixels;
}

relume_status limits_picture(const struct relume_limits *limits, const char *path, int64_t width,
                             int64_t height, const struct relume_log *log)
{
    const struct relume_limits l = limits_or_default(limits);
    return limits_allow(limits, width, height)
               ? RELUME_OK
               : log_fail(log, RELUME_ELIMIT,
                          "%s: %lld x %lld pixels; expected 1 to %d a side and at most %llu in all "
                          "(--max-pixels)",
                          path, (long long)width, (long long)height, l.max_side,
                          (unsigned long long)l.max_pixels);
}

static uint64_t megabytes(uint64_t bytes)
{
    return (bytes >> 20) + (bytes & ((1 << 20) - 1) ? 1 : 0);
}

struct memory_size memory_text(uint64_t bytes, uint64_t beside)
{
    struct memory_size size;
    const bool alike = megabytes(bytes) == megabytes(beside);
    snprintf(size.text, sizeof size.text, "%" PRIu64 " %s", alike ? bytes : megabytes(bytes),
             alike ? "bytes" : "MB");
    return size;
}

relume_status limits_memory(const struct relume_limits *limits, uint64_t bytes, const char *what,
                            const struct relume_log *log)
{
    const uint64_t most = limits_or_default(limits_of(limits, log)).max_memory;
    return bytes <= most
               ? RELUME_OK
               : log_fail(log, RELUME_ELIMIT, "%s takes %s; expected at most %s (--max-memory)",
                          what, memory_text(bytes, most).text, memory_text(most, bytes).text);
}
