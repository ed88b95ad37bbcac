// write.h - what the writers of notes share
#ifndef NOTES_WRITE_H
#define NOTES_WRITE_H

#include <relume/exchange/notes.h>
// Writes the note as an annotation of `source`.
struct jwriter;
void note_put(struct jwriter *w, const struct relume_note *note, const char *source);

#endif
