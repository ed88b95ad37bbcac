// log.c - sentences for people on their way to the callbacks of the caller
#include "core/base/log.h"

#include "core/base/called.h"

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

relume_status log_wrong(const struct relume_log *log, const char *path, const char *what,
                        const char *expected)
{
    return log_fail(log, RELUME_EFORMAT, "%s%s%s; expected %s", path ? path : "", path ? ": " : "",
                    what, expected);
}

bool log_progress(const struct relume_log *log, const char *what, double done)
{
    return !log || !log->progress || log->progress(log->user, what, done);
}

static void say_place(void *user, enum relume_level level, const char *text)
{
    const struct log_place *p = user;
    log_line(p->to, level, "%s%s", p->place, text);
}

static bool go_on(void *user, const char *what, double done)
{
    const struct log_place *p = user;
    return log_progress(p->to, what, done);
}

const struct relume_log *log_at(struct log_place *out, const struct relume_log *to,
                                const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(out->place, sizeof out->place, format, args);
    va_end(args);
    out->to = to;
    out->log = to ? *to : (struct relume_log){0};
    out->log.message = say_place;
    out->log.progress = go_on;
    out->log.user = out;
    return &out->log;
}

int relume_version(void)
{
    return RELUME_VERSION_NUMBER;
}

// What the three functions below say of a status.
static const struct {
    const char *name, *text;
    int exit;
} statuses[] = {
    [RELUME_OK] = {"ok", "no error", 0},
    [RELUME_ENOTFOUND] = {"not-found", "input not found or not readable", 1},
    [RELUME_EFORMAT] = {"format", "input of another format than expected", 1},
    [RELUME_EDAMAGED] = {"damaged", "damaged input", 1},
    [RELUME_ELIMIT] = {"limit", "input over the limits", 1},
    [RELUME_EUNSUPPORTED] = {"unsupported", "input of a kind that is not supported", 1},
    [RELUME_EUNFIT] = {"unfit", "input that cannot be used here", 1},
    [RELUME_EINVAL] = {"usage", "invalid argument", 2},
    [RELUME_ENOMEM] = {"memory", "out of memory", 3},
    [RELUME_EIO] = {"output", "output cannot be written", 3},
    [RELUME_ESYSTEM] = {"system", "the machine lacks something that is needed", 3},
    [RELUME_ECANCEL] = {"cancelled", "stopped on request", 130},
    [RELUME_ECODER] = {"coder", "the process that codes lossy planes has ended", 3},
};

static bool is_known(relume_status status)
{
    return (unsigned)status < sizeof statuses / sizeof *statuses;
}

const char *relume_status_text(relume_status status)
{
    return is_known(status) ? statuses[status].text : "unknown status";
}

const char *relume_status_name(relume_status status)
{
    return is_known(status) ? statuses[status].name : "unknown";
}

int relume_status_exit(relume_status status)
{
    return is_known(status) ? statuses[status].exit : 3;
}
