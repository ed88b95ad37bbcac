// rays.c - a list of rays
#include "rays.h"

#include "cli.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 1 << 26 };

struct list {
    struct relume_ray *ray;
    int count, room;
};

__attribute__((format(printf, 3, 4))) static relume_status fail(const struct relume_log *log,
                                                                const char *path,
                                                                const char *format, ...)
{
    char text[400];
    va_list arguments;
    const int n = snprintf(text, sizeof text, "%.200s: ", strcmp(path, "-") ? path : "stdin");
    va_start(arguments, format);
    vsnprintf(text + n, sizeof text - (size_t)n, format, arguments);
    va_end(arguments);
    log->message(log->user, RELUME_ERROR, text);
    return RELUME_EFORMAT;
}

static bool add(struct list *list, const double v[6])
{
    if (list->count == list->room) {
        const int room = list->room ? 2 * list->room : 64;
        struct relume_ray *more = realloc(list->ray, (size_t)room * sizeof *more);
        if (!more)
            return false;
        list->ray = more;
        list->room = room;
    }
    list->ray[list->count++] = (struct relume_ray){{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    return true;
}

// The numbers of a line, -1 where there is something else.
static int numbers_of(double v[6], const char *text)
{
    int n = 0;
    for (;; n++) {
        char *end;
        text += strspn(text, " \t,\r\n");
        if (!*text || n == 6)
            return *text ? -1 : n;
        v[n] = strtod(text, &end);
        if (end == text || !isfinite(v[n]))
            return -1;
        text = end;
    }
}

static relume_status read_line(struct list *list, char *line, int number, const char *path,
                               const struct relume_log *log)
{
    double v[6];
    line[strcspn(line, "#\r\n")] = '\0';
    const int n = numbers_of(v, line);
    if (n == 0)
        return RELUME_OK;
    if (n != 6)
        return fail(log, path,
                    "line %d: expected six numbers, x y z of the eye and of the direction; found "
                    "'%.60s'",
                    number, line);
    if (v[3] == 0.0 && v[4] == 0.0 && v[5] == 0.0)
        return fail(log, path, "line %d: the direction is 0 0 0; expected where the ray goes",
                    number);
    if (list->count == MOST)
        return fail(log, path, "line %d: expected at most %d rays", number, MOST);
    return add(list, v) ? RELUME_OK : RELUME_ENOMEM;
}

relume_status rays_read(struct relume_ray **out, int *count, const char *path,
                        const struct relume_log *log)
{
    struct list list = {0};
    char *line = NULL;
    size_t room = 0;
    relume_status status = RELUME_OK;
    const bool stream = !strcmp(path, "-");
    FILE *file = stream ? stdin : fopen(path, "re");
    *out = NULL;
    if (!file)
        return relume_input_fail(log, stream ? "stdin" : path, "cannot be read", errno);
    errno = 0;
    for (int number = 1; !status && getline(&line, &room, file) >= 0; number++)
        status = read_line(&list, line, number, path, log);
    if (!status && ferror(file))
        status = relume_input_fail(log, stream ? "stdin" : path, "cannot be read", errno);
    if (!status && !list.count)
        status = fail(log, path, "holds no rays; expected six numbers per line");
    if (!stream)
        (void)fclose(file);
    free(line);
    if (status) {
        free(list.ray);
        return status;
    }
    *out = list.ray;
    *count = list.count;
    return RELUME_OK;
}
