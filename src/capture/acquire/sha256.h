// sha256.h - the check sum that archives ask for (FIPS 180-4, SHA-256)
#ifndef ACQUIRE_SHA256_H
#define ACQUIRE_SHA256_H

#include <relume/base.h>

enum { SHA256_BYTES = 32, SHA256_TEXT = 2 * SHA256_BYTES + 1 };

struct sha256 {
    uint32_t state[8];
    uint64_t bytes;
    uint8_t block[64];
};
void sha256_init(struct sha256 *s);
void sha256_add(struct sha256 *s, const void *bytes, size_t n);
// As 64 hexadecimal digits.
void sha256_end(struct sha256 *s, char text[SHA256_TEXT]);

#endif
