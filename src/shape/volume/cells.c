// cells.c - the surface through single cells of a grid, by words of 64 cells
//
// A cell is its eight corners' bits. Lines on its faces (segments.h) close into loops, which are
// cut into triangles: once for each of 256 patterns, and for every cell anew where a face leaves
// open what is connected. Vertices of a row are numbered in the order in which a walk along it
// meets them (as Schroeder, Maynard, Geveci 2015 do), so that eight counters replace any index.
#include "shape/volume/cells.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "shape/volume/segments.h"

#include <string.h>

// Corners are bits x + 2 y + 4 z. Edges of a cell: along x at y + 2 z, along y at 4 + x + 2 z,
// along z at 8 + x + 2 y. Faces: 2 axis + (0 at its lower, 1 at its higher end).
enum { EDGES = 12, FACES = 6, MOST_TRIANGLES = 10, NO_EDGE = 0xff };

struct cut {
    uint8_t triangles;
    uint8_t open;      // faces, as bits, that leave open what is connected
    uint16_t crossed;  // edges, as bits
    uint8_t edge[MOST_TRIANGLES][3];
};

static int edge_at(int axis, const int p[3])
{
    return 4 * axis + (axis == 0 ? p[1] + 2 * p[2] : p[0] + 2 * p[axis == 1 ? 2 : 1]);
}

// The corner bits of a face, in the order of segments.h.
static int face_corners(int corners, int axis, int end)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const int c00 = end << axis, c10 = c00 | 1 << u, c11 = c10 | 1 << v, c01 = c00 | 1 << v;
    return (corners >> c00 & 1) | (corners >> c10 & 1) << 1 | (corners >> c11 & 1) << 2 |
           (corners >> c01 & 1) << 3;
}

static int side_edge(enum side side, int axis, int end)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    int p[3] = {0};
    p[axis] = end;
    if (side == SIDE_T)
        p[v] = 1;
    if (side == SIDE_R)
        p[u] = 1;
    return edge_at(side == SIDE_B || side == SIDE_T ? u : v, p);
}

static int edge_faces(int edge)
{
    const int axis = edge / 4, at = edge % 4;
    const int first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
    return 1 << (2 * first + at % 2) | 1 << (2 * second + at / 2);
}

// Cut off corners of a loop; chords in a face, where a neighbour may have the same, come last.
static void cut_loop(struct cut *c, uint8_t loop[EDGES], int count)
{
    while (count >= 3) {
        int ear = 0;
        while (ear < count && count > 3 &&
               edge_faces(loop[ear]) & edge_faces(loop[(ear + 2) % count]))
            ear++;
        ear = ear == count ? 0 : ear;
        const int middle = (ear + 1) % count;
        const uint8_t triangle[3] = {loop[ear], loop[middle], loop[(ear + 2) % count]};
        memcpy(c->edge[c->triangles++], triangle, sizeof triangle);
        memmove(loop + middle, loop + middle + 1, (size_t)(count - 1 - middle));
        count--;
    }
}

// `middles`: of faces, as bits, whose middle is inside.
static void cut_cell(struct cut *c, int corners, int middles)
{
    uint8_t next[EDGES];
    memset(next, NO_EDGE, sizeof next);
    *c = (struct cut){.triangles = 0};
    for (int axis = 0; axis < 3; axis++)
        for (int end = 0; end < 2; end++) {
            const int at = face_corners(corners, axis, end);
            const struct segments s = segments_of(at, middles >> (2 * axis + end) & 1);
            c->open |= (uint8_t)(segments_open(at) << (2 * axis + end));
            for (int i = 0; i < s.count; i++) {
                // seen from outside the higher face's lines turn round
                const int from = side_edge(end ? s.to[i] : s.from[i], axis, end);
                const int to = side_edge(end ? s.from[i] : s.to[i], axis, end);
                next[from] = (uint8_t)to;
                c->crossed |= (uint16_t)(1 << from);
            }
        }
    for (int start = 0; start < EDGES; start++) {
        uint8_t loop[EDGES];
        int count = 0;
        for (int at = start; next[at] != NO_EDGE;) {
            const int to = next[at];
            next[at] = NO_EDGE;
            loop[count++] = (uint8_t)at;
            at = to;
        }
        cut_loop(c, loop, count);
    }
}

// ---------------------------------------------------------------- rows of cells

struct cell_rows {
    const struct signs *g;
    struct cut table[256];
    struct numbering vertices;
    size_t *first;      // [layers + 1]: the number of a layer's first triangle
    size_t *ambiguous;  // [layers], then a sum
    size_t *cells;
    uint32_t (*triangle)[3];
};

// Where a row of cells lies: four rows of samples, at y and y + 1, z and z + 1.
struct cell_row {
    const uint64_t *bits[4];
    int words, cells;
};

static struct cell_row cell_row_at(const struct signs *g, int y, int z)
{
    return (struct cell_row){{signs_row(g, y, z), signs_row(g, y + 1, z), signs_row(g, y, z + 1),
                              signs_row(g, y + 1, z + 1)},
                             g->words,
                             g->size[0] - 1};
}

// The cells of a word whose corners differ; `low` and `high` are the corners at x and x + 1.
static uint64_t active_cells(const struct cell_row *r, int w, uint64_t low[4], uint64_t high[4])
{
    uint64_t any = 0, all = ~(uint64_t)0;
    for (int i = 0; i < 4; i++) {
        low[i] = r->bits[i][w];
        high[i] = signs_next(r->bits[i], w, r->words);
        any |= low[i] | high[i];
        all &= low[i] & high[i];
    }
    const int left = r->cells - 64 * w;
    const uint64_t own = left >= 64 ? ~(uint64_t)0 : ((uint64_t)1 << (left > 0 ? left : 0)) - 1;
    return any & ~all & own;
}

static int corners_at(const uint64_t low[4], const uint64_t high[4], int bit)
{
    int corners = 0;
    for (int i = 0; i < 4; i++)
        corners |= (int)((low[i] >> bit & 1) | (high[i] >> bit & 1) << 1) << 2 * i;
    return corners;
}

// The pattern of a cell; where faces leave it open, `own` has it made by their middles, the means
// of four samples.
static const struct cut *cut_at(const struct cell_rows *k, struct cut *own, int corners, int x,
                                int y, int z)
{
    const struct cut *c = &k->table[corners];
    if (!c->open)
        return c;
    const relume_volume *v = k->g->volume;
    const size_t step[3] = {1, (size_t)v->size[0], (size_t)v->size[0] * (size_t)v->size[1]};
    const size_t cell = volume_at(v, x, y, z);
    int middles = 0;
    for (int f = 0; f < FACES; f++) {
        const size_t a = cell + (f & 1 ? step[f / 2] : 0);
        const size_t u = step[(f / 2 + 1) % 3], w = step[(f / 2 + 2) % 3];
        const float sum = volume_sample(v, a) + volume_sample(v, a + u) + volume_sample(v, a + w) +
                          volume_sample(v, a + u + w);
        middles |= (0.25f * sum >= k->g->threshold) << f;
    }
    cut_cell(own, corners, middles);
    return own;
}

static void count_layer(void *context, size_t z, int worker)
{
    (void)worker;
    struct cell_rows *k = context;
    uint64_t low[4], high[4];
    size_t triangles = 0, open = 0, cells = 0;
    for (int y = 0; y + 1 < k->g->size[1]; y++) {
        const struct cell_row row = cell_row_at(k->g, y, (int)z);
        for (int w = 0; w < row.words; w++)
            for (uint64_t at = active_cells(&row, w, low, high); at; at &= at - 1) {
                const int bit = __builtin_ctzll(at);
                struct cut own;
                const struct cut *c =
                    cut_at(k, &own, corners_at(low, high, bit), 64 * w + bit, y, (int)z);
                triangles += c->triangles;
                open += (size_t)__builtin_popcount(c->open);
                cells++;
            }
    }
    k->first[z] = triangles;
    k->ambiguous[z] = open;
    k->cells[z] = cells;
}

// Numbers of the next vertices of four edges along x, two along y and two along z.
struct counters {
    uint32_t x[4], y[2], z[2];
};

static struct counters counters_at(const struct cell_rows *k, int y, int z)
{
    const size_t height = (size_t)k->g->size[1], row = (size_t)z * height + (size_t)y;
    const uint32_t *a = k->vertices.first + 3 * row, *b = a + 3, *c = a + 3 * height, *d = c + 3;
    return (struct counters){{a[0], b[0], c[0], d[0]}, {a[1], c[1]}, {a[2], b[2]}};
}

static size_t put_cell(const struct cut *c, struct counters *next, uint32_t (*out)[3])
{
    uint32_t id[EDGES];
    const unsigned crossed = c->crossed;
    for (int i = 0; i < 4; i++) {
        id[i] = next->x[i];
        next->x[i] += crossed >> i & 1;
    }
    for (int i = 0; i < 2; i++) {
        id[4 + 2 * i] = next->y[i];
        id[5 + 2 * i] = next->y[i] += crossed >> (4 + 2 * i) & 1;
        id[8 + 2 * i] = next->z[i];
        id[9 + 2 * i] = next->z[i] += crossed >> (8 + 2 * i) & 1;
    }
    for (int t = 0; t < c->triangles; t++)
        for (int i = 0; i < 3; i++)
            out[t][i] = id[c->edge[t][i]];
    return c->triangles;
}

static void put_layer(void *context, size_t z, int worker)
{
    (void)worker;
    const struct cell_rows *k = context;
    uint64_t low[4], high[4];
    uint32_t(*out)[3] = k->triangle + k->first[z];
    for (int y = 0; y + 1 < k->g->size[1] && k->first[z] < k->first[z + 1]; y++) {
        const struct cell_row row = cell_row_at(k->g, y, (int)z);
        struct counters next = counters_at(k, y, (int)z);
        for (int w = 0; w < row.words; w++)
            for (uint64_t at = active_cells(&row, w, low, high); at; at &= at - 1) {
                const int bit = __builtin_ctzll(at);
                struct cut own;
                out +=
                    put_cell(cut_at(k, &own, corners_at(low, high, bit), 64 * w + bit, y, (int)z),
                             &next, out);
            }
    }
}

static relume_status put(struct relume_mesh *out, struct cell_rows *k)
{
    relume_status status = numbering_create(&k->vertices, k->g, NULL);
    if (status)
        return status;
    const size_t vertices = k->vertices.count, triangles = k->first[k->g->size[2] - 1];
    out->position = mem_array(vertices, sizeof *out->position);
    out->normal = mem_array(vertices, sizeof *out->normal);
    out->triangle = k->triangle = mem_array(triangles, sizeof *out->triangle);
    if (!out->position || !out->normal || !out->triangle)
        return RELUME_ENOMEM;
    out->vertex_count = vertices;
    out->triangle_count = triangles;
    if (!signs_round(k->g, (size_t)k->g->size[2] - 1, put_layer, k, 0.4, 0.8))
        return RELUME_ECANCEL;
    numbering_put(&k->vertices, k->g, out);
    return RELUME_OK;
}

static size_t sum_up(size_t *of, size_t layers)
{
    size_t sum = 0;
    for (size_t z = 0; z <= layers; z++) {
        const size_t own = z < layers ? of[z] : 0;
        of[z] = sum;
        sum += own;
    }
    return sum;
}

static relume_status mesh_of(struct relume_mesh *out, struct relume_isosurface_report *report,
                             struct cell_rows *k)
{
    const size_t layers = (size_t)k->g->size[2] - 1;
    for (int corners = 0; corners < 256; corners++)
        cut_cell(&k->table[corners], corners, 0);
    if (!signs_round(k->g, layers, count_layer, k, 0.0, 0.4))
        return RELUME_ECANCEL;
    report->ambiguous = sum_up(k->ambiguous, layers);
    report->boxes = sum_up(k->cells, layers);
    return sum_up(k->first, layers) > UINT32_MAX ? RELUME_ELIMIT : put(out, k);
}

relume_status cells_mesh(struct relume_mesh *out, struct relume_isosurface_report *report,
                         const struct signs *g)
{
    const size_t layers = (size_t)g->size[2];
    struct cell_rows *k = mem_zeroed(1, sizeof *k);
    if (!k)
        return RELUME_ENOMEM;
    k->g = g;
    k->first = mem_array(layers, sizeof *k->first);
    k->ambiguous = mem_array(layers, sizeof *k->ambiguous);
    k->cells = mem_array(layers, sizeof *k->cells);
    const relume_status status =
        k->first && k->ambiguous && k->cells ? mesh_of(out, report, k) : RELUME_ENOMEM;
    numbering_free(&k->vertices);
    mem_free(k->first);
    mem_free(k->ambiguous);
    mem_free(k->cells);
    mem_free(k);
    return status;
}
