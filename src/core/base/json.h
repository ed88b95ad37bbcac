// json.h - reading JSON (json_write.h writes it); the folder's door to jansson
#ifndef BASE_JSON_H
#define BASE_JSON_H

#include <relume/base.h>

// A value inside a tree; belongs to the root. Every function takes NULL for "absent".
typedef struct json_t jvalue;

// The whole file; members that come twice are an error. RELUME_EFORMAT with a sentence.
relume_status jvalue_load(jvalue **root, const char *path, const struct relume_log *log);
// The same of a text; sentences begin as `log` has them begin.
relume_status jvalue_parse(jvalue **root, const char *text, const struct relume_log *log);
void jvalue_free(jvalue **root);
// Whether members "format" and "version" of the file's root are these; RELUME_EFORMAT with a
// sentence.
relume_status jvalue_check_format(const jvalue *root, const char *path, const char *format,
                                  int version, const struct relume_log *log);

// NULL when absent or when the value is of another kind.
const jvalue *jvalue_member(const jvalue *object, const char *key);
const jvalue *jvalue_item(const jvalue *array, size_t index);
const char *jvalue_text(const jvalue *value);
bool jvalue_is_null(const jvalue *value);
bool jvalue_is_array(const jvalue *value);
bool jvalue_is_object(const jvalue *value);
size_t jvalue_count(const jvalue *array);

// The first member of an object that is not in the NULL-terminated list; NULL when all are.
const char *jvalue_unknown(const jvalue *object, const char *const *known);
// RELUME_EFORMAT with a sentence that has the nearest of the list, unless all are.
relume_status jvalue_check_known(const jvalue *object, const char *const *known,
                                 const struct relume_log *log);

// False unless `value` is a finite number, an integer, one from `least` to `most`, true or false,
// an array of `count` finite numbers.
bool jvalue_number(const jvalue *value, double *out);
bool jvalue_integer(const jvalue *value, long long *out);
bool jvalue_whole(const jvalue *value, long long least, long long most, int *out);
bool jvalue_truth(const jvalue *value, bool *out);
bool jvalue_numbers(const jvalue *array, double *out, size_t count);

// Sets a member of an object to an array of integers. Returns false without memory.
bool jvalue_set_integers(jvalue *object, const char *key, const int *value, size_t count);

// Line and column, from 1, of the member `key` of item `index` of the root's member `array` in a
// file that has been loaded; of the item where `key` is NULL or absent. Without `array` the root
// itself is the item. False when it is not found.
bool jvalue_place(int line_column[2], const char *path, const struct relume_log *log,
                  const char *array, size_t index, const char *key);

// The value as JSON in one line of ASCII, to be freed; NULL when memory is short.
char *jvalue_print(const jvalue *value);
// Returns whether JSON can hold `text` unchanged, that is, whether it is UTF-8.
bool jvalue_may_hold(const char *text);

#endif
