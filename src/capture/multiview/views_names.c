// views_names.c - where a camera stands, from the name of its photograph
#include "capture/multiview/views.h"
#include "core/base/tree.h"

#include "core/base/log.h"
#include "core/base/memory.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST_NUMBERS = 8, MOST_DIGITS = 9 };

// ---------------------------------------------------------------- patterns

// What a pattern has found in a name; bits of `found` by field.
struct match {
    double value[5];
    unsigned found;
};
enum field { ROW, COLUMN, NUMBER, U, V };
static const char *const fields[] = {"{row}", "{column}", "{n}", "{u}", "{v}"};
enum { FIELDS = sizeof fields / sizeof *fields };

// The end of the number that `text` begins with; NULL: it begins with none. Whole ones for places
// in a grid, with a point for positions.
static const char *number_end(double *out, const char *text, bool whole)
{
    const char *c = text + (!whole && *text == '-');
    const char *digits = c;
    bool point = false;
    while (isdigit((unsigned char)*c) ||
           (!whole && *c == '.' && !point && isdigit((unsigned char)c[1])))
        point |= *c++ == '.';
    char number[64];  // without what follows, which may look like an exponent
    const size_t n = (size_t)(c - text);
    if (c == digits || (whole && c - digits > MOST_DIGITS) || (!whole && !point) ||
        n >= sizeof number)
        return NULL;
    snprintf(number, sizeof number, "%.*s", (int)n, text);
    *out = strtod(number, NULL);
    return c;
}

// Past the field or character that the pattern begins with; false: the text does not begin so.
static bool step(struct match *m, const char **pattern, const char **text)
{
    int f = 0;
    while (f < FIELDS && strncmp(*pattern, fields[f], strlen(fields[f])))
        f++;
    if (f == FIELDS)
        return **pattern && *(*pattern)++ == *(*text)++;
    *pattern += strlen(fields[f]);
    *text = number_end(&m->value[f], *text, f < U);
    m->found |= 1u << f;
    return *text;
}

// A star takes as little as it can, and only the last one is asked for more: what stands between
// two stars ends no earlier for beginning later. Behind the pattern stands the extension.
static bool matches(struct match *m, const char *pattern, const char *text)
{
    const char *star = NULL, *taken = NULL;
    while (*pattern || (*text && *text != '.'))
        if (*pattern == '*') {
            star = ++pattern;
            taken = text;
        } else if (!step(m, &pattern, &text)) {
            if (!star || !*taken)
                return false;
            pattern = star;
            text = ++taken;
        }
    return true;
}

static bool has(const struct match *m, enum field f)
{
    return m->found >> f & 1;
}

// False when the pattern fits but says too little; the number alone is kept as a column.
static bool place_of(struct view_place *p, const struct match *m)
{
    *p = (struct view_place){.has_uv = has(m, U) && has(m, V), .u = m->value[U], .v = m->value[V]};
    const bool crossing = has(m, ROW) && has(m, COLUMN);
    p->row = has(m, ROW) ? relume_whole(m->value[ROW]) : 0;
    p->column = has(m, NUMBER)   ? relume_whole(m->value[NUMBER])
                : has(m, COLUMN) ? relume_whole(m->value[COLUMN])
                                 : 0;
    return crossing || p->has_uv || has(m, NUMBER);
}

static bool all_match(struct view_place *places, const struct photo_set *set, const char *pattern,
                      int *first_bad)
{
    for (int i = 0; i < set->count; i++) {
        struct match m = {.found = 0};
        if (!matches(&m, pattern, path_name(set->camera[i].name)) || !place_of(&places[i], &m)) {
            *first_bad = i;
            return false;
        }
    }
    return true;
}

// ---------------------------------------------------------------- numbers that vary

static int whole_numbers(long out[MOST_NUMBERS], const char *name)
{
    int n = 0;
    for (const char *c = name; *c && n < MOST_NUMBERS;) {
        if (!isdigit((unsigned char)*c)) {
            c++;
            continue;
        }
        const size_t digits = strspn(c, "0123456789");
        out[n++] = digits <= MOST_DIGITS ? strtol(c, NULL, 10) : -1;
        c += digits;
    }
    return n;
}

// Which of the names' numbers differ from camera to camera: up to two, in order. Numbers of many
// digits are dates and the like.
static relume_status varying_numbers(int which[2], int *count, const struct photo_set *set,
                                     const struct relume_log *log)
{
    long first[MOST_NUMBERS], other[MOST_NUMBERS];
    bool varies[MOST_NUMBERS] = {false}, too_long[MOST_NUMBERS] = {false};
    const int n = whole_numbers(first, path_name(set->camera[0].name));
    for (int i = 1; i < set->count; i++) {
        if (whole_numbers(other, path_name(set->camera[i].name)) != n)
            return log_fail(log, RELUME_EUNFIT,
                            "%s: the name does not match; expected the pattern of %s, or --names",
                            set->camera[i].name, set->camera[0].name);
        for (int k = 0; k < n; k++) {
            varies[k] |= other[k] != first[k];
            too_long[k] |= other[k] < 0 || first[k] < 0;
        }
    }
    *count = 0;
    for (int k = 0; k < n; k++)
        if (varies[k] && !too_long[k] && (*count)++ < 2)
            which[*count - 1] = k;
    if (*count == 1 || *count == 2)
        return RELUME_OK;
    return log_fail(log, RELUME_EUNFIT,
                    "%s: expected names in which one or two numbers differ (row and column), or "
                    "--names; found %d",
                    set->camera[0].name, *count);
}

static void place_by_numbers(struct view_place *places, const struct photo_set *set,
                             const int which[2], int count)
{
    for (int i = 0; i < set->count; i++) {
        long numbers[MOST_NUMBERS];
        whole_numbers(numbers, path_name(set->camera[i].name));
        places[i] = (struct view_place){
            .row = count == 2 ? (int)numbers[which[0]] : 0,
            .column = (int)numbers[which[count - 1]],
        };
    }
}

// Numbered cameras stand row by row in a square.
static relume_status wrap_numbers(struct view_place *places, const struct photo_set *set,
                                  const struct relume_log *log)
{
    int least = places[0].column, most = least;
    for (int i = 1; i < set->count; i++) {
        least = places[i].column < least ? places[i].column : least;
        most = places[i].column > most ? places[i].column : most;
    }
    const double span = (double)most - least + 1.0;
    const int side = (int)lround(sqrt(span));
    if ((double)side * side != span)
        return log_fail(log, RELUME_EUNFIT,
                        "%s: numbers from %d to %d; expected a square grid, row by row, or --names "
                        "with {row} and {column}",
                        set->camera[0].name, least, most);
    for (int i = 0; i < set->count; i++) {
        const int n = places[i].column - least;
        places[i].row = n / side;
        places[i].column = n % side;
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- all cameras

static relume_status by_pattern(struct view_place *places, const struct photo_set *set,
                                const char *names, const struct relume_log *log)
{
    int bad = 0;
    if (!all_match(places, set, names, &bad))
        return log_fail(log, RELUME_EUNFIT,
                        "%s: the name does not match '%s'; expected {row} and {column}, {n}, or "
                        "{u} and {v} in it",
                        set->camera[bad].name, names);
    return strstr(names, "{n}") ? wrap_numbers(places, set, log) : RELUME_OK;
}

static relume_status by_numbers(struct view_place *places, const struct photo_set *set,
                                const struct relume_log *log)
{
    int which[2], count = 0;
    const relume_status status = varying_numbers(which, &count, set, log);
    if (status)
        return status;
    place_by_numbers(places, set, which, count);
    return count == 1 ? wrap_numbers(places, set, log) : RELUME_OK;
}

relume_status view_places(struct view_place *places, const struct photo_set *set, const char *names,
                          const struct relume_log *log)
{
    static const char *const archive[] = {"*_{row}_{column}_{v}_{u}", "*_{row}_{column}_{v}_{u}_"};
    int bad;
    if (names)
        return by_pattern(places, set, names, log);
    for (int i = 0; i < 2; i++)
        if (all_match(places, set, archive[i], &bad))
            return RELUME_OK;
    if (set->count == 1)
        return log_fail(log, RELUME_EUNFIT, "%s: a single camera; expected two or more for a slab",
                        set->camera[0].name);
    return by_numbers(places, set, log);
}
