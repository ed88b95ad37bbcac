// json_write.c - writing JSON (RFC 8259)
#include "core/base/json_write.h"

#include "core/base/memory.h"

#include <math.h>
#include <string.h>

enum { MAX_DEPTH = 64, FIRST_CAPACITY = 1024, MAX_DIGITS = 17 };

// ---------------------------------------------------------------- bytes

void jfail(struct jwriter *w, relume_status status)
{
    w->status = w->status ? w->status : status;
}

static bool grow_text(struct jwriter *w, size_t n)
{
    if (n <= w->capacity - w->size)
        return true;
    const size_t capacity = 2 * (w->size + n) + FIRST_CAPACITY;
    char *grown = mem_resize(w->text, capacity, 1);
    if (!grown)
        return false;
    w->text = grown;
    w->capacity = capacity;
    return true;
}

static void put_bytes(struct jwriter *w, const char *bytes, size_t n)
{
    if (w->status || !n)
        return;
    if (w->file) {
        fwrite(bytes, 1, n, w->file);
    } else if (grow_text(w, n)) {
        memcpy(w->text + w->size, bytes, n);
        w->size += n;
    } else {
        jfail(w, RELUME_ENOMEM);
    }
}

static void put(struct jwriter *w, const char *text)
{
    put_bytes(w, text, strlen(text));
}

static void put_gap(struct jwriter *w, const char *usual)
{
    put(w, w->gap ? w->gap : usual);
    w->gap = NULL;
}

// ---------------------------------------------------------------- texts

// JSON writes characters beyond the first 65536 as two halves.
static void put_escape(struct jwriter *w, uint32_t code)
{
    static const char letters[] = "\"\\bfnrt", codes[] = "\"\\\b\f\n\r\t";
    const char *short_form = code < 0x80 && code ? strchr(codes, (int)code) : NULL;
    char text[16];
    if (short_form)
        snprintf(text, sizeof text, "\\%c", letters[short_form - codes]);
    else if (code < 0x10000)
        snprintf(text, sizeof text, "\\u%04x", (unsigned)code);
    else
        snprintf(text, sizeof text, "\\u%04x\\u%04x", 0xd800 + (unsigned)((code - 0x10000) >> 10),
                 0xdc00 + (unsigned)(code & 0x3ff));
    put(w, text);
}

static bool needs_escape(const struct jwriter *w, uint32_t code)
{
    return code < 0x20 || code == '"' || code == '\\' || code == 0xfffd ||
           ((w->style & JSON_MARKUP) && (code == '<' || code == '>' || code == '&')) ||
           ((w->style & JSON_TERMINAL) && !relume_text_harmless(code));
}

static void put_quoted(struct jwriter *w, const char *text)
{
    uint32_t code;
    put(w, "\"");
    for (int n; (n = relume_text_step(&code, text)); text += n) {
        if (needs_escape(w, code))
            put_escape(w, code);
        else
            put_bytes(w, text, (size_t)n);
    }
    put(w, "\"");
}

// ---------------------------------------------------------------- structure

static bool in_object(const struct jwriter *w)
{
    return w->depth && w->objects >> (w->depth - 1) & 1;
}

static void begin_value(struct jwriter *w, const char *key)
{
    const bool dense = w->style & JSON_DENSE;
    if (in_object(w) != (key != NULL) || (!w->depth && w->comma))
        jfail(w, RELUME_EINVAL);
    put(w, w->comma ? "," : "");
    put_gap(w, w->comma && !dense ? " " : "");
    w->comma = true;
    if (!key)
        return;
    put_quoted(w, key);
    put(w, dense ? ":" : ": ");
}

static void open_level(struct jwriter *w, const char *key, bool object)
{
    begin_value(w, key);
    put(w, object ? "{" : "[");
    if (w->depth == MAX_DEPTH) {
        jfail(w, RELUME_EINVAL);
        return;
    }
    const uint64_t bit = (uint64_t)1 << w->depth++;
    w->objects = object ? w->objects | bit : w->objects & ~bit;
    w->comma = false;
}

void jopen_object(struct jwriter *w, const char *key)
{
    open_level(w, key, true);
}

void jopen_array(struct jwriter *w, const char *key)
{
    open_level(w, key, false);
}

void jclose(struct jwriter *w)
{
    if (!w->depth) {
        jfail(w, RELUME_EINVAL);
        return;
    }
    put_gap(w, "");
    put(w, in_object(w) ? "}" : "]");
    w->depth--;
    w->comma = true;
}

void jclose_levels(struct jwriter *w, int levels)
{
    for (int i = 0; i < levels; i++)
        jclose(w);
}

void jgap(struct jwriter *w, const char *space)
{
    w->gap = space;
}

// ---------------------------------------------------------------- values

void jput_raw(struct jwriter *w, const char *key, const char *json)
{
    begin_value(w, key);
    put(w, json ? json : "null");
}

void jput_null(struct jwriter *w, const char *key)
{
    jput_raw(w, key, NULL);
}

void jput_truth(struct jwriter *w, const char *key, bool value)
{
    jput_raw(w, key, value ? "true" : "false");
}

void jput_text(struct jwriter *w, const char *key, const char *text)
{
    if (!text) {
        jput_null(w, key);
        return;
    }
    begin_value(w, key);
    put_quoted(w, text);
}

void jput_integer(struct jwriter *w, const char *key, long long value)
{
    char text[24];
    snprintf(text, sizeof text, "%lld", value);
    jput_raw(w, key, text);
}

// The point of the locale may be a comma, and may have several bytes.
static void set_point(char *number)
{
    char *to = number;
    for (const char *from = number; *from; from++) {
        if (strchr("0123456789+-e", *from))
            *to++ = *from;
        else if (to == number || to[-1] != '.')
            *to++ = '.';
    }
    *to = '\0';
}

struct jnumber jnumber_text(double value)
{
    struct jnumber out;
    snprintf(out.text, sizeof out.text, "%.15g", value);
    if (strtod(out.text, NULL) != value)
        snprintf(out.text, sizeof out.text, "%.17g", value);
    set_point(out.text);
    return out;
}

static int digits_of(int digits)
{
    return digits < MAX_DIGITS ? digits : MAX_DIGITS;
}

void jput_number(struct jwriter *w, const char *key, double value, int digits)
{
    struct jnumber number = {""};
    if (digits <= 0 && isfinite(value)) {
        number = jnumber_text(value);
    } else {
        snprintf(number.text, sizeof number.text, "%.*g", digits_of(digits), value);
        set_point(number.text);
    }
    jput_raw(w, key, isfinite(value) ? number.text : NULL);
}

void jput_fixed(struct jwriter *w, const char *key, double value, int decimals)
{
    char text[352];  // 309 digits of the largest double, sign, point, decimals
    snprintf(text, sizeof text, "%.*f", digits_of(decimals), value);
    set_point(text);
    jput_raw(w, key, isfinite(value) ? text : NULL);
}

void jput_numbers(struct jwriter *w, const char *key, const double *value, size_t count, int digits)
{
    jopen_array(w, key);
    for (size_t i = 0; i < count; i++)
        jput_number(w, NULL, value[i], digits);
    jclose(w);
}

void jput_floats(struct jwriter *w, const char *key, const float *value, size_t count, int digits)
{
    jopen_array(w, key);
    for (size_t i = 0; i < count; i++)
        jput_number(w, NULL, (double)value[i], digits);
    jclose(w);
}

void jput_vector(struct jwriter *w, const char *key, struct relume_vec3 value, int digits)
{
    jput_numbers(w, key, (const double[]){value.x, value.y, value.z}, 3, digits);
}

void jput_texts(struct jwriter *w, const char *key, const char *const *text, size_t count)
{
    jopen_array(w, key);
    for (size_t i = 0; i < count; i++)
        jput_text(w, NULL, text[i]);
    jclose(w);
}

// ---------------------------------------------------------------- the end

relume_status jend(struct jwriter *w)
{
    jclose_levels(w, w->depth);
    put(w, "\n");
    if (w->file && ferror(w->file))
        jfail(w, RELUME_EIO);
    return w->status;
}

char *jtake(struct jwriter *w, size_t *size)
{
    jclose_levels(w, w->depth);
    put_bytes(w, "", 1);
    char *text = w->status ? NULL : w->text;
    if (text)
        w->text = NULL;
    if (size)
        *size = text ? w->size - 1 : 0;
    jdrop(w);
    return text;
}

void jdrop(struct jwriter *w)
{
    mem_free(w->text);
    w->text = NULL;
    w->size = w->capacity = 0;
}
