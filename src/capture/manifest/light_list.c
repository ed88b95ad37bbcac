// light_list.c - lists of lights that are texts, one reader for all of them
#include "capture/manifest/light_list.h"

#include "capture/manifest/light_columns.h"
#include "capture/manifest/light_layout.h"
#include "capture/manifest/light_text.h"
#include "capture/manifest/manifest.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/tree.h"
#include "core/math/vec.h"

#include <stdio.h>
#include <string.h>

enum { SHOWN = 40 };

struct reading {
    struct light_list *list;
    const char *path;
    const struct relume_log *log;
    struct light_line first;       // before the first line of lights
    struct light_columns columns;  // where a line names them
    struct light_layout layout;    // else
    long stated;                   // number of lights that the file states, 0: none
    int unnamed, named;            // lines without and with a name, 0: none
    bool numbers;                  // all names are numbers
    struct light_row row;          // of the current line
};

static relume_status refuse(const struct reading *r, const struct light_line *line,
                            const char *expected)
{
    const ptrdiff_t n = line->end - line->start;
    return log_fail(r->log, RELUME_EFORMAT, "%s: line %d; expected %s, found '%.*s'", r->path,
                    line->number, expected, (int)(n < SHOWN ? n : SHOWN), line->start);
}

// ---------------------------------------------------------------- before the lights

// The line is the number of lights and nothing else.
static bool is_count(const struct light_line *line, long *out)
{
    struct light_row row;
    light_row_split(&row, line, false);
    const bool one =
        row.count == 1 && row.numbers == 1 && row.word[0].value >= 1.0 && row.word[0].value < 1e9;
    *out = one ? (long)row.word[0].value : 0;
    return one && (double)*out == row.word[0].value;
}

// Lines of a table's titles that are in no known language.
static bool is_foreign_title(const struct reading *r, const struct light_line *line)
{
    struct light_row row;
    light_row_split(&row, line, true);
    return path_ends(r->path, ".csv") && !row.numbers;
}

// Moves `first` behind the count, titles and the comments before them.
static relume_status read_preamble(struct reading *r)
{
    struct light_line line = r->first;
    while (!r->columns.found && light_line_next(&line)) {
        const bool comment = light_line_comment(&line, NULL);
        if (!comment && !r->stated && is_count(&line, &r->stated)) {
            r->first = line;
            continue;
        }
        const relume_status status = light_columns_find(&r->columns, &line, r->path, r->log);
        if (status)
            return status;
        if (comment || r->columns.found || is_foreign_title(r, &line))
            r->first = line;
        if (!comment)
            break;
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- one line

// The text from word `from` up to word `to`, without quotation marks around one word.
static const char *join_words(struct reading *r, int from, int to)
{
    const struct light_word *a = &r->row.word[from], *b = &r->row.word[to - 1];
    return arena_format(&r->list->arena, "%.*s", (int)(b->text + b->length - a->text), a->text);
}

// The name before word `x`: all of it, or where a comma, semicolon or tab separates it from x the
// last field that is no number.
static void find_name(const struct light_row *row, int x, int *from, int *to)
{
    const char separator = x ? row->word[x - 1].after : ' ';
    *from = 0;
    *to = x;
    if (separator == ' ')
        return;
    for (int end = x, i = x - 1; i >= 0; i--) {
        if (i && row->word[i - 1].after != separator)
            continue;
        bool numbers = true;
        for (int k = i; k < end; k++)
            numbers &= row->word[k].number;
        if (!numbers || end == x) {
            *from = i;
            *to = end;
        }
        if (!numbers)
            return;
        end = i;
    }
}

static bool is_index(const char *name)
{
    return *name && strspn(name, "0123456789") == strlen(name);
}

static relume_status add_light(struct reading *r, const struct light_line *line, vec3 v, int from,
                               int to)
{
    struct light_list *list = r->list;
    const int n = list->count;
    list->vector[n] = list->direction[n] = v;
    list->line[n] = line->number;
    if (!direction_normalise(&list->direction[n]))
        return refuse(r, line, "a light direction, not zero and of finite numbers");
    *(from < to ? &r->named : &r->unnamed) = line->number;
    r->numbers &= from >= to || (to == from + 1 && r->row.word[from].number);
    list->name[n] = from < to ? join_words(r, from, to) : "";
    list->count++;
    return list->name[n] ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status read_voted(struct reading *r, const struct light_line *line)
{
    int from, to;
    light_row_split(&r->row, line, r->layout.commas);
    const int x = light_layout_at(&r->layout, &r->row);
    if (x < 0)
        return refuse(r, line,
                      r->first.number || r->list->count
                          ? "'name x y z' or 'x y z'"
                          : "the number of lights, 'name x y z' or 'x y z'");
    const struct light_word *w = &r->row.word[x];
    find_name(&r->row, x, &from, &to);
    return add_light(r, line, vec3_of(w[0].value, w[1].value, w[2].value), from, to);
}

static vec3 from_angles(const struct light_columns *c, double first, double azimuth)
{
    const double theta = (c->elevation ? 90.0 - first : first) * M_PI / 180.0;
    const double phi = azimuth * M_PI / 180.0;
    return vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

// Where blanks separate columns, words beyond these belong to the name, which may lack a title.
static relume_status read_titled(struct reading *r, const struct light_line *line)
{
    const struct light_columns *c = &r->columns;
    double v[3] = {0.0, 0.0, 0.0};
    if (c->delimiter == ' ')
        light_row_split(&r->row, line, false);
    else
        light_row_fields(&r->row, line, c->delimiter);
    while (r->row.count > c->count && c->delimiter != ' ' && !r->row.word[r->row.count - 1].length)
        r->row.count--;
    const int more = r->row.count - c->count;
    const int name = c->name >= 0 ? c->name : more > 0 ? 0 : c->index;
    const int absorbed = c->name >= 0 ? c->name : -1;
    char expected[48];
    snprintf(expected, sizeof expected, "%d columns as in line %d", c->count, c->line);
    if (more < 0 || (more > 0 && c->delimiter != ' '))
        return refuse(r, line, expected);
    for (int i = 0; i < (c->polar ? 2 : 3); i++) {
        const struct light_word *w =
            &r->row.word[c->vector[i] + (c->vector[i] > absorbed ? more : 0)];
        if (!w->number)
            return refuse(r, line, "numbers in the columns of the light");
        v[i] = w->value;
    }
    const int length = more + (c->name >= 0 || !more);
    const int end = name < 0 || !r->row.word[name].length ? name : name + length;
    return add_light(r, line, c->polar ? from_angles(c, v[0], v[1]) : vec3_of(v[0], v[1], v[2]),
                     name, end);
}

// ---------------------------------------------------------------- all lines

static relume_status make_room(struct reading *r, const struct relume_limits *limits)
{
    struct light_list *list = r->list;
    struct light_line line = r->first;
    const int most = limits_or_default(limits_of(limits, r->log)).max_lights;
    int n = 0;
    while (light_line_next(&line))
        n += !light_line_comment(&line, NULL);
    if (!n)
        return log_fail(r->log, RELUME_EFORMAT,
                        "%s: no lights; expected a line 'name x y z' or 'x y z' for each", r->path);
    if (n > most)
        return log_fail(r->log, RELUME_ELIMIT, "%s: %d lights; expected at most %d", r->path, n,
                        most);
    list->vector = arena_array(&list->arena, (size_t)n, sizeof *list->vector);
    list->direction = arena_array(&list->arena, (size_t)n, sizeof *list->direction);
    list->name = arena_array(&list->arena, (size_t)n, sizeof *list->name);
    list->line = arena_array(&list->arena, (size_t)n, sizeof *list->line);
    return list->vector && list->direction && list->name && list->line ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status read_lines(struct reading *r)
{
    struct light_line line = r->first;
    relume_status status =
        r->columns.found ? RELUME_OK : light_layout_find(&r->layout, r->first, r->path, r->log);
    while (!status && light_line_next(&line))
        if (!light_line_comment(&line, NULL))
            status = (r->columns.found ? read_titled : read_voted)(r, &line);
    return status;
}

// A whole list within 7 degrees of the pole, or of the horizon by its elevations, is in radians.
static relume_status check_angles(const struct reading *r)
{
    const struct light_list *list = r->list;
    const double small = 2.0 * M_PI * M_PI / 180.0;
    double lowest = 1.0, highest = -1.0;
    for (int i = 0; i < list->count; i++) {
        lowest = fmin(lowest, list->direction[i].z);
        highest = fmax(highest, list->direction[i].z);
    }
    const bool radians = r->columns.elevation ? highest < sin(small) : lowest > cos(small);
    if (!r->columns.polar || list->count < 3 || !radians)
        return RELUME_OK;
    return log_fail(r->log, RELUME_EFORMAT,
                    "%s: all its angles are below 7; expected degrees, found radians", r->path);
}

static relume_status check_names(struct reading *r)
{
    struct light_list *list = r->list;
    list->numbered = true;
    if (r->named && r->unnamed)
        return log_fail(r->log, RELUME_EFORMAT,
                        "%s: line %d has no name, line %d has one; expected names in all lines, or "
                        "in none",
                        r->path, r->unnamed, r->named);
    for (int i = 0; i < list->count; i++)
        list->numbered &= is_index(list->name[i]);
    if (r->numbers && !list->numbered)  // no names, or a column of other numbers
        list->name = NULL;
    return RELUME_OK;
}

static void look_at_lengths(struct reading *r)
{
    struct light_list *list = r->list;
    int units = 0;
    for (int i = 0; i < list->count; i++)
        units += fabs(vec3_length(list->vector[i]) - 1.0) <= 0.02;
    list->unit = 2 * units > list->count;
    list->angles = r->columns.polar;
    if (r->stated && r->stated != list->count)
        log_line(r->log, RELUME_WARNING,
                 "%s: its first line promises %ld lights; found %d, which are used", r->path,
                 r->stated, list->count);
}

void light_list_free(struct light_list *list)
{
    arena_free(&list->arena);
    *list = (struct light_list){0};
}

relume_status light_list_read(struct light_list *out, const char *path,
                              const struct relume_limits *limits, const struct relume_log *log)
{
    struct reading r = {.list = out, .path = path, .log = log, .numbers = true};
    char *text;
    *out = (struct light_list){0};
    relume_status status = light_text_load(&text, path, log);
    if (status)
        return status;
    r.first = light_line_first(text);
    status = read_preamble(&r);
    if (!status)
        status = make_room(&r, limits);
    if (!status)
        status = read_lines(&r);
    if (!status)
        status = check_angles(&r);
    if (!status)
        status = check_names(&r);
    if (!status)
        look_at_lengths(&r);
    else
        light_list_free(out);
    mem_free(text);
    return status;
}
