// state_line.h - how a file is looked at, in one line that pages, the viewer and the tool share:
// "light=dir,0.9,0.2,0.2&exposure=1&pass=specular"
//
// Names are those of options, values theirs with commas between words; what is no letter, digit or
// one of ",.:_+-" is %XX. A line may come from anywhere: it names options that show, none that
// write.
#ifndef PROGRAM_STATE_LINE_H
#define PROGRAM_STATE_LINE_H

#include <relume/base.h>
#include <stddef.h>

enum { STATE_LINE_MOST = 32768 };  // bytes

struct state_entry {
    char option[24];    // "--light"
    const char *value;  // in `buffer`
};
// At most `most` entries of `line`, of which all before a '#' is an address; texts lie in `buffer`,
// STATE_LINE_MOST bytes. Names that pages alone know are left out, with a warning those that nobody
// knows. RELUME_EINVAL with a sentence.
relume_status state_line_read(struct state_entry *out, int *count, int most, char *buffer,
                              const char *line, const struct relume_log *log);

// Append "name=value" with its '&', words of `value` separated by blanks. False when it does not
// fit; `line` is then as it was.
bool state_line_add(char *line, size_t size, const char *name, const char *value);

#endif
