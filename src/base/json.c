// json.c - the one file that knows jansson
#include "base/json.h"

#include "base/infile.h"
#include "base/log.h"
#include "base/memory.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
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

static bool is_utf8(const char *text)
{
    uint32_t code = 0;
    int n = 1;
    for (; n && code != 0xfffd; text += n)
        n = relume_text_step(&code, text);
    return n == 0;
}

// JSON is UTF-8; a name that is not, as disks allow, is written as it is shown.
char *jvalue_quote(const char *text)
{
    char *copy = is_utf8(text) ? NULL : mem_text(text);
    json_t *string = json_string(copy ? relume_printable(copy) : text);
    char *quoted = string ? json_dumps(string, JSON_ENCODE_ANY) : NULL;
    json_decref(string);
    mem_free(copy);
    return mem_take(quoted);
}
