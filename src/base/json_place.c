// json_place.c - where a value of a JSON file stands in its text, which jansson does not keep
#include "base/json.h"

#include "base/context.h"
#include "base/infile.h"
#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

// The text has been parsed before: it is JSON, or it has changed since and ends early.
static const char *skip_space(const char *at)
{
    return at + strspn(at, " \t\r\n");
}

static const char *skip_string(const char *at)
{
    for (at++; *at && *at != '"'; at++)
        at += *at == '\\' && at[1];
    return *at ? at + 1 : at;
}

static const char *skip_value(const char *at)
{
    int depth = 0;
    do {
        at = skip_space(at);
        if (*at == '"') {
            at = skip_string(at);
        } else if (*at && strchr("{}[],:", *at)) {
            depth += *at == '{' || *at == '[';
            depth -= *at == '}' || *at == ']';
            at++;
        } else {
            at += strcspn(at, " \t\r\n\"{}[],:");
        }
    } while (*at && depth > 0);
    return at;
}

static bool is_key(const char *at, const char *key)
{
    const size_t n = strlen(key);
    return !strncmp(at + 1, key, n) && at[1 + n] == '"';
}

// The member `key` of the object at `at`: its key, or its value; NULL when there is none.
static const char *find_member(const char *at, const char *key, bool value)
{
    if (*at != '{')
        return NULL;
    for (at = skip_space(at + 1); *at == '"'; at = skip_space(at + (*at == ','))) {
        const char *name = at;
        at = skip_space(skip_string(at));
        at = skip_space(at + (*at == ':'));
        if (is_key(name, key))
            return value ? at : name;
        at = skip_space(skip_value(at));
    }
    return NULL;
}

static const char *find_item(const char *at, size_t index)
{
    if (*at != '[')
        return NULL;
    at = skip_space(at + 1);
    for (; index > 0 && *at && *at != ']'; index--) {
        at = skip_space(skip_value(at));
        at = skip_space(at + (*at == ','));
    }
    return *at && *at != ']' ? at : NULL;
}

bool jvalue_place(int line_column[2], const char *path, const struct relume_log *log,
                  const char *array, size_t index, const char *key)
{
    char *text;
    size_t size;
    const struct relume_log quiet = {.context = context_of(log)};
    (void)!input_load(&text, &size, path, UINT64_MAX, "", &quiet);
    const char *at = text ? skip_space(text) : NULL;
    if (array) {
        at = at ? find_member(at, array, true) : NULL;
        at = at ? find_item(at, index) : NULL;
    }
    const char *member = at && key ? find_member(at, key, false) : NULL;
    at = member ? member : at;
    line_column[0] = line_column[1] = 1;
    for (const char *p = text; at && p < at; p++) {
        const bool inside = ((unsigned char)*p & 0xc0) == 0x80;  // of a character of UTF-8
        line_column[0] += *p == '\n';
        line_column[1] = *p == '\n' ? 1 : line_column[1] + !inside;
    }
    mem_free(text);
    return at != NULL;
}
