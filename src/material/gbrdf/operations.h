// operations.h - what can be done to a material: one table of operations, one of their parameters
#ifndef EDIT_OPERATIONS_H
#define EDIT_OPERATIONS_H

#include "material/gbrdf/on_gbrdf.h"

#include <relume/material/edit.h>

enum parameter_kind {
    PARAMETER_NUMBERS,   // double[count]
    PARAMETER_LABELS,    // int[count]
    PARAMETER_CHANNELS,  // char[4]
    PARAMETER_PICTURE,   // struct relume_image
};

struct edit_parameter {
    const char *name;
    enum parameter_kind kind;
    int count;
    size_t offset;  // in struct relume_edit
    double least, most;
    bool optional;  // may be NaN, -1 or empty: then files leave it out
    const char *form;
};

enum { MOST_PARAMETERS = 8 };

struct relume_edit_operation {
    const char *name, *summary;
    const struct edit_parameter *parameter[MOST_PARAMETERS];  // NULL ends them
    relume_status (*gbrdf)(struct edited_gbrdf *g, const struct relume_edit *edit);
    // NULL: maps have nothing that it changes.
    relume_status (*maps)(struct relume_maps *maps, const struct relume_edit *edit, int threads,
                          const struct relume_log *log);
};

// NULL when the operation has none of that name.
const struct edit_parameter *operation_parameter(const struct relume_edit_operation *o,
                                                 const char *name);
// Its value within an edit.
static inline void *parameter_of(const struct edit_parameter *p, const struct relume_edit *edit)
{
    return (char *)(uintptr_t)edit + p->offset;
}
// NULL, or the parameter whose value is missing or out of range.
const struct edit_parameter *edit_fault(const struct relume_edit *edit);
// RELUME_EINVAL with a sentence: what was expected of a parameter, and `found` unless that is NULL.
relume_status edit_refuse(const struct relume_edit_operation *o, const struct edit_parameter *p,
                          const char *found, const struct relume_log *log);
bool parameter_is_good(const struct edit_parameter *p, const struct relume_edit *edit);
// Whether an optional parameter has been set.
bool parameter_given(const struct edit_parameter *p, const struct relume_edit *edit);

#endif
