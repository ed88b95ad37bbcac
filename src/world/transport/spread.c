// spread.c - points spread evenly over triangles
//
// Far more places than points are put on the triangles, one for every so much of their area, and
// sorted into the cells of a grid, apart by the side that they face. What is in one becomes one
// point, of the area of all, in their middle: sums of smooth functions over the points are exact to
// second order, and the areas add up.
#include "world/transport/spread.h"

#include "core/base/memory.h"

enum { PLACES = 8, MOST_LEVELS = 20 };

struct place {
    uint64_t cell;  // and which of six sides it faces, in the lowest digits
    float position[3];
    uint32_t triangle;
    float u, v;
};

static double wrapped(double x)
{
    return x - floor(x);
}

// Place number i of a triangle (R2: Roberts 2018), folded into it.
static void put_within(struct place *out, const vec3 c[3], uint32_t triangle, size_t i)
{
    const double G1 = 0.7548776662466927, G2 = 0.5698402909980532;
    double u = wrapped(0.5 + G1 * (double)i), v = wrapped(0.5 + G2 * (double)i);
    if (u + v > 1.0)
        u = 1.0 - u, v = 1.0 - v;
    const vec3 at = vec3_along(vec3_along(c[0], vec3_sub(c[1], c[0]), u), vec3_sub(c[2], c[0]), v);
    out->position[0] = (float)at.x, out->position[1] = (float)at.y, out->position[2] = (float)at.z;
    out->triangle = triangle;
    out->u = (float)u, out->v = (float)v;
}

static int side_of(vec3 n)
{
    const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    return x >= y && x >= z ? 0 + (n.x > 0.0) : y >= z ? 2 + (n.y > 0.0) : 4 + (n.z > 0.0);
}

// The digits of x, two places apart.
static uint64_t apart(uint64_t x)
{
    uint64_t out = 0;
    for (int i = 0; i < MOST_LEVELS; i++)
        out |= (x >> i & 1u) << (3 * i);
    return out;
}

struct grid {
    vec3 min;
    double side;  // of a cell
    int levels;
};

static uint64_t cell_of(const struct grid *g, const float position[3])
{
    const double most = (double)((1u << g->levels) - 1);
    const double min[3] = {g->min.x, g->min.y, g->min.z};
    uint64_t cell = 0;
    for (int k = 0; k < 3; k++) {
        const double at = floor(((double)position[k] - min[k]) / g->side);
        cell |= apart((uint64_t)fmin(fmax(at, 0.0), most)) << k;
    }
    return cell;
}

static int by_cell(const void *a, const void *b)
{
    const struct place *p = a, *q = b;
    if (p->cell != q->cell)
        return p->cell < q->cell ? -1 : 1;
    if (p->triangle != q->triangle)
        return p->triangle < q->triangle ? -1 : 1;
    return (p->u > q->u) - (p->u < q->u);
}

static struct grid grid_over(const struct mesh *m, const uint32_t *triangle, size_t count,
                             double area)
{
    const double ACROSS = 1.5;  // cells that a piece of the size of one goes through, on average
    vec3 min = vec3_of(INFINITY, INFINITY, INFINITY), max = vec3_scale(min, -1.0);
    for (size_t i = 0; i < count; i++) {
        vec3 c[3];
        mesh_corners(c, m, triangle[i]);
        for (int k = 0; k < 3; k++) {
            const vec3 p = c[k];
            min = vec3_of(fmin(min.x, p.x), fmin(min.y, p.y), fmin(min.z, p.z));
            max = vec3_of(fmax(max.x, p.x), fmax(max.y, p.y), fmax(max.z, p.z));
        }
    }
    const double extent = fmax(fmax(max.x - min.x, max.y - min.y), max.z - min.z);
    struct grid g = {.min = min, .side = sqrt(ACROSS * area)};
    while (g.levels < MOST_LEVELS && g.side * (double)(1u << g.levels) < extent)
        g.levels++;
    g.side = fmax(g.side, extent / (double)(1u << g.levels));
    return g;
}

// One place for each `step` of the area, from the middle of the first on.
static size_t put_places(struct place *out, size_t capacity, const struct mesh *m,
                         const uint32_t *triangle, size_t count, double step, const struct grid *g)
{
    double before = 0.0;
    size_t n = 0;
    for (size_t i = 0; i < count; i++) {
        vec3 c[3];
        mesh_corners(c, m, triangle[i]);
        const vec3 twice = mesh_twice_area(c);
        before += 0.5 * vec3_length(twice);
        while (n < capacity && ((double)n + 0.5) * step < before) {
            put_within(&out[n], c, triangle[i], n);
            out[n].cell = cell_of(g, out[n].position) << 3 | (uint64_t)side_of(twice);
            n++;
        }
    }
    return n;
}

static void join(struct spread_point *out, const struct mesh *m, const struct place *place,
                 size_t n, double step)
{
    vec3 middle = {0, 0, 0}, normal = {0, 0, 0};
    double least = INFINITY;
    for (size_t i = 0; i < n; i++) {
        vec3 c[3];
        mesh_corners(c, m, place[i].triangle);
        const float *p = place[i].position;
        middle = vec3_along(middle, vec3_of(p[0], p[1], p[2]), 1.0 / (double)n);
        normal = vec3_add(normal, vec3_unit(mesh_twice_area(c)));
    }
    *out = (struct spread_point){.cell = place->cell >> 3, .area = (float)(step * (double)n)};
    for (size_t i = 0; i < n; i++) {
        const float *p = place[i].position;
        const double off = vec3_length(vec3_sub(vec3_of(p[0], p[1], p[2]), middle));
        if (off < least) {
            least = off;
            out->triangle = place[i].triangle;
            out->u = place[i].u, out->v = place[i].v;
        }
    }
    normal = vec3_unit(normal);
    out->position[0] = (float)middle.x, out->position[1] = (float)middle.y;
    out->position[2] = (float)middle.z;
    out->normal[0] = (float)normal.x, out->normal[1] = (float)normal.y;
    out->normal[2] = (float)normal.z;
}

static double area_of(const struct mesh *m, const uint32_t *triangle, size_t count)
{
    double area = 0.0;
    for (size_t i = 0; i < count; i++) {
        vec3 c[3];
        mesh_corners(c, m, triangle[i]);
        area += 0.5 * vec3_length(mesh_twice_area(c));
    }
    return area;
}

relume_status spread_make(struct spread *out, const struct mesh *mesh, const uint32_t *triangle,
                          size_t count, size_t wanted)
{
    const double area = area_of(mesh, triangle, count);
    const size_t capacity = PLACES * wanted;
    const double step = area / (double)capacity;
    struct place *place = mem_array(capacity, sizeof *place);
    *out = (struct spread){.point = mem_array(capacity, sizeof *out->point)};
    if (!place || !out->point) {
        mem_free(place);
        spread_free(out);
        return RELUME_ENOMEM;
    }
    const struct grid g = grid_over(mesh, triangle, count, area / (double)wanted);
    const size_t n = area > 0.0 ? put_places(place, capacity, mesh, triangle, count, step, &g) : 0;
    qsort(place, n, sizeof *place, by_cell);
    out->levels = g.levels;
    for (size_t i = 0, end; i < n; i = end) {
        for (end = i + 1; end < n && place[end].cell == place[i].cell; end++)
            ;
        join(&out->point[out->count++], mesh, place + i, end - i, step);
    }
    mem_free(place);
    struct spread_point *fewer = mem_resize(out->point, out->count, sizeof *fewer);
    out->point = fewer ? fewer : out->point;
    return RELUME_OK;
}

void spread_free(struct spread *s)
{
    mem_free(s->point);
    *s = (struct spread){.point = NULL};
}
