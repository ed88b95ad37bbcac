// charts.c - groups of triangles, and their positions in a picture
#include "shape/atlas/charts.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/vec.h"

#include <math.h>
#include <string.h>

static vec3 at(const struct atlas_corner *c)
{
    return vec3_of((double)c->position[0], (double)c->position[1], (double)c->position[2]);
}

// Twice the area, times the normal.
static vec3 across(const struct atlas_corner t[3])
{
    return vec3_cross(vec3_sub(at(&t[1]), at(&t[0])), vec3_sub(at(&t[2]), at(&t[0])));
}

// 2 k for the axis k that it faces most, 2 k + 1 the other way.
static uint8_t facing(const struct atlas_corner t[3])
{
    const vec3 n = across(t);
    const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    return (uint8_t)(x >= y && x >= z ? n.x < 0.0 : y >= z ? 2 + (n.y < 0.0) : 4 + (n.z < 0.0));
}

// The cosine between a triangle's normal and a way that a chart faces.
static double cosine_to(const struct atlas_corner t[3], int face)
{
    const vec3 n = across(t);
    const double length = vec3_length(n), along = face < 2 ? n.x : face < 4 ? n.y : n.z;
    return length > 0.0 ? (face % 2 ? -along : along) / length : 0.0;
}

// ---------------------------------------------------------------- groups

struct edge {
    float end[2][3];
    size_t triangle;
};

static int by_ends(const void *a, const void *b)
{
    const struct edge *x = a, *y = b;
    const int order = memcmp(x->end, y->end, sizeof x->end);
    return order ? order : (x->triangle > y->triangle) - (x->triangle < y->triangle);
}

static void set_edge(struct edge *to, const struct atlas_corner *a, const struct atlas_corner *b,
                     size_t triangle)
{
    const bool turned = memcmp(a->position, b->position, sizeof a->position) > 0;
    memcpy(to->end[turned], a->position, sizeof a->position);
    memcpy(to->end[!turned], b->position, sizeof b->position);
    to->triangle = triangle;
}

// The first of a group; ways are halved on the way.
static size_t first_of(size_t *of, size_t i)
{
    for (; of[i] != i; i = of[i])
        of[i] = of[of[i]];
    return i;
}

static void join(size_t *of, size_t a, size_t b)
{
    const size_t x = first_of(of, a), y = first_of(of, b);
    of[x > y ? x : y] = x > y ? y : x;
}

// Edges that two triangles share stand one behind the other.
static bool do_share(const struct edge *edge, size_t i)
{
    return !memcmp(edge[i - 1].end, edge[i].end, sizeof edge[i].end);
}

struct grouping {
    struct atlas_corner (*triangle)[3];
    size_t n;
    const bool *alone;
    struct edge *edge;  // [3 n], in order
    uint8_t *face;      // [n]: the way that its chart faces
    size_t *first;      // [n]: of its group
};

static bool is_alone(const struct grouping *g, size_t i)
{
    return g->alone && g->alone[i];
}

static void group(struct grouping *g)
{
    for (size_t i = 0; i < g->n; i++)
        g->first[i] = i;
    for (size_t i = 1; i < 3 * g->n; i++) {
        const size_t a = g->edge[i - 1].triangle, b = g->edge[i].triangle;
        if (do_share(g->edge, i) && g->face[a] == g->face[b] && !is_alone(g, a) && !is_alone(g, b))
            join(g->first, a, b);
    }
}

// Triangles of small groups go over to a larger one beside them, ring by ring, where they face it
// too. `area` holds n.
static void merge(struct grouping *g, double small, double *area)
{
    enum { RINGS = 6 };
    const double LEAST_FACING = 0.3;
    for (int ring = 0; ring < RINGS; ring++) {
        group(g);
        memset(area, 0, g->n * sizeof *area);
        for (size_t i = 0; i < g->n; i++)
            area[first_of(g->first, i)] += 0.5 * vec3_length(across(g->triangle[i]));
        for (size_t i = 1; i < 3 * g->n; i++) {
            size_t a = g->edge[i - 1].triangle, b = g->edge[i].triangle;
            if (!do_share(g->edge, i) || is_alone(g, a) || is_alone(g, b))
                continue;
            if (area[first_of(g->first, a)] > area[first_of(g->first, b)]) {
                const size_t swap = a;
                a = b;
                b = swap;
            }
            if (g->face[a] != g->face[b] && area[first_of(g->first, a)] < small &&
                area[first_of(g->first, b)] > area[first_of(g->first, a)] &&
                cosine_to(g->triangle[a], g->face[b]) >= LEAST_FACING)
                g->face[a] = g->face[b];
        }
    }
}

static relume_status make_groups(struct charts *out, struct grouping *g, double small)
{
    double *area = small > 0.0 ? mem_array(g->n, sizeof *area) : NULL;
    if (!g->edge || !g->first || !out->of || !g->face || (small > 0.0 && !area)) {
        mem_free(area);
        return RELUME_ENOMEM;
    }
    for (size_t i = 0; i < g->n; i++) {
        g->face[i] = facing(g->triangle[i]);
        for (size_t k = 0; k < 3; k++)
            set_edge(&g->edge[3 * i + k], &g->triangle[i][k], &g->triangle[i][(k + 1) % 3], i);
    }
    qsort(g->edge, 3 * g->n, sizeof *g->edge, by_ends);
    if (area)
        merge(g, small, area);
    mem_free(area);
    group(g);
    for (size_t i = 0; i < g->n; i++) {  // the first of a group comes before its others
        const size_t root = first_of(g->first, i);
        out->of[i] = root == i ? out->count++ : out->of[root];
    }
    return RELUME_OK;
}

relume_status charts_make(struct charts *out, struct atlas_corner (*triangle)[3], size_t n,
                          const bool *alone, double small)
{
    struct grouping g = {.triangle = triangle,
                         .n = n,
                         .alone = alone,
                         .edge = mem_array(3 * n, sizeof *g.edge),
                         .face = mem_array(n, sizeof *g.face),
                         .first = mem_array(n, sizeof *g.first)};
    *out = (struct charts){.of = mem_array(n, sizeof *out->of), .face = g.face};
    const relume_status status = make_groups(out, &g, small);
    mem_free(g.edge);
    mem_free(g.first);
    if (status)
        charts_free(out);
    return status;
}

void charts_free(struct charts *charts)
{
    mem_free(charts->of);
    mem_free(charts->face);
    *charts = (struct charts){.of = NULL};
}

// ---------------------------------------------------------------- positions

// A chart in units of the mesh, and where it stands in the picture.
struct chart {
    double least[2], most[2];
    int face;
    size_t number;
    int left, top, width, height;  // texels
};

// A place as it is seen from where a chart faces.
static void flat(double out[2], const struct atlas_corner *c, int face)
{
    const double p[3] = {(double)c->position[0], (double)c->position[1], (double)c->position[2]};
    out[0] = p[(face / 2 + 1) % 3] * (face % 2 ? -1.0 : 1.0);
    out[1] = p[(face / 2 + 2) % 3];
}

static void measure(struct chart *chart, const struct charts *charts,
                    struct atlas_corner (*triangle)[3], size_t n)
{
    for (size_t i = 0; i < charts->count; i++)
        chart[i] = (struct chart){.least = {INFINITY, INFINITY}, .most = {-INFINITY, -INFINITY}};
    for (size_t i = 0; i < n; i++) {
        struct chart *c = &chart[charts->of[i]];
        c->face = charts->face[i];
        for (int k = 0; k < 3; k++) {
            double p[2];
            flat(p, &triangle[i][k], c->face);
            for (int a = 0; a < 2; a++) {
                c->least[a] = fmin(c->least[a], p[a]);
                c->most[a] = fmax(c->most[a], p[a]);
            }
        }
    }
}

struct packing {
    struct chart *chart;  // highest first
    size_t count;
    int width, height;
};

static int by_height(const void *a, const void *b)
{
    const struct chart *x = a, *y = b;
    const double p = x->most[1] - x->least[1], q = y->most[1] - y->least[1];
    return p != q ? (p < q) - (p > q) : (x->number > y->number) - (x->number < y->number);
}

enum { AROUND = 1 };

// Rows from the top, each as high as its first chart.
static bool pack(const struct packing *p, double scale)
{
    int left = 0, top = 0, row = 0;
    for (size_t i = 0; i < p->count; i++) {
        struct chart *c = &p->chart[i];
        const double across = (c->most[0] - c->least[0]) * scale;
        const double down = (c->most[1] - c->least[1]) * scale;
        if (!(across < p->width && down < p->height))
            return false;
        c->width = (int)ceil(across) + 1 + 2 * AROUND;
        c->height = (int)ceil(down) + 1 + 2 * AROUND;
        if (left + c->width > p->width) {
            left = 0;
            top += row;
            row = 0;
        }
        row = c->height > row ? c->height : row;
        if (c->width > p->width || top + c->height > p->height)
            return false;
        c->left = left, c->top = top;
        left += c->width;
    }
    return true;
}

// Charts that fit only where they have no size do not fit.
enum { MOST_HALVED = 40 };

// The largest scale at which all fit, to a hundredth; 0: none.
static double find_scale(const struct packing *p)
{
    double most = 0.0, least = 0.0;
    for (size_t i = 0; i < p->count; i++)
        for (int a = 0; a < 2; a++)
            most = fmax(most, p->chart[i].most[a] - p->chart[i].least[a]);
    most = most > 0.0 ? (p->width > p->height ? p->width : p->height) / most : 1.0;
    if (!pack(p, 0.0))
        return 0.0;
    for (int i = 0; i < MOST_HALVED && most - least > 0.01 * most; i++) {
        const double middle = 0.5 * (least + most);
        if (pack(p, middle))
            least = middle;
        else
            most = middle;
    }
    (void)pack(p, least);
    return least;
}

static void place_triangles(struct atlas_corner (*triangle)[3], size_t n,
                            const struct charts *charts, const struct packing *p,
                            const size_t *where, double scale)
{
    for (size_t i = 0; i < n; i++) {
        const struct chart *c = &p->chart[where[charts->of[i]]];
        for (int k = 0; k < 3; k++) {
            double at[2];
            flat(at, &triangle[i][k], c->face);
            const double x = c->left + AROUND + 0.5 + (at[0] - c->least[0]) * scale;
            const double y = c->top + AROUND + 0.5 + (at[1] - c->least[1]) * scale;
            triangle[i][k].place[0] = (float)(x / p->width);
            triangle[i][k].place[1] = (float)(y / p->height);
        }
    }
}

relume_status charts_place(const struct charts *charts, struct atlas_corner (*triangle)[3],
                           size_t n, int width, int height, const struct relume_log *log)
{
    struct chart *chart = mem_array(charts->count, sizeof *chart);
    size_t *where = mem_array(charts->count, sizeof *where);
    const struct packing p = {chart, charts->count, width, height};
    relume_status status = chart && where ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        measure(chart, charts, triangle, n);
        for (size_t i = 0; i < charts->count; i++)
            chart[i].number = i;
        qsort(chart, charts->count, sizeof *chart, by_height);
        for (size_t i = 0; i < charts->count; i++)
            where[chart[i].number] = i;
        const double scale = find_scale(&p);
        if (scale > 0.0)
            place_triangles(triangle, n, charts, &p, where, scale);
        else
            status = log_fail(log, RELUME_EUNFIT,
                              "the atlas of %d x %d texels is too small for %zu charts; make it "
                              "larger",
                              width, height, charts->count);
    }
    mem_free(chart);
    mem_free(where);
    return status;
}
