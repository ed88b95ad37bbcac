// notes_file.h - what notes on a relume file are on (relume/exchange/notes.h)
#ifndef PROGRAM_NOTES_FILE_H
#define PROGRAM_NOTES_FILE_H

#include <relume/exchange/notes.h>
#include <relume/pack.h>

// A picture, or the object that several slabs stand around: between corners as far from its middle
// as the window of a slab reaches. `name` and the pack are borrowed.
struct relume_notes_file notes_file_of(const relume_pack *pack, const char *name);

#endif
