// capture_times.c - exposure times from a file
#include "cli/commands/capture_times.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_LINES = 4096 };
// A nanosecond to thirty years: whatever lies beyond is no time of an exposure, nor relative to
// one.
static const double SHORTEST_S = 1e-9, LONGEST_S = 1e9;

struct times {
    int count;
    struct {
        char name[256];  // "" when the line holds a time alone
        double seconds;
    } line[MAX_LINES];
};

static bool parse_seconds(const char *text, double *out)
{
    char *end;
    *out = strtod(text, &end);
    if (end != text && *end == '/') {
        const char *below = end + 1;
        *out /= strtod(below, &end);
        if (end == below)
            return false;
    }
    if (*end == 's')
        end++;
    return end != text && !*end;
}

static const char blanks[] = " \t\r\n,";

static char *trim(char *text)
{
    text += strspn(text, blanks);
    size_t n = strlen(text);
    while (n && strchr(blanks, text[n - 1]))
        text[--n] = '\0';
    return text;
}

// Of a trimmed line, whose rest is trimmed in turn: names may hold blanks.
static const char *last_word(char *text)
{
    char *word = text + strlen(text);
    while (word > text && !strchr(blanks, word[-1]))
        word--;
    for (char *end = word; end > text && strchr(blanks, end[-1]); end--)
        end[-1] = '\0';
    return word;
}

static relume_status parse_line(const char *path, struct times *t, char *text, int number)
{
    text[strcspn(text, "#")] = '\0';
    text = trim(text);
    if (!*text)
        return RELUME_OK;
    const char *const last = last_word(text);
    const char *const name = last > text ? text : "";
    if (t->count == MAX_LINES || !parse_seconds(last, &t->line[t->count].seconds))
        return data_error("%s: line %d; expected 'seconds' or 'name seconds', such as 1/60", path,
                          number);
    if (!(t->line[t->count].seconds >= SHORTEST_S && t->line[t->count].seconds <= LONGEST_S))
        return data_error("%s: line %d; expected an exposure time from %g to %g seconds; found %g",
                          path, number, SHORTEST_S, LONGEST_S, t->line[t->count].seconds);
    snprintf(t->line[t->count].name, sizeof t->line->name, "%s", name);
    t->count++;
    return RELUME_OK;
}

static relume_status load(const char *path, struct times *t, const struct relume_log *log)
{
    char text[1024];
    relume_status status = RELUME_OK;
    FILE *f = fopen(path, "re");
    if (!f)
        return relume_input_fail(log, path, "exposure times cannot be opened", errno);
    for (int number = 1; !status && fgets(text, sizeof text, f); number++)
        status = parse_line(path, t, text, number);
    fclose(f);
    return status;
}

static const double *find(const struct times *t, const char *name)
{
    for (int i = 0; i < t->count; i++)
        if (!strcmp(path_name(t->line[i].name), name))
            return &t->line[i].seconds;
    return NULL;
}

static relume_status assign(const char *path, const struct times *t,
                            const struct relume_photographs *list, struct relume_exif *notes)
{
    const bool named = t->count > 0 && *t->line[0].name;
    if (t->count == 0 || (!named && list->count % t->count))
        return data_error("%s: %d time%s; expected one for each of the %d photographs", path,
                          t->count, relume_plural(t->count), list->count);
    for (int i = 0; i < list->count; i++) {
        const double *seconds =
            named ? find(t, path_name(list->path[i])) : &t->line[i % t->count].seconds;
        if (!seconds)
            return data_error("%s: no line for %s; expected 'name seconds' for every photograph",
                              path, path_name(list->path[i]));
        notes[i].time_s = *seconds;
        notes[i].f_number = notes[i].iso = 0.0;
    }
    return RELUME_OK;
}

relume_status read_times(const char *path, const struct relume_photographs *list,
                         struct relume_exif *notes, const struct relume_log *log)
{
    struct times *t = calloc(1, sizeof *t);
    if (!t)
        return RELUME_ENOMEM;
    relume_status status = load(path, t, log);
    if (!status)
        status = assign(path, t, list, notes);
    free(t);
    return status;
}
