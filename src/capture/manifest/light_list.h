// light_list.h - the one reader of lists of lights that are texts: .lp files, lines, tables
#ifndef CAPTURE_LIGHT_LIST_H
#define CAPTURE_LIGHT_LIST_H

#include "core/base/arena.h"

#include <relume/base.h>

// Arrays live in `arena`.
struct light_list {
    struct arena arena;
    int count;
    struct relume_vec3 *vector;     // [count] as written
    struct relume_vec3 *direction;  // [count] unit
    const char **name;              // [count] as written, NULL in a list without names
    int *line;                      // [count] of the file
    bool numbered;                  // names are whole numbers, perhaps only an index
    bool angles;                    // written as angles: there are no positions
    bool unit;                      // most vectors have unit length within 2 %
};

// Reads a list. All lines together decide what their columns are (docs/capture.md, "Lists of
// lights"). RELUME_EFORMAT, RELUME_ELIMIT with a message that names file and line; another input
// status, RELUME_ENOMEM. On failure `out` is empty.
relume_status light_list_read(struct light_list *out, const char *path,
                              const struct relume_limits *limits, const struct relume_log *log);
void light_list_free(struct light_list *list);

#endif
