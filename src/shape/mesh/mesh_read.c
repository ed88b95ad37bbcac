// mesh_read.c - models from files: Wavefront OBJ and PLY, others by Assimp
#include "shape/mesh/mesh_read.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "shape/mesh/mesh_other.h"

#include <string.h>
#include <strings.h>

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
        return log_fail(log, RELUME_EFORMAT, "%s: no faces; expected a surface model", path);
    if (!is_sane(&out->mesh))
        return log_fail(log, RELUME_EDAMAGED, "%s: a vertex is not a finite number below 1e18",
                        path);
    const struct bounds b = mesh_bounds(&out->mesh);
    if (!(vec3_length(vec3_sub(b.max, b.min)) > 0.0))
        return log_fail(log, RELUME_EUNFIT, "%s: all vertices are one point", path);
    return RELUME_OK;
}

static relume_status read_own(struct mesh_file *out, const char *path, bool obj,
                              const struct relume_log *log)
{
    char *text;
    size_t size;
    relume_status status =
        input_load(&text, &size, path, (uint64_t)1 << 31, "a model of at most 2 GiB", log);
    if (status)
        return status;
    status = (obj ? mesh_read_obj : mesh_read_ply)(out, text, size, path, log);
    mem_free(text);
    return status;
}

// Of a file that names a picture, but no materials.
static relume_status cover(struct mesh_file *out)
{
    if (!out->picture || !out->has_uv || out->look[0].given)
        return RELUME_OK;
    out->look[0] = mesh_look_white();
    out->look[0].picture = mesh_file_picture(out, out->picture);
    return out->look[0].picture < 0 ? RELUME_ENOMEM : RELUME_OK;
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
    if (!status && ply)
        status = cover(out);
    if (status)
        mesh_file_free(out);
    return status;
}
