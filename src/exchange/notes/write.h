// write.h - what the writers of notes share
#ifndef NOTES_WRITE_H
#define NOTES_WRITE_H

#include <relume/exchange/notes.h>
#include <stdio.h>

// As JSON; false: no memory.
bool note_quote(FILE *f, const char *text);
bool note_print(FILE *f, const struct relume_note *note, const char *source);

#endif
