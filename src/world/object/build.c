// build.c - mesh files become one list of triangles in the world
#include "core/base/log.h"
#include "core/base/memory.h"
#include "shape/mesh/mesh_read.h"
#include "shape/mesh/tangents.h"
#include "world/object/levels.h"
#include "world/object/object.h"
#include "world/object/skin.h"

#include <string.h>

// ---------------------------------------------------------------- what a mesh lacks

// Texture coordinates of every triangle from the two axes that it faces least, the longest side of
// the mesh being 1. Corners are no longer shared: neighbours may face different axes.
static void project(struct mesh *out, const struct mesh *from)
{
    const struct bounds b = mesh_bounds(from);
    const vec3 extent = vec3_sub(b.max, b.min);
    const double longest = fmax(extent.x, fmax(extent.y, extent.z));
    for (size_t i = 0; i < from->triangle_count; i++) {
        const uint32_t *v = from->triangles[i].vertex;
        vec3 p[3];
        uint32_t made[3];
        for (int k = 0; k < 3; k++)
            p[k] = vertex_position(&from->vertices[v[k]]);
        const vec3 n = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
        const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
        for (int k = 0; k < 3; k++) {
            const vec3 at = vec3_scale(vec3_sub(p[k], b.min), 1.0 / longest);
            const vec3 uv = x > y && x > z ? vec3_of(n.x > 0.0 ? -at.z : at.z, at.y, 0)
                            : y > z        ? vec3_of(at.x, n.y > 0.0 ? -at.z : at.z, 0)
                                           : vec3_of(n.z > 0.0 ? at.x : -at.x, at.y, 0);
            made[k] = mesh_vertex(out, p[k], vertex_normal(&from->vertices[v[k]]), uv);
        }
        mesh_triangle(out, made[0], made[1], made[2], from->triangles[i].material);
    }
}

static relume_status make_uv(struct mesh_file *file)
{
    struct mesh made = {0};
    project(&made, &file->mesh);
    uint8_t(*colour)[4] =
        file->colour && !made.failed ? mem_array(made.vertex_count, sizeof *colour) : NULL;
    for (size_t i = 0; colour && i < made.vertex_count; i++)
        memcpy(colour[i], file->colour[file->mesh.triangles[i / 3].vertex[i % 3]], sizeof *colour);
    const bool failed = made.failed || (file->colour && !colour);
    mem_free(file->colour);
    file->colour = colour;
    mesh_free(&file->mesh);
    file->mesh = made;
    return failed ? RELUME_ENOMEM : RELUME_OK;
}

struct edge {
    float end[2][3];
};

static int by_ends(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct edge));
}

static void add_edge(struct edge *to, const float a[3], const float b[3])
{
    const bool turned = memcmp(a, b, 3 * sizeof *a) > 0;
    memcpy(to->end[turned], a, 3 * sizeof *a);
    memcpy(to->end[!turned], b, 3 * sizeof *b);
}

// Edges that more than two triangles share, by the places of their ends.
static relume_status count_fins(size_t *out, const struct mesh *m)
{
    struct edge *edge = mem_array(3 * m->triangle_count, sizeof *edge);
    size_t n = 0;
    *out = 0;
    if (!edge)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < m->triangle_count; i++) {
        const float *p[3];
        for (int k = 0; k < 3; k++)
            p[k] = m->vertices[m->triangles[i].vertex[k]].position;
        const size_t size = sizeof m->vertices->position;
        if (!memcmp(p[0], p[1], size) || !memcmp(p[1], p[2], size) || !memcmp(p[2], p[0], size))
            continue;
        for (int k = 0; k < 3; k++)
            add_edge(&edge[n++], p[k], p[(k + 1) % 3]);
    }
    qsort(edge, n, sizeof *edge, by_ends);
    for (size_t i = 0, end; i < n; i = end) {
        for (end = i + 1; end < n && !by_ends(&edge[i], &edge[end]); end++)
            ;
        *out += end - i > 2;
    }
    mem_free(edge);
    return RELUME_OK;
}

// ---------------------------------------------------------------- coverings

static const struct covering *covering_of(struct standing *s, const char *part)
{
    struct covering *found = NULL;
    for (int i = 0; i < s->coverings; i++)
        if (s->covering[i].part ? !strcmp(s->covering[i].part, part) : !found)
            found = &s->covering[i];
    if (found)
        found->used = true;
    return found;
}

// Whether some part shows a picture, and so asks where on it.
static bool needs_uv(const struct mesh_file *file, struct standing *s)
{
    for (int i = 0; i < file->parts; i++) {
        const struct covering *c = covering_of(s, file->part[i]);
        if ((c && c->material >= 0) || mesh_look_has_picture(&file->look[i]))
            return true;
    }
    return false;
}

static relume_status complete(struct mesh_file *file, struct standing *s, const char *path,
                              const struct relume_log *log)
{
    size_t fins;
    relume_status status = count_fins(&fins, &file->mesh);
    if (!status && fins)
        log_line(
            log, RELUME_WARNING,
            "%s: %zu edges with more than two faces; shading may look wrong there; mend the mesh",
            path, fins);
    if (!status && file->made_normals)
        log_line(log, RELUME_WARNING, "%s: some normals are missing; smooth ones were computed",
                 path);
    if (status || file->has_uv)
        return status;
    if (needs_uv(file, s))
        log_line(log, RELUME_WARNING,
                 "%s: no texture coordinates; they were made by projection along the axes", path);
    return make_uv(file);
}

// ---------------------------------------------------------------- into the world

// A part that nothing covers shows what the file of the mesh says.
static const struct covering own_look = {.material = -1, .repeat = {1, 1}};

static relume_status add_part(relume_objects *o, const struct mesh_file *file, int number,
                              const struct covering *c, const char *path,
                              const struct relume_objects_params *params)
{
    int material = c->material;
    relume_status status =
        material < 0 ? objects_own_look(o, file, number, path, &material, params) : RELUME_OK;
    if (status)
        return status;
    char *name = mem_text(file->part[number]);
    if (!name || !mem_grow(&o->part, (size_t)o->info.parts, sizeof *o->part)) {
        mem_free(name);
        return RELUME_ENOMEM;
    }
    o->part[o->info.parts++] = (struct relume_object_part){
        .name = name,
        .material = material,
        .bilinear = !c->nearest,
        .first = o->mesh.triangle_count,
        .object = o->info.objects,
    };
    return RELUME_OK;
}

uint32_t objects_vertex(relume_objects *o, vec3 place, vec3 normal, vec3 texture,
                        const uint8_t *colour)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const uint32_t vertex = mesh_vertex(&o->mesh, place, normal, texture);
    o->mesh.failed = o->mesh.failed || !mem_grow(&o->vertex_tint, vertex, sizeof *o->vertex_tint);
    for (int c = 0; c < 3 && !o->mesh.failed; c++)
        o->vertex_tint[vertex][c] =
            colour ? relume_transfer_decode(srgb, (float)colour[c] / 255.0f) : 1.0f;
    o->tinted |= colour != NULL;
    return vertex;
}

// Texture coordinates in repeats, t down from the upper edge of the sample.
static uint32_t add_vertex(relume_objects *o, const struct mesh_file *file, uint32_t number,
                           const struct frame *frame, const struct covering *c)
{
    const struct vertex *v = &file->mesh.vertices[number];
    const double s = (double)v->texture[0] * c->repeat[0] + c->offset[0];
    const double t = 1.0 - ((double)v->texture[1] * c->repeat[1] + c->offset[1]);
    const bool tinted =
        c->material < 0 && file->colour && !o->material[o->part[o->info.parts - 1].material].mirror;
    return objects_vertex(o, frame_point(frame, vertex_position(v)),
                          frame_normal(frame, vertex_normal(v)), vec3_of(s, t, 0),
                          tinted ? file->colour[number] : NULL);
}

// Wound as the normals say; a triangle without extent is left out.
static void add_triangle(relume_objects *o, const struct mesh_file *file, const uint32_t number[3],
                         const struct frame *frame, const struct covering *c)
{
    vec3 p[3], normal = {0, 0, 0};
    uint32_t made[3];
    for (int k = 0; k < 3; k++) {
        const struct vertex *v = &file->mesh.vertices[number[k]];
        p[k] = vertex_position(v);
        normal = vec3_add(normal, vertex_normal(v));
    }
    const vec3 out = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
    if (!(vec3_length(out) > 0.0))
        return;
    const bool turned = vec3_dot(out, normal) < 0.0;
    for (int k = 0; k < 3; k++)
        made[k] = add_vertex(o, file, number[k], frame, c);
    mesh_triangle(&o->mesh, made[0], made[turned ? 2 : 1], made[turned ? 1 : 2],
                  (uint32_t)o->info.parts - 1);
}

static relume_status add_parts(relume_objects *o, const struct mesh_file *file, struct standing *s,
                               const char *path, const struct relume_objects_params *params)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < file->parts && !status; i++) {
        const struct mesh *m = &file->mesh;
        size_t k = 0;
        while (k < m->triangle_count && m->triangles[k].material != (uint32_t)i)
            k++;
        if (k == m->triangle_count)
            continue;
        const struct covering *named = covering_of(s, file->part[i]);
        const struct covering *c = named ? named : &own_look;
        status = add_part(o, file, i, c, path, params);
        for (; k < m->triangle_count && !status; k++)
            if (m->triangles[k].material == (uint32_t)i)
                add_triangle(o, file, m->triangles[k].vertex, &s->frame, c);
        if (!status)
            o->part[o->info.parts - 1].count =
                o->mesh.triangle_count - o->part[o->info.parts - 1].first;
    }
    o->info.objects++;
    return status ? status : o->mesh.failed ? RELUME_ENOMEM : RELUME_OK;
}

relume_status objects_add(relume_objects *o, const char *path, struct standing *standing,
                          const struct relume_objects_params *params)
{
    const struct relume_log *log = params ? params->log : NULL;
    const size_t first = o->mesh.triangle_count;
    struct mesh_file file;
    relume_status status = mesh_read(&file, path, log);
    if (!status)
        status = complete(&file, standing, path, log);
    if (!status && standing->bare)
        objects_plain_look(&file, path, log);
    if (!status)
        status = add_parts(o, &file, standing, path, params);
    for (int i = 0; i < standing->coverings && !status; i++)
        if (standing->covering[i].part && !standing->covering[i].used)
            status = log_fail(log, RELUME_EUNFIT, "%s: no part '%s'; its first is '%s'", path,
                              standing->covering[i].part, file.part[0]);
    if (!status && standing->billboards > 0.0)
        status = objects_add_cloud(o, first, standing->billboards, log);
    if (!status && standing->levels > 0.0)
        status = objects_want_levels(o, o->info.objects - 1, standing->levels);
    mesh_file_free(&file);
    return status;
}

// Slopes of up to 40 degrees to all sides.
static const double CUSHION = 0.42;

static relume_status make_cushion(struct mesh_file *file)
{
    enum { SIDE = 48 };
    *file = (struct mesh_file){.has_uv = true};
    for (int i = 0; i < (SIDE + 1) * (SIDE + 1); i++) {
        const double u = (double)(i % (SIDE + 1)) / SIDE, v = (double)(i / (SIDE + 1)) / SIDE;
        const double x = 2.0 * u - 1.0, y = 2.0 * v - 1.0;
        const double fx = 1.0 - x * x, fy = 1.0 - y * y;
        const vec3 normal = vec3_of(2.0 * CUSHION * x * fy, 2.0 * CUSHION * y * fx, 1.0);
        mesh_vertex(&file->mesh, vec3_of(x, y, CUSHION * fx * fy), vec3_unit(normal),
                    vec3_of(u, v, 0));
    }
    for (uint32_t j = 0; j < SIDE; j++)
        for (uint32_t i = 0; i < SIDE; i++) {
            const uint32_t a = j * (SIDE + 1) + i, b = a + SIDE + 1;
            mesh_triangle(&file->mesh, a, a + 1, b + 1, 0);
            mesh_triangle(&file->mesh, a, b + 1, b, 0);
        }
    const int part = mesh_file_part(file, "cushion");
    return part < 0 || file->mesh.failed ? RELUME_ENOMEM : RELUME_OK;
}

relume_status objects_add_cushion(relume_objects *o, struct standing *standing,
                                  const struct relume_objects_params *params)
{
    struct mesh_file file;
    relume_status status = make_cushion(&file);
    if (!status)
        status = add_parts(o, &file, standing, "cushion", params);
    mesh_file_free(&file);
    return status;
}

relume_status objects_finish(relume_objects *o, const struct relume_objects_params *params)
{
    const struct relume_log *log = params ? params->log : NULL;
    struct tangents t;
    if (!o->mesh.triangle_count)
        return log_fail(log, RELUME_EUNFIT, "the objects have no surface");
    relume_status status = tangents_make(&t, &o->mesh, o->tinted ? o->vertex_tint : NULL);
    mem_free(o->vertex_tint);
    o->vertex_tint = NULL;
    o->reflection = mem_zeroed((size_t)o->info.objects, sizeof *o->reflection);
    o->vertices = t.vertices, o->triangles = t.triangles, o->tint = t.tint;
    if (status || !o->reflection)
        return status ? status : RELUME_ENOMEM;
    if (t.flat)
        log_line(log, RELUME_WARNING,
                 "%zu of %zu vertices have no texture direction; materials may be turned there",
                 t.flat, t.vertex_count);
    const struct bounds b = mesh_bounds(&o->mesh);
    o->info.vertices = o->vertices, o->info.vertex_count = t.vertex_count;
    o->info.triangles = (const uint32_t(*)[3])o->triangles;
    o->info.triangle_count = o->mesh.triangle_count;
    o->info.tint = (const float(*)[3])o->tint;
    o->info.part = o->part, o->info.material = o->material;
    o->info.min = b.min, o->info.max = b.max;
    struct trace_holes holes;
    const bool has_holes = skin_holes(&holes, o);
    status = objects_make_levels(o, log);
    return status ? status
                  : trace_create_clouds(&o->tracer, &o->mesh, o->cloud, o->clouds,
                                        has_holes ? &holes : NULL, log);
}
