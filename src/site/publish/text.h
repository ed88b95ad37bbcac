// text.h - texts of people inside JSON and addresses (of HTML: markup.h)
#ifndef PUBLISH_TEXT_H
#define PUBLISH_TEXT_H

#include "core/base/json_write.h"

#include <relume/base.h>
#include <stdio.h>

struct details;

// A text of people: line ends are blanks, what is no text or would be obeyed is a question mark.
// Writers of this folder have the style JSON_MARKUP.
void text_put(struct jwriter *w, const char *key, const char *text);
// A file's name and what visitors read of it, each on a line of its own.
void text_put_details(struct jwriter *w, const char *name, const struct details *d);
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
