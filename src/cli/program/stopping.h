// stopping.h - how the programs end when they are asked to
#ifndef PROGRAM_STOPPING_H
#define PROGRAM_STOPPING_H

#include <stdbool.h>

// From now on SIGINT, SIGTERM and SIGHUP ask to stop; a second one of its kind stops at once, and
// nohup's choice is kept. Most phases ask every few milliseconds whether to, and clean up. A
// library's loop asks nobody: when work goes on for 0.8 s after that, a thread removes what is
// unfinished and ends the program, with the line "PROGRAM: interrupted". `*midline` is
// whether the cursor is not at the start of a line; `midline` may be NULL.
void stopping_listen(const char *program, const volatile bool *midline);

// The signal that asked to stop, 0: none.
int stopping_asked(void);

// Ends the program by that signal, SIGINT where none came, so that shells and scripts see what it
// was. Returns an exit status where even that fails.
int stopping_die(void);

#endif
