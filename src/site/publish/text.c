// text.c - texts of people inside JSON and addresses
#include "site/publish/text.h"

#include "core/base/memory.h"
#include "core/math/markup.h"
#include "site/publish/details.h"

#include <string.h>

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

void text_json(FILE *to, const char *text)
{
    putc('"', to);
    markup_escape(to, text, json);
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

void text_details(FILE *to, const char *name, const struct details *d)
{
    text_member(to, "name", name);
    text_member(to, "title", d->title);
    text_member(to, "maker", d->maker);
    text_member(to, "licence", d->licence);
    text_member(to, "object", d->object);
    text_member(to, "description", d->description);
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
