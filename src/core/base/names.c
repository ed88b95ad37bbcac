// names.c - names looked up; what somebody meant who mistyped: the smallest edit distance
// (Levenshtein 1966); endings of counted nouns
#include "core/base/names.h"

#include <string.h>

const char *relume_plural(int64_t n)
{
    return n == 1 ? "" : "s";
}

static int edit_distance(const char *a, const char *b)
{
    enum { LIMIT = 64 };
    const size_t m = strlen(b);
    int row[LIMIT + 1];
    if (m > LIMIT)
        return LIMIT;
    for (size_t j = 0; j <= m; j++)
        row[j] = (int)j;
    for (size_t i = 0; a[i]; i++) {
        int diagonal = row[0];
        row[0] = (int)i + 1;
        for (size_t j = 1; j <= m; j++) {
            const int replace = diagonal + (a[i] != b[j - 1]);
            const int other = (row[j] < row[j - 1] ? row[j] : row[j - 1]) + 1;
            diagonal = row[j];
            row[j] = replace < other ? replace : other;
        }
    }
    return row[m];
}

const char *relume_name_nearest(const char *given, const char *const *names)
{
    const char *best = NULL;
    int best_distance = 1 + (int)strlen(given) / 2;
    for (; *names; names++) {
        const int d = edit_distance(given, *names);
        if (d < best_distance) {
            best_distance = d;
            best = *names;
        }
    }
    return best;
}

int name_find(const char *name, const char *const *names, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (names[i] && !strcmp(names[i], name))
            return (int)i;
    return -1;
}

const char *relume_name_quotes(const char *name)
{
    static const char plain[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789/._-+,:@%";
    return !name[strspn(name, plain)] ? "" : strchr(name, '\'') ? "\"" : "'";
}
