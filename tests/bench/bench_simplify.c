// bench_simplify: triangles at equal error, perceptual simplification beside quadrics with
// attributes, the same tested for attributes, and, where libmeshoptimizer2d is installed,
// meshoptimizer. bench_simplify [-t] [-e ERROR] MODEL ...; without a model it does nothing. -t:
// beside the tested peer alone; -e: at this error, diagonals, else 0.001 and 0.01
//
// How many triangles the others need to be no worse: in the distance of the surfaces (Hausdorff, of
// vertices and middles of triangles, both ways), and in what is seen of the shading in six pictures
// from where the error is seen under 1/30 degree (JND that 1 % of the pixels exceed, and the most).
#include "bench.h"

#include "shape/mesh/simplify_run.h"

#include <dlfcn.h>
#include <relume/image/jnd.h>
#include <relume/shape/simplify.h>
#define RELUME_VEC3_SHORT
#include <relume/core/vec.h>

#include <string.h>
#include <unistd.h>

static bool table;
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
    size_t used, capacity;
};

static int cell_of(const struct grid *g, double v, double low)
{
    const int c = (int)floor((v - low) / g->side);
    return c < 0 ? 0 : c >= CELLS ? CELLS - 1 : c;
}

static void put(struct grid *g, int cell, uint32_t t)
{
    if (g->used == g->capacity) {
        g->capacity = g->capacity ? 2 * g->capacity : 1 << 16;
        must((g->next = realloc(g->next, g->capacity * sizeof *g->next)) &&
             (g->triangle = realloc(g->triangle, g->capacity * sizeof *g->triangle)));
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

enum { PICTURES = 6 };
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

// ---------------------------------------------------------------- attributes kept within the error

// Simplification in the way of Guthe, Borodin, Balazs, Klein 2004: the same collapses in the order
// of the same quadrics, each tested; attributes may not be farther from where they were than the
// surface may. A texture slides by that at most; a normal is found again within that distance, by
// how fast the original's normals turn there.
struct keeper {
    struct simplify s;
    struct queue queue;
    struct samples samples;
    struct fan fan, there;
    double *bend;  // [points]: of normals, 1 / diagonal
    struct error most;
};

static void find_bend(struct keeper *k)
{
    const struct relume_mesh *m = k->s.mesh;
    double *edges = calloc(k->s.connect.points, sizeof *edges);
    must(edges && (k->bend = calloc(k->s.connect.points, sizeof *k->bend)));
    for (size_t t = 0; t < m->triangle_count; t++)
        for (int i = 0; i < 6; i++) {
            const uint32_t a = m->triangle[t][i % 3], b = m->triangle[t][(i % 3 + 1 + i / 3) % 3];
            const double length = vec3_length(vec3_sub(place(&k->s, a), place(&k->s, b)));
            const uint32_t at = k->s.connect.point[a];
            if (!(length > 0.0))
                continue;
            const double turn = vec3_length(vec3_sub(normal_of(&k->s, a), normal_of(&k->s, b)));
            k->bend[at] += turn * turn / (length * length);
            edges[at] += 0.5;  // the mean square over directions is half of that along one
        }
    for (uint32_t p = 0; p < k->s.connect.points; p++)
        k->bend[p] = edges[p] > 0.0 ? sqrt(k->bend[p] / edges[p]) : 0.0;
    free(edges);
}

static void keeper_create(struct keeper *k, const struct relume_mesh *m, double error)
{
    struct run run = {.s = {.mesh = m, .middle = middle, .scale = 1.0 / diagonal}};
    must(!run_settle(&run, relume_simplify_params(.error = error)));
    k->s = run.s;
    k->most = (struct error){error, INFINITY};
    must(!connect_create(&k->s.connect, m, m->triangle, m->triangle_count, m->part) &&
         !quadrics_create(&k->s) && !samples_create(&k->s, NULL) &&
         !near_create(&k->s.near, &k->s, error) && !queue_create(&k->queue, k->s.connect.points));
    find_bend(k);
}

static void keeper_free(struct keeper *k)
{
    struct run run = {.s = k->s, .queue = k->queue, .samples = k->samples};
    run_free(&run);
    free(k->bend);
}

static double cheapest(struct keeper *k, uint32_t point, double from, int *neighbour)
{
    struct moves moves;
    double least = INFINITY;
    for (int i = 0; i < k->fan.neighbours; i++) {
        if (!connect_is_target(&k->fan, i) ||
            !connect_moves(&k->s.connect, point, &k->fan, k->fan.neighbour[i], &moves))
            continue;
        const double cost = quadrics_error(&k->s, point, &moves);
        if (cost > from && cost < least) {
            least = cost;
            *neighbour = i;
        }
    }
    return least;
}

static bool keeps_normals(const struct keeper *k)
{
    for (size_t i = 0; i < k->samples.own; i++) {
        const struct landing *l = &k->samples.landing[i];
        vec3 n = vec3_of(0, 0, 0);
        for (int c = 0; c < 3; c++)
            n = vec3_along(n, normal_of(&k->s, l->corner[c]), (double)l->weight[c]);
        const double off = vec3_length(vec3_sub(vec3_unit(n), normal_of(&k->s, l->vertex)));
        // on a plane float normals differ by rounding
        if (off > fmax(k->bend[k->s.connect.point[l->vertex]] * k->most.length, 1e-4))
            return false;
    }
    return true;
}

static bool keep_point(struct keeper *k, uint32_t point)
{
    double cost = -1.0;
    int i = 0;
    while ((cost = cheapest(k, point, cost, &i)) < (double)INFINITY) {
        const uint32_t target = k->fan.neighbour[i];
        struct moves moves;
        struct error error;
        if (!connect_may_move(&k->s.connect, point, &k->fan, i, &moves, &k->there))
            continue;
        must(samples_try(&k->s, &k->samples, &error, &k->fan, &k->there, target, &moves, &k->most));
        if (error.length > k->most.length || !keeps_normals(k))
            continue;
        samples_move(&k->s, &k->samples, &k->fan);
        quadrics_move(&k->s, point, target, &moves);
        connect_move(&k->s.connect, point, &k->fan, target, &moves);
        return true;
    }
    return false;
}

static void reduce_keeping(struct relume_mesh *out, const struct relume_mesh *m, double error)
{
    struct keeper *k = calloc(1, sizeof *k);
    int i;
    must(k != NULL);
    keeper_create(k, m, error);
    for (uint32_t p = 0; p < k->s.connect.points; p++) {
        connect_fan(&k->s.connect, p, &k->fan);
        queue_put(&k->queue, p, fmin(cheapest(k, p, -1.0, &i), 1e30));
    }
    while (k->queue.count) {
        const uint32_t point = queue_take(&k->queue);
        connect_fan(&k->s.connect, point, &k->fan);
        const double cost = cheapest(k, point, -1.0, &i);
        if (cost > (double)k->queue.key[point] * (1.0 + 1e-5) && cost < (double)INFINITY)
            queue_put(&k->queue, point, cost);  // what is around it has changed
        else if (keep_point(k, point))
            for (i = 0; i < k->fan.neighbours; i++)
                queue_put(&k->queue, k->fan.neighbour[i], k->queue.key[k->fan.neighbour[i]]);
    }
    *out = (struct relume_mesh){0};
    must(!run_collect(out, &k->s.connect, m, NULL));
    keeper_free(k);
    free(k);
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

// Of the tested peer: at the largest error that looks no worse.
static size_t fewest_keeping(const struct relume_mesh *m, double error, double ppd,
                             const struct judged *want, enum measure by)
{
    double low = log(error / 64.0), high = log(4.0 * error);
    size_t fewest = m->triangle_count;
    for (int i = 0; i < 7; i++) {
        const double e = 0.5 * (low + high);
        struct relume_mesh small;
        struct judged j;
        reduce_keeping(&small, m, exp(e));
        look(&j, &small, ppd);
        if (j.of[by] <= want->of[by])
            fewest = small.triangle_count;
        *(j.of[by] <= want->of[by] ? &low : &high) = e;
        relume_mesh_free(&small);
    }
    return fewest;
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

// In the form of Guthe's Table 10.2: at the same error.
static void keep(const char *name, const struct relume_mesh *m, const struct grid *grid,
                 double error, double ppd)
{
    struct relume_mesh small;
    reduce_keeping(&small, m, error);
    struct judged j = {.of = {distance_of(&small, m, grid)}};
    look(&j, &small, ppd);
    printf(
        "%s %g%% attributes kept: %zu triangles, distance %.3f%%, 99%% below %.2f JND, all below "
        "%.2f\n",
        name, 100 * error, small.triangle_count, 100 * j.of[NEAR], j.of[LIKE], j.of[NOWHERE]);
    fflush(stdout);
    relume_mesh_free(&small);
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
    keep(name, m, &grid, error, ppd);
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
        for (enum measure by = LIKE; by <= NOWHERE; by++) {
            const size_t n = fewest_keeping(m, error, ppd, &own, by);
            printf("  attributes kept, as good in %s: %zu, ratio %.2f\n",
                   by == LIKE ? "99%" : "all", n, (double)small.triangle_count / (double)n);
            fflush(stdout);
        }
        if (!table)
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
    double error = 0.0;
    for (int option; (option = getopt(argc, argv, "te:")) != -1;) {
        table |= option == 't';
        error = option == 'e' ? atof(optarg) : error;
    }
    for (int i = optind; i < argc; i++) {
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
        if (error > 0.0)
            compare(argv[i], &m, error);
        for (int k = 0; k < 2 && !(error > 0.0); k++)
            compare(argv[i], &m, k ? 0.01 : 0.001);
        relume_mesh_free(&m);
    }
    return 0;
}
