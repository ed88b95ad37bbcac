// lights_read.c - lights from whatever file holds some
#include "capture/manifest/manifest.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/picture_kind.h"

#include <errno.h>
#include <relume/image/directions.h>
#include <stdio.h>
#include <string.h>

enum kind { KIND_LINES, KIND_LP, KIND_JSON };

// The first line that says something, without blanks and comments before it; "" at the end.
static const char *next_line(char line[256], FILE *file)
{
    while (fgets(line, 256, file)) {
        const char *start = line + strspn(line, " \t\r\n\xef\xbb\xbf");
        if (*start && *start != '#')
            return start;
    }
    return "";
}

static bool is_count(const char *line)
{
    double number;
    char rest;
    return sscanf(line, " %lf %c", &number, &rest) == 1;
}

// JSON starts with a brace, a .lp file with a lone count before lines that start with names.
static relume_status look(enum kind *kind, const char *path, const struct relume_log *log)
{
    FILE *file = input_open(path, log);
    if (!file)
        return relume_input_fail(log, path, "cannot be opened", errno);
    char line[256];
    double v[3];
    const char *start = next_line(line, file);
    const bool some = *start;
    *kind = *start == '{' || *start == '[' ? KIND_JSON : KIND_LINES;
    if (is_count(start)) {
        start = next_line(line, file);
        if (sscanf(start, "%lf%*[ \t,]%lf%*[ \t,]%lf", &v[0], &v[1], &v[2]) != 3)
            *kind = KIND_LP;
    }
    fclose(file);
    if (!some)
        return log_fail(log, RELUME_EFORMAT, "%s: no light directions; expected lines x y z", path);
    return RELUME_OK;
}

// The lights' names, where all have one; false without memory.
static bool list_names(struct relume_captured_lights *out, const jvalue *list)
{
    const size_t n = jvalue_count(list);
    for (size_t i = 0; i < n; i++)
        if (!jvalue_text(jvalue_member(jvalue_item(list, i), "name")))
            return true;
    out->name = mem_zeroed(n, sizeof *out->name);
    for (size_t i = 0; out->name && i < n; i++)
        if (!(out->name[i] = mem_text(jvalue_text(jvalue_member(jvalue_item(list, i), "name")))))
            return false;
    return out->name != NULL;
}

// [[x, y, z], ...], or objects that have such a "direction", "dir" or "position".
static relume_status list_lights(struct relume_captured_lights *out, const jvalue *list,
                                 const char *path, const struct relume_log *log)
{
    static const char *const keys[] = {"direction", "dir", "position"};
    const size_t n = jvalue_count(list);
    if (n < 1 || n > (size_t)limits_or_default(NULL).max_lights)
        return log_fail(log, RELUME_EFORMAT, "%s: no light directions; expected [x, y, z] for each",
                        path);
    out->direction = mem_array(n, sizeof *out->direction);
    if (!out->direction)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        const jvalue *item = jvalue_item(list, i), *vector = item;
        double v[3] = {0.0, 0.0, 0.0};
        for (size_t k = 0; jvalue_is_object(item) && k < sizeof keys / sizeof *keys; k++)
            vector = jvalue_is_array(vector) ? vector : jvalue_member(item, keys[k]);
        const bool good = jvalue_numbers(vector, v, 3);
        out->direction[i] = (struct relume_vec3){v[0], v[1], v[2]};
        if (!good || !direction_normalise(&out->direction[i]))
            return log_fail(log, RELUME_EFORMAT,
                            "%s: light %zu; expected three numbers x y z, not all 0", path, i);
    }
    out->count = (int)n;
    return list_names(out, list) ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status from_json(struct relume_captured_lights *out, const char *path,
                               const struct relume_log *log)
{
    jvalue *root;
    relume_status status = jvalue_load(&root, path, log);
    const jvalue *lights = jvalue_member(root, "lights");
    const jvalue *list = jvalue_is_array(root) ? root : jvalue_is_array(lights) ? lights : NULL;
    if (!status && list)
        status = list_lights(out, list, path, log);
    else if (!status)
        status = (is_dome(root) ? dome_lights : manifest_lights)(out, root, path, log);
    jvalue_free(&root);
    return status;
}

static relume_status from_lp(struct relume_captured_lights *out, const char *path,
                             const struct relume_log *log)
{
    struct draft draft = {0};
    relume_status status = lp_read(&draft, path, NULL, log);
    if (!status) {
        const size_t n = (size_t)draft.m.lights;
        out->count = draft.m.lights;
        out->direction = mem_copy(draft.directions, n, sizeof *out->direction);
        out->position = mem_copy(draft.positions, n, sizeof *out->position);
        status = out->direction && out->position ? RELUME_OK : RELUME_ENOMEM;
    }
    draft_free(&draft);
    return status;
}

enum { NAME = 256 };

// 1: a vector, perhaps behind a name; 0: a blank line or a comment; -1: neither.
static int parse_line(char *line, struct relume_vec3 *v, char name[NAME])
{
    char rest;
    *name = '\0';
    line[strcspn(line, "#\r\n")] = '\0';
    if (!line[strspn(line, " \t")])
        return 0;
    if (sscanf(line, "%lf%*[ \t,]%lf%*[ \t,]%lf %c", &v->x, &v->y, &v->z, &rest) == 3)
        return 1;
    return sscanf(line, "%255s %lf%*[ \t,]%lf%*[ \t,]%lf %c", name, &v->x, &v->y, &v->z, &rest) ==
                       4 &&
                   !is_count(name)
               ? 1
               : -1;
}

// A line of a table, "light0001,0.1,0.2,0.9,..." or without the name; the same of its numbers.
static int parse_row(const char *line, struct relume_vec3 *v, char name[NAME])
{
    double first;
    const char *comma = strchr(line, ',');
    *name = '\0';
    if (!line[strspn(line, " \t\r\n")])
        return 0;
    if (sscanf(line, "%lf , %lf , %lf", &v->x, &v->y, &v->z) == 3)
        return 1;
    snprintf(name, NAME, "%.*s", comma ? (int)(comma - line) : 0, line);
    return comma && sscanf(line, "%lf ,", &first) != 1 &&
                   sscanf(comma + 1, "%lf , %lf , %lf", &v->x, &v->y, &v->z) == 3
               ? 1
               : -1;
}

// Names count where all lights have one.
static void keep_names(struct relume_captured_lights *out)
{
    int named = 0;
    while (named < out->count && out->name[named])
        named++;
    for (int i = 0; named < out->count && i < out->count; i++)
        mem_free(out->name[i]);
    if (named < out->count) {
        mem_free(out->name);
        out->name = NULL;
    }
}

static relume_status read_lines(struct relume_captured_lights *out, FILE *file, const char *path,
                                const struct relume_log *log)
{
    const int most = limits_or_default(NULL).max_lights;
    char line[512], name[NAME];
    double stated = 0.0;
    bool first = true;
    const bool table = picture_has_extension(path, ".csv");
    out->direction = mem_array((size_t)most, sizeof *out->direction);
    out->position = mem_array((size_t)most, sizeof *out->position);
    out->name = mem_zeroed((size_t)most, sizeof *out->name);
    if (!out->direction || !out->position || !out->name)
        return RELUME_ENOMEM;
    for (int number = 1; fgets(line, sizeof line, file); number++) {
        struct relume_vec3 v;
        const bool count = first && is_count(line);
        if (count)
            stated = atof(line);
        int found = count ? 0 : table ? parse_row(line, &v, name) : parse_line(line, &v, name);
        if (found < 0 && table && first)  // what the columns are called
            found = 0, first = false;
        first &= !count && !found;
        if (!found)
            continue;
        struct relume_vec3 unit = v;
        if (found < 0 || !direction_normalise(&unit))
            return log_fail(log, RELUME_EFORMAT,
                            "%s: line %d; expected three numbers x y z, not all 0; found '%.40s'",
                            path, number, line);
        if (out->count == most)
            return log_fail(log, RELUME_ELIMIT, "%s: too many lights; expected at most %d", path,
                            most);
        if (*name && !(out->name[out->count] = mem_text(name)))
            return RELUME_ENOMEM;
        out->direction[out->count] = unit;
        out->position[out->count++] = v;
    }
    keep_names(out);
    if (stated > 0.0 && out->count && stated != out->count)
        log_line(log, RELUME_WARNING,
                 "%s: its first line promises %g lights; found %d, which are used", path, stated,
                 out->count);
    return out->count ? RELUME_OK
                      : log_fail(log, RELUME_EFORMAT,
                                 "%s: no light directions; expected lines x y z", path);
}

static relume_status from_lines(struct relume_captured_lights *out, const char *path,
                                const struct relume_log *log)
{
    FILE *file = input_open(path, log);
    if (!file)
        return relume_input_fail(log, path, "cannot be opened", errno);
    const relume_status status = read_lines(out, file, path, log);
    fclose(file);
    return status;
}

void relume_captured_lights_destroy(struct relume_captured_lights *list)
{
    mem_free(list->direction);
    mem_free(list->position);
    mem_free(list->intensity);
    for (int i = 0; list->name && i < list->count; i++)
        mem_free(list->name[i]);
    mem_free(list->name);
    *list = (struct relume_captured_lights){0};
}

relume_status relume_captured_lights_load(struct relume_captured_lights *out, const char *path,
                                          bool positions, const struct relume_log *log)
{
    static relume_status (*const read[])(struct relume_captured_lights *, const char *,
                                         const struct relume_log *) = {
        [KIND_LINES] = from_lines,
        [KIND_LP] = from_lp,
        [KIND_JSON] = from_json,
    };
    *out = (struct relume_captured_lights){0};
    enum kind kind;
    relume_status status = look(&kind, path, log);
    if (!status)
        status = read[kind](out, path, log);
    if (!status && kind != KIND_JSON && !positions) {
        mem_free(out->position);
        out->position = NULL;
    }
    if (!status && positions && !out->position)
        status = log_fail(log, RELUME_EUNFIT,
                          "%s: holds directions only; expected positions of near lights", path);
    if (status)
        relume_captured_lights_destroy(out);
    return status;
}

relume_status relume_captured_lights_read(struct relume_vec3 **out, int *n, const char *path,
                                          const struct relume_log *log)
{
    struct relume_captured_lights list;
    const relume_status status = relume_captured_lights_load(&list, path, false, log);
    *out = list.direction;
    *n = list.count;
    list.direction = NULL;
    relume_captured_lights_destroy(&list);
    return status;
}
