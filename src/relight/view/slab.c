// slab.c - the light slab: a grid of cameras on the plane uv looking through one window on st
//
// Levoy and Hanrahan 1996, Gortler et al. 1996; with illumination: Wong 1998, 8.1. A point of the
// uv plane is seen by the four cameras around it, with bilinear weights. A frame fixes (s, t) in
// every pixel, and u depends on s alone, v on t alone: the views it needs are a rectangle of the
// grid.
#include "relight/view/slab.h"

#include "core/base/memory.h"
#include "core/math/sort.h"
#include "relight/view/view.h"

#include <math.h>
#include <string.h>

// Camera coordinates closer than this (relative to the grid) are the same row or column.
#define SAME_LINE 1e-6
// A point this close (relative) to a row or column is on it: eyes are computed, and files keep
// camera places in single precision.
#define ON_LINE 1e-6

// ---------------------------------------------------------------- grid

// Sort `lines` and keep the least of each group closer than `same`; returns how many are left.
static int keep_distinct(double *lines, int n, double same)
{
    sort_doubles(lines, (size_t)n);
    int kept = 1;
    for (int i = 1; i < n; i++)
        if (lines[i] - lines[kept - 1] > same)
            lines[kept++] = lines[i];
    return kept;
}

// The last of the ascending `lines` that is not above `at`; 0 when all are.
static int line_below(const double *lines, int n, double at)
{
    int low = 0;
    while (n - low > 1) {
        const int middle = low + (n - low) / 2;
        if (lines[middle] <= at)
            low = middle;
        else
            n = middle;
    }
    return low;
}

// The cameras of one slab: where they stand, and which views they are.
struct cameras {
    const double (*uv)[2];  // [views of the file]
    const int *view;        // [count]
    int count;
};

static double extent(const struct cameras *c, int axis)
{
    double low = c->uv[c->view[0]][axis];
    double high = low;
    for (int i = 1; i < c->count; i++) {
        low = fmin(low, c->uv[c->view[i]][axis]);
        high = fmax(high, c->uv[c->view[i]][axis]);
    }
    return high - low;
}

// The rows and columns of the cameras, and which camera stands at each crossing.
static relume_status find_grid(relume_slab *slab, const struct cameras *c)
{
    const double size = fmax(extent(c, 0), extent(c, 1));
    const double depth = fabs(slab->geometry.uv_z - slab->geometry.st_z);
    double scale = fmax(size, depth);
    for (int i = 0; i < c->count; i++) {
        const double *uv = c->uv[c->view[i]];
        scale = fmax(scale, fmax(fabs(uv[0]), fabs(uv[1])));
        slab->u[i] = uv[0];
        slab->v[i] = uv[1];
    }
    slab->slack = ON_LINE * scale;
    slab->columns = keep_distinct(slab->u, c->count, SAME_LINE * size);
    slab->rows = keep_distinct(slab->v, c->count, SAME_LINE * size);
    if ((int64_t)slab->columns * slab->rows != c->count)
        return RELUME_EINVAL;
    for (int i = 0; i < c->count; i++)
        slab->view[i] = -1;
    for (int i = 0; i < c->count; i++) {
        const double *uv = c->uv[c->view[i]];
        const int column = line_below(slab->u, slab->columns, uv[0]);
        const int row = line_below(slab->v, slab->rows, uv[1]);
        int *at = &slab->view[(size_t)row * (size_t)slab->columns + (size_t)column];
        if (*at >= 0)
            return RELUME_EINVAL;
        *at = c->view[i];
    }
    return RELUME_OK;
}

static bool usable(const struct relume_geometry *g, const struct cameras *c)
{
    if (c->count < 1 || !isfinite(g->uv_z) || !isfinite(g->st_z) || g->uv_z == g->st_z)
        return false;
    for (int axis = 0; axis < 2; axis++)
        if (!isfinite(g->st_min[axis]) || !isfinite(g->st_max[axis]) ||
            !(g->st_min[axis] < g->st_max[axis]))
            return false;
    for (int i = 0; i < c->count; i++)
        if (!isfinite(c->uv[c->view[i]][0]) || !isfinite(c->uv[c->view[i]][1]))
            return false;
    return true;
}

static relume_status create(relume_slab **out, const struct relume_geometry *geometry,
                            const struct cameras *cameras, int views)
{
    if (!usable(geometry, cameras))
        return RELUME_EINVAL;
    relume_slab *slab = mem_zeroed(1, sizeof *slab);
    if (!slab)
        return RELUME_ENOMEM;
    slab->geometry = *geometry;
    slab->views = views;
    slab->u = mem_array((size_t)cameras->count, sizeof *slab->u);
    slab->v = mem_array((size_t)cameras->count, sizeof *slab->v);
    slab->view = mem_array((size_t)cameras->count, sizeof *slab->view);
    relume_status status = RELUME_ENOMEM;
    if (slab->u && slab->v && slab->view)
        status = find_grid(slab, cameras);
    if (status)
        relume_slab_destroy(&slab);
    *out = slab;
    return status;
}

relume_status slab_create(relume_slab **out, const struct relume_geometry *geometry,
                          const double (*uv)[2], const int *slab_of, int which, int views)
{
    *out = NULL;
    if (views < 1)
        return RELUME_EINVAL;
    int *view = mem_array((size_t)views, sizeof *view);
    if (!view)
        return RELUME_ENOMEM;
    struct cameras cameras = {uv, view, 0};
    for (int i = 0; i < views; i++)
        if (!slab_of || slab_of[i] == which)
            view[cameras.count++] = i;
    const relume_status status = create(out, geometry, &cameras, views);
    mem_free(view);
    return status;
}

relume_status relume_slab_create(relume_slab **out, const struct relume_geometry *geometry,
                                 const double (*uv)[2], int views)
{
    return slab_create(out, geometry, uv, NULL, 0, views);
}

void relume_slab_destroy(relume_slab **slab)
{
    if (!*slab)
        return;
    mem_free((*slab)->u);
    mem_free((*slab)->v);
    mem_free((*slab)->view);
    mem_free(*slab);
    *slab = NULL;
}

struct relume_slab_grid relume_slab_grid(const relume_slab *slab)
{
    return (struct relume_slab_grid){
        .columns = slab->columns,
        .rows = slab->rows,
        .u = slab->u,
        .v = slab->v,
        .view = slab->view,
        .views = slab->views,
    };
}

struct relume_vec3 relume_slab_middle(const relume_slab *slab)
{
    return (struct relume_vec3){
        .x = 0.5 * (slab->u[0] + slab->u[slab->columns - 1]),
        .y = 0.5 * (slab->v[0] + slab->v[slab->rows - 1]),
        .z = slab->geometry.uv_z,
    };
}

// ---------------------------------------------------------------- rays

bool slab_reach(double *reach, const relume_slab *slab, struct relume_vec3 eye)
{
    const struct relume_geometry *g = &slab->geometry;
    const bool finite = isfinite(eye.x) && isfinite(eye.y) && isfinite(eye.z);
    if (!finite || (eye.z - g->st_z) * (g->uv_z - g->st_z) <= 0.0)
        return false;
    *reach = (g->uv_z - eye.z) / (g->st_z - eye.z);
    return true;
}

double slab_hit(double eye, double st, double reach)
{
    return eye + reach * (st - eye);
}

bool relume_slab_uv(double uv[2], const relume_slab *slab, struct relume_vec3 eye, double s,
                    double t)
{
    double reach;
    if (!slab_reach(&reach, slab, eye))
        return false;
    uv[0] = slab_hit(eye.x, s, reach);
    uv[1] = slab_hit(eye.y, t, reach);
    return true;
}

// Of one axis: the eye sees the window from `low` to `high` through the lines between `first` and
// `last`.
static double share_of(double eye, double reach, double low, double high, double first, double last)
{
    const double a = slab_hit(eye, low, reach), b = slab_hit(eye, high, reach);
    if (a == b)
        return a >= first && a <= last;
    const double within = fmin(fmax(a, b), last) - fmax(fmin(a, b), first);
    return fmin(fmax(within / fabs(a - b), 0.0), 1.0);
}

double relume_slab_share(const relume_slab *slab, struct relume_vec3 eye)
{
    const struct relume_geometry *g = &slab->geometry;
    double reach;
    if (!slab_reach(&reach, slab, eye))
        return 0.0;
    return share_of(eye.x, reach, g->st_min[0], g->st_max[0], slab->u[0] - slab->slack,
                    slab->u[slab->columns - 1] + slab->slack) *
           share_of(eye.y, reach, g->st_min[1], g->st_max[1], slab->v[0] - slab->slack,
                    slab->v[slab->rows - 1] + slab->slack);
}

// ---------------------------------------------------------------- weights

static struct neighbours find_neighbours(const double *lines, int n, double slack, bool constant,
                                         double at)
{
    if (!(at >= lines[0] - slack && at <= lines[n - 1] + slack))
        return (struct neighbours){0};
    const int low = line_below(lines, n, at);
    if (low == n - 1 || at <= lines[low] + slack)
        return one_neighbour(low);
    if (at >= lines[low + 1] - slack)
        return one_neighbour(low + 1);
    const double part = (at - lines[low]) / (lines[low + 1] - lines[low]);
    if (constant)
        return one_neighbour(part < 0.5 ? low : low + 1);
    return (struct neighbours){2, {low, low + 1}, {1.0 - part, part}};
}

struct neighbours slab_columns_at(const relume_slab *slab, bool constant, double u)
{
    return find_neighbours(slab->u, slab->columns, slab->slack, constant, u);
}

struct neighbours slab_rows_at(const relume_slab *slab, bool constant, double v)
{
    return find_neighbours(slab->v, slab->rows, slab->slack, constant, v);
}

static bool takes_nearest(const struct relume_view_params *params)
{
    return params && params->interpolation == RELUME_INTERPOLATE_CONSTANT && !slab_is_lens(params);
}

int relume_slab_blend(int view[4], double weight[4], const relume_slab *slab, const double uv[2],
                      const struct relume_view_params *params)
{
    const bool constant = takes_nearest(params);
    const struct neighbours across = slab_columns_at(slab, constant, uv[0]);
    const struct neighbours down = slab_rows_at(slab, constant, uv[1]);
    int n = 0;
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++, n++) {
            view[n] =
                slab->view[(size_t)down.index[j] * (size_t)slab->columns + (size_t)across.index[i]];
            weight[n] = down.weight[j] * across.weight[i];
        }
    return n;
}

// ---------------------------------------------------------------- which views

// The lines with weight anywhere between two points; false when there are none.
static bool line_span(int span[2], const double *lines, int n, double slack, bool constant,
                      double from, double to)
{
    const double low = fmax(from, lines[0]);
    const double high = fmin(to, lines[n - 1]);
    if (low > high + slack)
        return false;
    const struct neighbours first = find_neighbours(lines, n, slack, constant, low);
    const struct neighbours last = find_neighbours(lines, n, slack, constant, high);
    span[0] = first.index[0];
    span[1] = last.index[last.count - 1];
    return true;
}

int slab_mark(bool *needed, const relume_slab *slab, struct relume_vec3 eye, const double st_min[2],
              const double st_max[2], const struct relume_view_params *params)
{
    const struct relume_geometry *g = &slab->geometry;
    const bool constant = takes_nearest(params);
    const double radius = params ? 0.5 * fabs(params->aperture) : 0.0;
    const size_t columns = (size_t)slab->columns;
    double a[2], b[2];
    int across[2], down[2];
    if (!relume_slab_uv(a, slab, eye, fmax(st_min[0], g->st_min[0]),
                        fmax(st_min[1], g->st_min[1])) ||
        !relume_slab_uv(b, slab, eye, fmin(st_max[0], g->st_max[0]),
                        fmin(st_max[1], g->st_max[1])) ||
        !line_span(across, slab->u, slab->columns, slab->slack, constant, fmin(a[0], b[0]) - radius,
                   fmax(a[0], b[0]) + radius) ||
        !line_span(down, slab->v, slab->rows, slab->slack, constant, fmin(a[1], b[1]) - radius,
                   fmax(a[1], b[1]) + radius))
        return 0;
    for (int row = down[0]; row <= down[1]; row++)
        for (int column = across[0]; column <= across[1]; column++)
            needed[slab->view[(size_t)row * columns + (size_t)column]] = true;
    return (down[1] - down[0] + 1) * (across[1] - across[0] + 1);
}

int relume_slab_needs(bool *needed, const relume_slab *slab, struct relume_vec3 eye,
                      const struct relume_view_params *params)
{
    memset(needed, 0, (size_t)slab->views * sizeof *needed);
    return slab_mark(needed, slab, eye, slab->geometry.st_min, slab->geometry.st_max, params);
}
