// acquire_warn.c - warnings: kept for the report, and said once where many photographs share them
#include "capture/acquire/acquire.h"

#include "core/base/log.h"
#include "core/base/memory.h"

#include <stdarg.h>
#include <stdio.h>

static relume_status keep(struct acquisition *s, const char *text)
{
    struct relume_acquisition *out = s->out;
    if (!mem_grow(&out->warning, (size_t)out->warnings, sizeof *out->warning))
        return RELUME_ENOMEM;
    out->warning[out->warnings] = mem_text(text);
    return out->warning[out->warnings++] ? RELUME_OK : RELUME_ENOMEM;
}

relume_status acquire_warn(struct acquisition *s, const char *format, ...)
{
    char text[1024];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    log_line(s->p.log, RELUME_WARNING, "%s", text);
    return keep(s, text);
}

relume_status acquire_warn_alike(struct acquisition *s, enum acquire_alike kind, double how_bad,
                                 const char *format, ...)
{
    char text[1024];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    struct alike *a = &s->alike[kind];
    const int at = s->out->warnings;
    if (a->count < SHOOT_FEW)
        a->first[a->count] = at;
    if (!a->count || how_bad > a->how_bad) {
        a->how_bad = how_bad;
        a->worst = at;
    }
    a->count++;
    return keep(s, text);
}

void acquire_say_alike(struct acquisition *s)
{
    for (int kind = 0; kind < ALIKE_KINDS; kind++) {
        struct alike *a = &s->alike[kind];
        for (int i = 0; i < a->count && a->count <= SHOOT_FEW; i++)
            log_line(s->p.log, RELUME_WARNING, "%s", s->out->warning[a->first[i]]);
        if (a->count > SHOOT_FEW)
            log_line(s->p.log, RELUME_WARNING, "%s (the worst of %d photographs like it%s)",
                     s->out->warning[a->worst], a->count, s->dir ? "; report.html names all" : "");
        *a = (struct alike){0};
    }
}
