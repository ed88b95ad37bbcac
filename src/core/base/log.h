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
// "PATH: WHAT; expected EXPECTED" of a file at fault: RELUME_EFORMAT. Without a path "WHAT;
// expected EXPECTED", to a log that names the file.
relume_status log_wrong(const struct relume_log *log, const char *path, const char *what,
                        const char *expected);
// False when the caller asked to stop.
bool log_progress(const struct relume_log *log, const char *what, double done);

// A log that is `to`, but for its sentences, which begin with a place, as "FILE: region 3: ".
struct log_place {
    struct relume_log log;
    const struct relume_log *to;
    char place[2048];  // as long as a line may be
};
// In `out`, which must live as long as what it returns.
__attribute__((format(printf, 3, 4))) const struct relume_log *log_at(struct log_place *out,
                                                                      const struct relume_log *to,
                                                                      const char *format, ...);

#endif
