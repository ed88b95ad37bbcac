// octree.c - triangles as cells of an octree, and rays through it
//
// Each triangle is clipped by the cells that it goes through; of each cell normals count by their
// area in it, and the material of the largest area is the cell's. A ray goes from cell to cell:
// down to the one that holds a point of it, past that where it is empty, up while the point is
// outside.
#include "cli/measure/octree.h"

#include "core/base/memory.h"

#include <string.h>

enum { MOST_DEPTH = 10, MOST_CORNERS = 12 };

struct node {
    uint32_t child[8];  // 0: nothing is there
    float normal[3];    // of all below, each by its area
    uint32_t material;
    float area, of_material;  // the part that its material covers
};
struct octree {
    struct node *node;  // the first is the root
    size_t nodes;
    vec3 min;
    double side;  // of the root
    int depth;
    bool failed;
};

// ---------------------------------------------------------------- cells

// A convex piece of a triangle, in units of the root's side.
struct piece {
    vec3 corner[MOST_CORNERS];
    int corners;
};

static double along(vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

// What of a piece lies on one side of a plane.
static void clip(struct piece *out, const struct piece *from, int axis, double at, double side)
{
    out->corners = 0;
    for (int i = 0; i < from->corners; i++) {
        const vec3 a = from->corner[i], b = from->corner[(i + 1) % from->corners];
        const double da = side * (along(a, axis) - at), db = side * (along(b, axis) - at);
        if (da >= 0.0 && out->corners < MOST_CORNERS)
            out->corner[out->corners++] = a;
        if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0))
            if (out->corners < MOST_CORNERS)
                out->corner[out->corners++] = vec3_along(a, vec3_sub(b, a), da / (da - db));
    }
}

static vec3 twice_area(const struct piece *p)
{
    vec3 sum = {0, 0, 0};
    for (int i = 2; i < p->corners; i++)
        sum = vec3_add(sum, vec3_cross(vec3_sub(p->corner[i - 1], p->corner[0]),
                                       vec3_sub(p->corner[i], p->corner[0])));
    return sum;
}

static uint32_t child_of(octree *o, uint32_t number, int which)
{
    if (o->node[number].child[which])
        return o->node[number].child[which];
    if (!mem_grow(&o->node, o->nodes, sizeof *o->node)) {
        o->failed = true;
        return 0;
    }
    const uint32_t made = (uint32_t)o->nodes++;
    o->node[made] = (struct node){.area = 0.0f};
    o->node[number].child[which] = made;
    return made;
}

// Triangles come by their materials: what a cell has of the present one is known when it ends.
struct adding {
    octree *o;
    uint32_t material;
    float *of_present;  // [nodes]
    size_t capacity;
};

static void add_area(struct adding *a, uint32_t number, vec3 twice)
{
    struct node *n = &a->o->node[number];
    n->area += (float)(0.5 * vec3_length(twice));
    n->normal[0] += (float)twice.x, n->normal[1] += (float)twice.y;
    n->normal[2] += (float)twice.z;
}

static void add_piece(struct adding *a, uint32_t number, const struct piece *piece, vec3 low,
                      double side, int depth)
{
    const vec3 twice = twice_area(piece);
    if (!(vec3_length(twice) > 0.0) || a->o->failed)
        return;
    add_area(a, number, twice);
    for (int i = 0; i < 8 && depth < a->o->depth; i++) {
        const double half = 0.5 * side;
        const vec3 corner = vec3_of(low.x + (i & 1) * half, low.y + (i >> 1 & 1) * half,
                                    low.z + (i >> 2 & 1) * half);
        struct piece one = *piece, two;
        for (int axis = 0; axis < 3 && one.corners; axis++) {
            const bool upper = i >> axis & 1;
            clip(&two, &one, axis, along(low, axis) + half, upper ? 1.0 : -1.0);
            one = two;
        }
        if (one.corners < 3 || !(vec3_length(twice_area(&one)) > 0.0))
            continue;
        const uint32_t child = child_of(a->o, number, i);
        if (child)
            add_piece(a, child, &one, corner, half, depth + 1);
    }
}

// After the triangles of one material: which cells it covers more of than any before it.
static bool end_material(struct adding *a)
{
    octree *o = a->o;
    if (a->capacity < o->nodes) {
        float *more = mem_resize(a->of_present, o->nodes, sizeof *more);
        if (!more)
            return false;
        memset(more + a->capacity, 0, (o->nodes - a->capacity) * sizeof *more);
        a->of_present = more, a->capacity = o->nodes;
    }
    for (size_t i = 0; i < o->nodes; i++) {
        const float present = o->node[i].area - a->of_present[i];
        if (present > o->node[i].of_material) {
            o->node[i].of_material = present;
            o->node[i].material = a->material;
        }
        a->of_present[i] = o->node[i].area;
    }
    return true;
}

static void add_triangles(struct adding *a, const struct mesh *m)
{
    octree *o = a->o;
    for (size_t i = 0; i < m->triangle_count; i++) {
        struct piece p = {.corners = 3};
        if (m->triangles[i].material != a->material)
            continue;
        for (int k = 0; k < 3; k++)
            p.corner[k] = vec3_scale(
                vec3_sub(vertex_position(&m->vertices[m->triangles[i].vertex[k]]), o->min),
                1.0 / o->side);
        add_piece(a, 0, &p, vec3_of(0, 0, 0), 1.0, 0);
    }
}

relume_status octree_create(octree **out, const struct mesh *mesh, int depth)
{
    const double BEYOND = 1e-6;  // nothing lies on the outer faces
    const struct bounds b = mesh_bounds(mesh);
    const vec3 size = vec3_sub(b.max, b.min);
    octree *o = mem_zeroed(1, sizeof *o);
    struct adding a = {.o = o};
    uint32_t last = 0;
    *out = NULL;
    if (!o || !mem_grow(&o->node, 0, sizeof *o->node)) {
        octree_destroy(&o);
        return RELUME_ENOMEM;
    }
    o->node[0] = (struct node){.area = 0.0f};
    o->nodes = 1;
    o->depth = depth < 1 ? 1 : depth > MOST_DEPTH ? MOST_DEPTH : depth;
    o->side = (1.0 + 2.0 * BEYOND) * fmax(fmax(size.x, size.y), fmax(size.z, 1e-30));
    o->min = vec3_sub(b.min, vec3_scale(vec3_of(1, 1, 1), BEYOND * o->side));
    for (size_t i = 0; i < mesh->triangle_count; i++)
        last = mesh->triangles[i].material > last ? mesh->triangles[i].material : last;
    bool good = true;
    for (; a.material <= last && good; a.material++) {
        add_triangles(&a, mesh);
        good = !o->failed && end_material(&a);
    }
    mem_free(a.of_present);
    if (!good)
        octree_destroy(&o);
    *out = o;
    return good ? RELUME_OK : RELUME_ENOMEM;
}

void octree_destroy(octree **o)
{
    if (*o)
        mem_free((*o)->node);
    mem_free(*o);
    *o = NULL;
}

size_t octree_bytes(const octree *o)
{
    return o->nodes * sizeof *o->node;
}

double octree_cell(const octree *o)
{
    return o->side / (double)(1 << o->depth);
}

// ---------------------------------------------------------------- rays

struct walk {
    double from[3], along[3];  // in finest cells
    double t;
    int cell[3];  // that the ray is in
};

static void find_cell(struct walk *w, int cells)
{
    for (int k = 0; k < 3; k++) {
        const int at = (int)floor(w->from[k] + w->t * w->along[k]);
        w->cell[k] = at < 0 ? 0 : at < cells ? at : cells - 1;
    }
}

// Where the ray enters and leaves a cube.
static bool cross(double span[2], const struct walk *w, const double low[3], double side)
{
    span[0] = 0.0, span[1] = INFINITY;
    for (int k = 0; k < 3; k++) {
        if (w->along[k] == 0.0) {
            if (w->from[k] < low[k] || w->from[k] > low[k] + side)
                return false;
            continue;
        }
        const double a = (low[k] - w->from[k]) / w->along[k];
        const double b = (low[k] + side - w->from[k]) / w->along[k];
        span[0] = fmax(span[0], fmin(a, b));
        span[1] = fmin(span[1], fmax(a, b));
    }
    return span[0] < span[1];
}

static void report(struct octree_hit *out, const octree *o, const struct node *n, double distance,
                   double side)
{
    const vec3 normal = vec3_of(n->normal[0], n->normal[1], n->normal[2]);
    *out = (struct octree_hit){.distance = distance,
                               .side = side * octree_cell(o),
                               .normal = vec3_length(normal) > 0.0 ? vec3_unit(normal) : normal,
                               .material = n->material};
}

bool octree_trace(struct octree_hit *out, const octree *o, vec3 origin, vec3 direction, double cone)
{
    const double cell = octree_cell(o), root[3] = {0, 0, 0}, PAST = 1e-7;
    const int cells = 1 << o->depth;
    const vec3 at = vec3_scale(vec3_sub(origin, o->min), 1.0 / cell);
    struct walk w = {{at.x, at.y, at.z}, {direction.x, direction.y, direction.z}, 0, {0}};
    uint32_t stack[MOST_DEPTH + 1] = {0};
    int level = 0, path[3] = {0};  // of the stack's last node
    double whole[2];
    if (!cross(whole, &w, root, cells))
        return false;
    w.t = whole[0];
    while (w.t < whole[1]) {
        find_cell(&w, cells);
        for (int k = 0; k < 3; k++)  // up, while the point is outside
            while (w.cell[k] >> (o->depth - level) != path[k] >> (o->depth - level))
                level--;
        for (int k = 0; k < 3; k++)
            path[k] = w.cell[k];
        bool there = true;
        while (there && level < o->depth && (double)(1 << (o->depth - level)) > cone * w.t) {
            const int bit = o->depth - level - 1;
            const int which =
                (w.cell[0] >> bit & 1) | (w.cell[1] >> bit & 1) << 1 | (w.cell[2] >> bit & 1) << 2;
            const uint32_t next = o->node[stack[level]].child[which];
            stack[++level] = next;
            there = next != 0;
        }
        if (there) {
            report(out, o, &o->node[stack[level]], w.t * cell, 1 << (o->depth - level));
            return true;
        }
        double low[3], span[2];
        const int side = 1 << (o->depth - level);
        for (int k = 0; k < 3; k++)
            low[k] = (double)(w.cell[k] & ~(side - 1));
        w.t = (cross(span, &w, low, side) ? fmax(span[1], w.t) : w.t) + PAST * cells;
        level--;  // the empty cell is no node
    }
    return false;
}
