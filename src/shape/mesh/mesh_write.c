// mesh_write.c - meshes into files: the format by its ending, Wavefront OBJ and PLY
#include "shape/mesh/mesh_write.h"

#include "core/base/tree.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

// ---------------------------------------------------------------- bytes

static void flush(struct sink *s)
{
    if (!s->status && s->filled)
        s->status = outfile_write(s->file, s->buffer, s->filled, s->offset);
    s->offset += (off_t)s->filled;
    s->filled = 0;
}

void sink_put(struct sink *s, const void *bytes, size_t size)
{
    const char *from = bytes;
    while (size) {
        const size_t left = SINK_BYTES - s->filled, part = size < left ? size : left;
        memcpy(s->buffer + s->filled, from, part);
        s->filled += part;
        from += part;
        size -= part;
        if (s->filled == SINK_BYTES)
            flush(s);
    }
}

void sink_print(struct sink *s, const char *format, ...)
{
    char line[512];
    va_list list;
    va_start(list, format);
    const int length = vsnprintf(line, sizeof line, format, list);
    va_end(list);
    sink_put(s, line, (size_t)length < sizeof line ? (size_t)length : sizeof line - 1);
}

const char *mesh_write_picture(const struct relume_mesh *mesh, const char *path)
{
    const size_t folder = (size_t)path_folder(path);
    return strncmp(mesh->picture, path, folder) ? mesh->picture : mesh->picture + folder;
}

// Names may be longer than sink_print takes.
static void put_name(struct sink *to, const char *before, const char *name)
{
    sink_put(to, before, strlen(before));
    sink_put(to, name, strlen(name));
    sink_put(to, "\n", 1);
}

// ---------------------------------------------------------------- Wavefront OBJ

static void put_vertices(struct sink *to, const struct relume_mesh *m)
{
    for (size_t i = 0; i < m->vertex_count; i++) {
        const float *p = m->position[i];
        sink_print(to, "v %.9g %.9g %.9g", (double)p[0], (double)p[1], (double)p[2]);
        if (m->colour)
            sink_print(to, " %.4g %.4g %.4g", m->colour[i][0] / 255.0, m->colour[i][1] / 255.0,
                       m->colour[i][2] / 255.0);
        sink_put(to, "\n", 1);
    }
    for (size_t i = 0; m->texture && i < m->vertex_count; i++)
        sink_print(to, "vt %.9g %.9g\n", (double)m->texture[i][0], (double)m->texture[i][1]);
    for (size_t i = 0; m->normal && i < m->vertex_count; i++)
        sink_print(to, "vn %.6g %.6g %.6g\n", (double)m->normal[i][0], (double)m->normal[i][1],
                   (double)m->normal[i][2]);
}

// Of a mesh of parts nobody knows which of them the picture is of.
static bool has_library(const struct relume_mesh *m)
{
    return m->picture && m->texture && !(m->part && m->part_name);
}

relume_status mesh_write_obj(struct sink *to, const struct relume_mesh *m, const char *path,
                             const struct relume_log *log)
{
    (void)log;
    if (has_library(m)) {
        const char *name = path_name(path);
        sink_print(to, "mtllib %.*s.mtl\nusemtl picture\n", (int)(strrchr(name, '.') - name), name);
    }
    put_vertices(to, m);
    for (size_t i = 0; i < m->triangle_count; i++) {
        if (m->part && m->part_name && (i == 0 || m->part[i] != m->part[i - 1]))
            put_name(to, "usemtl ", m->part_name[m->part[i]]);
        sink_put(to, "f", 1);
        for (int k = 0; k < 3; k++) {
            const unsigned long v = (unsigned long)m->triangle[i][k] + 1;
            sink_print(to, " %lu", v);
            if (m->texture)
                sink_print(to, "/%lu", v);
            if (m->normal)
                sink_print(to, m->texture ? "/%lu" : "//%lu", v);
        }
        sink_put(to, "\n", 1);
    }
    return RELUME_OK;
}

// Its materials, which are one.
static relume_status write_library(struct sink *to, const struct relume_mesh *m, const char *path,
                                   const struct relume_log *log)
{
    (void)log;
    put_name(to, "newmtl picture\nKd 1 1 1\nmap_Kd ", mesh_write_picture(m, path));
    if (m->cut_out)
        put_name(to, "map_d ", mesh_write_picture(m, path));
    return RELUME_OK;
}

// ---------------------------------------------------------------- PLY

static void put_ply_header(struct sink *to, const struct relume_mesh *m, const char *path)
{
    sink_print(to, "ply\nformat binary_little_endian 1.0\n");
    if (m->picture)
        put_name(to, "comment TextureFile ", mesh_write_picture(m, path));
    sink_print(to, "element vertex %zu\nproperty float x\nproperty float y\nproperty float z\n",
               m->vertex_count);
    if (m->normal)
        sink_print(to, "property float nx\nproperty float ny\nproperty float nz\n");
    if (m->texture)
        sink_print(to, "property float u\nproperty float v\n");
    if (m->colour)
        sink_print(to, "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                       "property uchar alpha\n");
    sink_print(to,
               "element face %zu\nproperty list uchar uint vertex_indices\n"
               "end_header\n",
               m->triangle_count);
}

relume_status mesh_write_ply(struct sink *to, const struct relume_mesh *m, const char *path,
                             const struct relume_log *log)
{
    (void)log;
    put_ply_header(to, m, path);
    for (size_t i = 0; i < m->vertex_count; i++) {
        sink_put(to, m->position[i], sizeof m->position[i]);
        if (m->normal)
            sink_put(to, m->normal[i], sizeof m->normal[i]);
        if (m->texture)
            sink_put(to, m->texture[i], sizeof m->texture[i]);
        if (m->colour)
            sink_put(to, m->colour[i], sizeof m->colour[i]);
    }
    for (size_t i = 0; i < m->triangle_count; i++) {
        const char corners = 3;
        sink_put(to, &corners, 1);
        sink_put(to, m->triangle[i], sizeof m->triangle[i]);
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- files

static const struct format {
    const char *ending;
    relume_status (*write)(struct sink *to, const struct relume_mesh *mesh, const char *path,
                           const struct relume_log *log);
} formats[] = {{".obj", mesh_write_obj}, {".ply", mesh_write_ply}, {".glb", mesh_write_glb}};

static relume_status find(const struct format **out, const char *path, const struct relume_log *log)
{
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof formats / sizeof *formats; i++)
        if (!strcasecmp(dot, formats[i].ending)) {
            *out = &formats[i];
            return RELUME_OK;
        }
    return log_fail(log, RELUME_EINVAL,
                    "%s: unknown format for a mesh; expected a name that ends in .ply, .obj or "
                    ".glb",
                    path);
}

static relume_status check_mesh(const struct relume_mesh *m, const char *path,
                                const struct relume_log *log)
{
    if (m->vertex_count > UINT32_MAX || m->triangle_count > UINT32_MAX)
        return log_fail(log, RELUME_EINVAL,
                        "%s: a mesh of %zu vertices and %zu triangles; expected at most 2^32 - 1 "
                        "of each",
                        path, m->vertex_count, m->triangle_count);
    for (size_t i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            if (m->triangle[i][k] >= m->vertex_count ||
                (m->part && m->part[i] >= (uint32_t)m->parts))
                return log_fail(log, RELUME_EINVAL,
                                "%s: triangle %zu names a vertex or a part that is not there", path,
                                i);
    return RELUME_OK;
}

relume_status relume_mesh_check(const char *path, const struct relume_mesh_params *params)
{
    const struct relume_mesh_params p = PARAMS(relume_mesh_params, params);
    const struct format *format = NULL;
    const relume_status status = find(&format, path, p.log);
    return status ? status : relume_file_check(path, p.log);
}

typedef relume_status writer(struct sink *to, const struct relume_mesh *mesh, const char *path,
                             const struct relume_log *log);

static relume_status write_file(writer *write, const struct relume_mesh *mesh, const char *path,
                                const struct relume_log *log)
{
    struct sink to = {.buffer = NULL};
    relume_status status = outfile_open(&to.file, path, NULL, log);
    if (!status && !(to.buffer = mem_array(SINK_BYTES, 1)))
        status = RELUME_ENOMEM;
    if (!status)
        status = write(&to, mesh, path, log);
    if (!status)
        flush(&to);
    if (!status)
        status = to.status;
    if (!status)
        status = outfile_commit(&to.file);
    outfile_abort(&to.file);
    mem_free(to.buffer);
    return status;
}

// "cow.obj": "cow.mtl".
static relume_status write_beside(const struct relume_mesh *mesh, const char *path,
                                  const struct relume_log *log)
{
    const size_t stem = (size_t)(strrchr(path, '.') - path);
    char *name = mem_array(stem + sizeof ".mtl", 1);
    if (!name)
        return RELUME_ENOMEM;
    memcpy(name, path, stem);
    memcpy(name + stem, ".mtl", sizeof ".mtl");
    const relume_status status = write_file(write_library, mesh, name, log);
    mem_free(name);
    return status;
}

relume_status relume_mesh_write(const struct relume_mesh *mesh, const char *path,
                                const struct relume_mesh_params *params)
{
    const struct relume_mesh_params p = PARAMS(relume_mesh_params, params);
    const struct format *format = NULL;
    relume_status status = find(&format, path, p.log);
    if (!status)
        status = check_mesh(mesh, path, p.log);
    if (!status && format->write == mesh_write_obj && has_library(mesh))
        status = write_beside(mesh, path, p.log);
    return status ? status : write_file(format->write, mesh, path, p.log);
}
