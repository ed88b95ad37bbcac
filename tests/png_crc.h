// png_crc.h - the check sum of a PNG chunk (PNG 1.2, annex D)
#ifndef PNG_CRC_H
#define PNG_CRC_H

#include <stddef.h>
#include <stdint.h>

static inline uint32_t png_crc(const uint8_t *bytes, size_t n)
{
    uint32_t c = ~0u;
    for (size_t i = 0; i < n; i++) {
        c ^= bytes[i];
        for (int k = 0; k < 8; k++)
            c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    }
    return ~c;
}

#endif
