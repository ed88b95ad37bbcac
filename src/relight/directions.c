// directions.c - a coder's basis tabulated over directions
//
// Rows are even in the angle from the pole, columns in azimuth: unlike octahedral and concentric
// maps this one has no crease inside a cell, and near the pole, where columns meet, a smooth
// function is linear in the angle. The bilinear error is h^2 / 8 x the second derivative.
#include <relume/relight.h>

#include "base/memory.h"
#include "base/thread.h"
#include "math/vec.h"

enum { DEFAULT_STEPS = 96, LEAST_STEPS = 16, MOST_STEPS = 1024, MOST_WEIGHTS = 3 * 4096 };
static const size_t MOST_BYTES = (size_t)256 << 20;

struct relume_weight_grid {
    struct relume_weight_grid_info info;
    bool hemispherical, pole_y;
    float *data;
};

static bool below(const struct relume_weight_grid *g, int row)
{
    return row > g->info.steps;
}

// The direction of a node, world. The second row at the horizon lies a hair below it.
static vec3 node_direction(const struct relume_weight_grid *g, int row, int column)
{
    const int step = below(g, row) ? row - 1 : row;
    const double theta = 0.5 * M_PI * step / g->info.steps;
    const double phi = 2.0 * M_PI * column / (g->info.columns - 1) - M_PI;
    double height = step == g->info.steps ? 0.0 : cos(theta);
    if (below(g, row) && step == g->info.steps)
        height = -1e-12;
    const double r = sin(theta);
    return world_from_pole(vec3_of(r * cos(phi), r * sin(phi), height), g->pole_y);
}

static void fill_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct relume_weight_grid *g = context;
    const struct relume_weight_grid_info *info = &g->info;
    const size_t used = (size_t)info->sets * (size_t)info->coefficients;
    float weights[MOST_WEIGHTS], constant[3];
    float *to = g->data + row * (size_t)info->columns * (size_t)info->stride;
    for (int x = 0; x < info->columns; x++, to += info->stride) {
        relume_coder_weights(info->coder, node_direction(g, (int)row, x), weights, constant);
        for (size_t i = 0; i < used; i++)
            to[i] = weights[i];
        for (size_t c = 0; info->sets == 3 && c < 3; c++)
            to[used + c] = constant[c];
    }
}

static void set_size(struct relume_weight_grid_info *info, bool hemispherical, int steps)
{
    info->steps = steps;
    info->columns = 4 * steps + 1;
    info->rows = (hemispherical ? 1 : 2) * (steps + 1);
}

static size_t floats(const struct relume_weight_grid_info *info)
{
    return (size_t)info->rows * (size_t)info->columns * (size_t)info->stride;
}

relume_status relume_weight_grid_create(relume_weight_grid **out, const relume_coder *coder,
                                        const struct relume_weight_grid_params *params)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    const struct relume_weight_grid_params p =
        params ? *params : (struct relume_weight_grid_params){0};
    *out = NULL;
    if (p.steps && (p.steps < 2 || p.steps > MOST_STEPS))
        return RELUME_EINVAL;
    struct relume_weight_grid *g = mem_zeroed(1, sizeof *g);
    if (!g)
        return RELUME_ENOMEM;
    const int sets = info->basis->learned ? 3 : 1;
    g->hemispherical = info->hemispherical;
    g->pole_y = info->pole_y;
    g->info = (struct relume_weight_grid_info){
        .coder = coder,
        .sets = sets,
        .coefficients = info->coefficients,
        .stride = sets * info->coefficients + (sets == 3 ? 3 : 0),
    };
    int steps = p.steps ? p.steps : DEFAULT_STEPS;
    set_size(&g->info, g->hemispherical, steps);
    while (!p.steps && steps > LEAST_STEPS && floats(&g->info) * sizeof(float) > MOST_BYTES)
        set_size(&g->info, g->hemispherical, steps /= 2);
    g->info.data = g->data = mem_array(floats(&g->info), sizeof(float));
    if (!g->data) {
        relume_weight_grid_destroy(&g);
        return RELUME_ENOMEM;
    }
    thread_for(p.threads, (size_t)g->info.rows, fill_row, g);
    *out = g;
    return RELUME_OK;
}

void relume_weight_grid_destroy(relume_weight_grid **grid)
{
    if (!*grid)
        return;
    free((*grid)->data);
    free(*grid);
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
    const double r = sqrt(d.x * d.x + d.y * d.y), steps = grid->info.steps;
    const bool lower = d.z < 0.0;
    const double theta = lower && grid->hemispherical ? 0.5 * M_PI : atan2(r, d.z);
    xy[0] = (atan2(d.y, d.x) + M_PI) * (2.0 * steps / M_PI);
    xy[1] = theta * (2.0 * steps / M_PI) + (lower && !grid->hemispherical ? 1.0 : 0.0);
}

// The four nodes around a direction and their shares.
struct corners {
    const float *node[4];
    float share[4];
};

static int cell_of(double at, int nodes, float *share)
{
    const int i = at < nodes - 2 ? at > 0.0 ? (int)at : 0 : nodes - 2;
    *share = (float)fmin(fmax(at - i, 0.0), 1.0);
    return i;
}

static struct corners corners_at(const struct relume_weight_grid *g, vec3 direction)
{
    const struct relume_weight_grid_info *info = &g->info;
    double xy[2];
    float fx, fy;
    relume_weight_grid_place(xy, g, direction);
    const size_t x = (size_t)cell_of(xy[0], info->columns, &fx);
    const size_t y = (size_t)cell_of(xy[1], info->rows, &fy);
    const size_t next = (size_t)info->stride, line = (size_t)info->columns * next;
    const float *first = g->data + y * line + x * next;
    return (struct corners){
        {first, first + next, first + line, first + line + next},
        {(1.0f - fx) * (1.0f - fy), fx * (1.0f - fy), (1.0f - fx) * fy, fx * fy},
    };
}

static float mix(const struct corners *at, int i)
{
    return at->share[0] * at->node[0][i] + at->share[1] * at->node[1][i] +
           at->share[2] * at->node[2][i] + at->share[3] * at->node[3][i];
}

void relume_weight_grid_add(float *weights, float constant[3], const relume_weight_grid *grid,
                            struct relume_vec3 direction, const float value[3])
{
    const struct corners at = corners_at(grid, direction);
    const int k = grid->info.coefficients;
    if (grid->info.sets == 1) {
        for (int i = 0; i < k; i++) {
            const float b = mix(&at, i);
            for (int c = 0; c < 3; c++)
                weights[c * k + i] += value[c] * b;
        }
        return;
    }
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < k; i++)
            weights[c * k + i] += value[c] * mix(&at, c * k + i);
        constant[c] += value[c] * mix(&at, 3 * k + c);
    }
}
