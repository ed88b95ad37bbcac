// maps_edit.h - the task of `relume maps` that has a file of its own
#ifndef CLI_MAPS_EDIT_H
#define CLI_MAPS_EDIT_H

#include "cli/cli.h"

extern const struct command maps_task_edit;

#endif
