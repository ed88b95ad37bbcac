// rays.c - a list of rays
#include "rays.h"

#include "cli.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 1 << 26 };

struct list {
    struct relume_ray *ray;
    int count, room;
};

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

static relume_status read_line(struct list *list, char *line, int number, const char *name,
                               const struct relume_log *log)
{
    double v[6];
    line[strcspn(line, "#\r\n")] = '\0';
    const int n = numbers_of(v, line);
    if (n == 0)
        return RELUME_OK;
    if (n != 6)
        return say(log, RELUME_EFORMAT,
                   "%s: line %d: expected six numbers, x y z of the eye and of the direction; "
                   "found '%.60s'",
                   name, number, line);
    if (v[3] == 0.0 && v[4] == 0.0 && v[5] == 0.0)
        return say(log, RELUME_EFORMAT,
                   "%s: line %d: the direction is 0 0 0; expected where the ray goes", name,
                   number);
    if (list->count == MOST)
        return say(log, RELUME_EFORMAT, "%s: line %d: expected at most %d rays", name, number,
                   MOST);
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
    const char *const name = stream ? "stdin" : path;
    FILE *file = stream ? stdin : fopen(path, "re");
    *out = NULL;
    if (!file)
        return relume_input_fail(log, name, "cannot be read", errno);
    errno = 0;
    for (int number = 1; !status && getline(&line, &room, file) >= 0; number++)
        status = read_line(&list, line, number, name, log);
    if (!status && ferror(file))
        status = relume_input_fail(log, name, "cannot be read", errno);
    if (!status && !list.count)
        status = say(log, RELUME_EFORMAT, "%s: holds no rays; expected six numbers per line", name);
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
