// log.c - sentences for people on their way to the callbacks of the caller
#include "base/log.h"

#include "base/called.h"

#include <stdarg.h>
#include <stdio.h>

enum { LINE = 2048 };

static void say(const struct relume_log *log, enum relume_level level, const char *format,
                va_list args)
{
    if (!log || !log->message)
        return;
    char text[LINE];
    vsnprintf(text, sizeof text, format, args);
    called_rename(text, sizeof text);
    log->message(log->user, level, relume_printable(text));
}

void log_line(const struct relume_log *log, enum relume_level level, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    say(log, level, format, args);
    va_end(args);
}

relume_status log_fail(const struct relume_log *log, relume_status status, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    say(log, RELUME_ERROR, format, args);
    va_end(args);
    return status;
}

bool log_progress(const struct relume_log *log, const char *what, double done)
{
    return !log || !log->progress || log->progress(log->user, what, done);
}

int relume_version(void)
{
    return RELUME_VERSION_NUMBER;
}

const char *relume_status_text(relume_status status)
{
    switch (status) {
    case RELUME_OK: return "no error";
    case RELUME_EINVAL: return "invalid argument";
    case RELUME_EDATA: return "unusable input";
    case RELUME_ENOMEM: return "out of memory";
    case RELUME_EIO: return "output cannot be written";
    case RELUME_ESYSTEM: return "the machine lacks something that is needed";
    case RELUME_ECANCEL: return "stopped on request";
    }
    return "unknown status";
}
