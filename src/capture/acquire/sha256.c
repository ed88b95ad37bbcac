// sha256.c - the check sum that archives ask for (FIPS 180-4, SHA-256)
#include "capture/acquire/sha256.h"

#include <stdio.h>
#include <string.h>

// FIPS 180-4, 4.2.2: the fractions of the cube roots of the first 64 primes
static const uint32_t k[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2,
};

void sha256_init(struct sha256 *s)
{
    *s = (struct sha256){.state = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f,
                                   0x9b05688c, 0x1f83d9ab, 0x5be0cd19}};
}

static inline uint32_t turn(uint32_t v, int bits)
{
    return v >> bits | v << (32 - bits);
}

// 6.2.2, with its letters. Instead of the values their names go round: a name is one register
// once the loop over eight words is unrolled.
static inline __attribute__((always_inline)) void take_word(uint32_t v[8], int turns, uint32_t word)
{
    const uint32_t a = v[(8 - turns) & 7], b = v[(9 - turns) & 7], c = v[(10 - turns) & 7];
    const uint32_t e = v[(12 - turns) & 7], f = v[(13 - turns) & 7], g = v[(14 - turns) & 7];
    uint32_t *d = &v[(11 - turns) & 7], *h = &v[(15 - turns) & 7];
    const uint32_t t1 = *h + (turn(e, 6) ^ turn(e, 11) ^ turn(e, 25)) + ((e & f) ^ (~e & g)) + word;
    *d += t1;
    *h = t1 + (turn(a, 2) ^ turn(a, 13) ^ turn(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
}

static void add_block(uint32_t h[8], const uint8_t *block)
{
    uint32_t w[64], v[8];
    for (int t = 0; t < 16; t++, block += 4)
        w[t] = (uint32_t)block[0] << 24 | (uint32_t)block[1] << 16 | (uint32_t)block[2] << 8 |
               block[3];
    for (int t = 16; t < 64; t++) {
        const uint32_t a = w[t - 15], b = w[t - 2];
        w[t] = w[t - 16] + w[t - 7] + (turn(a, 7) ^ turn(a, 18) ^ a >> 3) +
               (turn(b, 17) ^ turn(b, 19) ^ b >> 10);
    }
    memcpy(v, h, sizeof v);
    for (int t = 0; t < 64; t += 8) {
        take_word(v, 0, k[t] + w[t]);
        take_word(v, 1, k[t + 1] + w[t + 1]);
        take_word(v, 2, k[t + 2] + w[t + 2]);
        take_word(v, 3, k[t + 3] + w[t + 3]);
        take_word(v, 4, k[t + 4] + w[t + 4]);
        take_word(v, 5, k[t + 5] + w[t + 5]);
        take_word(v, 6, k[t + 6] + w[t + 6]);
        take_word(v, 7, k[t + 7] + w[t + 7]);
    }
    for (int i = 0; i < 8; i++)
        h[i] += v[i];
}

void sha256_add(struct sha256 *s, const void *bytes, size_t n)
{
    const uint8_t *from = bytes;
    while (n) {
        const size_t at = s->bytes % 64, some = n < 64 - at ? n : 64 - at;
        if (some == 64)
            add_block(s->state, from);
        else
            memcpy(s->block + at, from, some);
        s->bytes += some;
        from += some;
        n -= some;
        if (some < 64 && s->bytes % 64 == 0)
            add_block(s->state, s->block);
    }
}

void sha256_end(struct sha256 *s, char text[SHA256_TEXT])
{
    static const uint8_t zeros[64] = {0};
    const uint64_t bits = 8 * s->bytes;
    uint8_t length[8];
    for (int i = 0; i < 8; i++)
        length[i] = (uint8_t)(bits >> (56 - 8 * i));
    sha256_add(s, "\x80", 1);
    sha256_add(s, zeros, (64 + 56 - s->bytes % 64) % 64);
    sha256_add(s, length, sizeof length);
    for (int i = 0; i < 8; i++)
        snprintf(text + 8 * i, 9, "%08x", (unsigned)s->state[i]);
}
