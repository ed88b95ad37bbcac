// light_text.c - the text of a list of lights, whatever program wrote it
#include "capture/manifest/light_text.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_BYTES = 64 << 20, SAMPLE = 4096 };

// ---------------------------------------------------------------- encodings

enum encoding { ENCODING_BYTES, ENCODING_LITTLE, ENCODING_BIG };

// Texts without a byte order mark are UTF-16 where nearly every second byte is 0.
static enum encoding guess_encoding(const unsigned char *bytes, size_t size)
{
    const size_t pairs = (size < SAMPLE ? size : SAMPLE) / 2;
    size_t zeros[2] = {0, 0};
    for (size_t i = 0; i < 2 * pairs; i++)
        zeros[i % 2] += !bytes[i];
    if (!zeros[0] && 4 * zeros[1] > 3 * pairs)
        return ENCODING_LITTLE;
    return !zeros[1] && 4 * zeros[0] > 3 * pairs ? ENCODING_BIG : ENCODING_BYTES;
}

static enum encoding find_encoding(size_t *mark, const unsigned char *bytes, size_t size)
{
    *mark = size >= 2 ? 2 : 0;
    if (size >= 2 && bytes[0] == 0xff && bytes[1] == 0xfe)
        return ENCODING_LITTLE;
    if (size >= 2 && bytes[0] == 0xfe && bytes[1] == 0xff)
        return ENCODING_BIG;
    *mark = size >= 3 && !memcmp(bytes, "\xef\xbb\xbf", 3) ? 3 : 0;
    return guess_encoding(bytes, size);
}

static char *put_code(char *to, unsigned code)
{
    if (code < 0x80) {
        *to++ = (char)code;
        return to;
    }
    const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    static const unsigned char lead[] = {0, 0xc0, 0xe0, 0xf0};
    *to++ = (char)(lead[more] | code >> 6 * more);
    for (int i = more - 1; i >= 0; i--)
        *to++ = (char)(0x80 | (code >> 6 * i & 0x3f));
    return to;
}

static unsigned unit_at(const unsigned char *bytes, bool big)
{
    return (unsigned)bytes[big] | (unsigned)bytes[!big] << 8;
}

// Half a pair of surrogates becomes U+FFFD.
static char *from_utf16(size_t *length, const unsigned char *bytes, size_t size, bool big)
{
    char *out = mem_array(size / 2 * 3 + 1, 1), *to = out;
    for (size_t i = 0; out && i + 1 < size; i += 2) {
        unsigned code = unit_at(bytes + i, big);
        const unsigned low = i + 3 < size ? unit_at(bytes + i + 2, big) : 0;
        if (code >> 10 == 0x36 && low >> 10 == 0x37) {
            code = 0x10000 + ((code & 0x3ff) << 10 | (low & 0x3ff));
            i += 2;
        } else if (code >> 11 == 0x1b) {
            code = 0xfffd;
        }
        to = put_code(to, code);
    }
    if (out)
        *to = '\0';
    *length = (size_t)(to - out);
    return out;
}

// DOS ends texts with a byte 26.
static bool is_binary(const char *text, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        const unsigned char c = (unsigned char)text[i];
        if (c < ' ' && !memchr("\t\n\v\f\r\x1a", c, 6))
            return true;
    }
    return false;
}

relume_status light_text_load(char **out, const char *path, const struct relume_log *log)
{
    char *bytes;
    size_t size, mark;
    *out = NULL;
    relume_status status = input_load(&bytes, &size, path, MAX_BYTES, "a list of lights", log);
    if (status)
        return status;
    const unsigned char *b = (const unsigned char *)bytes;
    const enum encoding encoding = find_encoding(&mark, b, size);
    if (encoding != ENCODING_BYTES) {
        *out = from_utf16(&size, b + mark, size - mark, encoding == ENCODING_BIG);
        mem_free(bytes);
    } else {
        *out = memmove(bytes, bytes + mark, size - mark + 1);
        size -= mark;
    }
    if (*out && is_binary(*out, size)) {
        mem_free(*out);
        *out = NULL;
        return log_fail(log, RELUME_EFORMAT,
                        "%s: not a text file; expected a list of lights, lines 'name x y z'", path);
    }
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- lines

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\x1a';
}

struct light_line light_line_first(const char *text)
{
    return (struct light_line){text, text, 0, text};
}

bool light_line_next(struct light_line *line)
{
    while (*line->next) {
        const char *start = line->next, *end = start + strcspn(start, "\r\n");
        line->next = end + (*end == '\r' && end[1] == '\n') + (*end != '\0');
        line->number++;
        line->start = start;
        line->end = end;
        while (start < end && is_blank(*start))
            start++;
        if (start < end)
            return true;
    }
    return false;
}

// The length of a mark that begins a comment.
static int comment_mark(const char *at, const char *end)
{
    return *at == '#' ? 1 : end - at >= 2 && at[0] == '/' && at[1] == '/' ? 2 : 0;
}

bool light_line_comment(const struct light_line *line, const char **text)
{
    const char *start = line->start;
    while (start < line->end && is_blank(*start))
        start++;
    const int mark = comment_mark(start, line->end);
    if (text)
        *text = start + mark;
    return mark > 0;
}

// ---------------------------------------------------------------- numbers

// A decimal number with a point or a comma; NaN and infinity are numbers here, so that the line
// that holds them is found.
static bool parse_number(double *out, const char *text, int length)
{
    static const char minus[] = "\xe2\x88\x92";  // U+2212, as spreadsheets write it
    static const char *const special[] = {"nan", "inf", "infinity"};
    char word[64], *to = word, *end;
    if (length >= (int)sizeof word)
        return false;
    if (length > 3 && !memcmp(text, minus, 3)) {
        *to++ = '-';
        text += 3;
        length -= 3;
    }
    for (int i = 0; i < length; i++)
        *to++ = text[i] == ',' ? '.' : text[i];
    *to = '\0';
    const char *digits = word + (*word == '-' || *word == '+');
    bool known = strspn(word, "0123456789.+-eE") == strlen(word) && strpbrk(word, "0123456789");
    for (size_t i = 0; i < sizeof special / sizeof *special; i++)
        known |= !strcasecmp(digits, special[i]);
    *out = known ? strtod(word, &end) : 0.0;
    return known && !*end;
}

static void add_word(struct light_row *row, const char *text, const char *end)
{
    struct light_word *w = &row->word[row->count++];
    *w = (struct light_word){.text = text, .length = (int)(end - text), .after = ' '};
    w->number = parse_number(&w->value, text, w->length);
    row->numbers += w->number;
}

// ---------------------------------------------------------------- words

// A name that begins with an apostrophe has no closing one before a separator.
static const char *closing_quote(const char *at, const char *end)
{
    if (*at != '"' && *at != '\'')
        return NULL;
    for (const char *c = at + 1; c < end; c++)
        if (*c == *at && (c + 1 == end || is_blank(c[1]) || c[1] == ',' || c[1] == ';'))
            return c;
    return NULL;
}

static bool is_separator(const char *at, const char *end, bool commas)
{
    if (is_blank(*at) || *at == ';')
        return true;
    return *at == ',' && (commas || at + 1 == end || is_blank(at[1]) || at[1] == ';');
}

static const char *skip_separators(const char *at, const char *end, bool commas, char *strongest)
{
    for (; at < end && is_separator(at, end, commas); at++)
        if (*at == ';' || (*at == ',' && *strongest != ';') || (*at == '\t' && *strongest == ' '))
            *strongest = *at;
    return at;
}

// A comment may follow a number at once: "0 0 1# the last".
static const char *word_end(const struct light_row *row, const char *at, const char *end,
                            bool commas)
{
    double value;
    const char *c = at;
    while (c < end && !is_separator(c, end, commas) &&
           !(*c == '#' && row->numbers >= 2 && parse_number(&value, at, (int)(c - at))))
        c++;
    return c;
}

void light_row_split(struct light_row *out, const struct light_line *line, bool commas)
{
    const char *at = line->start, *end = line->end;
    out->count = out->numbers = 0;
    while (at < end && out->count < LIGHT_WORDS) {
        char none = ' ';
        at =
            skip_separators(at, end, commas, out->count ? &out->word[out->count - 1].after : &none);
        if (at == end || (comment_mark(at, end) && (!out->count || out->numbers >= 2)))
            return;
        const char *quote = closing_quote(at, end);
        const char *last = quote ? quote : word_end(out, at, end, commas);
        add_word(out, at + !!quote, last);
        at = last + !!quote;
    }
}

static void add_field(struct light_row *row, const char *start, const char *end)
{
    while (start < end && is_blank(*start))
        start++;
    while (end > start && is_blank(end[-1]))
        end--;
    const char *quote = start < end ? closing_quote(start, end) : NULL;
    if (quote && quote + 1 == end) {
        start++;
        end--;
    }
    add_word(row, start, end);
}

void light_row_fields(struct light_row *out, const struct light_line *line, char delimiter)
{
    const char *start = line->start, *end = line->end;
    out->count = out->numbers = 0;
    while (out->count < LIGHT_WORDS) {
        const char *at = start;
        while (at < end && is_blank(*at) && *at != delimiter)
            at++;
        const char *quote = at < end ? closing_quote(at, end) : NULL;
        at = quote ? quote + 1 : at;
        while (at < end && *at != delimiter)
            at++;
        add_field(out, start, at);
        if (at >= end)
            return;
        start = at + 1;
    }
}
