// say.h - sentences for people; the library's own helper is private to it
#ifndef VIEWER_SAY_H
#define VIEWER_SAY_H

#include <relume/base.h>

// Sends one line to `log` (NULL is silent) and hands `status` back.
__attribute__((format(printf, 3, 4))) relume_status say(const struct relume_log *log,
                                                        relume_status status, const char *format,
                                                        ...);

#endif
