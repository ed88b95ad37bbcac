// markup.h - texts of people in pages, and what reports look like
#ifndef MATH_MARKUP_H
#define MATH_MARKUP_H

#include <relume/base.h>
#include <stdio.h>

// `text` as HTML shows it, in content and in quoted attributes: line ends are blanks, what is no
// text or would be obeyed is a question mark. NULL is nothing.
void markup_text(FILE *to, const char *text);
// The same for another language: `escape` gives what stands in place of a character, NULL: itself.
void markup_escape(FILE *to, const char *text, const char *(*escape)(uint32_t code));

// The style that report.html of all kinds shares; each adds its own.
extern const char markup_style[];

#endif
