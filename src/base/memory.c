#include "base/memory.h"

#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

static atomic_long countdown;  // test hook only; 0 is off

void mem_fail_after(long n)
{
    atomic_store(&countdown, n);
}

bool mem_fail_pending(void)
{
    return atomic_load(&countdown) > 0;
}

static bool refuse(void)
{
    return atomic_load_explicit(&countdown, memory_order_relaxed) > 0 &&
           atomic_fetch_sub(&countdown, 1) == 1;
}

void *mem_array(size_t count, size_t size)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes) || refuse())
        return NULL;
    return malloc(bytes ? bytes : 1);
}

void *mem_zeroed(size_t count, size_t size)
{
    return refuse() ? NULL : calloc(count ? count : 1, size ? size : 1);
}

void *mem_resize(void *old, size_t count, size_t size)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes) || refuse())
        return NULL;
    return realloc(old, bytes ? bytes : 1);
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

char *mem_format(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    char *text = NULL;
    if (refuse() || vasprintf(&text, format, args) < 0)
        text = NULL;
    va_end(args);
    return text;
}

struct relume_limits limits_or_default(const struct relume_limits *limits)
{
    struct relume_limits l = limits ? *limits : (struct relume_limits){0};
    l.max_side = l.max_side ? l.max_side : 65536;
    l.max_pixels = l.max_pixels ? l.max_pixels : (uint64_t)1 << 30;
    l.max_lights = l.max_lights ? l.max_lights : 65536;
    l.max_views = l.max_views ? l.max_views : 65536;
    return l;
}

bool limits_allow(const struct relume_limits *limits, int64_t width, int64_t height)
{
    const struct relume_limits l = limits_or_default(limits);
    return width >= 1 && height >= 1 && width <= l.max_side && height <= l.max_side &&
           (uint64_t)width * (uint64_t)height <= l.max_pixels;
}
