// log.h - sentences for people, sent through the caller's callbacks
#ifndef BASE_LOG_H
#define BASE_LOG_H

#include <relume/base.h>

// All three do nothing when `log` or its callback is NULL.
__attribute__((format(printf, 3, 4))) void log_line(const struct relume_log *log,
                                                    enum relume_level level, const char *format,
                                                    ...);
// Says why and hands the status back: `return log_fail(log, RELUME_EFORMAT, "%s: ...", path)`.
__attribute__((format(printf, 3, 4))) relume_status log_fail(const struct relume_log *log,
                                                             relume_status status,
                                                             const char *format, ...);
// False when the caller asked to stop.
bool log_progress(const struct relume_log *log, const char *what, double done);

#endif
