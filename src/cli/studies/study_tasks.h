// study_tasks.h - the tasks of `relume study` that make things
#ifndef STUDIES_STUDY_TASKS_H
#define STUDIES_STUDY_TASKS_H

#include "cli/cli.h"

extern const struct command study_task_make, study_task_run;

#endif
