// json_write.h - writing JSON: commas, keys, escapes and numbers
#ifndef BASE_JSON_WRITE_H
#define BASE_JSON_WRITE_H

#include <relume/base.h>
#include <stdio.h>

// Styles of a text; several are added.
enum json_style {
    JSON_DENSE = 1,     // no blank after a comma or a colon
    JSON_TERMINAL = 2,  // characters that a terminal would obey are escaped
    JSON_MARKUP = 4,    // < > & are escaped: the text may stand in a script of a page
};

// A JSON text being written to `file`, or without one to memory. Set these two members, and zero
// the private ones. Every function below takes the key of the value, or NULL in an array and for
// the whole document. After an error nothing more is written, and jend() or jsave() returns the
// error: callers check once. One thread at a time; no function changes global state or depends on
// the locale.
struct jwriter {
    FILE *file;
    unsigned style;
    // Private:
    char *text;  // in memory
    size_t size, capacity;
    const char *gap;   // white space before the next token, or NULL: the usual
    uint64_t objects;  // bit d: whether the open level d is an object
    int depth;         // open levels, at most 64
    bool comma;        // whether the next value follows another
    relume_status status;
};

void jopen_object(struct jwriter *w, const char *key);
void jopen_array(struct jwriter *w, const char *key);
// Closes the innermost object or array.
void jclose(struct jwriter *w);
void jclose_levels(struct jwriter *w, int levels);
// Puts `space`, white space that outlives the next call, before the next value or closing bracket
// instead of the usual blank or nothing: "\n  " begins a line.
void jgap(struct jwriter *w, const char *space);

// A text of UTF-8, null for NULL. A byte that is not UTF-8 becomes U+FFFD.
void jput_text(struct jwriter *w, const char *key, const char *text);
void jput_texts(struct jwriter *w, const char *key, const char *const *text, size_t count);
// A number of `digits` significant digits, 1 to 17; with 0, of 15 digits or 17, whichever read back
// as the same number. NaN and infinity become null.
void jput_number(struct jwriter *w, const char *key, double value, int digits);
// The same with `decimals` digits after the point, at most 17.
void jput_fixed(struct jwriter *w, const char *key, double value, int decimals);
// Arrays of such numbers.
void jput_numbers(struct jwriter *w, const char *key, const double *value, size_t count,
                  int digits);
void jput_floats(struct jwriter *w, const char *key, const float *value, size_t count, int digits);
void jput_vector(struct jwriter *w, const char *key, struct relume_vec3 value, int digits);
void jput_integer(struct jwriter *w, const char *key, long long value);
void jput_truth(struct jwriter *w, const char *key, bool value);
void jput_null(struct jwriter *w, const char *key);
// `json` is a whole value, written as it is; NULL: null.
void jput_raw(struct jwriter *w, const char *key, const char *json);

// Closes all levels and ends the line. Fails with RELUME_ENOMEM, with RELUME_EIO when the stream
// failed, and with RELUME_EINVAL when a key was missing, an array was given one, or levels did not
// fit.
relume_status jend(struct jwriter *w);
// The text in memory with all levels closed, ending with zero, to be freed with mem_free(); `*size`
// without the zero (may be NULL). NULL after an error. Frees what the writer holds.
char *jtake(struct jwriter *w, size_t *size);
// jend(), then the text in memory becomes the file `path`: also the errors of outfile_save(). Frees
// what the writer holds.
relume_status jsave(struct jwriter *w, const char *path, const struct relume_log *log);
// The same of the file `name` in a folder.
relume_status jsave_in(struct jwriter *w, const char *folder, const char *name,
                       const struct relume_log *log);
// Keeps the first error, of a caller that cannot make a value.
void jfail(struct jwriter *w, relume_status status);
// Frees the memory of a writer that is given up. A zeroed one is fine.
void jdrop(struct jwriter *w);

// A finite number as jput_number() writes it with 0 digits, for texts that are not JSON.
struct jnumber {
    char text[32];
};
struct jnumber jnumber_text(double value);

#endif
