// text.h - texts of people inside JSON and addresses (of HTML: markup.h)
#ifndef PUBLISH_TEXT_H
#define PUBLISH_TEXT_H

#include <relume/base.h>
#include <stdio.h>

struct details;

// As a JSON string with its quotes, which may also stand inside a script of a page.
void text_json(FILE *to, const char *text);
// A line of a JSON object with a comma; none where `value` is NULL.
void text_member(FILE *to, const char *key, const char *value);
// Such lines of a file's name and of what visitors read of it.
void text_details(FILE *to, const char *name, const struct details *d);
// As an address: what may not stand in one is percent-encoded.
void text_address(FILE *to, const char *text);

// What a memory stream collects.
struct text {
    FILE *file;
    char *bytes;
    size_t size;
};
relume_status text_open(struct text *t);
// The bytes are there from here on. RELUME_ENOMEM.
relume_status text_close(struct text *t);
void text_free(struct text *t);

#endif
