// clouds.c - objects that are shown as billboards: rays meet these, and shade the places of the
// surface that their texels show
#include "core/base/memory.h"
#include "world/object/object.h"

#include <string.h>

// Positions and triangles from `first` on, counted from 0.
static relume_status take_mesh(struct relume_mesh *out, const struct mesh *from, size_t first)
{
    out->vertex_count = from->vertex_count;
    out->triangle_count = from->triangle_count - first;
    out->position = mem_array(out->vertex_count, sizeof *out->position);
    out->triangle = mem_array(out->triangle_count, sizeof *out->triangle);
    if (!out->position || !out->triangle)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < out->vertex_count; i++)
        memcpy(out->position[i], from->vertices[i].position, sizeof out->position[i]);
    for (size_t i = 0; i < out->triangle_count; i++)
        memcpy(out->triangle[i], from->triangles[first + i].vertex, sizeof out->triangle[i]);
    return RELUME_OK;
}

relume_status objects_add_cloud(relume_objects *o, size_t first, double error,
                                const struct relume_log *log)
{
    struct relume_mesh mesh = {0};
    struct relume_billboards *cloud = mem_zeroed(1, sizeof *cloud);
    relume_status status = cloud ? take_mesh(&mesh, &o->mesh, first) : RELUME_ENOMEM;
    if (!status)
        status = relume_billboards_create(cloud, &mesh,
                                          relume_billboards_params(.log = log, .error = error));
    if (!status && !mem_grow(&o->cloud, (size_t)o->clouds, sizeof *o->cloud))
        status = RELUME_ENOMEM;
    if (!status)
        // the surface lies up to an error off, two texels; one for places beside
        o->cloud[o->clouds++] =
            (struct trace_cloud){cloud, first, mesh.triangle_count, 3.0f * cloud->side};
    else if (cloud)
        relume_billboards_free(cloud);
    if (status)
        mem_free(cloud);
    relume_mesh_free(&mesh);
    return status;
}
