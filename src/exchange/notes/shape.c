// shape.c - points, lines and polygons as selectors
//
// Of SVG the straight shapes are read that annotation tools write. Curves are none of ours: they
// would come back as something else.
#include "exchange/notes/shape.h"

#include "core/base/memory.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include <strings.h>

void shape_free(struct shape *shape)
{
    mem_free(shape->place);
    mem_free(shape->z);
    *shape = (struct shape){.places = 0};
}

// ---------------------------------------------------------------- numbers of a text

static const char *skip(const char *at)
{
    return at + strspn(at, " \t\r\n,");
}

// The next number; NULL when there is none. No hexadecimal numbers, no infinities.
static const char *number(double *out, const char *at)
{
    char *end;
    at = skip(at);
    if (!strchr("+-.0123456789", *at) || !*at || tolower((unsigned char)at[1]) == 'x')
        return NULL;
    *out = strtod(at, &end);
    return end == at || !isfinite(*out) ? NULL : end;
}

static bool add(struct shape *s, double x, double y, relume_status *status)
{
    if (s->places == RELUME_NOTE_MOST_PLACES) {
        *status = RELUME_EFORMAT;
        return false;
    }
    if (!mem_grow(&s->place, (size_t)s->places, sizeof *s->place)) {
        *status = RELUME_ENOMEM;
        return false;
    }
    s->place[s->places][0] = x;
    s->place[s->places++][1] = y;
    return true;
}

static bool add_deep(struct shape *s, const double at[3], relume_status *status)
{
    if (!mem_grow(&s->z, (size_t)s->places, sizeof *s->z)) {
        *status = RELUME_ENOMEM;
        return false;
    }
    s->z[s->places] = at[2];
    return add(s, at[0], at[1], status);
}

// ---------------------------------------------------------------- well-known text

static const char *word(const char *at, const char *wanted)
{
    const size_t n = strlen(wanted);
    at += strspn(at, " \t\r\n");
    return strncasecmp(at, wanted, n) ? NULL : at + n;
}

// The places of a ring or line, and what closes it; NULL where it breaks the grammar.
static const char *read_ring(struct shape *s, const char *at, relume_status *status)
{
    for (;;) {
        double v[3];
        for (int c = 0; c < 3; c++)
            if (!(at = number(&v[c], at)))
                return NULL;
        if (!add_deep(s, v, status))
            return NULL;
        const char *more = word(at, ",");
        if (!more)
            return word(at, ")");
        at = more;
    }
}

// "LINESTRING Z (0 0 0, 1 0 0)" and "POLYGON Z ((0 0 0, 1 0 0, 0 1 0, 0 0 0))", of one ring.
static relume_status read_text(struct shape *s, const char *text)
{
    relume_status status = RELUME_OK;
    const char *at = word(text, "LINESTRING");
    s->kind = at ? RELUME_NOTE_LINE : RELUME_NOTE_POLYGON;
    if (!at && !(at = word(text, "POLYGON")))
        return RELUME_EUNSUPPORTED;
    const bool ring = s->kind == RELUME_NOTE_POLYGON;
    if (!(at = word(at, "Z")) || !(at = word(at, "(")) || (ring && !(at = word(at, "("))))
        return RELUME_EFORMAT;
    at = read_ring(s, at, &status);
    if (status)
        return status;
    if (!at || (ring && !(at = word(at, ")"))) || *skip(at))
        return RELUME_EFORMAT;
    const int last = s->places - 1;
    if (ring && last > 0 && !memcmp(s->place[0], s->place[last], sizeof *s->place) &&
        !memcmp(&s->z[0], &s->z[last], sizeof *s->z))
        s->places--;
    return RELUME_OK;
}

// ---------------------------------------------------------------- SVG

// The value of an attribute within the tag that begins at `tag`, of at most `most` bytes without
// its end; false where there is none.
static bool attribute(char *out, size_t most, const char *tag, const char *name)
{
    const char *end = strchr(tag, '>');
    const size_t n = strlen(name);
    for (const char *at = tag; end && (at = strstr(at, name)) && at < end; at += n) {
        const char *value = at + n + strspn(at + n, " ");
        if (!isspace((unsigned char)at[-1]) || *value != '=')
            continue;
        value += 1 + strspn(value + 1, " ");
        const char *close = *value == '"' || *value == '\'' ? strchr(value + 1, *value) : NULL;
        if (!close || close > end || (size_t)(close - value) > most)
            return false;
        memcpy(out, value + 1, (size_t)(close - value - 1));
        out[close - value - 1] = '\0';
        return true;
    }
    return false;
}

static bool attribute_number(double *out, const char *tag, const char *name)
{
    char text[64];
    const char *end = attribute(text, sizeof text, tag, name) ? number(out, text) : NULL;
    return end && (!*skip(end) || !strcmp(end, "px"));
}

// Of a path: M, L, H, V and Z, absolute and relative, of one part.
static relume_status read_path(struct shape *s, const char *at)
{
    relume_status status = RELUME_OK;
    double here[2] = {0.0, 0.0};
    char command = 0;
    s->kind = RELUME_NOTE_LINE;
    for (at = skip(at); *at; at = skip(at)) {
        if (isalpha((unsigned char)*at)) {
            if (toupper((unsigned char)*at) == 'M' && s->places)
                return RELUME_EUNSUPPORTED;
            command = *at++;
            if (toupper((unsigned char)command) == 'Z') {
                s->kind = RELUME_NOTE_POLYGON;
                return *skip(at) ? RELUME_EUNSUPPORTED : RELUME_OK;
            }
            continue;
        }
        const int upper = toupper((unsigned char)command);
        if (!command || !strchr("MLHV", upper))
            return command ? RELUME_EUNSUPPORTED : RELUME_EFORMAT;
        for (int k = upper == 'V'; k < 1 + (upper != 'H'); k++) {
            double value;
            if (!(at = number(&value, at)))
                return RELUME_EFORMAT;
            here[k] = value + (islower((unsigned char)command) ? here[k] : 0.0);
        }
        if (!add(s, here[0], here[1], &status))
            return status;
    }
    return RELUME_OK;
}

static relume_status read_points(struct shape *s, const char *at)
{
    relume_status status = RELUME_OK;
    double x, y;
    while (*(at = skip(at))) {
        if (!(at = number(&x, at)) || !(at = number(&y, at)))
            return RELUME_EFORMAT;
        if (!add(s, x, y, &status))
            break;
    }
    return status;
}

static relume_status read_box(struct shape *s, double x, double y, double width, double height)
{
    relume_status status = RELUME_OK;
    s->kind = RELUME_NOTE_POLYGON;
    (void)(add(s, x, y, &status) && add(s, x + width, y, &status) &&
           add(s, x + width, y + height, &status) && add(s, x, y + height, &status));
    return status;
}

static relume_status read_tag(struct shape *s, const char *tag, char *scratch, size_t size)
{
    const char *name = tag + 1;
    double v[4];
    if (!strncmp(name, "path", 4))
        return attribute(scratch, size, tag, "d") ? read_path(s, scratch) : RELUME_EFORMAT;
    if (!strncmp(name, "polyline", 8) || !strncmp(name, "polygon", 7)) {
        s->kind = name[4] == 'l' ? RELUME_NOTE_LINE : RELUME_NOTE_POLYGON;
        return attribute(scratch, size, tag, "points") ? read_points(s, scratch) : RELUME_EFORMAT;
    }
    if (!strncmp(name, "rect", 4))
        return attribute_number(&v[0], tag, "x") && attribute_number(&v[1], tag, "y") &&
                       attribute_number(&v[2], tag, "width") &&
                       attribute_number(&v[3], tag, "height")
                   ? read_box(s, v[0], v[1], v[2], v[3])
                   : RELUME_EFORMAT;
    relume_status status = RELUME_OK;
    if (!strncmp(name, "line", 4)) {
        s->kind = RELUME_NOTE_LINE;
        if (!attribute_number(&v[0], tag, "x1") || !attribute_number(&v[1], tag, "y1") ||
            !attribute_number(&v[2], tag, "x2") || !attribute_number(&v[3], tag, "y2"))
            return RELUME_EFORMAT;
        (void)(add(s, v[0], v[1], &status) && add(s, v[2], v[3], &status));
        return status;
    }
    s->kind = RELUME_NOTE_POINT;
    if (!attribute_number(&v[0], tag, "cx") || !attribute_number(&v[1], tag, "cy"))
        return RELUME_EFORMAT;
    (void)add(s, v[0], v[1], &status);
    return status;
}

static relume_status read_svg(struct shape *s, const char *svg)
{
    static const char *const shapes[] = {"<path", "<polyline", "<polygon",
                                         "<rect", "<line",     "<circle"};
    const char *tag = NULL;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        for (const char *at = svg; (at = strstr(at, shapes[i])); at++)
            if (isspace((unsigned char)at[strlen(shapes[i])])) {
                if (tag)
                    return RELUME_EUNSUPPORTED;
                tag = at;
            }
    if (!tag || strstr(svg, "transform"))
        return RELUME_EUNSUPPORTED;
    const size_t size = strlen(tag) + 1;
    char *scratch = mem_array(size, 1);
    const relume_status status = scratch ? read_tag(s, tag, scratch, size) : RELUME_ENOMEM;
    mem_free(scratch);
    return status;
}

// ---------------------------------------------------------------- selectors

relume_status shape_read_fragment(struct shape *s, const char *text)
{
    double v[4];
    *s = (struct shape){.kind = RELUME_NOTE_POINT};
    if (strncmp(text, "xywh=", 5))
        return RELUME_EUNSUPPORTED;
    text += 5;
    if (!strncmp(text, "pixel:", 6))
        text += 6;
    for (int i = 0; i < 4; i++)
        if (!(text = number(&v[i], text)))
            return RELUME_EFORMAT;
    return *skip(text) ? RELUME_EFORMAT : read_box(s, v[0], v[1], v[2], v[3]);
}

static relume_status read_point(struct shape *out, const jvalue *selector)
{
    const jvalue *deep = jvalue_member(selector, "z");
    relume_status status = RELUME_OK;
    double at[3];
    if (!jvalue_number(jvalue_member(selector, "x"), &at[0]) ||
        !jvalue_number(jvalue_member(selector, "y"), &at[1]) ||
        (deep && !jvalue_number(deep, &at[2])))
        return RELUME_EFORMAT;
    (void)(deep ? add_deep(out, at, &status) : add(out, at[0], at[1], &status));
    return status;
}

relume_status shape_read(struct shape *out, const jvalue *selector)
{
    const char *type = jvalue_text(jvalue_member(selector, "type"));
    const char *value = jvalue_text(jvalue_member(selector, "value"));
    relume_status status = RELUME_EUNSUPPORTED;
    *out = (struct shape){.kind = RELUME_NOTE_POINT};
    if (type && !strcmp(type, "PointSelector"))
        status = read_point(out, selector);
    else if (type && value && !strcmp(type, "WktSelector"))
        status = read_text(out, value);
    else if (type && value && !strcmp(type, "SvgSelector"))
        status = read_svg(out, value);
    else if (type && value && !strcmp(type, "FragmentSelector"))
        status = shape_read_fragment(out, value);
    if (status)
        shape_free(out);
    return status;
}

void shape_print_path(FILE *f, const struct relume_note *note)
{
    for (int i = 0; i < note->places; i++)
        fprintf(f, "%s%s,%s", i ? " L" : "M", jnumber_text(note->place[i][0]).text,
                jnumber_text(note->place[i][1]).text);
    if (note->kind == RELUME_NOTE_POLYGON)
        fputs(" Z", f);
}

// A line or polygon on an object; the ring of a polygon ends where it began.
static void print_deep(FILE *f, const struct relume_note *note)
{
    const bool closed = note->kind == RELUME_NOTE_POLYGON;
    fputs(closed ? "POLYGON Z ((" : "LINESTRING Z (", f);
    for (int i = 0; i < note->places + closed; i++) {
        const int k = i % note->places;
        fprintf(f, "%s%s %s %s", i ? ", " : "", jnumber_text(note->place[k][0]).text,
                jnumber_text(note->place[k][1]).text, jnumber_text(note->z[k]).text);
    }
    fputs(closed ? "))" : ")", f);
}

static void print_flat(FILE *f, const struct relume_note *note)
{
    fputs("<svg xmlns='http://www.w3.org/2000/svg'><path d='", f);
    shape_print_path(f, note);
    fputs("'/></svg>", f);
}

static void put_point(struct jwriter *w, const char *key, const struct relume_note *note)
{
    jopen_object(w, key);
    jput_text(w, "type", "PointSelector");
    jput_number(w, "x", note->place[0][0], 0);
    jput_number(w, "y", note->place[0][1], 0);
    if (note->z)
        jput_number(w, "z", note->z[0], 0);
    jclose(w);
}

void shape_put(struct jwriter *w, const char *key, const struct relume_note *note)
{
    if (note->kind == RELUME_NOTE_POINT) {
        put_point(w, key, note);
        return;
    }
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);
    if (f)
        (note->z ? print_deep : print_flat)(f, note);
    if (!f || fclose(f))
        jfail(w, RELUME_ENOMEM);
    jopen_object(w, key);
    jput_text(w, "type", note->z ? "WktSelector" : "SvgSelector");
    jput_text(w, "value", text);
    jclose(w);
    mem_free_libc(text);
}
