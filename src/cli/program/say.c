// say.c - a sentence for people
#include "cli/program/say.h"

#include <stdarg.h>
#include <stdio.h>

relume_status say(const struct relume_log *log, relume_status status, const char *format, ...)
{
    char text[4400];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (log && log->message)
        log->message(log->user, RELUME_ERROR, text);
    return status;
}
