// slab_ingest.c - relume_slab_ingest: photographs named by their places become a slab
#include "capture/multiview/views_order.h"

#include "core/base/log.h"
#include "core/base/params.h"
#include "core/base/memory.h"
#include "core/base/outdir.h"
#include "core/math/sort.h"
#include "capture/multiview/views_shift.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Less than this is no evidence against the names: agreement is 0.2 to 0.6 on rendered scenes and
// 0.36 on the chess pieces of the Stanford archive.
static const double clear_agreement = 0.05;
// Occlusions are a weaker witness and only lead to a hint: 0.46 on a rendered chess board, 0.02 on
// the photographed one, and with the wrong sign up to 0.37 on a convex thing before black.
static const double clear_occlusion = 0.3;

struct slab {
    const struct relume_slab_ingest_params *p;
    const struct relume_ingest_params *common;
    struct photo_set set;
    struct view_place *place;  // [set.count]
    int rows, columns;
    int *camera;    // [rows][columns]
    double *u, *v;  // [columns], [rows]
    int width, height;
};

static double or_default(double value, double otherwise)
{
    return value != 0.0 ? value : otherwise;
}

// ---------------------------------------------------------------- rows and columns

// Positions alone: equal ones are a row or a column.
static relume_status rank_positions(struct slab *s, bool of_u)
{
    const size_t n = (size_t)s->set.count;
    double *sorted = mem_array(n, sizeof *sorted);
    if (!sorted)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++)
        sorted[i] = of_u ? s->place[i].u : -s->place[i].v;
    sort_doubles(sorted, n);
    const double near = 1e-6 * (sorted[n - 1] - sorted[0]);
    for (size_t i = 0; i < n; i++) {
        const double at = of_u ? s->place[i].u : -s->place[i].v;
        int rank = 0;
        for (size_t k = 1; k < n && sorted[k] <= at + near; k++)
            rank += sorted[k] > sorted[k - 1] + near;
        *(of_u ? &s->place[i].column : &s->place[i].row) = rank;
    }
    mem_free(sorted);
    return RELUME_OK;
}

static bool has_crossings(const struct slab *s)
{
    for (int i = 1; i < s->set.count; i++)
        if (s->place[i].row != s->place[0].row || s->place[i].column != s->place[0].column)
            return true;
    return false;
}

// The different values, ascending; returns how many.
static int distinct(int *values, const struct slab *s, bool rows)
{
    int n = 0;
    for (int i = 0; i < s->set.count; i++) {
        const int value = rows ? s->place[i].row : s->place[i].column;
        int at = n;
        while (at > 0 && values[at - 1] > value)
            at--;
        if (at > 0 && values[at - 1] == value)
            continue;
        memmove(values + at + 1, values + at, (size_t)(n++ - at) * sizeof *values);
        values[at] = value;
    }
    return n;
}

static int index_of(const int *values, int value)
{
    int i = 0;
    while (values[i] != value)
        i++;
    return i;
}

// A column's place: the mean of what its cameras' names say, else its number.
static void place_lines(double *out, const struct slab *s, const int *values, int n, bool rows)
{
    for (int line = 0; line < n; line++) {
        double sum = 0.0;
        int count = 0;
        for (int i = 0; i < s->set.count; i++) {
            const struct view_place *p = &s->place[i];
            if ((rows ? p->row : p->column) != values[line])
                continue;
            sum += p->has_uv ? (rows ? p->v : p->u) : rows ? -p->row : p->column;
            count++;
        }
        out[line] = sum / count;
    }
}

static relume_status place_cameras(struct slab *s, const int *rows, const int *columns)
{
    const struct relume_log *log = s->common->log;
    for (int i = 0; i < s->rows * s->columns; i++)
        s->camera[i] = -1;
    for (int i = 0; i < s->set.count; i++) {
        int *at = &s->camera[index_of(rows, s->place[i].row) * s->columns +
                             index_of(columns, s->place[i].column)];
        if (*at >= 0)
            return log_fail(log, RELUME_EUNFIT,
                            "%s: is at row %d, column %d; expected one camera there; found %s",
                            s->set.camera[i].name, s->place[i].row, s->place[i].column,
                            s->set.camera[*at].name);
        *at = i;
    }
    return RELUME_OK;
}

// The camera that stands nearest in the grid.
static int nearest_camera(const struct slab *s, const int *camera, int row, int column)
{
    int best = -1, least = 0;
    for (int r = 0; r < s->rows; r++)
        for (int c = 0; c < s->columns; c++) {
            const int d = (r - row) * (r - row) + (c - column) * (c - column);
            if (camera[r * s->columns + c] >= 0 && (best < 0 || d < least)) {
                best = camera[r * s->columns + c];
                least = d;
            }
        }
    return best;
}

static relume_status fill_grid(struct slab *s, const int *rows, const int *columns)
{
    const struct relume_log *log = s->common->log;
    const size_t n = (size_t)(s->rows * s->columns);
    int *found = mem_copy(s->camera, n, sizeof *found);
    relume_status status = found ? RELUME_OK : RELUME_ENOMEM;
    for (int r = 0; r < s->rows && !status; r++)
        for (int c = 0; c < s->columns && !status; c++) {
            int *at = &s->camera[r * s->columns + c];
            if (*at >= 0)
                continue;
            *at = nearest_camera(s, found, r, c);
            if (!s->p->fill)
                status = log_fail(log, RELUME_ENOTFOUND,
                                  "no photograph of row %d, column %d; expected a whole grid of "
                                  "%d x %d, or --fill; found %d photograph%s",
                                  rows[r], columns[c], s->rows, s->columns, s->set.count,
                                  relume_plural(s->set.count));
            else
                log_line(log, RELUME_WARNING, "row %d, column %d: missing; filled by %s", rows[r],
                         columns[c], s->set.camera[*at].name);
        }
    mem_free(found);
    return status;
}

static relume_status make_grid(struct slab *s)
{
    const size_t n = (size_t)s->set.count;
    struct arena *a = &s->set.arena;
    int *rows = arena_array(a, n + 1, sizeof *rows), *columns = arena_array(a, n + 1, sizeof *rows);
    if (!rows || !columns)
        return RELUME_ENOMEM;
    if (s->place[0].has_uv && !has_crossings(s)) {
        const relume_status status = rank_positions(s, true);
        if (status || rank_positions(s, false))
            return RELUME_ENOMEM;
    }
    s->rows = distinct(rows, s, true);
    s->columns = distinct(columns, s, false);
    const double cells = (double)s->rows * s->columns;
    if (cells > 65536.0)
        return log_fail(s->common->log, RELUME_ELIMIT,
                        "%d rows and %d columns of cameras; expected a grid of at most 65536",
                        s->rows, s->columns);
    s->camera = arena_array(a, (size_t)cells, sizeof *s->camera);
    s->u = arena_array(a, (size_t)s->columns, sizeof *s->u);
    s->v = arena_array(a, (size_t)s->rows, sizeof *s->v);
    if (!s->camera || !s->u || !s->v)
        return RELUME_ENOMEM;
    place_lines(s->u, s, columns, s->columns, false);
    place_lines(s->v, s, rows, s->rows, true);
    const relume_status status = place_cameras(s, rows, columns);
    return status ? status : fill_grid(s, rows, columns);
}

// ---------------------------------------------------------------- world

static void turn(double *values, int n)
{
    for (int i = 0; i < n; i++)
        values[i] = -values[i];
}

// Whether rows and columns run alike the photographs know better than the names.
static relume_status check_order(struct slab *s)
{
    struct grid_order o;
    const struct camera_grid grid = {s->rows, s->columns, s->camera, s->u, s->v};
    const struct relume_log *log = s->common->log;
    const relume_status status = grid_order(&o, &s->set, &grid, s->common);
    if (status)
        return status;
    if (o.mixed && o.agreement > clear_agreement) {
        turn(s->v, s->rows);
        log_line(log, RELUME_WARNING,
                 "rows run against the names, columns with them (agreement %.2f): rows turned "
                 "round; --keep-order keeps the names' order, --turn turns both",
                 o.agreement);
    }
    if (o.occlusion < -clear_occlusion)
        log_line(log, RELUME_NOTE,
                 "far things seem to hide near ones (%.2f): if depth comes out inside out, --turn "
                 "turns columns and rows round",
                 o.occlusion);
    return RELUME_OK;
}

static void range_of(double range[2], const double *values, int n)
{
    range[0] = range[1] = values[0];
    for (int i = 1; i < n; i++) {
        range[0] = fmin(range[0], values[i]);
        range[1] = fmax(range[1], values[i]);
    }
}

// Where neither names nor the caller say how far apart rows are.
static bool is_open(const struct slab *s)
{
    return !s->place[0].has_uv && s->p->baseline_v <= 0.0 && s->rows > 1 && s->columns > 1;
}

// A ratio this near to 1, or nearer than its error, is that of a square grid.
static const double near_square = 0.03;

// Of the grid in world units: numbers in names may count rows otherwise than columns.
static void say_spacing(const struct slab *s, const struct grid_spacing *g)
{
    const struct relume_log *log = s->common->log;
    double u[2], v[2];
    range_of(u, s->u, s->columns);
    range_of(v, s->v, s->rows);
    const double high = v[1] - v[0];
    const double ratio = high / (s->rows - 1) * (s->columns - 1) / (u[1] - u[0]);
    if (g->ratio == 0.0)
        log_line(log, RELUME_NOTE,
                 "assuming that rows of cameras are %.3g times as far apart as columns, %g from "
                 "the first to the last: the photographs do not show it; if that is wrong, give "
                 "--baseline-v",
                 ratio, high);
    else
        log_line(log, RELUME_NOTE,
                 "rows of cameras are %.2f times as far apart as columns, %.3g from the first to "
                 "the last, by the photographs (error %.0f %%, %.0f %% of the pixels agree); if "
                 "not, give --baseline-v",
                 ratio, high, ceil(100.0 * g->error), 100.0 * g->share);
}

// How many times as far as a unit of u is a unit of v.
static relume_status find_spacing(struct grid_spacing *g, const struct slab *s)
{
    const struct camera_grid grid = {s->rows, s->columns, s->camera, s->u, s->v};
    *g = (struct grid_spacing){.ratio = 0.0};
    const relume_status status =
        is_open(s) ? grid_spacing(g, &s->set, &grid, s->common) : RELUME_OK;
    if (g->ratio > 0.0 && fabs(log(g->ratio)) < fmax(near_square, 2.0 * g->error))
        g->ratio = 1.0;
    return status;
}

// The grid around the origin, as wide as the baseline (one column: as high). Rows are to scale,
// unless their own baseline is known or found in the photographs.
static relume_status scale_grid(struct slab *s)
{
    double u[2], v[2];
    struct grid_spacing spacing;
    range_of(u, s->u, s->columns);
    range_of(v, s->v, s->rows);
    const double high = v[1] - v[0];
    const relume_status status = find_spacing(&spacing, s);
    const double k = or_default(s->p->baseline, 1.0) / (u[1] > u[0] ? u[1] - u[0] : high);
    const double kv = s->p->baseline_v > 0.0 && high > 0.0 ? s->p->baseline_v / high
                                                           : k * or_default(spacing.ratio, 1.0);
    for (int i = 0; i < s->columns; i++)
        s->u[i] = (s->u[i] - 0.5 * (u[0] + u[1])) * k;
    for (int i = 0; i < s->rows; i++)
        s->v[i] = (s->v[i] - 0.5 * (v[0] + v[1])) * kv;
    if (!status && is_open(s))
        say_spacing(s, &spacing);
    return status;
}

// ---------------------------------------------------------------- folder

static struct relume_geometry geometry_of(const struct slab *s)
{
    struct relume_geometry g = relume_geometry_default(RELUME_SLAB, s->width, s->height);
    const double half = 0.5 * or_default(s->p->window, 2.0);
    const double half_height = half * s->height / s->width;
    g.st_z = s->p->st_z;
    g.uv_z = g.st_z + or_default(s->p->distance, 3.0);
    g.st_min[0] = -half;
    g.st_max[0] = half;
    g.st_min[1] = -half_height;
    g.st_max[1] = half_height;
    return g;
}

static relume_status refer(struct slab *s, struct relume_manifest_view *view, int camera,
                           const char *dir, const outdir *folder)
{
    struct arena *a = &s->set.arena;
    view->images = arena_array(a, (size_t)s->set.lights, sizeof *view->images);
    for (int k = 0; view->images && k < s->set.lights; k++)
        if (!(view->images[k] = path_from(a, folder, dir, s->set.camera[camera].images[k])))
            return RELUME_ENOMEM;
    return view->images ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status write_slab(struct slab *s, const char *dir, const outdir *folder)
{
    const int n = s->rows * s->columns;
    struct relume_manifest_view *view = arena_array(&s->set.arena, (size_t)n, sizeof *view);
    relume_status status = view ? RELUME_OK : RELUME_ENOMEM;
    const bool shift = s->p->focus_disparity != 0.0 || s->set.turned;
    const struct camera_grid grid = {s->rows, s->columns, s->camera, s->u, s->v};
    s->width = s->set.width;
    s->height = s->set.height;
    for (int i = 0; i < n && !status; i++) {
        view[i].uv[0] = s->u[i % s->columns];
        view[i].uv[1] = s->v[i / s->columns];
        if (!shift)
            status = refer(s, &view[i], s->camera[i], dir, folder);
    }
    if (!status && shift)
        status = save_shifted(view, &s->width, &s->height, folder, &s->set, &grid,
                              s->p->focus_disparity, s->common);
    if (status)
        return status;
    struct relume_transfer transfer = {.curve = RELUME_CURVE_LINEAR};
    if (!shift)
        transfer = s->common->transfer;
    const struct relume_manifest m = {
        .transfer = transfer,
        .geometry = geometry_of(s),
        .lights = s->set.lights,
        .directions = s->set.directions,
        .views = n,
        .view = view,
    };
    return save_manifest(folder, &m, s->common->log);
}

static relume_status check(const struct slab *s)
{
    const struct relume_slab_ingest_params *p = s->p;
    const double values[] = {p->baseline, p->baseline_v, p->distance, p->window};
    for (int i = 0; i < 4; i++)
        if (!(values[i] >= 0.0) || isinf(values[i]))
            return log_fail(s->common->log, RELUME_EINVAL,
                            "baseline, distance and window: expected above 0; found %g", values[i]);
    return isfinite(p->focus_disparity) && isfinite(p->st_z) ? RELUME_OK : RELUME_EINVAL;
}

static relume_status ingest(struct slab *s, const char *dir, const char *const *photos, int n)
{
    relume_status status = check(s);
    if (!status)
        status = photo_set_open(&s->set, photos, n, s->common);
    if (status)
        return status;
    s->place = arena_array(&s->set.arena, (size_t)s->set.count, sizeof *s->place);
    status = s->place ? view_places(s->place, &s->set, s->p->names, s->common->log) : RELUME_ENOMEM;
    if (!status)
        status = make_grid(s);
    if (!status && s->p->turn) {
        turn(s->u, s->columns);
        turn(s->v, s->rows);
    }
    if (!status && s->p->baseline_v > 0.0 && s->rows < 2)
        status = log_fail(s->common->log, RELUME_EINVAL,
                          "--baseline-v: expected rows of cameras; found one");
    if (!status)
        status = scale_grid(s);
    if (!status && !s->p->keep_order)
        status = check_order(s);
    outdir *folder = NULL;
    if (!status)
        status = outdir_open(&folder, dir, s->common->force, s->common->log);
    if (!status)
        status = write_slab(s, dir, folder);
    return outdir_end(&folder, status);
}

relume_status relume_slab_ingest(const char *dir, const char *const *photos, int n,
                                 const struct relume_slab_ingest_params *slab,
                                 const struct relume_ingest_params *params)
{
    const struct relume_slab_ingest_params own = PARAMS(relume_slab_ingest_params, slab);
    const struct relume_ingest_params common = PARAMS_WORK(relume_ingest_params, params);
    struct slab s = {.p = &own, .common = &common};
    const relume_status status = ingest(&s, dir, photos, n);
    photo_set_free(&s.set);
    return status;
}
