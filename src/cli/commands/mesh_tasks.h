// mesh_tasks.h - the tasks of `relume mesh` that have files of their own
#ifndef COMMANDS_MESH_TASKS_H
#define COMMANDS_MESH_TASKS_H

#include "cli.h"

extern const struct command mesh_task_simplify;

#endif
