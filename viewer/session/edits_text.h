// edits_text.h - edits of a material or of maps in words, as scripts and the panel say them
#ifndef VIEWER_EDITS_TEXT_H
#define VIEWER_EDITS_TEXT_H

#include <relume/material/edit.h>

// Changes a list: "undo", "redo" or an operation of relume/material/edit.h, "OPERATION VALUE
// [PARAMETER VALUE ...]" with quotes around what holds blanks. Cuts the words up. RELUME_EINVAL
// with a sentence, an input status.
relume_status edits_change(relume_edits *edits, char *words, const struct relume_log *log);
// Returns a name without the quotes around it, which are cut off in place.
const char *edits_unquote(char *name);

#endif
