// json.c - the one file that knows jansson; where a value stands in a text, which jansson does not
// keep
#include "core/base/json.h"

#include "core/base/context.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

relume_status jvalue_load(jvalue **root, const char *path, const struct relume_log *log)
{
    json_error_t error;
    *root = NULL;
    FILE *file = input_open(path, log);
    if (!file)
        return relume_input_fail(log, path, "cannot be opened", errno);
    *root = json_loadf(file, JSON_REJECT_DUPLICATES, &error);
    fclose(file);
    if (*root)
        return RELUME_OK;
    if (json_error_code(&error) == json_error_out_of_memory)
        return RELUME_ENOMEM;
    return log_fail(log, RELUME_EFORMAT, "%s: line %d, column %d; expected JSON, %s", path,
                    error.line, error.column, error.text);
}

relume_status jvalue_parse(jvalue **root, const char *text, const struct relume_log *log)
{
    json_error_t error;
    *root = json_loads(text, JSON_REJECT_DUPLICATES, &error);
    if (*root)
        return RELUME_OK;
    return json_error_code(&error) == json_error_out_of_memory
               ? RELUME_ENOMEM
               : log_fail(log, RELUME_EFORMAT, "line %d, column %d; expected JSON, %s", error.line,
                          error.column, error.text);
}

void jvalue_free(jvalue **root)
{
    json_decref(*root);
    *root = NULL;
}

relume_status jvalue_check_format(const jvalue *root, const char *path, const char *format,
                                  int version, const struct relume_log *log)
{
    const char *found = jvalue_text(jvalue_member(root, "format"));
    long long number = 0;
    if (!found || strcmp(found, format))
        return log_fail(log, RELUME_EFORMAT, "%s: expected \"format\": \"%s\"", path, format);
    if (!jvalue_integer(jvalue_member(root, "version"), &number) || number != version)
        return log_fail(log, number > version ? RELUME_EUNSUPPORTED : RELUME_EFORMAT,
                        "%s: expected version %d; found %lld", path, version, number);
    return RELUME_OK;
}

const jvalue *jvalue_member(const jvalue *object, const char *key)
{
    return json_object_get(object, key);
}

const jvalue *jvalue_item(const jvalue *array, size_t index)
{
    return json_array_get(array, index);
}

const char *jvalue_text(const jvalue *value)
{
    return json_string_value(value);
}

bool jvalue_is_null(const jvalue *value)
{
    return json_is_null(value);
}

bool jvalue_is_array(const jvalue *value)
{
    return json_is_array(value);
}

bool jvalue_is_object(const jvalue *value)
{
    return json_is_object(value);
}

const char *jvalue_unknown(const jvalue *object, const char *const *known)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)object, key, value)
    {
        int i = 0;
        while (known[i] && strcmp(known[i], key))
            i++;
        if (!known[i])
            return key;
    }
    return NULL;
}

relume_status jvalue_check_known(const jvalue *object, const char *const *known,
                                 const struct relume_log *log)
{
    const char *stranger = jvalue_unknown(object, known);
    const char *near = stranger ? relume_name_nearest(stranger, known) : NULL;
    return stranger ? log_fail(log, RELUME_EFORMAT, "unknown member '%s'%s%s%s", stranger,
                               near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "")
                    : RELUME_OK;
}

size_t jvalue_count(const jvalue *array)
{
    return json_array_size(array);
}

bool jvalue_number(const jvalue *value, double *out)
{
    if (!json_is_number(value) || !isfinite(json_number_value(value)))
        return false;
    *out = json_number_value(value);
    return true;
}

bool jvalue_integer(const jvalue *value, long long *out)
{
    if (!json_is_integer(value))
        return false;
    *out = json_integer_value(value);
    return true;
}

bool jvalue_whole(const jvalue *value, long long least, long long most, int *out)
{
    long long whole;
    if (!jvalue_integer(value, &whole) || whole < least || whole > most)
        return false;
    *out = (int)whole;
    return true;
}

bool jvalue_truth(const jvalue *value, bool *out)
{
    *out = json_is_true(value);
    return json_is_boolean(value);
}

bool jvalue_numbers(const jvalue *array, double *out, size_t count)
{
    if (!json_is_array(array) || json_array_size(array) != count)
        return false;
    for (size_t i = 0; i < count; i++)
        if (!jvalue_number(json_array_get(array, i), &out[i]))
            return false;
    return true;
}

bool jvalue_may_hold(const char *text)
{
    uint32_t code = 0;
    int n = 1;
    for (; n && code != 0xfffd; text += n)
        n = relume_text_step(&code, text);
    return n == 0;
}

bool jvalue_set_integers(jvalue *object, const char *key, const int *value, size_t count)
{
    json_t *array = json_array();
    bool good = array != NULL;
    for (size_t i = 0; good && i < count; i++)
        good = !json_array_append_new(array, json_integer(value[i]));
    if (!good)
        json_decref(array);
    return good && !json_object_set_new(object, key, array);
}

char *jvalue_print(const jvalue *value)
{
    char *made = json_dumps(value, JSON_COMPACT | JSON_ENSURE_ASCII | JSON_ENCODE_ANY);
    return mem_take(made);
}

// ---------------------------------------------------------------- places in the text

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
