// environment.c - distant radiance from all directions (Wong 1998, Eq. 7.6): a map becomes cells
// with exact solid angles and the directions from where their energy comes
#include <relume/light.h>
#include <relume/relight/relight.h>

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/fnv.h"
#include "core/math/luminance.h"
#include "core/math/random.h"
#include "core/math/vec.h"
#include "format/coder/coding.h"
#include "relight/light/environment.h"
#include "relight/light/grid.h"
#include "relight/light/refit.h"

#include <string.h>

enum { CELL_COLUMNS = 256, CELL_ROWS = 128, SHOWN_COLUMNS = 1024, SHOWN_ROWS = 512 };

struct relume_environment {
    struct relume_image map;
    uint64_t fingerprint;
    int count, rows;
    int end[CELL_ROWS];  // of each row, in `cell`
    struct relume_environment_cell *cell;
};

// ---------------------------------------------------------------- the map

static size_t clean(struct relume_image *map)
{
    const size_t n = (size_t)map->width * (size_t)map->height * 3;
    size_t bad = 0;
    for (size_t i = 0; i < n; i++)
        if (!(map->data[i] >= 0.0f && map->data[i] <= 1e9f)) {
            map->data[i] = 0.0f;
            bad++;
        }
    return bad;
}

static relume_status copy_map(struct relume_image *to, const struct relume_image *from)
{
    const relume_status status = relume_image_create(to, from->width, from->height, 3);
    if (!status)
        memcpy(to->data, from->data,
               (size_t)from->width * (size_t)from->height * 3 * sizeof *from->data);
    return status;
}

static void say_oddities(const struct relume_image *map, size_t bad,
                         const struct relume_environment_params *p)
{
    const char *name = p->name ? p->name : "environment";
    if (bad)
        log_line(p->log, RELUME_WARNING,
                 "%s: %zu pixel%s negative, not finite or above 1e9; treated as black", name, bad,
                 bad == 1 ? " is" : "s are");
    if (map->width != 2 * map->height)
        log_line(
            p->log, RELUME_WARNING,
            "%s: %d x %d pixels; expected a map twice as wide as high; it is stretched to that",
            name, map->width, map->height);
}

// Block averages of at most SHOWN_COLUMNS x SHOWN_ROWS pixels, in place of `map`.
static relume_status shrink(struct relume_image *map)
{
    const int width = map->width < SHOWN_COLUMNS ? map->width : SHOWN_COLUMNS;
    const int height = map->height < SHOWN_ROWS ? map->height : SHOWN_ROWS;
    struct relume_image small;
    if (width == map->width && height == map->height)
        return RELUME_OK;
    relume_status status = relume_image_create(&small, width, height, 3);
    float *count = mem_zeroed((size_t)width * (size_t)height, sizeof *count);
    if (!status && !count)
        status = RELUME_ENOMEM;
    for (int y = 0; !status && y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            const size_t to = (size_t)((int64_t)y * height / map->height) * (size_t)width +
                              (size_t)((int64_t)x * width / map->width);
            const float *from = map->data + 3 * ((size_t)y * (size_t)map->width + (size_t)x);
            for (size_t c = 0; c < 3; c++)
                small.data[3 * to + c] += from[c];
            count[to] += 1.0f;
        }
    for (size_t i = 0; !status && i < (size_t)width * (size_t)height * 3; i++)
        small.data[i] /= count[i / 3];
    mem_free(count);
    if (status) {
        relume_image_destroy(&small);
        return status;
    }
    relume_image_destroy(map);
    *map = small;
    return RELUME_OK;
}

// ---------------------------------------------------------------- cells

struct gathered {
    double rgb[3];  // sum of E dw
    vec3 centre;    // sum of direction x luminance x dw
};

// The pixels of small maps are cut into pieces, so that a cell is never wider than 3 degrees.
static int pieces(int pixels, int cells)
{
    return pixels >= cells ? 1 : cells / pixels;
}

static void gather_row(struct gathered *cells, int columns, const struct relume_image *map, int row,
                       double top, double bottom, const double (*azimuth)[2], int cut)
{
    const double solid = 2.0 * M_PI / ((double)map->width * cut) * (cos(top) - cos(bottom));
    const double theta = 0.5 * (top + bottom);
    for (int i = 0; i < map->width * cut; i++) {
        const float *e = map->data + 3 * ((size_t)row * (size_t)map->width + (size_t)(i / cut));
        struct gathered *g = &cells[(int64_t)i * columns / ((int64_t)map->width * cut)];
        const double energy = luminance_709(e) * solid;
        for (int c = 0; c < 3; c++)
            g->rgb[c] += (double)e[c] * solid;
        g->centre =
            vec3_add(g->centre, vec3_of(energy * sin(theta) * azimuth[i][0], energy * cos(theta),
                                        -energy * sin(theta) * azimuth[i][1]));
    }
}

static void keep_cells(relume_environment *e, const struct gathered *cells, int n)
{
    for (int i = 0; i < n; i++) {
        const struct gathered *g = &cells[i];
        if (!(vec3_length(g->centre) > 0.0))
            continue;
        struct relume_environment_cell *to = &e->cell[e->count++];
        to->direction = vec3_unit(g->centre);
        for (int c = 0; c < 3; c++)
            to->rgb[c] = (float)(g->rgb[c] / M_PI);
    }
    e->end[e->rows++] = e->count;
}

static relume_status make_cells(relume_environment *e)
{
    const struct relume_image *map = &e->map;
    const int across = pieces(map->width, CELL_COLUMNS), down = pieces(map->height, CELL_ROWS);
    const int fine = map->width * across, lines = map->height * down;
    const int columns = fine < CELL_COLUMNS ? fine : CELL_COLUMNS;
    const int rows = lines < CELL_ROWS ? lines : CELL_ROWS;
    double(*azimuth)[2] = mem_array((size_t)fine, sizeof *azimuth);
    struct gathered *row = mem_zeroed((size_t)columns, sizeof *row);
    e->cell = mem_array((size_t)columns * (size_t)rows, sizeof *e->cell);
    const bool good = azimuth && row && e->cell;
    for (int i = 0; good && i < fine; i++) {
        const double phi = ((i + 0.5) / fine * 2.0 - 1.0) * M_PI;
        azimuth[i][0] = sin(phi);
        azimuth[i][1] = cos(phi);
    }
    for (int y = 0, r = 0; good && y < lines; y++) {
        gather_row(row, columns, map, y / down, M_PI * y / lines, M_PI * (y + 1) / lines,
                   (const double(*)[2])azimuth, across);
        if ((int64_t)(y + 1) * rows / lines == r)
            continue;
        keep_cells(e, row, columns);
        memset(row, 0, (size_t)columns * sizeof *row);
        r++;
    }
    mem_free(azimuth);
    mem_free(row);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

static uint64_t fingerprint_of(const struct relume_image *map)
{
    const int size[2] = {map->width, map->height};
    const uint64_t hash = fnv_of(FNV_START, size, sizeof size);
    return fnv_of(hash, map->data, 3 * sizeof(float) * (size_t)map->width * (size_t)map->height);
}

relume_status relume_environment_create(relume_environment **out, const struct relume_image *map,
                                        const struct relume_environment_params *params)
{
    const struct relume_environment_params p = PARAMS(relume_environment_params, params);
    *out = NULL;
    if (!map->data || map->channels != 3 || map->width < 1 || map->height < 1)
        return RELUME_EINVAL;
    relume_environment *e = mem_zeroed(1, sizeof *e);
    relume_status status = e ? copy_map(&e->map, map) : RELUME_ENOMEM;
    if (!status) {
        say_oddities(map, clean(&e->map), &p);
        status = make_cells(e);
    }
    if (!status)
        status = shrink(&e->map);
    if (status)
        relume_environment_destroy(&e);
    else
        e->fingerprint = fingerprint_of(&e->map);
    *out = e;
    return status;
}

relume_status relume_environment_load(relume_environment **out, const char *path,
                                      const struct relume_log *log)
{
    struct relume_image map;
    *out = NULL;
    relume_status status = relume_image_load(&map, path, relume_image_params(.log = log));
    if (!status)
        status = relume_environment_create(out, &map,
                                           relume_environment_params(.log = log, .name = path));
    relume_image_destroy(&map);
    return status;
}

relume_status relume_environment_of_lamp(relume_environment **out, const struct relume_light *lamp)
{
    relume_environment *e = *out = mem_zeroed(1, sizeof *e);
    if (!e || !(e->cell = mem_zeroed(1, sizeof *e->cell))) {
        relume_environment_destroy(out);
        return RELUME_ENOMEM;
    }
    e->cell[0].direction = vec3_unit(lamp->direction);
    memcpy(e->cell[0].rgb, lamp->rgb, sizeof lamp->rgb);
    e->count = e->rows = e->end[0] = 1;
    return RELUME_OK;
}

void relume_environment_destroy(relume_environment **environment)
{
    if (!*environment)
        return;
    relume_image_destroy(&(*environment)->map);
    mem_free((*environment)->cell);
    mem_free(*environment);
    *environment = NULL;
}

uint64_t relume_environment_fingerprint(const relume_environment *environment)
{
    return environment->fingerprint;
}

const struct relume_image *relume_environment_map(const relume_environment *environment)
{
    return &environment->map;
}

const struct relume_environment_cell *relume_environment_cells(
    int *n, const relume_environment *environment)
{
    *n = environment->count;
    return environment->cell;
}

// ---------------------------------------------------------------- light

// About +y by the right hand, -z goes to -x: the other way round.
struct relume_vec3 relume_environment_turn(struct relume_vec3 direction, double rotate_deg)
{
    const double c = cos(rotate_deg * (M_PI / 180.0)), s = sin(rotate_deg * (M_PI / 180.0));
    const vec3 d = direction;
    return vec3_of(c * d.x - s * d.z, d.y, s * d.x + c * d.z);
}

// Of light along the surface at most this share of that from the border of the region is used.
static const double upright = 0.05, most_upright = 0.25;
// Lamps farther apart than 70 degrees say too little of what is between them.
static const double most_between = 1.25;

// The share of `shown` (grid_shown), which replaces light from `direction`. Between lamps it is
// what makes a plane show what it should: flat triangles lie inside the sphere. For light from
// beyond them a single light's share (relume_coder_clamp, `lone`) is what predicts lamps best, 2 to
// 4 % too much in the sum; this has the same end along the surface and the mean of a plane's z /
// z', which is 1/2, so that an even sky shows a white plane as 1: rest + (1 - rest) t^power.
static double share_of_sky(const struct relume_captured_region *region, vec3 direction, vec3 shown,
                           double lone)
{
    const double to = vec3_dot(direction, region->facing), border = vec3_dot(shown, region->facing);
    if (!(border > 0.0))
        return lone;
    if (to >= border)
        return fmin(to / border, most_between);
    const double rest = fmin(upright / (border + upright), most_upright);
    return rest + (1.0 - rest) * pow(fmax(to / border, 0.0), 0.5 / (0.5 - rest));
}

void relume_environment_weights(float *weights, float constant[3], const relume_weight_grid *grid,
                                const struct relume_light *light)
{
    const relume_environment *e = light->environment;
    const relume_weight_grid *const sums = grid_for_sums(grid);
    const relume_coder *coder = relume_weight_grid_info(grid)->coder;
    const struct relume_coder_info *info = relume_coder_info(coder);
    for (int i = 0; i < e->count; i++) {
        const vec3 d = relume_environment_turn(e->cell[i].direction, light->rotate_deg);
        float value[3];
        vec3 from;
        if (info->hemispherical && pole_from_world(d, info->pole_y).z < 0.0)
            continue;
        const double lone = relume_coder_clamp(&from, coder, d);
        const float share =
            (float)share_of_sky(relume_coder_region(coder), d, grid_shown(sums, from), lone);
        for (int c = 0; c < 3; c++)
            value[c] = share * light->rgb[c] * e->cell[i].rgb[c];
        relume_weight_grid_add(weights, constant, sums, from, value);
    }
}

relume_status environment_on_lights(struct relume_light *out, int *count, const relume_coder *coder,
                                    const struct relume_light *light, int threads)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    struct relume_coder_params p = {
        .hemispherical = info->hemispherical,
        .pole_y = info->pole_y,
        .interpolant = info->interpolant ? info->interpolant : relume_interpolant_find("chord"),
        .decode = true};
    const size_t n = (size_t)info->lights;
    relume_coder *table = NULL;
    relume_weight_grid *grid = NULL;
    float *weights = mem_zeroed(3 * n, sizeof *weights), constant[3] = {0};
    memcpy(p.parameter, info->parameter, sizeof p.parameter);
    relume_status status = weights ? relume_coder_create(&table, &relume_basis_table,
                                                         info->directions, info->lights, &p)
                                   : RELUME_ENOMEM;
    if (!status)
        status = relume_weight_grid_create(
            &grid, table, relume_weight_grid_params(.sums = true, .threads = threads));
    if (!status)
        relume_environment_weights(weights, constant, grid, light);
    for (size_t i = 0; !status && i < n; i++)
        if (weights[i] != 0.0f || weights[n + i] != 0.0f || weights[2 * n + i] != 0.0f)
            out[(*count)++] =
                (struct relume_light){.kind = RELUME_LIGHT_DIRECTIONAL,
                                      .direction = info->directions[i],
                                      .rgb = {weights[i], weights[n + i], weights[2 * n + i]}};
    relume_weight_grid_destroy(&grid);
    relume_coder_destroy(&table);
    mem_free(weights);
    return status;
}

// ---------------------------------------------------------------- sampling

static const double golden = 0.6180339887498949;

// The first of the running sums from `at` on that is above `want`, the last at most.
static int find_above(const double *sum, int at, int last, double want)
{
    while (at < last && sum[at] <= want)
        at++;
    return at;
}

// Cells that shine more than a light's share of the others are bright sources, a light each:
// so many are *out, and sum[] is the running sum of the others. What is drawn of them would all
// come from one direction, and leave few lights for the sky.
static int take_bright_sources(struct relume_light *out, int n, const struct relume_light *light,
                               double *sum)
{
    const relume_environment *e = light->environment;
    int taken = 0;
    for (int i = 0; i < e->count; i++)
        sum[i] = luminance_709(e->cell[i].rgb);
    for (int before = -1; taken > before;) {
        double left = 0.0;
        for (int i = 0; i < e->count; i++)
            left += sum[i];
        const double share = left / (n - taken);
        before = taken;
        for (int i = 0; i < e->count; i++)
            if (sum[i] > share) {
                sum[i] = 0.0;
                out[taken] = (struct relume_light){
                    .direction = relume_environment_turn(e->cell[i].direction, light->rotate_deg)};
                memcpy(out[taken++].rgb, e->cell[i].rgb, sizeof e->cell[i].rgb);
            }
    }
    for (int i = 1; i < e->count; i++)
        sum[i] += sum[i - 1];
    return taken;
}

// A Fibonacci lattice, shifted: its rows by inversion of the running sum of luminance over the rows
// of cells, its columns by that within a row, so that what is drawn is spread evenly both ways.
static void draw(struct relume_light *out, int n, const struct relume_light *light,
                 const double *sum, uint64_t seed)
{
    const relume_environment *e = light->environment;
    const double total = sum[e->count - 1];
    struct random random = random_stream(seed, 0, 0);
    const double down = random_next(&random), along = random_next(&random);
    for (int i = 0, row = 0; i < n; i++) {
        const double want = (i + down) / n * total;
        while (row < e->rows - 1 && (e->end[row] == 0 || sum[e->end[row] - 1] <= want))
            row++;
        const int first = row ? e->end[row - 1] : 0, last = e->end[row] - 1;
        const double from = first ? sum[first - 1] : 0.0, part = i * golden + along;
        const int at =
            find_above(sum, first, last, from + (part - floor(part)) * (sum[last] - from));
        const struct relume_environment_cell *cell = &e->cell[at];
        const double factor = total / (n * luminance_709(cell->rgb));
        out[i] = (struct relume_light){
            .direction = relume_environment_turn(cell->direction, light->rotate_deg)};
        for (int c = 0; c < 3; c++)
            out[i].rgb[c] = (float)((double)cell->rgb[c] * factor);
    }
}

// Colours in proportion, so that each channel has the total of the map.
static void match_totals(struct relume_light *out, int n, const struct relume_light *light)
{
    const relume_environment *e = light->environment;
    for (int c = 0; c < 3; c++) {
        double map = 0.0, drawn = 0.0;
        for (int i = 0; i < e->count; i++)
            map += (double)e->cell[i].rgb[c];
        for (int i = 0; i < n; i++)
            drawn += (double)out[i].rgb[c];
        const double factor = drawn > 0.0 ? map / drawn : 0.0;
        for (int i = 0; i < n; i++)
            out[i].rgb[c] = (float)((double)out[i].rgb[c] * factor * (double)light->rgb[c]);
    }
}

relume_status relume_environment_sample(struct relume_light *out, int n,
                                        const struct relume_light *environment, uint64_t seed)
{
    const relume_environment *e = environment->environment;
    for (int i = 0; i < n; i++)
        out[i] = (struct relume_light){.direction = {0.0, 1.0, 0.0}};
    if (n < 1 || e->count == 0)
        return n < 1 ? RELUME_EINVAL : RELUME_OK;
    double *sum = mem_array((size_t)e->count, sizeof *sum);
    if (!sum)
        return RELUME_ENOMEM;
    const int taken = take_bright_sources(out, n, environment, sum);
    if (sum[e->count - 1] > 0.0)
        draw(out + taken, n - taken, environment, sum, seed);
    match_totals(out, n, environment);
    mem_free(sum);
    return RELUME_OK;
}
