// object_points.c - surfaces as points, for those who gather light themselves
// (relume/world/points.h)
#include "world/object/object.h"

#include "core/base/memory.h"
#include "core/base/params.h"
#include "world/object/object_points.h"
#include "world/object/skin.h"
#include "world/transport/pieces.h"

#include <string.h>

enum { SCENE_SPOTS = 1 << 16, OBJECT_SPOTS = 1 << 14 };  // as instant.c

void relume_points_free(struct relume_points *points)
{
    mem_free(points->node);
    mem_free(points->leaf);
    mem_free(points->begins);
    mem_free(points->block);
    mem_free(points->spot);
    *points = (struct relume_points){.node = NULL};
}

// ---------------------------------------------------------------- trees

_Static_assert((int)RELUME_POINTS_WAYS == (int)HIERARCHY_WAYS, "children of a node");
_Static_assert((int)RELUME_POINTS_LEVELS == (int)HIERARCHY_LEVELS, "levels of a tree");

static void put_node(struct relume_points *out, const struct hierarchy *h, int level, size_t i)
{
    const struct group *g = &h->groups[i / HIERARCHY_WAYS];
    const size_t k = i % HIERARCHY_WAYS;
    const size_t below = level + 1 < h->levels ? h->first[level + 1] + i - out->first[level] : 0;
    out->node[i] = (struct relume_points_node){
        .middle = {g->x[k], g->y[k], g->z[k]},
        .radius = g->radius[k],
        .facing = {g->facing[0][k], g->facing[1][k], g->facing[2][k]},
        .turned = g->turned[k],
        .cone = g->cone[k],
        .edge = g->edge[k],
        .area = h->area[i],
        .child = below ? (int32_t)(HIERARCHY_WAYS * below) : -1,
    };
}

static relume_status take_nodes(struct relume_points *out, const struct hierarchy *h)
{
    out->levels = h->levels;
    out->leaves = h->leaves;
    for (int l = 0; l <= h->levels; l++)
        out->first[l] = HIERARCHY_WAYS * h->first[l];
    out->nodes = out->first[h->levels];
    out->node = mem_zeroed(out->nodes, sizeof *out->node);
    out->leaf = mem_zeroed(out->leaves, sizeof *out->leaf);
    if (!out->node || !out->leaf)
        return RELUME_ENOMEM;
    for (int l = 0; l < h->levels; l++)
        for (size_t i = out->first[l]; i < out->first[l + 1]; i++)
            put_node(out, h, l, i);
    return RELUME_OK;
}

static relume_status take_spots(struct relume_points *out, const struct points *points)
{
    out->spots = points->count;
    out->area = points->count ? points->at->area : 0.0;
    out->spot = mem_zeroed(points->count, sizeof *out->spot);
    if (!out->spot)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < points->count; i++) {
        vec3_store(out->spot[i].place, points->at[i].place);
        vec3_store(out->spot[i].normal, points->at[i].normal);
        out->spot[i].both = points->at[i].both;
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- a scene

// What is summed up for a leaf: blocks that were there already grow.
static void add_block(struct relume_points *out, size_t leaf, size_t block, double weight)
{
    struct relume_points_block *b = out->block + out->begins[leaf];
    struct relume_points_block *const end = out->block + out->begins[leaf + 1];
    while (b < end && b->block != (uint32_t)block)
        b++;
    if (b == end) {
        *b = (struct relume_points_block){.block = (uint32_t)block};
        out->begins[leaf + 1]++;
    }
    b->weight += (float)weight;
}

static void put_scene_leaf(struct relume_points *out, const struct hierarchy *h, size_t leaf,
                           const struct piece *pieces, const struct mesh *mesh)
{
    const size_t first = h->begins[leaf], end = h->begins[leaf + 1];
    const size_t middle = h->order[first + (end - first) / 2];
    struct relume_points_leaf *to = &out->leaf[leaf];
    double all = 0.0;
    memcpy(to->place, pieces[middle].place, sizeof to->place);
    vec3_store(to->normal, vec3_unit(vec3_floats(pieces[middle].area)));
    to->is_far = middle >= mesh->triangle_count;
    for (size_t i = first; i < end; i++)
        all += vec3_length(vec3_floats(pieces[h->order[i]].area));
    out->begins[leaf + 1] = out->begins[leaf];
    for (size_t i = first; i < end; i++) {
        const size_t piece = h->order[i];
        const double weight = vec3_length(vec3_floats(pieces[piece].area)) / all;
        if (piece >= mesh->triangle_count)
            add_block(out, leaf, piece - mesh->triangle_count, weight);
        for (int k = 0; k < 3 && piece < mesh->triangle_count; k++)
            add_block(out, leaf, mesh->triangles[piece].vertex[k], weight / 3.0);
    }
}

static relume_status take_scene(struct relume_points *out, const struct scenery *c,
                                const struct hierarchy *h, const struct piece *pieces)
{
    const struct mesh *mesh = scenery_mesh(c);
    const size_t most = h->leaves ? 3 * h->begins[h->leaves] : 0;
    out->side = scenery_blocks(&out->across, c);
    out->begins = mem_zeroed(h->leaves + 1, sizeof *out->begins);
    out->block = mem_zeroed(most, sizeof *out->block);
    relume_status status = out->begins && out->block ? take_nodes(out, h) : RELUME_ENOMEM;
    for (size_t i = 0; i < h->leaves && !status; i++)
        put_scene_leaf(out, h, i, pieces, mesh);
    return status;
}

static relume_status points_of_scenery(struct relume_points *out, const struct scenery *c,
                                       const relume_objects *objects, int threads)
{
    struct hierarchy h = {0};
    struct piece *pieces;
    struct points points = {0};
    size_t count;
    relume_status status = pieces_of_scene(&pieces, &count, c, objects ? &objects->mesh : NULL);
    if (!status)
        status = hierarchy_create(&h, pieces, count, PIECES_SCENE, threads);
    if (!status)
        status = take_scene(out, c, &h, pieces);
    if (!status)
        status = points_of_scene(&points, c, SCENE_SPOTS);
    if (!status)
        status = take_spots(out, &points);
    points_forget(&points);
    hierarchy_forget(&h);
    mem_free(pieces);
    return status;
}

relume_status relume_points_of_scene(struct relume_points *out,
                                     const struct relume_geometry *geometry,
                                     const struct relume_image *places,
                                     const relume_objects *objects,
                                     const struct relume_points_params *given)
{
    const struct relume_points_params params = PARAMS_WORK(relume_points_params, given);
    struct scenery *c;
    *out = (struct relume_points){.node = NULL};
    if (places->channels != 3)
        return RELUME_EINVAL;
    relume_status status = scenery_create(&c, geometry, geometry->center, places, params.log);
    if (!status)
        status = points_of_scenery(out, c, objects, params.threads);
    scenery_destroy(&c);
    if (status)
        relume_points_free(out);
    return status;
}

// ---------------------------------------------------------------- objects

// Of light from directions spread as the cosine.
static void find_returned(float rgb[3], const relume_objects *o, const struct surface_point *p,
                          vec3 normal)
{
    enum { DIRECTIONS = 16 };
    const double golden = M_PI * (3.0 - sqrt(5.0));
    const vec3 any = fabs(normal.x) < 0.7 ? vec3_of(1, 0, 0) : vec3_of(0, 1, 0);
    const vec3 x = vec3_unit(vec3_cross(any, normal)), y = vec3_cross(normal, x);
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (int i = 0; i < DIRECTIONS; i++) {
        const double u = (i + 0.5) / DIRECTIONS, r = sqrt(u);
        const struct arrival a = {
            .towards =
                vec3_along(vec3_along(vec3_scale(normal, sqrt(1.0 - u)), x, r * cos(golden * i)), y,
                           r * sin(golden * i)),
            .share = 1.0 / DIRECTIONS,
            .with = {1.0f, 1.0f, 1.0f}};
        float part[3];
        objects_return(part, o, p, vec3_add(p->position, normal), &a);
        for (int c = 0; c < 3; c++)
            rgb[c] += isfinite(part[c]) ? fmaxf(part[c], 0.0f) : 0.0f;
    }
}

static void put_object_leaf(struct relume_points_leaf *to, const relume_objects *o,
                            const struct point *p, int side)
{
    const vec3 normal = side ? vec3_scale(p->normal, -1.0) : p->normal;
    const struct trace_hit hit = {p->triangle, p->u, p->v, 1.0f, 0};
    struct surface_point point;
    objects_point(&point, o, &hit, vec3_scale(normal, -1.0));
    vec3_store(to->place, p->place);
    vec3_store(to->normal, normal);
    find_returned(to->returned, o, &point, normal);
    skin_add_emission(to->emitted, o, &point, 1.0f);
}

static relume_status take_side(struct relume_points *out, const relume_objects *o,
                               const struct points *points, int side,
                               const struct relume_points_params *params)
{
    struct hierarchy h = {0};
    struct piece *pieces;
    relume_status status = pieces_of_points(&pieces, points, side);
    if (!status)
        status =
            hierarchy_create(&h, pieces, points->count, (size_t)params->leaves, params->threads);
    if (!status)
        status = take_nodes(out, &h);
    for (size_t i = 0; i < h.leaves && !status; i++)
        put_object_leaf(&out->leaf[i], o, &points->at[h.order[h.begins[i]]], side);
    hierarchy_forget(&h);
    mem_free(pieces);
    return status;
}

relume_status relume_points_of_objects(struct relume_points out[2], const relume_objects *o,
                                       const struct relume_points_params *given)
{
    enum { FEWEST = 64, MOST = 65536 };
    struct relume_points_params params = PARAMS_WORK(relume_points_params, given);
    struct points few = {0}, many = {0};
    out[0] = out[1] = (struct relume_points){.node = NULL};
    params.leaves = params.leaves ? params.leaves : PIECES_OBJECT;
    if (params.leaves < FEWEST || params.leaves > MOST || params.leaves & (params.leaves - 1))
        return RELUME_EINVAL;
    relume_status status =
        points_of_objects(&few, &o->mesh, o->tracer, (size_t)params.leaves, params.threads);
    if (!status)
        status = points_of_objects(&many, &o->mesh, o->tracer, OBJECT_SPOTS, params.threads);
    for (int k = 0; k < PIECES_SIDES && !status; k++)
        status = take_side(&out[k], o, &few, k, &params);
    if (!status)
        status = take_spots(&out[0], &many);
    points_forget(&few);
    points_forget(&many);
    for (int k = 0; k < PIECES_SIDES && status; k++)
        relume_points_free(&out[k]);
    return status;
}
