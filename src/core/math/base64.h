// base64.h - bytes as text of 64 characters (RFC 4648, section 4)
#ifndef MATH_BASE64_H
#define MATH_BASE64_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

extern const char base64_digits[65];

// A text of base64_length(n) characters, without an end.
static inline size_t base64_length(size_t n)
{
    return (n + 2) / 3 * 4;
}
void base64_text(char *out, const uint8_t *bytes, size_t n);
// Writes the bytes as a text of a JSON object.
struct jwriter;
void base64_put(struct jwriter *w, const char *key, const void *bytes, size_t n);
void base64_print(FILE *to, const uint8_t *bytes, size_t n);
// How many bytes a whole text was, at most 3/4 of its length; -1 where it is none.
ptrdiff_t base64_bytes(uint8_t *out, const char *text);

#endif
