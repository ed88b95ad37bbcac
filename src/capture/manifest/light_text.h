// light_text.h - the text of a list of lights: decoded, cut into lines, and these into words
#ifndef CAPTURE_LIGHT_TEXT_H
#define CAPTURE_LIGHT_TEXT_H

#include <relume/base.h>

// Loads a text as UTF-8, which mem_free() frees. UTF-16 is converted, a byte order mark removed.
// RELUME_EFORMAT for a binary file, RELUME_ELIMIT beyond 64 MB, RELUME_ENOTFOUND, RELUME_ENOMEM.
relume_status light_text_load(char **out, const char *path, const struct relume_log *log);

// A line without its end; lines end in LF, CR or both.
struct light_line {
    const char *start, *end;
    int number;        // 1 for the first of the file
    const char *next;  // start of the following line
};
struct light_line light_line_first(const char *text);
// Moves to the next line that is not blank; `line` starts as light_line_first(). False at the end.
bool light_line_next(struct light_line *line);

enum { LIGHT_WORDS = 256 };
struct light_word {
    const char *text;
    int length;
    bool number;
    char after;  // strongest separator behind the word: ';', ',', tab or blank
    double value;
};
// The words of one line, at most LIGHT_WORDS.
struct light_row {
    int count, numbers;
    struct light_word word[LIGHT_WORDS];
};
// Splits a line at blanks, tabs and semicolons, and at commas that a blank follows; with `commas`
// at every comma. Words in quotation marks stay whole. A comment ends the line: # or // at its
// start or behind two numbers.
void light_row_split(struct light_row *out, const struct light_line *line, bool commas);
// Splits a line at each `delimiter`, blanks around fields are removed; fields may be empty.
void light_row_fields(struct light_row *out, const struct light_line *line, char delimiter);
// The line is a comment: it starts with # or //. `text` (or NULL) becomes what follows these marks.
bool light_line_comment(const struct light_line *line, const char **text);

#endif
