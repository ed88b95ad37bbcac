// fnv.h - fingerprints of bytes (FNV-1a of 64 bits; Fowler, Noll and Vo 1991)
#ifndef MATH_FNV_H
#define MATH_FNV_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define FNV_START 0xcbf29ce484222325u
// One step: a byte, or eight of them.
static inline uint64_t fnv_of_word(uint64_t hash, uint64_t word)
{
    return (hash ^ word) * 0x100000001b3u;
}

// Begin with FNV_START; the next bytes of what a fingerprint is of.
static inline uint64_t fnv_of(uint64_t hash, const void *bytes, size_t size)
{
    const uint8_t *b = (const uint8_t *)bytes;
    for (size_t i = 0; i < size; i++)
        hash = fnv_of_word(hash, b[i]);
    return hash;
}

// A text without its end.
static inline uint64_t fnv_of_text(const char *text)
{
    return fnv_of(FNV_START, text, strlen(text));
}

// Likewise, eight bytes at a time; the last ones are filled up with zeros.
static inline uint64_t fnv_of_words(uint64_t hash, const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; i += sizeof hash) {
        uint64_t word = 0;
        memcpy(&word, (const char *)bytes + i, size - i < sizeof word ? size - i : sizeof word);
        hash = fnv_of_word(hash, word);
    }
    return hash;
}

#endif
