// light_columns.h - the first line of a table of lights, which says what its columns are
#ifndef CAPTURE_LIGHT_COLUMNS_H
#define CAPTURE_LIGHT_COLUMNS_H

#include "capture/manifest/light_text.h"

// Columns count from 0; -1 is a missing one.
struct light_columns {
    bool found;
    char delimiter;  // ' ': blanks, where a name may hold blanks
    int count;
    bool polar;      // vector[0] is the angle from +z, or the elevation, vector[1] the azimuth
    bool elevation;  // vector[0] is an elevation
    int vector[3];
    int name, index;
    int line;
};

// Looks whether `line`, or a comment that it holds, names columns of a vector: x y z (also lx,
// dirx, position_x), theta phi, or azimuth elevation. A comment counts only where it says more than
// `x y z`. RELUME_EFORMAT with a message for two columns of one kind, or angles in radians.
relume_status light_columns_find(struct light_columns *out, const struct light_line *line,
                                 const char *path, const struct relume_log *log);

#endif
