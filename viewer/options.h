// options.h - the command line of relume-view
#ifndef VIEWER_OPTIONS_H
#define VIEWER_OPTIONS_H

#include "app.h"

struct options {
    const char *file;       // NULL: only help was asked for
    const char *offscreen;  // picture to write without a window, or NULL
    const char *script;     // events to play without a window, or NULL
    struct app_state start;
    bool sized;   // --size was given
    int threads;  // that read files; 0: all cores
};

// RELUME_EINVAL with a sentence in `log`: unknown options, wrong values, no FILE.
relume_status options_parse(struct options *options, int argc, char **argv,
                            const struct relume_log *log);
void options_help(void);

// One directional light in words. RELUME_EINVAL with a sentence, RELUME_ENOMEM.
relume_status options_light(struct relume_light *out, const char *spec,
                            const struct relume_log *log);

// "x,y,z": `count` numbers separated by commas or blanks and nothing else.
bool options_numbers(const char *text, double *out, int count);

#endif
