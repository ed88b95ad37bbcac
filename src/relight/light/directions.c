// directions.c - a coder's basis tabulated over directions
//
// Rows go by the angle from the pole, columns by azimuth: unlike octahedral and concentric maps
// this one has no crease inside a cell, and near the pole, where columns run together, a smooth
// function is linear in the angle. The bilinear error is h^2 / 8 x the second derivative. Rows are
// closer at the horizon, 1 - t = sqrt(1 - theta / 90 degrees), since hemispherical harmonics rise
// there like sqrt(cos theta). Interpolants have cusps at the lights (the angular one opposite to
// them as well), around which cells are divided (cells.c). What is linear over triangles of lights
// is kept at the lights (triangles.c).
#include <relume/relight/relight.h>

#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "core/math/vec.h"
#include "format/coder/coding.h"
#include "relight/light/cells.h"
#include "relight/light/grid.h"
#include "relight/light/refit.h"
#include "relight/light/triangles.h"

#include <string.h>

enum { DEFAULT_STEPS = 96, LEAST_STEPS = 16, MOST_STEPS = 1024, MOST_FUNCTIONS = 4096 };
static const size_t MOST_BYTES = (size_t)256 << 20;
// Of values in [0, 1], whatever they are: a step of 8 bits.
static const double TOLERANCE = 1.0 / 255;

struct relume_weight_grid {
    struct relume_weight_grid_info info;
    bool hemispherical, pole_y;
    int down;  // cells from pole to horizon
    float *data;
    struct triangles *triangles;  // or NULL
    struct cells cells;
    float *turned;  // while it is made: [functions][stride], the coder's transform and mean
    relume_weight_grid *sums;  // for environments, or NULL: itself
};

// The second row at the horizon lies a hair below it.
static vec3 node_direction(const struct relume_weight_grid *g, double row, double column)
{
    if (g->triangles)
        return g->triangles->point[(int)column];
    const bool below = row > g->down;
    const double step = below ? g->info.rows - 1 - row : row;
    const double t = step / g->down, theta = 0.5 * M_PI * (2.0 * t - t * t);
    const double phi = 2.0 * M_PI * column / (g->info.columns - 1) - M_PI;
    const double height = step == g->down ? 1e-12 : cos(theta), r = sin(theta);
    return vec3_of(r * cos(phi), r * sin(phi), below ? -height : height);
}

// The coder's transform and mean with a node's values side by side.
static relume_status turn_transform(struct relume_weight_grid *g)
{
    const struct relume_coder_info *info = relume_coder_info(g->info.coder);
    const size_t raw = (size_t)info->functions, stride = (size_t)g->info.stride;
    const size_t used = (size_t)g->info.sets * (size_t)g->info.coefficients;
    if (!info->transform)
        return RELUME_OK;
    g->turned = mem_zeroed(raw, stride * sizeof *g->turned);
    for (size_t j = 0; g->turned && j < raw; j++) {
        for (size_t i = 0; i < used; i++)
            g->turned[j * stride + i] = info->transform[i * raw + j];
        for (size_t c = 0; info->mean && c < 3; c++)
            g->turned[j * stride + used + c] = info->mean[c * raw + j];
    }
    return g->turned ? RELUME_OK : RELUME_ENOMEM;
}

static void evaluate_at(const void *grid, double row, double column, double *value)
{
    const struct relume_weight_grid *g = grid;
    relume_coder_info(g->info.coder)
        ->basis->evaluate(g->info.coder, node_direction(g, row, column), value);
}

static void put_node(const struct relume_weight_grid *g, const double *value, float *to)
{
    const int stride = g->info.stride, raw = relume_coder_info(g->info.coder)->functions;
    memset(to, 0, (size_t)stride * sizeof *to);
    for (int j = 0; j < raw; j++)
        if (g->turned && value[j] != 0.0)
            add_scaled(to, g->turned + (size_t)j * (size_t)stride, (float)value[j], (size_t)stride);
        else if (!g->turned)
            to[j] = (float)value[j];
}

static float *node_at(const struct relume_weight_grid *g, int row, int column)
{
    return g->data +
           ((size_t)row * (size_t)g->info.columns + (size_t)column) * (size_t)g->info.stride;
}

static void fill_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct relume_weight_grid *g = context;
    double value[MOST_FUNCTIONS];
    for (int x = 0; x < g->info.columns; x++) {
        evaluate_at(g, (double)row, x, value);
        put_node(g, value, node_at(g, (int)row, x));
    }
}

// ---------------------------------------------------------------- divided cells

static int tiles_across(const struct relume_weight_grid_info *info)
{
    return info->columns / 3;
}

static void fill_tile(void *context, size_t tile, int worker)
{
    (void)worker;
    const struct relume_weight_grid *g = context;
    const int across = tiles_across(&g->info), t = (int)tile;
    const size_t raw = (size_t)relume_coder_info(g->info.coder)->functions;
    for (int i = 0; i < 9; i++)
        put_node(g, g->cells.value + (9 * tile + (size_t)i) * raw,
                 node_at(g, g->info.rows + t / across * 3 + i / 3, t % across * 3 + i % 3));
}

// The cells of the lights and of the places opposite to them. Memory for two of each light.
static int find_starts(int (*start)[2], const struct relume_weight_grid *g)
{
    const struct relume_coder_info *info = relume_coder_info(g->info.coder);
    int n = 0;
    for (int i = 0; i < 2 * info->lights; i++) {
        const vec3 l = vec3_scale(info->directions[i / 2], i % 2 ? -1.0 : 1.0);
        double xy[2];
        if (g->hemispherical && pole_from_world(l, g->pole_y).z < 0.0)
            continue;
        relume_weight_grid_place(xy, g, l);
        start[n][0] = relume_whole(fmin(xy[1], g->info.rows - 2));
        start[n++][1] = relume_whole(fmin(xy[0], g->info.columns - 2));
    }
    return n;
}

// Three times the memory of the grid, and no more than all may take.
static int most_tiles(const struct relume_weight_grid *g)
{
    const size_t row = (size_t)g->info.columns * (size_t)g->info.stride * sizeof(float);
    const int all = (int)(MOST_BYTES / row), rows = g->info.rows;
    return (all < 4 * rows ? all > rows ? all - rows : 0 : 3 * rows) / 3 * tiles_across(&g->info);
}

static relume_status find_cells(struct relume_weight_grid *g, int threads)
{
    const struct relume_coder_info *info = relume_coder_info(g->info.coder);
    int(*start)[2] = mem_array(2 * (size_t)info->lights, sizeof *start);
    if (!start)
        return RELUME_ENOMEM;
    const relume_status status =
        cells_create(&g->cells, &(const struct cells_params){
                                    .context = g,
                                    .evaluate = evaluate_at,
                                    .values = info->functions,
                                    .rows = g->info.rows,
                                    .columns = g->info.columns,
                                    .seam = g->hemispherical ? -2 : g->down,
                                    .start = (const int(*)[2])start,
                                    .starts = find_starts(start, g),
                                    .tolerance = TOLERANCE,
                                    .most = most_tiles(g),
                                    .threads = threads,
                                });
    mem_free(start);
    g->info.tiles = g->cells.count;
    g->info.tile = g->cells.of;
    g->info.child = (const int(*)[4])g->cells.child;
    return status;
}

static void set_size(struct relume_weight_grid *g, int steps)
{
    g->down = steps + steps / 2;
    g->info.columns = 4 * steps + 1;
    g->info.rows = (g->hemispherical ? 1 : 2) * (g->down + 1);
}

static relume_status take_triangles(struct relume_weight_grid *g,
                                    const struct relume_coder_triangles *from)
{
    const int lights = relume_coder_info(g->info.coder)->lights;
    const relume_status status = triangles_create(&g->triangles, from, lights);
    if (status || !g->triangles)
        return status;
    g->info.rows = 1;
    g->info.columns = lights;
    g->info.triangles = g->triangles->count;
    g->info.triangle = g->triangles->triangle;
    g->info.start = g->triangles->start;
    return RELUME_OK;
}

static size_t floats(const struct relume_weight_grid_info *info)
{
    return (size_t)relume_weight_grid_rows(info) * (size_t)info->columns * (size_t)info->stride;
}

static struct relume_weight_grid *new_grid(const relume_coder *coder)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    struct relume_weight_grid *g = mem_zeroed(1, sizeof *g);
    if (!g)
        return NULL;
    const int sets = info->basis->joint ? 3 : 1;
    g->hemispherical = info->hemispherical;
    g->pole_y = info->pole_y;
    g->info = (struct relume_weight_grid_info){
        .coder = coder,
        .sets = sets,
        .coefficients = info->coefficients,
        .stride = sets * info->coefficients + (sets == 3 ? 3 : 0),
    };
    return g;
}

static relume_status alloc_nodes(struct relume_weight_grid *g)
{
    g->info.data = g->data = mem_array(floats(&g->info), sizeof(float));
    return g->data ? turn_transform(g) : RELUME_ENOMEM;
}

static void free_turned(struct relume_weight_grid *g)
{
    mem_free(g->turned);
    g->turned = NULL;
}

// The coder's functions at each light, whatever lies between.
static void fill_lights(const struct relume_weight_grid *g)
{
    const int lights = g->info.columns;
    double value[MOST_FUNCTIONS] = {0.0};
    for (int i = 0; i < lights; i++) {
        value[i] = 1.0;
        put_node(g, value, node_at(g, 0, i));
        value[i] = 0.0;
    }
}

// Interpolants that extrapolate have weights below 0: under a bright source among black pixels a
// sum of such would be a hole. Environments are summed over flat triangles then, whose weights are
// shares.
static relume_status make_sums(struct relume_weight_grid **out, const relume_coder *coder)
{
    struct relume_coder_triangles around;
    *out = NULL;
    if (!relume_coder_hull(&around, coder))
        return RELUME_OK;
    struct relume_weight_grid *g = new_grid(coder);
    relume_status status = g ? take_triangles(g, &around) : RELUME_ENOMEM;
    const bool any = g && g->triangles;  // lights that span nothing have none
    if (!status && any)
        status = alloc_nodes(g);
    if (!status && any)
        fill_lights(g);
    if (g)
        free_turned(g);
    if (status || !any)
        relume_weight_grid_destroy(&g);
    *out = g;
    return status;
}

static relume_status fill(struct relume_weight_grid *g, const struct relume_weight_grid_params *p)
{
    const relume_status status = alloc_nodes(g);
    if (!status) {
        thread_for(p->threads, (size_t)g->info.rows, fill_row, g);
        thread_for(p->threads, (size_t)g->cells.count, fill_tile, g);
    }
    mem_free(g->cells.value);
    g->cells.value = NULL;
    free_turned(g);
    return status;
}

static relume_status make_grid(struct relume_weight_grid *g,
                               const struct relume_weight_grid_params *p)
{
    struct relume_coder_triangles own;
    int steps = p->steps ? p->steps : DEFAULT_STEPS;
    set_size(g, steps);
    while (!p->steps && steps > LEAST_STEPS && floats(&g->info) * sizeof(float) > MOST_BYTES)
        set_size(g, steps /= 2);
    relume_status status = RELUME_OK;
    if (!p->steps && relume_coder_triangles(&own, g->info.coder))
        status = take_triangles(g, &own);
    if (!status && !p->steps && !g->triangles && relume_coder_info(g->info.coder)->interpolant)
        status = find_cells(g, p->threads);
    return status ? status : fill(g, p);
}

relume_status relume_weight_grid_create(relume_weight_grid **out, const relume_coder *coder,
                                        const struct relume_weight_grid_params *params)
{
    const struct relume_weight_grid_params p = PARAMS(relume_weight_grid_params, params);
    struct relume_weight_grid *sums;
    *out = NULL;
    if (p.steps && (p.steps < 2 || p.steps > MOST_STEPS))
        return RELUME_EINVAL;
    relume_status status = make_sums(&sums, coder);
    if (status || (p.sums && sums)) {
        *out = sums;
        return status;
    }
    struct relume_weight_grid *g = new_grid(coder);
    if (g)
        g->sums = sums;
    else
        relume_weight_grid_destroy(&sums);
    status = g ? make_grid(g, &p) : RELUME_ENOMEM;
    if (status)
        relume_weight_grid_destroy(&g);
    *out = g;
    return status;
}

const relume_weight_grid *grid_for_sums(const relume_weight_grid *grid)
{
    return grid->sums ? grid->sums : grid;
}

void relume_weight_grid_destroy(relume_weight_grid **grid)
{
    if (!*grid)
        return;
    relume_weight_grid_destroy(&(*grid)->sums);
    mem_free((*grid)->turned);
    mem_free((*grid)->data);
    triangles_destroy(&(*grid)->triangles);
    cells_destroy(&(*grid)->cells);
    mem_free(*grid);
    *grid = NULL;
}

const struct relume_weight_grid_info *relume_weight_grid_info(const relume_weight_grid *grid)
{
    return &grid->info;
}

void relume_weight_grid_place(double xy[2], const relume_weight_grid *grid,
                              struct relume_vec3 direction)
{
    const vec3 d = pole_from_world(direction, grid->pole_y);
    const double r = sqrt(d.x * d.x + d.y * d.y);
    const bool below = d.z < 0.0;
    const double height = below && grid->hemispherical ? 0.0 : fabs(d.z);
    const double t = 1.0 - sqrt(1.0 - atan2(r, height) * (2.0 / M_PI));
    xy[0] = (atan2(d.y, d.x) + M_PI) * ((grid->info.columns - 1) / (2.0 * M_PI));
    xy[1] = grid->down * t;
    if (below && !grid->hemispherical)
        xy[1] = grid->info.rows - 1 - xy[1];
}

// The four nodes around a direction and their shares.
struct corners {
    const float *node[4];
    float share[4];
};

static int cell_of(double at, int nodes, double *share)
{
    const int i = at < nodes - 2 ? at > 0.0 ? (int)at : 0 : nodes - 2;
    *share = fmin(fmax(at - i, 0.0), 1.0);
    return i;
}

// Below the horizon of a hemispherical capture: at the horizon of the same azimuth.
static vec3 captured(const struct relume_weight_grid *g, vec3 direction)
{
    const vec3 d = pole_from_world(direction, g->pole_y);
    if (!g->hemispherical || d.z >= 0.0)
        return d;
    const double r = hypot(d.x, d.y);
    return r > 0.0 ? vec3_of(d.x / r, d.y / r, 0.0) : vec3_of(1.0, 0.0, 0.0);
}

static struct corners corners_of_triangle(const struct relume_weight_grid *g, vec3 direction)
{
    int node[3];
    float share[3];
    triangles_find(node, share, g->triangles, captured(g, direction));
    const size_t stride = (size_t)g->info.stride;
    const float *const first = g->data + (size_t)node[0] * stride;
    return (struct corners){
        {first, g->data + (size_t)node[1] * stride, g->data + (size_t)node[2] * stride, first},
        {share[0], share[1], share[2], 0.0f},
    };
}

struct relume_vec3 grid_shown(const relume_weight_grid *grid, struct relume_vec3 direction)
{
    int node[3];
    float share[3];
    vec3 sum = {0.0, 0.0, 0.0};
    if (!grid->triangles)
        return direction;
    triangles_find(node, share, grid->triangles, captured(grid, direction));
    for (int i = 0; i < 3; i++)
        sum = vec3_along(sum, grid->triangles->point[node[i]], (double)share[i]);
    return world_from_pole(sum, grid->pole_y);
}

static struct corners corners_at(const struct relume_weight_grid *g, vec3 direction)
{
    if (g->triangles)
        return corners_of_triangle(g, direction);
    double xy[2], x, y;
    relume_weight_grid_place(xy, g, direction);
    int column = cell_of(xy[0], g->info.columns, &x), row = cell_of(xy[1], g->info.rows, &y);
    const int tile =
        g->info.tiles ? cells_find(&g->cells, g->info.columns, &row, &column, &x, &y) : -1;
    if (tile >= 0) {
        row += g->info.rows + tile / tiles_across(&g->info) * 3;
        column += tile % tiles_across(&g->info) * 3;
    }
    const size_t next = (size_t)g->info.stride, line = (size_t)g->info.columns * next;
    const float *first = node_at(g, row, column);
    const float fx = (float)x, fy = (float)y;
    return (struct corners){
        {first, first + next, first + line, first + line + next},
        {(1.0f - fx) * (1.0f - fy), fx * (1.0f - fy), (1.0f - fx) * fy, fx * fy},
    };
}

static void blend(float *restrict to, const struct corners *at, int first, int n, float value)
{
    const float a = value * at->share[0], b = value * at->share[1];
    const float c = value * at->share[2], d = value * at->share[3];
    const float *restrict p = at->node[0] + first, *restrict q = at->node[1] + first;
    const float *restrict r = at->node[2] + first, *restrict s = at->node[3] + first;
    for (int i = 0; i < n; i++)
        to[i] += a * p[i] + b * q[i] + c * r[i] + d * s[i];
}

void grid_blend(float *out, const relume_weight_grid *grid, struct relume_vec3 direction)
{
    const struct corners at = corners_at(grid, direction);
    memset(out, 0, (size_t)grid->info.stride * sizeof *out);
    blend(out, &at, 0, grid->info.stride, 1.0f);
}

enum { RUN = 64 };

// The same weights for all channels: blended once, then scaled.
static void blend_shared(float *weights, const struct corners *at, int k, const float value[3])
{
    float once[RUN];
    for (int first = 0; first < k; first += RUN) {
        const int n = k - first < RUN ? k - first : RUN;
        memset(once, 0, (size_t)n * sizeof *once);
        blend(once, at, first, n, 1.0f);
        for (int c = 0; c < 3; c++)
            add_scaled(weights + c * k + first, once, value[c], (size_t)n);
    }
}

void relume_weight_grid_add(float *weights, float constant[3], const relume_weight_grid *grid,
                            struct relume_vec3 direction, const float value[3])
{
    const struct corners at = corners_at(grid, direction);
    const int k = grid->info.coefficients;
    if (grid->info.sets == 1) {
        blend_shared(weights, &at, k, value);
        return;
    }
    for (int c = 0; c < 3; c++) {
        blend(weights + c * k, &at, c * k, k, value[c]);
        blend(constant + c, &at, 3 * k + c, 1, value[c]);
    }
}
