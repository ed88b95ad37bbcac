// say.h - a sentence for people
#ifndef PROGRAM_SAY_H
#define PROGRAM_SAY_H

#include <relume/base.h>

// Sends one line to `log` as an error (NULL is silent) and hands `status` back.
__attribute__((format(printf, 3, 4))) relume_status say(const struct relume_log *log,
                                                        relume_status status, const char *format,
                                                        ...);

#endif
