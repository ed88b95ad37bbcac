// base64.c - bytes as text of 64 characters, three as four
#include "core/math/base64.h"

#include "core/base/json_write.h"
#include "core/base/memory.h"

#include <string.h>

const char base64_digits[65] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

void base64_text(char *out, const uint8_t *bytes, size_t n)
{
    for (size_t i = 0; i < n; i += 3) {
        const uint32_t bits = (uint32_t)bytes[i] << 16 |
                              (i + 1 < n ? (uint32_t)bytes[i + 1] << 8 : 0) |
                              (i + 2 < n ? (uint32_t)bytes[i + 2] : 0);
        for (int k = 0; k < 4; k++)
            *out++ = i + (size_t)k > n ? '=' : base64_digits[bits >> (18 - 6 * k) & 63];
    }
}

void base64_print(FILE *to, const uint8_t *bytes, size_t n)
{
    enum { AT_ONCE = 3072 };
    char text[AT_ONCE / 3 * 4];
    for (size_t i = 0; i < n; i += AT_ONCE) {
        const size_t part = n - i < AT_ONCE ? n - i : AT_ONCE;
        base64_text(text, bytes + i, part);
        fwrite(text, 1, base64_length(part), to);
    }
}

void base64_put(struct jwriter *w, const char *key, const void *bytes, size_t n)
{
    const size_t length = base64_length(n);
    char *text = mem_array(length + 1, 1);
    if (text) {
        base64_text(text, bytes, n);
        text[length] = '\0';
        jput_text(w, key, text);
    } else {
        jfail(w, RELUME_ENOMEM);
    }
    mem_free(text);
}

ptrdiff_t base64_bytes(uint8_t *out, const char *text)
{
    const size_t n = strlen(text);
    const size_t end = n - (n && text[n - 1] == '=') - (n > 1 && text[n - 2] == '=');
    uint32_t bits = 0;
    ptrdiff_t size = 0;
    if (n % 4)
        return -1;
    for (size_t i = 0; i < n; i++) {
        const char *digit = i < end ? strchr(base64_digits, text[i]) : base64_digits;
        if (!digit)
            return -1;
        bits = bits << 6 | (uint32_t)(digit - base64_digits);
        for (int k = 2; i % 4 == 3 && k >= 0; k--)
            out[size++] = (uint8_t)(bits >> 8 * k);
    }
    return size - (ptrdiff_t)(n - end);
}
