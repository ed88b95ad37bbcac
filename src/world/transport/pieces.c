// pieces.c - what trees of points are made of
#include "world/transport/pieces.h"

#include "core/base/memory.h"

static double farthest_vertex(const struct mesh *mesh, vec3 eye)
{
    double most = 0.0;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        most = fmax(most, vec3_length(vec3_sub(vertex_position(&mesh->vertices[i]), eye)));
    return most;
}

static double far_from(const struct scenery *c, const struct mesh *objects)
{
    const double FAR = 1000.0;
    const vec3 eye = scenery_eye(c);
    const double scene = farthest_vertex(scenery_mesh(c), eye);
    const double all = fmax(scene, objects ? farthest_vertex(objects, eye) : 0.0);
    return FAR * (all > 0.0 ? all : 1.0);
}

static void put_background(struct piece *out, const struct scenery *c, size_t i, double far)
{
    vec3 towards;
    float unused[3];
    const double angle = scenery_piece(&towards, unused, c, i, 0.5, 0.5);
    *out = (struct piece){{0}, {0}};
    if (!(angle > 0.0))
        return;
    vec3_store(out->place, vec3_along(scenery_eye(c), towards, far));
    vec3_store(out->area, vec3_scale(towards, -angle * far * far));
}

static void put_triangle(struct piece *out, const struct scenery *c, size_t i)
{
    vec3 at[3];
    mesh_corners(at, scenery_mesh(c), i);
    const vec3 twice = mesh_twice_area(at);
    const double side = vec3_dot(twice, vec3_sub(scenery_eye(c), at[0])) < 0.0 ? -0.5 : 0.5;
    vec3_store(out->place, vec3_scale(vec3_add(vec3_add(at[0], at[1]), at[2]), 1.0 / 3.0));
    vec3_store(out->area, vec3_scale(twice, side));
}

relume_status pieces_of_scene(struct piece **out, size_t *count, const struct scenery *c,
                              const struct mesh *objects)
{
    const size_t triangles = scenery_mesh(c)->triangle_count, blocks = scenery_pieces(c);
    struct piece *pieces = mem_array(triangles + blocks ? triangles + blocks : 1, sizeof *pieces);
    *out = pieces, *count = pieces ? triangles + blocks : 0;
    if (!pieces)
        return RELUME_ENOMEM;
    const double far = far_from(c, objects);
    for (size_t i = 0; i < triangles; i++)
        put_triangle(&pieces[i], c, i);
    for (size_t i = 0; i < blocks; i++)
        put_background(&pieces[triangles + i], c, i, far);
    return RELUME_OK;
}

relume_status pieces_of_points(struct piece **out, const struct points *points, int side)
{
    struct piece *pieces = points->count ? mem_zeroed(points->count, sizeof *pieces) : NULL;
    *out = pieces;
    if (points->count && !pieces)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < points->count; i++) {
        const struct point *p = &points->at[i];
        vec3_store(pieces[i].place, p->place);
        if (!side || p->both)
            vec3_store(pieces[i].area, vec3_scale(p->normal, side ? -p->area : p->area));
    }
    return RELUME_OK;
}
