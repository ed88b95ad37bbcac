// report.h - the page of a comparison, and what its pictures show
#ifndef CHANGE_REPORT_H
#define CHANGE_REPORT_H

#include <relume/material/change.h>

// What is white in the pictures.
enum { RAMP_DEGREES = 15, RAMP_DELTA_E = 15, RAMP_SIGNIFICANCE = 20 };
#define RAMP_GLOSS 0.3

struct writing {
    const struct relume_change *change;
    const struct relume_change_write_params *params;
    const char *folder;
};

// report.html in the folder, beside the pictures that it shows.
relume_status report_write(const struct writing *w);

#endif
