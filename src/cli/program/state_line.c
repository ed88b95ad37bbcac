// state_line.c - how a file is looked at, in one line
#include "cli/program/state_line.h"

#include "cli/program/say.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

// What a line may say, and whether words of its value are separated by blanks on a command line.
static const struct {
    const char *name;
    bool words;
} known[] = {
    {"light", true},   {"view", false},       {"eye", false},         {"look-at", false},
    {"up", false},     {"fov", false},        {"pan", false},         {"tilt", false},
    {"zoom", false},   {"projection", false}, {"interpolate", false}, {"aperture", false},
    {"focus", false},  {"exposure", false},   {"tone", false},        {"white", false},
    {"pass", false},   {"gain", false},       {"highlight", false},   {"exponent", false},
    {"radius", false}, {"range", false},
};
// Where a page is scrolled to, and what it shows.
static const char *const of_pages[] = {"file", "at", "note"};

static int digit(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : isxdigit((unsigned char)c) ? tolower(c) - 'a' + 10 : -1;
}

// `n` characters of `from`, decoded; the byte behind them in `buffer`, NULL for what is not encoded
// so. No control characters: values go into sentences, and file names.
static char *decode(char *buffer, const char *from, size_t n, char between)
{
    for (size_t i = 0; i < n; i++) {
        char c = from[i];
        if (c == '%') {
            if (i + 2 >= n)
                return NULL;
            const int high = digit(from[i + 1]), low = digit(from[i + 2]);
            if (high < 0 || low < 0)
                return NULL;
            c = (char)(16 * high + low);
            i += 2;
        } else if (c == ',')
            c = between;
        if (iscntrl((unsigned char)c))
            return NULL;
        *buffer++ = c;
    }
    *buffer++ = '\0';
    return buffer;
}

static int find(const char *name, size_t n)
{
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strlen(known[i].name) == n && !strncmp(name, known[i].name, n))
            return (int)i;
    return -1;
}

static bool is_of_pages(const char *name, size_t n)
{
    for (size_t i = 0; i < sizeof of_pages / sizeof *of_pages; i++)
        if (strlen(of_pages[i]) == n && !strncmp(name, of_pages[i], n))
            return true;
    return false;
}

static void warn(const char *name, size_t n, const struct relume_log *log)
{
    char shown[32], text[96];
    snprintf(shown, sizeof shown, "%.*s", n < sizeof shown ? (int)n : (int)sizeof shown - 1, name);
    snprintf(text, sizeof text, "--state: '%s' is not known here; it is left out",
             relume_printable(shown));
    if (log && log->message)
        log->message(log->user, RELUME_WARNING, text);
}

relume_status state_line_read(struct state_entry *out, int *count, int most, char *buffer,
                              const char *line, const struct relume_log *log)
{
    const char *hash = strrchr(line, '#');
    const char *at = hash ? hash + 1 : line;
    *count = 0;
    if (strlen(at) >= STATE_LINE_MOST)
        return say(log, RELUME_EINVAL, "--state: expected at most %d characters; found %zu",
                   STATE_LINE_MOST - 1, strlen(at));
    for (size_t n; *at; at += n + (at[n] == '&')) {
        n = strcspn(at, "&");
        const char *equals = memchr(at, '=', n);
        const size_t name = equals ? (size_t)(equals - at) : n;
        if (!n)
            continue;
        const int which = find(at, name);
        if (which < 0) {
            if (!is_of_pages(at, name))
                warn(at, name, log);
            continue;
        }
        if (*count == most)
            return say(log, RELUME_EINVAL, "--state: expected at most %d entries", most);
        struct state_entry *e = &out[(*count)++];
        snprintf(e->option, sizeof e->option, "--%s", known[which].name);
        e->value = buffer;
        buffer = equals ? decode(buffer, equals + 1, n - name - 1, known[which].words ? ' ' : ',')
                        : NULL;
        if (!buffer)
            return say(log, RELUME_EINVAL, "--state: expected %s=VALUE, as the page wrote it",
                       known[which].name);
    }
    return RELUME_OK;
}

bool state_line_add(char *line, size_t size, const char *name, const char *value)
{
    static const char plain[] = ".:_+-";
    const size_t start = strlen(line);
    size_t n = start;
    const int head = snprintf(line + n, size - n, "%s%s=", n ? "&" : "", name);
    bool fits = head >= 0 && (size_t)head < size - n;
    for (n += (size_t)head; fits && *value; value++) {
        const unsigned char c = (unsigned char)*value;
        char code[4] = {(char)c};
        if (c == ' ')
            code[0] = ',';
        else if (!isalnum(c) && !strchr(plain, c))
            snprintf(code, sizeof code, "%%%02X", c);
        fits = n + strlen(code) < size;
        if (fits)
            n += (size_t)snprintf(line + n, size - n, "%s", code);
    }
    if (!fits)
        line[start] = '\0';
    return fits;
}
