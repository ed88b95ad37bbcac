// text.c - texts of people inside JSON and addresses
#include "site/publish/text.h"

#include "core/base/memory.h"
#include "site/publish/details.h"

#include <string.h>

void text_put(struct jwriter *w, const char *key, const char *text)
{
    char *copy = text ? mem_text(text) : NULL;
    if (text && !copy)
        jfail(w, RELUME_ENOMEM);
    for (size_t i = 0; copy && copy[i]; i++)
        if (copy[i] == '\n' || copy[i] == '\t')
            copy[i] = ' ';
    jput_text(w, key, copy ? relume_printable(copy) : NULL);
    mem_free(copy);
}

void text_put_details(struct jwriter *w, const char *name, const struct details *d)
{
    const struct {
        const char *key, *text;
    } rows[] = {{"name", name},          {"title", d->title},   {"maker", d->maker},
                {"licence", d->licence}, {"object", d->object}, {"description", d->description}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (!rows[i].text)
            continue;
        jgap(w, "\n  ");
        text_put(w, rows[i].key, rows[i].text);
    }
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
