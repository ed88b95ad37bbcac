// interpolant_delaunay.c - linear over a triangulation of the lights (mesh.c)
#include "core/base/memory.h"
#include "format/coder/basis.h"
#include "format/coder/coding.h"
#include "format/coder/interpolant.h"

#include <string.h>

struct delaunay {
    mesh *mesh;
    int lights;
};

static relume_status prepare(void **data, const struct relume_vec3 *lights, int n,
                             const double *parameter, const struct relume_log *log)
{
    (void)parameter;
    (void)log;
    struct delaunay *d = *data = mem_zeroed(1, sizeof *d);
    if (!d)
        return RELUME_ENOMEM;
    d->lights = n;
    const relume_status status = mesh_create(&d->mesh, lights, n);
    if (status) {
        mem_free(d);
        *data = NULL;
    }
    return status;
}

static void evaluate(const void *data, struct relume_vec3 light, double *weights)
{
    const struct delaunay *d = data;
    const struct blend b = mesh_blend(d->mesh, light);
    memset(weights, 0, (size_t)d->lights * sizeof *weights);
    for (int i = 0; i < b.count; i++)
        weights[b.light[i]] += b.weight[i];
}

static struct relume_coder_triangles triangles(const void *delaunay)
{
    return mesh_triangles(((const struct delaunay *)delaunay)->mesh);
}

static void release(void *data)
{
    struct delaunay *d = data;
    mesh_destroy(&d->mesh);
    mem_free(d);
}

const struct relume_interpolant interpolant_delaunay = {
    .name = "delaunay",
    .summary = "linear over spherical triangles; never leaves the range of the captured values",
    .prepare = prepare,
    .evaluate = evaluate,
    .release = release,
    .triangles = triangles,
};
