// start.h - the tool as a function, of the programs relume and relume-mpi
#ifndef CLI_START_H
#define CLI_START_H

#include "cli.h"

// A whole command line. `team` and `threads` are those of struct args.
relume_status tool_run(int argc, char **argv, const struct relume_team *team, int threads);
// What the program ends with; of memory that is short and of an interruption a sentence is said.
int tool_exit(relume_status status);

#endif
