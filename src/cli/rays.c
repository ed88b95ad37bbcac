// rays.c - a list of rays
#include "rays.h"

#include "cli.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 1 << 26 };

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

static relume_status read_line(struct relume_buffer *list, char *line, int number, const char *name,
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
    const struct relume_ray ray = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    if (list->size == MOST * sizeof ray)
        return say(log, RELUME_EFORMAT, "%s: line %d: expected at most %d rays", name, number,
                   MOST);
    const struct relume_writer to = relume_buffer_writer(list);
    return to.write(list, &ray, sizeof ray, list->size) ? RELUME_OK : RELUME_ENOMEM;
}

relume_status rays_read(struct relume_ray **out, int *count, const char *path,
                        const struct relume_log *log)
{
    struct relume_buffer list = {0};
    char *line = NULL;
    size_t capacity = 0;
    relume_status status = RELUME_OK;
    const bool stream = !strcmp(path, "-");
    const char *const name = stream ? "stdin" : path;
    FILE *file = stream ? stdin : fopen(path, "re");
    *out = NULL;
    if (!file)
        return relume_input_fail(log, name, "cannot be read", errno);
    errno = 0;
    for (int number = 1; !status && getline(&line, &capacity, file) >= 0; number++)
        status = read_line(&list, line, number, name, log);
    if (!status && ferror(file))
        status = relume_input_fail(log, name, "cannot be read", errno);
    if (!status && !list.size)
        status = say(log, RELUME_EFORMAT, "%s: holds no rays; expected six numbers per line", name);
    if (!stream)
        (void)fclose(file);
    free(line);
    if (status) {
        relume_buffer_destroy(&list);
        return status;
    }
    *out = (struct relume_ray *)(void *)list.data;
    *count = (int)(list.size / sizeof **out);
    return RELUME_OK;
}
