// mesh_obj.c - Wavefront OBJ: v, vt, vn, f, mtllib, usemtl and g; every other keyword is passed
// over
#include "core/base/tree.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "shape/mesh/mesh_file.h"

#include <errno.h>
#include <string.h>

// One of the file's three lists of vectors.
struct list {
    vec3 *at;
    size_t count;
};

struct corner {
    long v, vt, vn;  // 0: not given
};

struct obj {
    struct list v, vt, vn;
    struct list colour;  // behind positions, as many write them: as many as `v`, or none
    struct mesh_file *out;
    const char *path;
    const struct relume_log *log;
    int line;
    bool own_normals;     // every corner so far has a normal
    uint32_t *smooth_of;  // vertex -> position number
    bool has_materials;   // parts go by usemtl, else by g
    uint32_t part;
    struct mesh_library library;
};

static relume_status push(struct list *list, vec3 v)
{
    if (!mem_grow(&list->at, list->count, sizeof *list->at))
        return RELUME_ENOMEM;
    list->at[list->count++] = v;
    return RELUME_OK;
}

static relume_status bad_line(const struct obj *o, const char *expected)
{
    return log_fail(o->log, RELUME_EFORMAT, "%s: line %d: expected %s", o->path, o->line, expected);
}

static relume_status read_vector(const struct obj *o, struct list *list, char *text, int least)
{
    double x[3] = {0};
    int n = 0;
    for (char *end; n < 3; n++, text = end) {
        x[n] = strtod(text, &end);
        if (end == text)
            break;
    }
    if (n < least || !isfinite(x[0]) || !isfinite(x[1]) || !isfinite(x[2]))
        return bad_line(o, least == 1 ? "texture coordinates" : "three finite numbers");
    return push(list, vec3_of(x[0], x[1], x[2]));
}

// x y z, and maybe red green blue of 1.
static relume_status read_position(struct obj *o, char *text)
{
    double rgb[3];
    int n = 0;
    relume_status status = read_vector(o, &o->v, text, 3);
    for (int skip = 0; skip < 3; skip++)
        (void)strtod(text, &text);
    for (char *end; n < 3; n++, text = end) {
        rgb[n] = strtod(text, &end);
        if (end == text || !isfinite(rgb[n]))
            break;
    }
    // a fourth number alone is a weight
    if (!status && n == 3 && o->colour.count + 1 == o->v.count)
        status = push(&o->colour, vec3_of(rgb[0], rgb[1], rgb[2]));
    return status;
}

// Counted from 1, or from the end when negative, as the format says; 0 when out of range.
static long resolve(long index, const struct list *list)
{
    if (index < 0)
        index += (long)list->count + 1;
    return index >= 1 && index <= (long)list->count ? index : 0;
}

static bool read_index(char **text, const struct list *list, long *out)
{
    char *end;
    errno = 0;
    const long index = strtol(*text, &end, 10);
    if (end == *text || errno)
        return false;
    *text = end;
    *out = resolve(index, list);
    return *out != 0;
}

// v, v/vt, v//vn or v/vt/vn.
static bool read_corner(const struct obj *o, char **text, struct corner *c)
{
    *c = (struct corner){0};
    if (!read_index(text, &o->v, &c->v))
        return false;
    if (**text != '/')
        return true;
    ++*text;
    if (**text != '/' && !read_index(text, &o->vt, &c->vt))
        return false;
    if (**text != '/')
        return true;
    ++*text;
    return read_index(text, &o->vn, &c->vn);
}

// Corners become vertices of their own: what shares a position may differ in the rest.
static uint32_t add_corner(struct obj *o, struct corner c)
{
    struct mesh *mesh = &o->out->mesh;
    const vec3 zero = vec3_of(0, 0, 0);
    const vec3 normal = c.vn ? o->vn.at[c.vn - 1] : zero;
    o->own_normals &= vec3_length(normal) > 0.0;
    o->out->has_uv |= c.vt != 0;
    const uint32_t vertex =
        mesh_vertex(mesh, o->v.at[c.v - 1], vec3_length(normal) > 0.0 ? vec3_unit(normal) : normal,
                    c.vt ? o->vt.at[c.vt - 1] : zero);
    mesh->failed = mesh->failed || !mem_grow(&o->smooth_of, vertex, sizeof *o->smooth_of);
    if (!mesh->failed)
        o->smooth_of[vertex] = (uint32_t)(c.v - 1);
    return vertex;
}

static relume_status read_face(struct obj *o, char *text)
{
    uint32_t first = 0, last = 0;
    int corners = 0;
    for (text += strspn(text, " \t"); *text; text += strspn(text, " \t"), corners++) {
        struct corner c;
        if (!read_corner(o, &text, &c) || (*text && *text != ' ' && *text != '\t'))
            return bad_line(o, "corners v/vt/vn that were listed before");
        const uint32_t vertex = add_corner(o, c);
        if (corners == 0)
            first = vertex;
        if (corners >= 2)
            mesh_triangle(&o->out->mesh, first, last, vertex, o->part);
        last = vertex;
    }
    if (!o->out->parts && mesh_file_part(o->out, "all") < 0)
        return RELUME_ENOMEM;
    if (corners < 3)
        return bad_line(o, "a face of at least three corners");
    return o->out->mesh.failed ? RELUME_ENOMEM : RELUME_OK;
}

static relume_status read_library(struct obj *o, const char *name)
{
    char *path = path_beside(o->path, name);
    if (!path)
        return RELUME_ENOMEM;
    const relume_status status = mesh_read_mtl(&o->library, o->out, path, o->log);
    mem_free(path);
    return status;
}

static void take_looks(const struct obj *o)
{
    for (int i = 0; i < o->out->parts && o->has_materials; i++) {
        const struct mesh_look *look = mesh_library_find(&o->library, o->out->part[i]);
        if (look)
            o->out->look[i] = *look;
    }
}

// What follows belongs to this part.
static relume_status begin_part(struct obj *o, char *name, bool material)
{
    name[strcspn(name, "\r\n")] = '\0';
    for (size_t n = strlen(name); n && strchr(" \t", name[n - 1]); n--)
        name[n - 1] = '\0';
    if (!*name || (o->has_materials && !material))
        return RELUME_OK;
    o->has_materials |= material;
    const int part = mesh_file_part(o->out, name);
    if (part < 0)
        return bad_line(o, "at most 1024 parts");
    o->part = (uint32_t)part;
    return RELUME_OK;
}

static relume_status read_line(struct obj *o, char *line)
{
    line += strspn(line, " \t");
    const size_t length = strcspn(line, " \t");
    char *rest = line + length + strspn(line + length, " \t");
    if (length == 1 && line[0] == 'v')
        return read_position(o, rest);
    if (length == 1 && line[0] == 'f')
        return read_face(o, rest);
    if (length == 2 && !strncmp(line, "vt", 2))
        return read_vector(o, &o->vt, rest, 1);
    if (length == 2 && !strncmp(line, "vn", 2))
        return read_vector(o, &o->vn, rest, 3);
    if (length == 6 && !strncmp(line, "usemtl", 6))
        return begin_part(o, rest, true);
    if (length == 1 && line[0] == 'g')
        return begin_part(o, rest, false);
    if (length == 6 && !strncmp(line, "mtllib", 6))
        return read_library(o, rest);
    return RELUME_OK;
}

// Normals are made on the shared positions, then handed to every corner that stands on one.
static relume_status make_normals(const struct obj *o)
{
    struct mesh shared = {0}, *mesh = &o->out->mesh;
    for (size_t i = 0; i < o->v.count; i++)
        mesh_vertex(&shared, o->v.at[i], vec3_of(0, 0, 0), vec3_of(0, 0, 0));
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *v = mesh->triangles[i].vertex;
        mesh_triangle(&shared, o->smooth_of[v[0]], o->smooth_of[v[1]], o->smooth_of[v[2]], 0);
    }
    const bool failed = shared.failed;
    if (!failed)
        mesh_smooth(&shared);
    for (size_t i = 0; i < mesh->vertex_count && !failed; i++)
        memcpy(mesh->vertices[i].normal, shared.vertices[o->smooth_of[i]].normal,
               sizeof mesh->vertices[i].normal);
    mesh_free(&shared);
    return failed ? RELUME_ENOMEM : RELUME_OK;
}

static uint8_t colour_byte(double value)
{
    return (uint8_t)relume_whole(fmin(fmax(value, 0.0), 1.0) * 255.0 + 0.5);
}

static relume_status take_colours(const struct obj *o)
{
    const size_t count = o->out->mesh.vertex_count;
    uint8_t(*colour)[4] = mem_array(count, sizeof *colour);
    for (size_t i = 0; colour && i < count; i++) {
        const vec3 c = o->colour.at[o->smooth_of[i]];
        const uint8_t rgba[4] = {colour_byte(c.x), colour_byte(c.y), colour_byte(c.z), 255};
        memcpy(colour[i], rgba, sizeof rgba);
    }
    o->out->colour = colour;
    return colour ? RELUME_OK : RELUME_ENOMEM;
}

// Cut the next line out of `*text`, joining lines that end in a backslash; NULL at the end.
static char *next_line(char **text, const char *end, int *number)
{
    char *line = *text;
    if (line >= end)
        return NULL;
    char *at = line;
    for (;;) {
        ++*number;
        at += strcspn(at, "\n");
        if (at >= end || at == line || at[-1] != '\\')
            break;
        at[-1] = at[0] = ' ';
    }
    *text = at + 1;
    *at = '\0';
    line[strcspn(line, "#\r")] = '\0';
    return line;
}

static relume_status read_lines(struct obj *o, char *text, size_t size)
{
    relume_status status = RELUME_OK;
    const char *end = text + size;
    for (char *line; !status && (line = next_line(&text, end, &o->line));)
        status = read_line(o, line);
    return status;
}

relume_status mesh_read_obj(struct mesh_file *out, const char *text, size_t size, const char *path,
                            const struct relume_log *log)
{
    if (memchr(text, '\0', size))
        return log_fail(log, RELUME_EFORMAT, "%s: not a text file; expected an OBJ model", path);
    struct obj o = {.out = out, .path = path, .log = log, .own_normals = true};
    char *copy = mem_copy(text, size + 1, 1);
    relume_status status = copy ? read_lines(&o, copy, size) : RELUME_ENOMEM;
    out->made_normals = !o.own_normals;
    if (!status && !o.own_normals)
        status = make_normals(&o);
    if (!status && o.v.count && o.colour.count == o.v.count)
        status = take_colours(&o);
    if (!status)
        take_looks(&o);
    mesh_library_free(&o.library);
    mem_free(copy);
    mem_free(o.colour.at);
    mem_free(o.v.at);
    mem_free(o.vt.at);
    mem_free(o.vn.at);
    mem_free(o.smooth_of);
    return status;
}
