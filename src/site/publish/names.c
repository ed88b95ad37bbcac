// names.c - names of pages and folders that every server and file system takes
#include "site/publish/names.h"

#include "core/base/memory.h"

#include <stdio.h>
#include <string.h>

// Space for "-255" behind it.
enum { LONGEST = 48 };

char *names_stem(const char *path)
{
    size_t end = strlen(path);
    while (end > 1 && path[end - 1] == '/')
        end--;
    size_t start = end;
    while (start > 0 && path[start - 1] != '/')
        start--;
    size_t dot = end;
    while (dot > start + 1 && path[dot - 1] != '.')
        dot--;
    const size_t n = (dot > start + 1 ? dot - 1 : end) - start;
    char *stem = mem_array(n + 1, 1);
    if (stem) {
        memcpy(stem, path + start, n);
        stem[n] = '\0';
    }
    return stem;
}

static bool is_plain(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

// What is not plain becomes one '-', none at the ends.
static void make(char *name, const char *stem)
{
    size_t n = 0;
    bool gap = false;
    for (; *stem && n < LONGEST; stem++) {
        const char c = (char)(*stem >= 'A' && *stem <= 'Z' ? *stem - 'A' + 'a' : *stem);
        if (is_plain(c)) {
            if (gap && n)
                name[n++] = '-';
            name[n++] = c;
        }
        gap = !is_plain(c);
    }
    name[n] = '\0';
    if (!n)
        snprintf(name, SITE_NAME, "object");
}

static bool is_taken(char (*names)[SITE_NAME], int count, const char *name)
{
    bool taken = !strcmp(name, "index") || !strcmp(name, "open") || !strcmp(name, "relume");
    for (int i = 0; !taken && i < count; i++)
        taken = !strcmp(names[i], name);
    return taken;
}

void names_make(char (*names)[SITE_NAME], char *const *stems, int count)
{
    for (int i = 0; i < count; i++) {
        char first[SITE_NAME], name[2 * SITE_NAME];
        make(first, stems[i]);
        snprintf(name, sizeof name, "%s", first);
        for (int k = 2; is_taken(names, i, name); k++)
            snprintf(name, sizeof name, "%s-%d", first, k);
        memcpy(names[i], name, SITE_NAME);
        names[i][SITE_NAME - 1] = '\0';
    }
}
