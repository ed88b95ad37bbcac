// bytes.c - a file in memory, read from the front: text lines, then binary
#include "exchange/formats/bytes.h"

#include "core/base/infile.h"
#include "core/base/memory.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

relume_status bytes_load(struct bytes *out, const char *path, const struct relume_log *log)
{
    *out = (struct bytes){0};
    return input_load((char **)&out->data, &out->size, path, UINT64_MAX, "a file", log);
}

void bytes_free(struct bytes *b)
{
    mem_free(b->data);
    *b = (struct bytes){0};
}

static bool is_blank(uint8_t c)
{
    return c == ' ' || c == '\t';
}

static bool is_space(uint8_t c)
{
    return is_blank(c) || c == '\n' || c == '\r';
}

bool bytes_word(struct bytes *b, char *word, size_t capacity)
{
    size_t n = 0;
    while (b->at < b->size && is_space(b->data[b->at]))
        b->at++;
    while (b->at < b->size && !is_space(b->data[b->at])) {
        if (n + 1 >= capacity)
            return false;
        word[n++] = (char)b->data[b->at++];
    }
    word[n] = '\0';
    return n > 0;
}

bool bytes_integer(struct bytes *b, long *out)
{
    char word[24], *end;
    if (!bytes_word(b, word, sizeof word))
        return false;
    errno = 0;
    *out = strtol(word, &end, 10);
    return !*end && !errno;
}

bool bytes_number(struct bytes *b, double *out)
{
    char word[48], *end;
    if (!bytes_word(b, word, sizeof word))
        return false;
    *out = strtod(word, &end);
    return !*end && isfinite(*out);
}

bool bytes_line_end(struct bytes *b)
{
    while (b->at < b->size && is_blank(b->data[b->at]))
        b->at++;
    if (b->at >= b->size)
        return false;
    if (b->data[b->at] == '\r') {
        b->at++;
        if (b->at < b->size && b->data[b->at] == '\n')
            b->at++;
        return true;
    }
    return b->data[b->at++] == '\n';
}

void bytes_skip_comments(struct bytes *b, char mark)
{
    while (b->at < b->size && b->data[b->at] == (uint8_t)mark) {
        while (b->at < b->size && b->data[b->at] != '\n' && b->data[b->at] != '\r')
            b->at++;
        if (!bytes_line_end(b))
            return;
    }
}

const uint8_t *bytes_take(struct bytes *b, size_t size)
{
    if (b->size - b->at < size)
        return NULL;
    const uint8_t *here = b->data + b->at;
    b->at += size;
    return here;
}

bool bytes_float(struct bytes *b, float *out)
{
    const uint8_t *p = bytes_take(b, 4);
    if (!p)
        return false;
    const uint32_t bits =
        (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    memcpy(out, &bits, sizeof *out);
    return true;
}
