// messages.c - sentences and progress for people
#include "messages.h"

#include "cli/program/clock.h"
#include "cli/program/stopping.h"

#include <stdarg.h>
#include <string.h>
#include <unistd.h>

FILE *people;
volatile bool bar_drawn;

void clear_bar(void)
{
    if (bar_drawn)
        fputs("\r\033[K", people);
    bar_drawn = false;
}

// One line, whatever bytes file names hold.
static void print_line(const char *prefix, const char *text)
{
    struct shown line;
    clear_bar();
    fprintf(people, "relume: %s%s\n", prefix, shown(&line, text));
}

void on_message(void *user, enum relume_level level, const char *text)
{
    const struct args *args = user;
    if (level != RELUME_NOTE || !args || !args->quiet)
        print_line(level == RELUME_WARNING ? "warning: " : "", text);
}

static void on_prefixed(void *user, enum relume_level level, const char *text)
{
    const struct prefix_log *p = user;
    char line[2048];
    snprintf(line, sizeof line, "%s: %s", p->prefix, text);
    p->to->message(p->to->user, level, line);
}

static bool on_prefixed_progress(void *user, const char *what, double done)
{
    const struct prefix_log *p = user;
    return p->to->progress(p->to->user, what, done);
}

const struct relume_log *prefix_log(struct prefix_log *p, const struct relume_log *to,
                                    const char *prefix)
{
    *p =
        (struct prefix_log){{on_prefixed, on_prefixed_progress, p, to->context, false}, to, prefix};
    return &p->log;
}

static void draw_bar(const char *what, double done)
{
    enum { CELLS = 30 };
    static double start, last;
    static const char *task;
    const double now = now_s();
    if (what != task) {
        task = what;
        start = now;
    } else if (now - last < 0.1 && done < 1.0) {
        return;
    }
    last = now;
    char bar[CELLS + 1];
    for (int i = 0; i < CELLS; i++)
        bar[i] = i < done * CELLS ? '#' : '.';
    bar[CELLS] = '\0';
    const double left = done > 0.0 ? (now - start) * (1.0 - done) / done : 0.0;
    fprintf(people, "\r\033[K%-12s [%s] %3.0f %%", what, bar, 100.0 * done);
    if (done > 0.0 && done < 1.0)
        fprintf(people, "  %.0f s left", left);
    fflush(people);
    bar_drawn = true;
    if (done >= 1.0)
        clear_bar();
}

bool on_progress(void *user, const char *what, double done)
{
    const struct args *args = user;
    if (!args->quiet && isatty(STDERR_FILENO))
        draw_bar(what, done);
    return !stopping_asked();
}

void announce(const struct args *args, enum relume_level level, const char *format, ...)
{
    char text[2048];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    args->log->message(args->log->user, level, text);
}

relume_status refuse(relume_status status, const char *format, ...)
{
    char text[2048];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    print_line("", text);
    return status;
}
