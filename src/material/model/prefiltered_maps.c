// prefiltered_maps.c - an environment under lobes of all directions and eleven exponents
// (thesis, 9.4)
//
// Kept are means under lobes, not sums: a sum falls with the exponent as 1 / (e + 1), and linear
// interpolation of it errs even under a uniform sky. The factor n.l, which the thesis takes at the
// axis of the lobe (its Eq. prints the axis without making it a unit vector), and the horizon,
// which it leaves out, are the mean over the lobe here, in a table: exact under a uniform sky.
#include "material/model/ambient.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "core/math/luminance.h"
#include "material/model/environment.h"
#include "relight/light/environment.h"

#include <string.h>

enum { EXPONENTS = RELUME_PREFILTERED_EXPONENTS, STEPS = RELUME_PREFILTERED_STEPS };
enum { CELL_COLUMNS = 96, CELL_ROWS = 48 };  // cells of 3.75 degrees: the sharpest lobe has 12
enum { LANES = 16 };                         // exponents, and what fills vectors
enum { TABLE = 2048, USUAL_HEIGHT = 48 };

static double exponent_of(int i)
{
    return pow(2.0, 0.5 * i);
}

// ---------------------------------------------------------------- the environment in few cells

static vec3 direction_of(double column, double row)  // parts of the map
{
    const double phi = (2.0 * column - 1.0) * M_PI, theta = row * M_PI;
    return vec3_of(sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi));
}

static void place_of(vec3 d, double out[2])
{
    out[0] = 0.5 + atan2(d.x, -d.z) / (2.0 * M_PI);
    out[1] = acos(fmin(fmax(d.y, -1.0), 1.0)) / M_PI;
}

// Neighbouring cells become one, from where their energy comes; which do does not depend on the
// rotation.
static int gather(struct relume_environment_cell *cell, const struct relume_light *light)
{
    int kept = 0;
    int n;
    const struct relume_environment_cell *from = relume_environment_cells(&n, light->environment);
    for (int i = 0; i < n; i++) {
        double at[2];
        const vec3 d = from[i].direction;
        place_of(d, at);
        const int x = (int)(at[0] * CELL_COLUMNS) % CELL_COLUMNS;
        const int y = at[1] < 1.0 ? (int)(at[1] * CELL_ROWS) : CELL_ROWS - 1;
        const int to = y * CELL_COLUMNS + x;
        cell[to].direction = vec3_along(cell[to].direction, d, luminance_709(from[i].rgb));
        for (int c = 0; c < 3; c++)
            cell[to].rgb[c] += light->rgb[c] * from[i].rgb[c];
    }
    for (int i = 0; i < CELL_COLUMNS * CELL_ROWS; i++)
        if (vec3_length(cell[i].direction) > 0.0) {
            struct relume_environment_cell one = cell[i];
            one.direction = relume_environment_turn(vec3_unit(one.direction), light->rotate_deg);
            cell[kept++] = one;
        }
    return kept;
}

// ---------------------------------------------------------------- maps

// Numbers of four exponents (a vector type of GCC and Clang: sanitizers look at each memory access,
// and loops of single numbers take five times as long with them).
typedef float four __attribute__((vector_size(16), aligned(4), may_alias));

struct filtering {
    relume_prefiltered_maps *p;
    float (*power)[LANES];  // [TABLE + 1]: (i / TABLE)^e
};

struct sums {
    float diffuse[3], specular[3][LANES];
};

static inline void add_lobes(struct sums *restrict sums, const float low[restrict LANES],
                             const float high[restrict LANES], float part,
                             const float rgb[restrict 3])
{
    for (int e = 0; e < LANES; e += 4) {
        const four from = *(const four *)(low + e);
        const four weight = from + part * (*(const four *)(high + e) - from);
        for (int c = 0; c < 3; c++)
            *(four *)(sums->specular[c] + e) += weight * rgb[c];
    }
}

static void filter_pixel(const struct filtering *f, vec3 d, struct sums *sums)
{
    const relume_prefiltered_maps *p = f->p;
    for (int i = 0; i < p->cells; i++) {
        const struct relume_environment_cell *cell = &p->cell[i];
        const double z = vec3_dot(d, cell->direction);
        if (!(z > 0.0))
            continue;
        const float fall = p->rim > 0.0 && z < p->rim ? (float)(z / p->rim) : 1.0f;
        const float at = z < 1.0 ? (float)z * TABLE : TABLE;
        const int low = at < TABLE ? (int)at : TABLE - 1;
        for (int c = 0; c < 3; c++)
            sums->diffuse[c] += fall * cell->rgb[c];
        add_lobes(sums, f->power[low], f->power[low + 1], at - (float)low, cell->rgb);
    }
}

static void filter_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct filtering *f = context;
    relume_prefiltered_maps *p = f->p;
    const size_t width = (size_t)p->width, plane = width * (size_t)p->height;
    for (size_t x = 0; x < width; x++) {
        struct sums sums = {.diffuse = {0.0f}};
        const size_t at = row * width + x;
        const vec3 d = direction_of(((double)x + 0.5) / p->width, ((double)row + 0.5) / p->height);
        filter_pixel(f, d, &sums);
        memcpy(p->diffuse + 3 * at, sums.diffuse, sizeof sums.diffuse);
        for (int e = 0; e < EXPONENTS; e++)
            for (size_t c = 0; c < 3; c++)
                p->specular[3 * ((size_t)e * plane + at) + c] =
                    (float)(0.5 * (exponent_of(e) + 1.0)) * sums.specular[c][e];
    }
}

static relume_status filter(relume_prefiltered_maps *p, int threads)
{
    struct filtering f = {p, mem_zeroed(TABLE + 1, sizeof *f.power)};
    if (!f.power)
        return RELUME_ENOMEM;
    for (int i = 0; i <= TABLE; i++)
        for (int e = 0; e < EXPONENTS; e++) {
            const double power = pow((double)i / TABLE, exponent_of(e));
            // less is nothing, and numbers too small for a float are slow
            f.power[i][e] = power > 1e-12 ? (float)power : 0.0f;
        }
    thread_for(threads, (size_t)p->height, filter_row, &f);
    mem_free(f.power);
    return RELUME_OK;
}

// ---------------------------------------------------------------- parts of lobes

// Half the integral over azimuth of lobes of all exponents at the height z over the horizon, their
// axis having the cosine `axis` to the normal. Exponents double every other one.
static void around(double axis, double z, double sum[EXPONENTS])
{
    enum { AROUND = 64 };
    const double across = sqrt(fmax((1.0 - axis * axis) * (1.0 - z * z), 0.0));
    for (int e = 0; e < EXPONENTS; e++)
        sum[e] = 0.0;
    for (int i = 0; i < AROUND; i++) {
        const double mu = axis * z + across * cos((i + 0.5) / AROUND * M_PI);
        double power[EXPONENTS] = {mu, pow(fmax(mu, 0.0), exponent_of(1))};
        for (int e = 0; e < EXPONENTS && mu > 0.0; e++) {
            power[e] = e < 2 ? power[e] : power[e - 2] * power[e - 2];
            sum[e] += power[e] * M_PI / AROUND;
        }
    }
}

// Parts of all lobes about one axis. Below the rim values are those at the rim, times fall(z) =
// z / rim: the lobe is asked there, and fall and z have a closed form.
static void parts_of_lobes(double axis, double rim, double even[EXPONENTS],
                           double cosine[EXPONENTS])
{
    enum { UP = 64 };
    double sum[EXPONENTS];
    around(axis, rim, sum);
    for (int e = 0; e < EXPONENTS; e++) {
        even[e] = 0.5 * rim * sum[e];
        cosine[e] = 0.5 * rim * rim * sum[e];
    }
    for (int i = 0; i < UP; i++) {
        const double theta = acos(rim) * (i + 0.5) / UP, z = cos(theta);
        const double step = acos(rim) / UP * sin(theta);
        around(axis, z, sum);
        for (int e = 0; e < EXPONENTS; e++) {
            even[e] += step * sum[e];
            cosine[e] += step * z * sum[e];
        }
    }
}

// A whole lobe has the integral 2 pi / (e + 1).
static void fill_parts(relume_prefiltered_maps *p)
{
    for (int i = 0; i < STEPS; i++) {
        double even[EXPONENTS], cosine[EXPONENTS];
        parts_of_lobes(2.0 * i / (STEPS - 1) - 1.0, p->rim, even, cosine);
        for (int e = 0; e < EXPONENTS; e++) {
            const double scale = (exponent_of(e) + 1.0) / M_PI;
            p->part[e * STEPS + i] = (float)(scale * even[e]);
            p->part[(EXPONENTS + e) * STEPS + i] = (float)(scale * cosine[e]);
        }
    }
}

// ---------------------------------------------------------------- making one

static relume_status check(const struct relume_light *light,
                           const struct relume_prefiltered_maps_params *p)
{
    if (light->kind != RELUME_LIGHT_ENVIRONMENT)
        return log_fail(p->log, RELUME_EINVAL,
                        "prefiltered maps: expected an environment; found '%s'",
                        relume_light_kind_name(light->kind));
    if (p->height && (p->height < 4 || p->height > 512))
        return log_fail(p->log, RELUME_EINVAL,
                        "prefiltered maps: expected a height of 4 to 512; found %d", p->height);
    if (!(p->rim >= 0.0 && p->rim <= 1.0))
        return log_fail(p->log, RELUME_EINVAL,
                        "prefiltered maps: expected a rim of 0 to 1; found %g", p->rim);
    return relume_light_check(light, "environment", p->log);
}

relume_status prefiltered_from_cells(relume_prefiltered_maps **out,
                                     const struct relume_environment_cell *cell, int cells,
                                     int height, double rim, int threads)
{
    *out = NULL;
    relume_prefiltered_maps *p = mem_zeroed(1, sizeof *p);
    if (!p)
        return RELUME_ENOMEM;
    p->height = height;
    p->width = 2 * p->height;
    p->rim = rim;
    p->cells = cells;
    const size_t plane = 3 * (size_t)p->width * (size_t)p->height;
    p->diffuse = mem_zeroed(plane, sizeof *p->diffuse);
    p->specular = mem_zeroed(EXPONENTS * plane, sizeof *p->specular);
    p->part = mem_zeroed((size_t)2 * EXPONENTS * STEPS, sizeof *p->part);
    p->cell = mem_copy(cell, (size_t)cells, sizeof *cell);
    p->info = (struct relume_prefiltered_maps_info){p->width, p->height, p->diffuse, p->specular,
                                                    p->part};
    relume_status status =
        p->diffuse && p->specular && p->part && p->cell ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        fill_parts(p);
        status = filter(p, threads);
    }
    if (status)
        relume_prefiltered_maps_destroy(&p);
    *out = p;
    return status;
}

relume_status relume_prefiltered_maps_create(relume_prefiltered_maps **out,
                                             const struct relume_light *light,
                                             const struct relume_prefiltered_maps_params *params)
{
    const struct relume_prefiltered_maps_params p =
        PARAMS_WORK(relume_prefiltered_maps_params, params);
    *out = NULL;
    relume_status status = check(light, &p);
    if (status)
        return status;
    struct relume_environment_cell *cell =
        mem_zeroed((size_t)CELL_COLUMNS * CELL_ROWS, sizeof *cell);
    status = cell ? prefiltered_from_cells(out, cell, gather(cell, light),
                                           p.height ? p.height : USUAL_HEIGHT, p.rim, p.threads)
                  : RELUME_ENOMEM;
    mem_free(cell);
    return status;
}

void relume_prefiltered_maps_destroy(relume_prefiltered_maps **prefiltered)
{
    relume_prefiltered_maps *p = *prefiltered;
    *prefiltered = NULL;
    if (!p)
        return;
    mem_free(p->diffuse);
    mem_free(p->specular);
    mem_free(p->part);
    mem_free(p->cell);
    mem_free(p);
}

const struct relume_prefiltered_maps_info *relume_prefiltered_maps_info(
    const relume_prefiltered_maps *p)
{
    return &p->info;
}

// ---------------------------------------------------------------- lookups

// Columns repeat, rows end at the poles.
static void add_map(const relume_prefiltered_maps *p, const float *map, const double at[2],
                    float weight, float rgb[3])
{
    const struct bilinear b = bilinear_at(at[0] * p->width - 0.5, at[1] * p->height - 0.5, p->width,
                                          p->height, EDGE_WRAPPED);
    for (int k = 0; k < 4; k++)
        for (size_t c = 0; c < 3; c++)
            rgb[c] += bilinear_sharef(&b, k, weight) * map[3 * b.at[k] + c];
}

// Between which exponents, and how far.
static int layer_of(double exponent, float *part)
{
    const double at = fmin(fmax(2.0 * log2(exponent), 0.0), EXPONENTS - 1);
    const int low = at < EXPONENTS - 1 ? (int)at : EXPONENTS - 2;
    *part = (float)(at - low);
    return low;
}

void relume_prefiltered_maps_diffuse(float rgb[3], const relume_prefiltered_maps *p,
                                     struct relume_vec3 normal)
{
    double at[2];
    place_of(normal, at);
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    add_map(p, p->diffuse, at, 1.0f, rgb);
}

void relume_prefiltered_maps_specular(float rgb[3], const relume_prefiltered_maps *p,
                                      struct relume_vec3 axis, double exponent)
{
    double at[2];
    float part;
    const int low = layer_of(exponent, &part);
    const size_t plane = 3 * (size_t)p->width * (size_t)p->height;
    const float *map = p->specular + (size_t)low * plane;
    place_of(axis, at);
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    add_map(p, map, at, 1.0f - part, rgb);
    add_map(p, map + plane, at, part, rgb);
}

static float part_at(const relume_prefiltered_maps *p, double cosine, double exponent,
                     bool with_cosine)
{
    float part;
    const int low = layer_of(exponent, &part);
    const double at = fmin(fmax(0.5 * (cosine + 1.0), 0.0), 1.0) * (STEPS - 1);
    const int step = at < STEPS - 1 ? (int)at : STEPS - 2;
    const float along = (float)(at - step);
    const float *row = p->part + ((with_cosine ? EXPONENTS : 0) + low) * STEPS + step;
    const float a = row[0] + along * (row[1] - row[0]);
    const float b = row[STEPS] + along * (row[STEPS + 1] - row[STEPS]);
    return a + part * (b - a);
}

void relume_prefiltered_maps_lobe(float rgb[3], const relume_prefiltered_maps *p,
                                  struct relume_vec3 normal, struct relume_vec3 axis,
                                  double exponent, bool cosine)
{
    relume_prefiltered_maps_specular(rgb, p, axis, exponent);
    const float scale =
        (float)(2.0 / (exponent + 1.0)) * part_at(p, vec3_dot(normal, axis), exponent, cosine);
    for (int c = 0; c < 3; c++)
        rgb[c] *= scale;
}
