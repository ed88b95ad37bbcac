// fnv.h - fingerprints of bytes (FNV-1a of 64 bits; Fowler, Noll and Vo 1991)
#ifndef MATH_FNV_H
#define MATH_FNV_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

// Begin with FNV_START; the next bytes of what a fingerprint is of.
#define FNV_START 0xcbf29ce484222325u
static inline uint64_t fnv_of(uint64_t hash, const void *bytes, size_t size)
{
    const uint8_t *b = (const uint8_t *)bytes;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ b[i]) * 0x100000001b3u;
    return hash;
}

// Likewise, eight bytes at a time; the last ones are filled up with zeros.
static inline uint64_t fnv_of_words(uint64_t hash, const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; i += sizeof hash) {
        uint64_t word = 0;
        memcpy(&word, (const char *)bytes + i, size - i < sizeof word ? size - i : sizeof word);
        hash = (hash ^ word) * 0x100000001b3u;
    }
    return hash;
}

#endif
