#include "mesh/mesh_read.h"

#include "base/inputs.h"
#include "base/log.h"
#include "base/memory.h"
#include "mesh/mesh_other.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

static const off_t MAX_BYTES = (off_t)1 << 31;

void mesh_file_free(struct mesh_file *file)
{
    mesh_free(&file->mesh);
    free(file->picture);
    for (int i = 0; i < file->parts; i++)
        free(file->part[i]);
    free(file->part);
    *file = (struct mesh_file){0};
}

int mesh_file_part(struct mesh_file *file, const char *name)
{
    enum { MOST_PARTS = 1024 };
    for (int i = 0; i < file->parts; i++)
        if (!strcmp(file->part[i], name))
            return i;
    char **part = file->parts < MOST_PARTS
                      ? mem_resize(file->part, (size_t)file->parts + 1, sizeof *part)
                      : NULL;
    if (!part)
        return -1;
    file->part = part;
    part[file->parts] = mem_text(name);
    return part[file->parts] ? file->parts++ : -1;
}

char *mesh_beside(const char *path, const char *name)
{
    const char *slash = strrchr(path, '/');
    if (name[0] == '/' || !slash)
        return mem_text(name);
    return mem_format("%.*s%s", (int)(slash - path) + 1, path, name);
}

relume_status mesh_load_text(char **out, size_t *size, const char *path,
                             const struct relume_log *log)
{
    *out = NULL;
    FILE *file = input_open(path, log);
    struct stat s;
    if (!file || fstat(fileno(file), &s)) {
        const int error = errno;
        if (file)
            fclose(file);
        return relume_input_fail(log, path, "cannot be opened", error);
    }
    if (!S_ISREG(s.st_mode) || s.st_size > MAX_BYTES) {
        fclose(file);
        return log_fail(log, RELUME_EDATA, "%s: expected a regular file of at most 2 GiB", path);
    }
    char *text = mem_array((size_t)s.st_size + 1, 1);
    if (text) {
        *size = fread(text, 1, (size_t)s.st_size, file);
        text[*size] = '\0';
    }
    fclose(file);
    *out = text;
    return text ? RELUME_OK : RELUME_ENOMEM;
}

// Beside model.obj: model.png, model.jpg.
static char *picture_beside(const char *path)
{
    static const char *const extensions[] = {"png", "jpg", "jpeg", "PNG", "JPG", NULL};
    const char *dot = strrchr(path, '.');
    for (const char *const *e = extensions; *e; e++) {
        char *name = mem_format("%.*s.%s", (int)(dot - path), path, *e);
        if (!name || !access(name, R_OK))
            return name;
        free(name);
    }
    return NULL;
}

// Embree takes places below 1.84e18, so that their squares are floats; anything larger is a broken
// file.
static bool is_sane(const struct mesh *mesh)
{
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (int c = 0; c < 3; c++)
            if (!(fabsf(mesh->vertices[i].position[c]) < 1e18f) ||
                !isfinite(mesh->vertices[i].texture[c]) || !isfinite(mesh->vertices[i].normal[c]))
                return false;
    return true;
}

static relume_status check(struct mesh_file *out, const char *path, const struct relume_log *log)
{
    if (out->mesh.failed)
        return RELUME_ENOMEM;
    if (!out->mesh.triangle_count)
        return log_fail(log, RELUME_EDATA, "%s: no faces; expected a surface model", path);
    if (!is_sane(&out->mesh))
        return log_fail(log, RELUME_EDATA, "%s: a vertex is not a finite number below 1e18", path);
    const struct bounds b = mesh_bounds(&out->mesh);
    if (!(vec3_length(vec3_sub(b.max, b.min)) > 0.0))
        return log_fail(log, RELUME_EDATA, "%s: all vertices are one point", path);
    return RELUME_OK;
}

static relume_status read_own(struct mesh_file *out, const char *path, bool obj,
                              const struct relume_log *log)
{
    char *text;
    size_t size;
    relume_status status = mesh_load_text(&text, &size, path, log);
    if (status)
        return status;
    status = (obj ? mesh_read_obj : mesh_read_ply)(out, text, size, path, log);
    free(text);
    return status;
}

relume_status mesh_read(struct mesh_file *out, const char *path, const struct relume_log *log)
{
    *out = (struct mesh_file){.has_uv = false};
    const char *dot = strrchr(path, '.');
    const bool obj = dot && !strcasecmp(dot, ".obj"), ply = dot && !strcasecmp(dot, ".ply");
    relume_status status =
        obj || ply ? read_own(out, path, obj, log) : mesh_read_other(out, path, log);
    if (!status)
        status = check(out, path, log);
    if (!status && !out->parts && mesh_file_part(out, "all") < 0)
        status = RELUME_ENOMEM;
    if (!status && out->has_uv && !out->picture)
        out->picture = picture_beside(path);
    if (status)
        mesh_file_free(out);
    return status;
}
