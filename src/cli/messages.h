// messages.h - sentences and progress for people
#ifndef CLI_MESSAGES_H
#define CLI_MESSAGES_H

#include "cli.h"

extern FILE *people;  // standard error
extern volatile bool bar_drawn;

// Of a log whose user is a struct args.
void on_message(void *user, enum relume_level level, const char *text);
bool on_progress(void *user, const char *what, double done);
void clear_bar(void);

#endif
