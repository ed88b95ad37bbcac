// mesh_ply.c - the Stanford polygon format (Turk 1994): ascii, binary little and big endian
//
// A header declares elements and their properties; the body holds them in that order. Positions,
// normals, texture coordinates and colours of `vertex`, the index list of `face` and the comment
// TextureFile are used, the rest is read past.
#include "core/base/tree.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "shape/mesh/mesh_file.h"

#include <stdio.h>
#include <string.h>

enum { MAX_ELEMENTS = 16, MAX_PROPERTIES = 64, MAX_CORNERS = 4096 };
enum form { FORM_NONE, FORM_ASCII, FORM_LITTLE, FORM_BIG };
enum type { TYPE_NONE, INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64 };
enum use {
    USE_NONE,
    USE_X,
    USE_Y,
    USE_Z,
    USE_NX,
    USE_NY,
    USE_NZ,
    USE_U,
    USE_V,
    USE_RED,
    USE_GREEN,
    USE_BLUE,
    USE_ALPHA,
    USE_CORNERS,
    USES
};

struct property {
    enum type count;  // of a list's length; TYPE_NONE: not a list
    enum type type;
    enum use use;
};

struct element {
    bool is_vertex, is_face;
    unsigned long long count;
    int properties;
    struct property property[MAX_PROPERTIES];
};

struct ply {
    const char *at, *end;
    enum form form;
    int elements;
    struct element element[MAX_ELEMENTS];
    bool has_normals, has_colours;
    struct mesh_file *out;
    const char *path;
    const struct relume_log *log;
};

static relume_status refuse(const struct ply *p, relume_status status, const char *what)
{
    return log_fail(p->log, status, "%s: %s", p->path, what);
}

static relume_status bad(const struct ply *p, const char *what)
{
    return refuse(p, RELUME_EFORMAT, what);
}

// ---------------------------------------------------------------- header

static enum type type_named(const char *name)
{
    static const struct {
        const char *name, *alias;
    } types[] = {
        [INT8] = {"char", "int8"},        [UINT8] = {"uchar", "uint8"},
        [INT16] = {"short", "int16"},     [UINT16] = {"ushort", "uint16"},
        [INT32] = {"int", "int32"},       [UINT32] = {"uint", "uint32"},
        [FLOAT32] = {"float", "float32"}, [FLOAT64] = {"double", "float64"},
    };
    for (int t = INT8; t <= FLOAT64; t++)
        if (!strcmp(name, types[t].name) || !strcmp(name, types[t].alias))
            return (enum type)t;
    return TYPE_NONE;
}

static enum use use_named(const char *name)
{
    static const struct {
        const char *name;
        enum use use;
    } uses[] = {
        {"x", USE_X},
        {"y", USE_Y},
        {"z", USE_Z},
        {"nx", USE_NX},
        {"ny", USE_NY},
        {"nz", USE_NZ},
        {"u", USE_U},
        {"v", USE_V},
        {"s", USE_U},
        {"t", USE_V},
        {"texture_u", USE_U},
        {"texture_v", USE_V},
        {"red", USE_RED},
        {"green", USE_GREEN},
        {"blue", USE_BLUE},
        {"alpha", USE_ALPHA},
        {"vertex_indices", USE_CORNERS},
        {"vertex_index", USE_CORNERS},
    };
    for (size_t i = 0; i < sizeof uses / sizeof *uses; i++)
        if (!strcmp(name, uses[i].name))
            return uses[i].use;
    return USE_NONE;
}

static relume_status read_property(struct ply *p, const char *line)
{
    char a[32], b[32], c[64];
    struct property new = {TYPE_NONE};
    if (sscanf(line, "property list %31s %31s %63s", a, b, c) == 3)
        new = (struct property){type_named(a), type_named(b), use_named(c)};
    else if (sscanf(line, "property %31s %63s", a, c) == 2)
        new = (struct property){TYPE_NONE, type_named(a), use_named(c)};
    const bool list = !strncmp(line, "property list", 13);
    if (!p->elements || new.type == TYPE_NONE || (list && new.count == TYPE_NONE) ||
        new.count >= FLOAT32)
        return bad(p, "a property in the header cannot be understood");
    struct element *e = &p->element[p->elements - 1];
    if (e->properties == MAX_PROPERTIES)
        return refuse(p, RELUME_ELIMIT, "more than 64 properties in one element");
    // A list is only asked for corners, a plain number never.
    if (list != (new.use == USE_CORNERS))
        new.use = USE_NONE;
    p->has_normals |= e->is_vertex && new.use == USE_NX;
    p->out->has_uv |= e->is_vertex && new.use == USE_U;
    p->has_colours |= e->is_vertex && new.use == USE_RED;
    e->property[e->properties++] = new;
    return RELUME_OK;
}

static relume_status read_element(struct ply *p, const char *line)
{
    char name[64];
    struct element new = {.is_vertex = false};
    if (sscanf(line, "element %63s %llu", name, &new.count) != 2 || new.count > UINT32_MAX)
        return bad(p, "an element in the header cannot be understood");
    if (p->elements == MAX_ELEMENTS)
        return refuse(p, RELUME_ELIMIT, "more than 16 elements");
    new.is_vertex = !strcmp(name, "vertex");
    new.is_face = !strcmp(name, "face");
    p->element[p->elements++] = new;
    return RELUME_OK;
}

static relume_status read_format(struct ply *p, const char *line)
{
    char name[32];
    if (sscanf(line, "format %31s 1.0", name) == 1)
        p->form = !strcmp(name, "ascii")                  ? FORM_ASCII
                  : !strcmp(name, "binary_little_endian") ? FORM_LITTLE
                  : !strcmp(name, "binary_big_endian")    ? FORM_BIG
                                                          : FORM_NONE;
    return p->form
               ? RELUME_OK
               : refuse(p, RELUME_EUNSUPPORTED, "unknown PLY format; expected ascii or binary 1.0");
}

static bool header_line(struct ply *p, char *line, size_t capacity)
{
    const size_t left = (size_t)(p->end - p->at);
    const char *newline = memchr(p->at, '\n', left);
    const size_t length = newline ? (size_t)(newline - p->at) : left;
    if (!newline || length >= capacity)
        return false;
    memcpy(line, p->at, length);
    line[length] = '\0';
    line[strcspn(line, "\r")] = '\0';
    p->at = newline + 1;
    return true;
}

// As MeshLab names the texture of the whole.
static relume_status take_picture(struct ply *p, const char *name)
{
    p->out->picture = path_beside(p->path, name);
    return p->out->picture ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status read_header(struct ply *p)
{
    static const char picture[] = "comment TextureFile ";
    char line[1024];
    if (!header_line(p, line, sizeof line) || strcmp(line, "ply"))
        return bad(p, "not a PLY file");
    relume_status status = RELUME_OK;
    while (!status) {
        if (!header_line(p, line, sizeof line))
            return bad(p, "the header does not end");
        if (!strcmp(line, "end_header"))
            break;
        if (!strncmp(line, "format ", 7))
            status = read_format(p, line);
        else if (!strncmp(line, picture, strlen(picture)) && !p->out->picture)
            status = take_picture(p, line + strlen(picture));
        else if (!strncmp(line, "element ", 8))
            status = read_element(p, line);
        else if (!strncmp(line, "property ", 9))
            status = read_property(p, line);
    }
    return status || p->form ? status : bad(p, "no format line in the header");
}

// ---------------------------------------------------------------- body

static bool read_ascii(struct ply *p, double *out)
{
    char *end;
    *out = strtod(p->at, &end);
    const bool found = end != p->at;
    p->at = end;
    return found;
}

static double value_of(uint64_t bits, enum type type)
{
    float f;
    double d;
    const uint32_t low = (uint32_t)bits;
    switch (type) {
    case INT8: return (int8_t)bits;
    case INT16: return (int16_t)bits;
    case INT32: return (int32_t)bits;
    case FLOAT32: memcpy(&f, &low, sizeof f); return (double)f;
    case FLOAT64: memcpy(&d, &bits, sizeof d); return d;
    default: return (double)bits;
    }
}

static bool read_value(struct ply *p, enum type type, double *out)
{
    static const size_t sizes[] = {[INT8] = 1,  [UINT8] = 1,  [INT16] = 2,   [UINT16] = 2,
                                   [INT32] = 4, [UINT32] = 4, [FLOAT32] = 4, [FLOAT64] = 8};
    if (p->form == FORM_ASCII)
        return read_ascii(p, out);
    const size_t size = sizes[type];
    if ((size_t)(p->end - p->at) < size)
        return false;
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++) {
        const size_t shift = p->form == FORM_LITTLE ? i : size - 1 - i;
        bits |= (uint64_t)(unsigned char)p->at[i] << 8 * shift;
    }
    p->at += size;
    *out = value_of(bits, type);
    return true;
}

static relume_status truncated(const struct ply *p)
{
    return refuse(p, RELUME_EDAMAGED,
                  "ends too early or has something that is not a number; expected what its header "
                  "declares");
}

// As 8 bits; numbers with a point are of 1.
static uint8_t colour_byte(double value, enum type type)
{
    const double scaled = type >= FLOAT32 ? value * 255.0 : type == UINT16 ? value / 257.0 : value;
    return (uint8_t)relume_whole(fmin(fmax(scaled, 0.0), 255.0) + 0.5);
}

static void add_colour(struct ply *p, const double at[USES])
{
    struct mesh_file *out = p->out;
    const size_t vertex = out->mesh.vertex_count - 1;
    out->mesh.failed = out->mesh.failed || !mem_grow(&out->colour, vertex, sizeof *out->colour);
    for (int c = 0; !out->mesh.failed && c < 4; c++)
        out->colour[vertex][c] = (uint8_t)at[USE_RED + c];
}

static relume_status read_vertex(struct ply *p, const struct element *e)
{
    double at[USES] = {[USE_ALPHA] = 255.0};
    for (int i = 0; i < e->properties; i++) {
        const struct property *property = &e->property[i];
        double length = 1.0, value;
        if (property->count && (!read_value(p, property->count, &length) || !(length >= 0.0)))
            return truncated(p);
        for (double k = 0.0; k < length; k++) {
            if (!read_value(p, property->type, &value))
                return truncated(p);
            at[property->use] = property->use >= USE_RED && property->use <= USE_ALPHA
                                    ? colour_byte(value, property->type)
                                    : value;
        }
    }
    const vec3 normal = vec3_of(at[USE_NX], at[USE_NY], at[USE_NZ]);
    p->has_normals &= vec3_length(normal) > 0.0;
    mesh_vertex(&p->out->mesh, vec3_of(at[USE_X], at[USE_Y], at[USE_Z]),
                p->has_normals ? vec3_unit(normal) : normal, vec3_of(at[USE_U], at[USE_V], 0.0));
    if (p->has_colours)
        add_colour(p, at);
    return RELUME_OK;
}

static relume_status read_list(struct ply *p, const struct property *property, double length)
{
    uint32_t first = 0, last = 0;
    const double vertices = (double)p->out->mesh.vertex_count;
    for (int k = 0; k < length; k++) {
        double value;
        if (!read_value(p, property->type, &value))
            return truncated(p);
        if (property->use != USE_CORNERS)
            continue;
        if (!(value >= 0.0 && value < vertices))
            return refuse(p, RELUME_EDAMAGED, "a face names a vertex that does not exist");
        const uint32_t vertex = (uint32_t)value;
        if (k == 0)
            first = vertex;
        if (k >= 2)
            mesh_triangle(&p->out->mesh, first, last, vertex, 0);
        last = vertex;
    }
    return RELUME_OK;
}

static relume_status read_item(struct ply *p, const struct element *e)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < e->properties && !status; i++) {
        const struct property *property = &e->property[i];
        struct property plain = *property;
        plain.use = e->is_face ? property->use : USE_NONE;
        double length = 1.0;
        if (property->count && !read_value(p, property->count, &length))
            return truncated(p);
        if (!(length >= 0.0 && length <= MAX_CORNERS))
            return refuse(p, RELUME_ELIMIT, "a list of more than 4096 entries");
        status = read_list(p, &plain, length);
    }
    return status;
}

static relume_status read_body(struct ply *p)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < p->elements; i++) {
        const struct element *e = &p->element[i];
        // Items without properties take no bytes: a count of billions would only spin.
        for (unsigned long long k = 0; k < e->count && e->properties && !status; k++) {
            status = e->is_vertex ? read_vertex(p, e) : read_item(p, e);
            if (p->out->mesh.failed)
                status = RELUME_ENOMEM;
        }
    }
    return status;
}

relume_status mesh_read_ply(struct mesh_file *out, const char *text, size_t size, const char *path,
                            const struct relume_log *log)
{
    struct ply p = {.at = text, .end = text + size, .out = out, .path = path, .log = log};
    relume_status status = read_header(&p);
    if (!status)
        status = read_body(&p);
    out->made_normals = !p.has_normals;
    if (!status && !p.has_normals && !out->mesh.failed)
        mesh_smooth(&out->mesh);
    return status;
}
