// text.c - texts of people inside HTML, JSON and addresses
#include "publish/text.h"

#include "base/memory.h"

#include <string.h>

// The next character, a blank for line ends and '?' for what is no text; 0 at the end.
static uint32_t next(const char **text, int *bytes)
{
    uint32_t code;
    *bytes = relume_text_step(&code, *text);
    *text += *bytes;
    return !*bytes                        ? 0
           : code == '\n' || code == '\t' ? ' '
           : relume_text_harmless(code)   ? code
                                          : '?';
}

static void put(FILE *to, const char *text, const char *(*escape)(uint32_t code))
{
    int n = 0;
    for (uint32_t code; text && (code = next(&text, &n));) {
        const char *instead = escape(code);
        if (instead)
            fputs(instead, to);
        else if (code < 0x80)
            putc((int)code, to);
        else
            fwrite(text - n, 1, (size_t)n, to);
    }
}

static const char *html(uint32_t code)
{
    switch (code) {
    case '<': return "&lt;";
    case '>': return "&gt;";
    case '&': return "&amp;";
    case '"': return "&quot;";
    case '\'': return "&#39;";
    default: return NULL;
    }
}

static const char *json(uint32_t code)
{
    switch (code) {
    case '"': return "\\\"";
    case '\\': return "\\\\";
    case '<': return "\\u003c";
    case '>': return "\\u003e";
    case '&': return "\\u0026";
    default: return NULL;
    }
}

void text_html(FILE *to, const char *text)
{
    put(to, text, html);
}

void text_json(FILE *to, const char *text)
{
    putc('"', to);
    put(to, text, json);
    putc('"', to);
}

void text_member(FILE *to, const char *key, const char *value)
{
    if (!value)
        return;
    fprintf(to, "  \"%s\": ", key);
    text_json(to, value);
    fputs(",\n", to);
}

void text_address(FILE *to, const char *text)
{
    for (; text && *text; text++) {
        const unsigned char c = (unsigned char)*text;
        if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
            strchr("-._~:/%", c))
            putc(c, to);
        else
            fprintf(to, "%%%02X", c);
    }
}

relume_status text_open(struct text *t)
{
    *t = (struct text){0};
    t->file = open_memstream(&t->bytes, &t->size);
    return t->file ? RELUME_OK : RELUME_ENOMEM;
}

relume_status text_close(struct text *t)
{
    const bool failed = !t->file || fclose(t->file) != 0;
    t->file = NULL;
    return failed ? RELUME_ENOMEM : RELUME_OK;
}

void text_free(struct text *t)
{
    if (t->file)
        fclose(t->file);
    mem_free_libc(t->bytes);
    *t = (struct text){0};
}
