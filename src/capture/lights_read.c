// lights_read.c - light directions from whatever file holds some
#include "base/log.h"
#include "base/memory.h"
#include "capture/manifest.h"

#include <errno.h>
#include <relume/lights.h>
#include <stdio.h>
#include <string.h>

enum kind { KIND_LINES, KIND_LP, KIND_JSON };

// JSON starts with a brace, a .lp file with a lone count.
static enum kind kind_of(const char *line)
{
    double number;
    char rest;
    if (line[strspn(line, " \t\r\n\xef\xbb\xbf")] == '{')
        return KIND_JSON;
    const bool count = sscanf(line, " %lf %c", &number, &rest) == 1;
    return count ? KIND_LP : KIND_LINES;
}

static relume_status look(enum kind *kind, const char *path, const struct relume_log *log)
{
    FILE *file = fopen(path, "r");
    if (!file)
        return log_fail(log, RELUME_EDATA, "%s: cannot be opened; %s", path, strerror(errno));
    char line[256] = "";
    const char *start = line;
    do {
        if (!fgets(line, sizeof line, file))
            break;
        start = line + strspn(line, " \t\r\n");
    } while (!*start);
    fclose(file);
    *kind = kind_of(line);
    if (!*start)
        return log_fail(log, RELUME_EDATA, "%s: no light directions; expected lines x y z", path);
    return RELUME_OK;
}

static relume_status from_lp(struct relume_vec3 **out, int *n, const char *path,
                             const struct relume_log *log)
{
    struct draft draft = {0};
    relume_status status = lp_read(&draft, path, NULL, log);
    if (!status) {
        *n = draft.m.lights;
        *out = mem_copy(draft.directions, (size_t)*n, sizeof **out);
        status = *out ? RELUME_OK : RELUME_ENOMEM;
    }
    draft_free(&draft);
    return status;
}

// 1: a direction; 0: a blank line or a comment; -1: neither.
static int parse_line(char *line, struct relume_vec3 *v)
{
    line[strcspn(line, "#\r\n")] = '\0';
    char rest;
    if (!line[strspn(line, " \t")])
        return 0;
    const int found = sscanf(line, "%lf%*[ \t,]%lf%*[ \t,]%lf %c", &v->x, &v->y, &v->z, &rest);
    return found == 3 && direction_normalise(v) ? 1 : -1;
}

static relume_status read_lines(struct relume_vec3 **out, int *n, FILE *file, const char *path,
                                const struct relume_log *log)
{
    const int most = limits_or_default(NULL).max_lights;
    struct relume_vec3 *v = mem_array((size_t)most, sizeof *v);
    if (!v)
        return RELUME_ENOMEM;
    relume_status status = RELUME_OK;
    char line[512];
    for (int number = 1; !status && fgets(line, sizeof line, file); number++) {
        struct relume_vec3 one;
        const int found = parse_line(line, &one);
        if (found < 0)
            status = log_fail(log, RELUME_EDATA,
                              "%s: line %d; expected three numbers x y z, not "
                              "all 0; found '%.40s'",
                              path, number, line);
        else if (found && *n == most)
            status =
                log_fail(log, RELUME_EDATA, "%s: too many lights; expected at most %d", path, most);
        else if (found)
            v[(*n)++] = one;
    }
    if (!status && !*n)
        status = log_fail(log, RELUME_EDATA, "%s: no light directions; expected lines x y z", path);
    if (status) {
        free(v);
        return status;
    }
    *out = v;
    return RELUME_OK;
}

static relume_status from_lines(struct relume_vec3 **out, int *n, const char *path,
                                const struct relume_log *log)
{
    FILE *file = fopen(path, "r");
    if (!file)
        return log_fail(log, RELUME_EDATA, "%s: cannot be opened; %s", path, strerror(errno));
    const relume_status status = read_lines(out, n, file, path, log);
    fclose(file);
    return status;
}

relume_status relume_lights_read(struct relume_vec3 **out, int *n, const char *path,
                                 const struct relume_log *log)
{
    *out = NULL;
    *n = 0;
    enum kind kind;
    relume_status status = look(&kind, path, log);
    if (!status && kind == KIND_JSON)
        status = manifest_directions(path, out, n, log);
    else if (!status && kind == KIND_LP)
        status = from_lp(out, n, path, log);
    else if (!status)
        status = from_lines(out, n, path, log);
    if (status)
        *n = 0;
    return status;
}
