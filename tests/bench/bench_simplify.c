// bench_simplify: triangles at equal error, perceptual simplification beside quadrics with
// attributes and, where libmeshoptimizer2d is installed, meshoptimizer.
// bench_simplify MODEL ...; without a model it does nothing
//
// How many triangles the others need to be no worse: in the distance of the surfaces (Hausdorff, of
// vertices and middles of triangles, both ways), and in what is seen of the shading in two pictures
// from where the error is seen under 1/30 degree (JND that 1 % of the pixels exceed, and the most).
#include "bench.h"

#include <dlfcn.h>
#include <relume/jnd.h>
#include <relume/simplify.h>
#define RELUME_VEC3_SHORT
#include <relume/vec.h>

#include <string.h>

static double diagonal;  // of the original
static vec3 middle;

static vec3 at(const struct relume_mesh *m, uint32_t i)
{
    return vec3_of((double)m->position[i][0], (double)m->position[i][1], (double)m->position[i][2]);
}

static void must(bool good)
{
    if (!good)
        exit(1);
}

// ---------------------------------------------------------------- distance of surfaces

enum { CELLS = 48 };
struct grid {
    const struct relume_mesh *m;
    vec3 low;
    double side;
    uint32_t *first, *next, *triangle;
    size_t used, room;
};

static int cell_of(const struct grid *g, double v, double low)
{
    const int c = (int)floor((v - low) / g->side);
    return c < 0 ? 0 : c >= CELLS ? CELLS - 1 : c;
}

static void put(struct grid *g, int cell, uint32_t t)
{
    if (g->used == g->room) {
        g->room = g->room ? 2 * g->room : 1 << 16;
        must((g->next = realloc(g->next, g->room * sizeof *g->next)) &&
             (g->triangle = realloc(g->triangle, g->room * sizeof *g->triangle)));
    }
    g->next[g->used] = g->first[cell];
    g->triangle[g->used] = t;
    g->first[cell] = (uint32_t)g->used++;
}

static void grid_create(struct grid *g, const struct relume_mesh *m)
{
    *g = (struct grid){.m = m, .side = 1.02 * diagonal / CELLS};
    g->low = vec3_sub(middle, vec3_scale(vec3_of(1, 1, 1), 0.51 * diagonal));
    must((g->first = malloc(CELLS * CELLS * CELLS * sizeof *g->first)));
    memset(g->first, 0xff, CELLS * CELLS * CELLS * sizeof *g->first);
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        int low[3] = {CELLS, CELLS, CELLS}, high[3] = {0};
        for (int k = 0; k < 3; k++) {
            const vec3 p = at(m, m->triangle[t][k]);
            const int c[3] = {cell_of(g, p.x, g->low.x), cell_of(g, p.y, g->low.y),
                              cell_of(g, p.z, g->low.z)};
            for (int a = 0; a < 3; a++) {
                low[a] = c[a] < low[a] ? c[a] : low[a];
                high[a] = c[a] > high[a] ? c[a] : high[a];
            }
        }
        for (int z = low[2]; z <= high[2]; z++)
            for (int y = low[1]; y <= high[1]; y++)
                for (int x = low[0]; x <= high[0]; x++)
                    put(g, (z * CELLS + y) * CELLS + x, t);
    }
}

static void grid_free(struct grid *g)
{
    free(g->first);
    free(g->next);
    free(g->triangle);
}

static double to_segment(vec3 p, vec3 a, vec3 b)
{
    const vec3 ab = vec3_sub(b, a);
    const double along = vec3_dot(vec3_sub(p, a), ab), all = vec3_dot(ab, ab);
    const double t = all > 0.0 ? fmin(fmax(along / all, 0.0), 1.0) : 0.0;
    return vec3_length(vec3_sub(p, vec3_along(a, ab, t)));
}

// By the plane where the foot lies inside, else the nearest edge.
static double to_triangle(const struct relume_mesh *m, uint32_t t, vec3 p)
{
    const vec3 a = at(m, m->triangle[t][0]), b = at(m, m->triangle[t][1]),
               c = at(m, m->triangle[t][2]);
    const vec3 n = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
    const double size = vec3_length(n);
    const bool inside = vec3_dot(vec3_cross(vec3_sub(b, a), vec3_sub(p, a)), n) >= 0.0 &&
                        vec3_dot(vec3_cross(vec3_sub(c, b), vec3_sub(p, b)), n) >= 0.0 &&
                        vec3_dot(vec3_cross(vec3_sub(a, c), vec3_sub(p, c)), n) >= 0.0;
    if (size > 0.0 && inside)
        return fabs(vec3_dot(vec3_sub(p, a), n)) / size;
    return fmin(to_segment(p, a, b), fmin(to_segment(p, b, c), to_segment(p, c, a)));
}

static double to_mesh(const struct grid *g, vec3 p)
{
    const int c[3] = {cell_of(g, p.x, g->low.x), cell_of(g, p.y, g->low.y),
                      cell_of(g, p.z, g->low.z)};
    double best = INFINITY;
    for (int ring = 0; ring < CELLS && best > (ring - 1) * g->side; ring++)
        for (int z = c[2] - ring; z <= c[2] + ring; z++)
            for (int y = c[1] - ring; y <= c[1] + ring; y++)
                for (int x = c[0] - ring; x <= c[0] + ring; x++) {
                    const bool rim =
                        abs(z - c[2]) == ring || abs(y - c[1]) == ring || abs(x - c[0]) == ring;
                    if (!rim || x < 0 || y < 0 || z < 0 || x >= CELLS || y >= CELLS || z >= CELLS)
                        continue;
                    for (uint32_t i = g->first[(z * CELLS + y) * CELLS + x]; i != UINT32_MAX;
                         i = g->next[i])
                        best = fmin(best, to_triangle(g->m, g->triangle[i], p));
                }
    return best;
}

static double one_way(const struct relume_mesh *from, const struct grid *to)
{
    double worst = 0.0;
    for (uint32_t t = 0; t < from->triangle_count; t++) {
        const uint32_t *v = from->triangle[t];
        const vec3 a = at(from, v[0]), b = at(from, v[1]), c = at(from, v[2]);
        worst = fmax(worst, to_mesh(to, a));
        worst = fmax(worst, to_mesh(to, vec3_scale(vec3_add(a, vec3_add(b, c)), 1.0 / 3)));
        worst = fmax(worst, to_mesh(to, vec3_scale(vec3_add(b, c), 0.5)));
    }
    return worst;
}

// ---------------------------------------------------------------- pictures

enum { PICTURES = 2 };
static void shade(float *rgb, vec3 n, vec3 light)
{
    const vec3 half = vec3_unit(vec3_add(light, vec3_of(0, 0, 1)));
    const double facing = fmax(vec3_dot(n, light), 0.0);
    const double v =
        0.02 + 0.5 * facing + (facing > 0.0 ? 0.3 * pow(fmax(vec3_dot(n, half), 0.0), 20.0) : 0.0);
    rgb[0] = rgb[1] = rgb[2] = (float)v;
}

// A picture, and the pixels in which one surface ends before another, or before nothing.
struct view {
    struct relume_image picture;
    uint8_t *edge;  // [size][size]
};

static void view_free(struct view *v)
{
    relume_image_destroy(&v->picture);
    free(v->edge);
}

// Of pictures of twice the size; neighbours of one surface differ by less than some pixels.
static void find_edges(uint8_t *edge, const float *depth, int size)
{
    const float STEP = 6.0f;
    for (int j = 0; j + 1 < size; j++)
        for (int i = 0; i + 1 < size; i++) {
            const float d = depth[j * size + i], right = depth[j * size + i + 1],
                        down = depth[(j + 1) * size + i];
            const bool nothing = isinf(d) && isinf(right) && isinf(down);
            if (!nothing && !(fabsf(d - right) < STEP && fabsf(d - down) < STEP))
                edge[j / 2 * (size / 2) + i / 2] = 1;
        }
}

// Seen along z after turning about y, from afar.
static struct relume_image draw_fine(const struct relume_mesh *m, int size, int picture,
                                     uint8_t *edge)
{
    const double phi = 2.0 * 3.14159265358979 * picture / PICTURES, c = cos(phi), s = sin(phi);
    const vec3 light = vec3_unit(vec3_of(picture % 2 ? 0.7 : -0.5, 0.6, 0.6));
    struct relume_image out;
    float *depth = malloc((size_t)size * (size_t)size * sizeof *depth);
    must(!relume_image_create(&out, size, size, 3) && depth);
    for (int i = 0; i < size * size; i++)
        depth[i] = -INFINITY;
    for (size_t t = 0; t < m->triangle_count; t++) {
        double x[3], y[3], z[3];
        vec3 n[3];
        for (int k = 0; k < 3; k++) {
            const uint32_t v = m->triangle[t][k];
            const vec3 p = vec3_scale(vec3_sub(at(m, v), middle), size / diagonal);
            x[k] = c * p.x + s * p.z + 0.5 * size;
            y[k] = 0.5 * size - p.y;
            z[k] = c * p.z - s * p.x;
            const float *g = m->normal[v];
            n[k] = vec3_of(c * (double)g[0] + s * (double)g[2], (double)g[1],
                           c * (double)g[2] - s * (double)g[0]);
        }
        const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
        const int top = (int)fmax(0, floor(fmin(y[0], fmin(y[1], y[2])))),
                  bottom = (int)fmin(size - 1, ceil(fmax(y[0], fmax(y[1], y[2])))),
                  left = (int)fmax(0, floor(fmin(x[0], fmin(x[1], x[2])))),
                  right = (int)fmin(size - 1, ceil(fmax(x[0], fmax(x[1], x[2]))));
        for (int j = top; area != 0.0 && j <= bottom; j++)
            for (int i = left; i <= right; i++) {
                const double px = i + 0.5, py = j + 0.5;
                const double w1 =
                    ((px - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (py - y[0])) / area;
                const double w2 =
                    ((x[1] - x[0]) * (py - y[0]) - (px - x[0]) * (y[1] - y[0])) / area;
                const double w0 = 1.0 - w1 - w2, d = w0 * z[0] + w1 * z[1] + w2 * z[2];
                if (w0 < 0.0 || w1 < 0.0 || w2 < 0.0 || d <= (double)depth[j * size + i])
                    continue;
                vec3 normal = vec3_scale(n[0], w0);
                normal = vec3_along(vec3_along(normal, n[1], w1), n[2], w2);
                depth[j * size + i] = (float)d;
                if (vec3_length(normal) > 0.0)
                    shade(out.data + 3 * (j * size + i), vec3_unit(normal), light);
            }
    }
    find_edges(edge, depth, size);
    free(depth);
    return out;
}

// Four samples a pixel.
static struct view draw(const struct relume_mesh *m, int size, int picture)
{
    struct view out = {.edge = calloc((size_t)size * (size_t)size, 1)};
    must(out.edge != NULL);
    struct relume_image fine = draw_fine(m, 2 * size, picture, out.edge);
    must(!relume_image_scale(&out.picture, &fine, size, size, NULL));
    relume_image_destroy(&fine);
    return out;
}

// Where the surface is seen in both, some pixels away from all outlines: what is left of shading.
// Elsewhere the first becomes the second: an outline that moves is so bright a step that its coarse
// part is seen all over the surface.
static struct relume_image inside(struct view *a, const struct view *b)
{
    enum { AWAY = 3 };
    struct relume_image mask;
    const int n = a->picture.width;
    must(!relume_image_create(&mask, n, n, 1));
    for (int y = AWAY; y < n - AWAY; y++)
        for (int x = AWAY; x < n - AWAY; x++) {
            bool all = a->picture.data[3 * (y * n + x)] > 0.0f;
            for (int j = y - AWAY; j <= y + AWAY; j++)
                for (int i = x - AWAY; i <= x + AWAY; i++)
                    all &= !a->edge[j * n + i] && !b->edge[j * n + i];
            mask.data[y * n + x] = all;
        }
    for (int i = 0; i < n * n; i++)
        if (!(mask.data[i] > 0.5f))
            memcpy(a->picture.data + 3 * i, b->picture.data + 3 * i, 3 * sizeof(float));
    return mask;
}

enum measure { NEAR, LIKE, NOWHERE, MEASURES };
struct judged {
    double of[MEASURES];
};

static struct view original[PICTURES];

static void look(struct judged *j, const struct relume_mesh *m, double ppd)
{
    j->of[LIKE] = j->of[NOWHERE] = 0.0;
    for (int i = 0; i < PICTURES; i++) {
        struct view now = draw(m, original[i].picture.width, i);
        struct relume_image mask = inside(&now, &original[i]);
        struct relume_jnd d;
        must(!relume_image_jnd(&d, NULL, &now.picture, &original[i].picture,
                               relume_jnd_params(.pixels_per_degree = ppd, .mask = &mask)));
        j->of[LIKE] += d.most / PICTURES;
        j->of[NOWHERE] += d.max / PICTURES;
        relume_image_destroy(&mask);
        view_free(&now);
    }
}

static double distance_of(const struct relume_mesh *m, const struct relume_mesh *reference,
                          const struct grid *grid)
{
    struct grid own;
    grid_create(&own, m);
    const double d = fmax(one_way(m, grid), one_way(reference, &own)) / diagonal;
    grid_free(&own);
    return d;
}

// ---------------------------------------------------------------- the others

typedef size_t meshopt(unsigned *, const unsigned *, size_t, const float *, size_t, size_t, size_t,
                       float, unsigned, float *);
static meshopt *meshopt_simplify;

static bool reduce(struct relume_mesh *out, const struct relume_mesh *m, size_t triangles,
                   bool by_meshopt)
{
    if (!by_meshopt)
        return !relume_mesh_simplify(
            out, NULL, m, relume_simplify_params(.triangles = triangles, .quadrics = true));
    *out = *m;  // the same vertices
    out->triangle = malloc(m->triangle_count * sizeof *out->triangle);
    must(out->triangle != NULL);
    out->triangle_count =
        meshopt_simplify(out->triangle[0], m->triangle[0], 3 * m->triangle_count, m->position[0],
                         m->vertex_count, sizeof *m->position, 3 * triangles, 1.0f, 0, NULL) /
        3;
    return true;
}

static void drop(struct relume_mesh *m, bool by_meshopt)
{
    if (by_meshopt)
        free(m->triangle);
    else
        relume_mesh_free(m);
}

// The fewest triangles that are no worse by one measure.
static size_t fewest(const struct relume_mesh *m, const struct grid *grid, double ppd,
                     const struct judged *want, enum measure by, bool by_meshopt)
{
    double low = log(32.0), high = log((double)m->triangle_count);
    for (int i = 0; i < 7; i++) {
        const double n = 0.5 * (low + high);
        struct relume_mesh small;
        struct judged j;
        must(reduce(&small, m, (size_t)exp(n), by_meshopt));
        if (by == NEAR)
            j.of[NEAR] = distance_of(&small, m, grid);
        else
            look(&j, &small, ppd);
        *(j.of[by] <= want->of[by] ? &high : &low) = n;
        drop(&small, by_meshopt);
    }
    return (size_t)exp(high);
}

// How many of each the others need.
static void others(const struct relume_mesh *small, const struct relume_mesh *m,
                   const struct grid *grid, double ppd, const struct judged *own)
{
    for (int peer = 0; peer < 1 + (meshopt_simplify != NULL); peer++) {
        size_t n[MEASURES];
        for (int by = 0; by < MEASURES; by++)
            n[by] = fewest(m, grid, ppd, own, (enum measure)by, peer);
        printf("  %s: %zu as near, %zu for the 99%%, %zu for all: ratios %.2f, %.2f, %.2f\n",
               peer ? "meshoptimizer" : "quadrics", n[NEAR], n[LIKE], n[NOWHERE],
               (double)small->triangle_count / (double)n[NEAR],
               (double)small->triangle_count / (double)n[LIKE],
               (double)small->triangle_count / (double)n[NOWHERE]);
        fflush(stdout);
    }
}

static void compare(const char *name, const struct relume_mesh *m, double error)
{
    static const double jnd[] = {1.0, 4.0};
    const double seen_from = error / (2.0 * tan(3.14159265358979 / 180 / 60));
    const double width_deg = 2.0 * atan(0.5 / seen_from) * 180.0 / 3.14159265358979;
    const int size = (int)fmax(192.0, 20.0 * width_deg);
    const double ppd = size / width_deg;
    struct grid grid;
    grid_create(&grid, m);
    for (int i = 0; i < PICTURES; i++)
        original[i] = draw(m, size, i);
    for (size_t k = 0; k < sizeof jnd / sizeof *jnd; k++) {
        struct relume_mesh small;
        const double start = now_s();
        must(!relume_mesh_simplify(&small, NULL, m,
                                   relume_simplify_params(.error = error, .jnd = jnd[k])));
        const double time = now_s() - start;
        struct judged own = {.of = {distance_of(&small, m, &grid)}};
        look(&own, &small, ppd);
        printf("%s %g%% %g JND: %zu triangles of %zu in %.2f s, distance %.3f%%, 99%% below %.2f "
               "JND, all below %.2f\n",
               name, 100 * error, jnd[k], small.triangle_count, m->triangle_count, time,
               100 * own.of[NEAR], own.of[LIKE], own.of[NOWHERE]);
        fflush(stdout);
        others(&small, m, &grid, ppd, &own);
        relume_mesh_free(&small);
    }
    grid_free(&grid);
    for (int i = 0; i < PICTURES; i++)
        view_free(&original[i]);
}

int main(int argc, char **argv)
{
    void *library = dlopen("libmeshoptimizer.so.2d", RTLD_NOW);
    void *symbol = library ? dlsym(library, "meshopt_simplify") : NULL;
    memcpy(&meshopt_simplify, &symbol, sizeof symbol);
    for (int i = 1; i < argc; i++) {
        struct relume_mesh m;
        must(!relume_mesh_read(&m, argv[i], NULL));
        vec3 low = at(&m, 0), high = low;
        for (uint32_t v = 0; v < m.vertex_count; v++) {
            const vec3 p = at(&m, v);
            low = vec3_of(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
            high = vec3_of(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
        }
        middle = vec3_scale(vec3_add(low, high), 0.5);
        diagonal = vec3_length(vec3_sub(high, low));
        compare(argv[i], &m, 0.001);
        compare(argv[i], &m, 0.01);
        relume_mesh_free(&m);
    }
    return 0;
}
