// tracing.c - what rays off a mirror ball hit, by the cells of an octree and by the ray tracer
#include "cli/measure/octree.h"
#include "cli/measure/reflections.h"
#include "core/base/clock.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/tree.h"
#include "core/math/random.h"
#include "core/math/sort.h"
#include "shape/mesh/mesh_read.h"
#include "shape/mesh/trace.h"
#include "world/stage/shapes.h"

enum { SHALLOWEST = 7, DEEPEST = 9, TEAPOT_STEPS = 16 };
static const double CONE = 0.01;  // width of a ray over its length

struct rays {
    vec3 *from, *along;
    double *exact;     // distance by the ray tracer; infinite: nothing is hit
    double *distance;  // the same by the octree
    double *error;
    double size;  // the mesh's diagonal
};

static relume_status alloc_rays(struct rays *r)
{
    r->from = mem_array(REFLECTED_RAYS, sizeof *r->from);
    r->along = mem_array(REFLECTED_RAYS, sizeof *r->along);
    r->exact = mem_array(REFLECTED_RAYS, sizeof *r->exact);
    r->distance = mem_array(REFLECTED_RAYS, sizeof *r->distance);
    r->error = mem_array(REFLECTED_RAYS, sizeof *r->error);
    return r->from && r->along && r->exact && r->distance && r->error ? RELUME_OK : RELUME_ENOMEM;
}

static void free_rays(struct rays *r)
{
    mem_free(r->from);
    mem_free(r->along);
    mem_free(r->exact);
    mem_free(r->distance);
    mem_free(r->error);
}

// Aims rays off a ball beside the mesh, as an eye far away sees it.
static void aim_rays(struct rays *r, const struct mesh *m)
{
    const struct bounds b = mesh_bounds(m);
    const vec3 middle = vec3_scale(vec3_add(b.min, b.max), 0.5);
    r->size = vec3_length(vec3_sub(b.max, b.min));
    const vec3 ball = vec3_along(middle, vec3_of(0.8, 0, 0.6), 0.9 * r->size);
    const vec3 eye = vec3_along(ball, vec3_of(-0.6, 0, 0.8), 9 * r->size);
    for (int i = 0; i < REFLECTED_RAYS; i++) {
        struct random at = random_stream(2, (uint64_t)i, 0);
        const double z = random_range(&at, -1, 1), a = random_range(&at, 0, 2 * M_PI);
        const vec3 n = vec3_of(sqrt(1 - z * z) * cos(a), z, sqrt(1 - z * z) * sin(a));
        r->from[i] = vec3_along(ball, n, 0.3 * r->size);
        const vec3 in = vec3_unit(vec3_sub(eye, r->from[i]));
        r->along[i] = vec3_sub(vec3_scale(n, 2.0 * vec3_dot(n, in)), in);
    }
}

static double trace_exactly(const struct rays *r, const tracer *t)
{
    const double start = processor_s();
    for (int i = 0; i < REFLECTED_RAYS; i++) {
        const vec3 p = r->from[i], d = r->along[i];
        const float from[3] = {(float)p.x, (float)p.y, (float)p.z};
        const float along[3] = {(float)d.x, (float)d.y, (float)d.z};
        struct trace_hit hit;
        r->exact[i] = trace_closest(t, from, along, &hit) ? (double)hit.distance : INFINITY;
    }
    return processor_s() - start;
}

static double trace_cells(const struct rays *r, const octree *o, double cone)
{
    const double start = processor_s();
    for (int i = 0; i < REFLECTED_RAYS; i++) {
        struct octree_hit hit;
        r->distance[i] =
            octree_trace(&hit, o, r->from[i], r->along[i], cone) ? hit.distance : INFINITY;
    }
    return processor_s() - start;
}

// Compares distances with the ray tracer's.
static void compare_distances(struct tracing_result *out, const struct rays *r)
{
    int both = 0, one = 0;
    for (int i = 0; i < REFLECTED_RAYS; i++) {
        const bool a = r->distance[i] < INFINITY, b = r->exact[i] < INFINITY;
        one += a != b;
        if (a && b)
            r->error[both++] = fabs(r->distance[i] - r->exact[i]) / r->size;
    }
    sort_doubles(r->error, (size_t)both);
    out->one_only = (double)one / REFLECTED_RAYS;
    out->error = both ? r->error[both / 2] : (double)NAN;
}

static relume_status measure_tracer(struct tracing_result *out, const struct rays *r,
                                    const struct mesh *m, const struct relume_log *log)
{
    tracer *t;
    const double start = processor_s();
    const relume_status status = trace_create(&t, m, log);
    if (status)
        return status;
    *out = (struct tracing_result){.build_s = processor_s() - start, .error = (double)NAN};
    out->rays_per_s = REFLECTED_RAYS / trace_exactly(r, t);
    trace_destroy(&t);
    return RELUME_OK;
}

// Measures cells of one depth, at full size and as wide as the cone.
static relume_status measure_octree(struct tracing_result out[2], const struct rays *r,
                                    const struct mesh *m, int depth)
{
    octree *o;
    const double start = processor_s();
    const relume_status status = octree_create(&o, m, depth);
    const double build_s = processor_s() - start;
    for (int cone = 0; !status && cone < 2; cone++) {
        out[cone] = (struct tracing_result){
            .depth = depth, .cone = cone, .build_s = build_s, .bytes = octree_bytes(o)};
        out[cone].rays_per_s = REFLECTED_RAYS / trace_cells(r, o, cone ? CONE : 0.0);
        compare_distances(&out[cone], r);
    }
    octree_destroy(&o);
    return status;
}

static relume_status measure_mesh(struct traced_mesh *out, const struct rays *r,
                                  const struct mesh *m, const struct relume_log *log)
{
    relume_status status = measure_tracer(&out->result[0], r, m, log);
    for (int depth = SHALLOWEST; !status && depth <= DEEPEST; depth++) {
        const int at = 1 + 2 * (depth - SHALLOWEST);
        status = measure_octree(&out->result[at], r, m, depth);
        if (!status && !log_progress(log, "tracing", (double)(at + 2) / TRACING_METHODS))
            status = RELUME_ECANCEL;
    }
    return status;
}

relume_status measure_tracing(struct traced_mesh *out, const char *path,
                              const struct relume_log *log)
{
    struct mesh_file file = {.has_uv = true};
    struct rays r = {0};
    relume_status status = path ? mesh_read(&file, path, log) : RELUME_OK;
    if (!path)
        shape_teapot(&file.mesh, TEAPOT_STEPS);
    *out = (struct traced_mesh){.name = path ? path_name(path) : "teapot",
                                .triangles = file.mesh.triangle_count};
    if (!status)
        status = file.mesh.failed ? RELUME_ENOMEM : alloc_rays(&r);
    if (!status) {
        aim_rays(&r, &file.mesh);
        status = measure_mesh(out, &r, &file.mesh, log);
    }
    free_rays(&r);
    mesh_file_free(&file);
    return status;
}
