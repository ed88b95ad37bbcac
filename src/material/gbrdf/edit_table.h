// edit_table.h - the table of edit operations
#ifndef GBRDF_EDIT_TABLE_H
#define GBRDF_EDIT_TABLE_H

#include <relume/material/edit.h>

// One line for help texts; constant.
const char *relume_edit_operation_summary(const struct relume_edit_operation *operation);
// Whether maps have what it changes; g-BRDFs have all of it.
bool relume_edit_operation_on_maps(const struct relume_edit_operation *operation);

// The longest side of a drawing or mask that a list keeps, pixels; larger ones are reduced.
enum { RELUME_EDIT_MOST_SIDE = 1024 };
// Operations of a list.
enum { RELUME_EDIT_MOST = 256 };

#endif
