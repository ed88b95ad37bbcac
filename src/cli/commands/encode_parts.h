// encode_parts.h - encode shared by several machines: the options that say so, and the lines for
// the shell
#ifndef ENCODE_PARTS_H
#define ENCODE_PARTS_H

#include "cli/cli.h"

// "3/8"; 0 of 0 where nobody asked.
struct which_part {
    int part, parts;
};
relume_status take_part(void *which, const struct option *option, const char *text,
                        const struct relume_log *log);

// The options of `table` that were given and say what is encoded, as a text; those whose names are
// in `but` (NULL-terminated) are left out.
struct options_text {
    char text[4096];
};
relume_status options_text(struct options_text *out, const struct args *args,
                           const struct option *table, const char *const *but);

// One line for each of `parts`, and one that joins what they write into `output`. `learns`: with a
// folder beside it for what they learn, unless one is given.
void print_commands_of_parts(const struct args *args, const char *output, int parts, bool learns);

#endif
