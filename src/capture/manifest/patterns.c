// patterns.c - spreading light directions over the sphere (Wong 1998, 8.1.4), and how evenly
//
// Every pattern fills the unit square (phi / 2 pi, t) with t the height along the pole: Archimedes'
// cylinder map keeps areas, so what is even in the square is even on the sphere.
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/random.h"
#include "core/math/vec.h"

#include <relume/image/directions.h>
#include <string.h>

static double radical_inverse_2(uint32_t k)
{
    double inverse = 0.0;
    for (double digit = 0.5; k; k >>= 1, digit *= 0.5)
        inverse += (k & 1) * digit;
    return inverse;
}

// The pattern's rows: about square cells at the equator, never more rows than points.
static int rows_for(int n, bool hemisphere)
{
    const int rows = (int)lround(sqrt(hemisphere ? n / 4.0 : n / 2.0));
    return rows < 1 ? 1 : rows;
}

// Points before row i when n points are shared out over the rows as evenly as can be.
static int before_row(int i, int rows, int n)
{
    return (int)((int64_t)i * n / rows);
}

static relume_status fill_grid(double (*out)[2], int n, uint64_t seed, bool hemisphere)
{
    (void)seed;
    const int rows = rows_for(n, hemisphere);
    for (int i = 0; i < rows; i++) {
        const int first = before_row(i, rows, n), count = before_row(i + 1, rows, n) - first;
        const double theta_rad = M_PI * (i + 0.5) / rows * (hemisphere ? 0.5 : 1.0);
        for (int j = 0; j < count; j++) {
            out[first + j][0] = (double)j / count;
            out[first + j][1] = hemisphere ? cos(theta_rad) : 0.5 + 0.5 * cos(theta_rad);
        }
    }
    return RELUME_OK;
}

static relume_status fill_random(double (*out)[2], int n, uint64_t seed, bool hemisphere)
{
    (void)hemisphere;
    struct random random = random_stream(seed, 1, 0);
    for (int k = 0; k < n; k++) {
        out[k][0] = random_next(&random);
        out[k][1] = random_next(&random);
    }
    return RELUME_OK;
}

static relume_status fill_jittered(double (*out)[2], int n, uint64_t seed, bool hemisphere)
{
    struct random random = random_stream(seed, 2, 0);
    const int rows = rows_for(n, hemisphere);
    for (int i = 0; i < rows; i++) {
        const int first = before_row(i, rows, n), count = before_row(i + 1, rows, n) - first;
        for (int j = 0; j < count; j++) {
            // A row is as high as its share of the points: all cells have one area.
            out[first + j][0] = (j + random_next(&random)) / count;
            out[first + j][1] = (first + count * random_next(&random)) / n;
        }
    }
    return RELUME_OK;
}

static vec3 on_sphere(const double square[2], bool hemisphere)
{
    const double z = hemisphere ? square[1] : 2.0 * square[1] - 1.0;
    const double r = sqrt(fmax(0.0, 1.0 - z * z)), phi_rad = 2.0 * M_PI * square[0];
    return vec3_of(r * cos(phi_rad), r * sin(phi_rad), z);
}

// Best candidates (Mitchell 1991): of several random points keep the one farthest from all so far.
static relume_status fill_poisson(double (*out)[2], int n, uint64_t seed, bool hemisphere)
{
    vec3 *kept = mem_array((size_t)n, sizeof *kept);
    if (!kept)
        return RELUME_ENOMEM;
    // The work is candidates * n^2 / 2: fewer candidates for sets of thousands.
    const double affordable = 2e9 / ((double)n * n);
    const int candidates = affordable < 4.0 ? 4 : affordable < 100.0 ? (int)affordable : 100;
    struct random random = random_stream(seed, 3, 0);
    for (int k = 0; k < n; k++) {
        double best = 2.0;
        for (int c = 0; c < candidates; c++) {
            const double u = random_next(&random);
            const double square[2] = {u, random_next(&random)};
            const vec3 point = on_sphere(square, hemisphere);
            double near = -1.0;
            for (int i = 0; i < k; i++)
                near = fmax(near, vec3_dot(point, kept[i]));
            if (near < best) {
                best = near;
                kept[k] = point;
                memcpy(out[k], square, sizeof square);
            }
        }
    }
    mem_free(kept);
    return RELUME_OK;
}

// Phi_2 steps through multiples of 2^-bits; on the hemisphere half a step keeps off the horizon.
static relume_status fill_hammersley(double (*out)[2], int n, uint64_t seed, bool hemisphere)
{
    (void)seed;
    double step = 1.0;
    while (step * n > 1.0)
        step *= 0.5;
    for (int k = 0; k < n; k++) {
        out[k][0] = (double)k / n;
        out[k][1] = radical_inverse_2((uint32_t)k) + (hemisphere ? 0.5 * step : 0.0);
    }
    return RELUME_OK;
}

// Golden-angle spiral (Vogel 1979; Swinbank and Purser 2006).
static relume_status fill_spiral(double (*out)[2], int n, uint64_t seed, bool hemisphere)
{
    (void)seed, (void)hemisphere;
    const double golden = 0.5 * (sqrt(5.0) - 1.0);
    for (int k = 0; k < n; k++) {
        out[k][0] = fmod(k * golden, 1.0);
        out[k][1] = (k + 0.5) / n;
    }
    return RELUME_OK;
}

static const struct relume_pattern
    hammersley = {"hammersley", "low discrepancy: radical inverses (the default)", fill_hammersley},
    grid = {"grid", "rows of equal zenith angle; crowded at the poles", fill_grid},
    random_pattern = {"random", "independent random points", fill_random},
    jittered = {"jittered", "one random point in each cell of equal area", fill_jittered},
    poisson = {"poisson", "random points that keep their distance", fill_poisson},
    spiral = {"spiral", "a golden-angle spiral", fill_spiral};

const struct relume_pattern *const relume_patterns[] = {
    &hammersley, &grid, &random_pattern, &jittered, &poisson, &spiral, NULL,
};

const struct relume_pattern *relume_pattern_find(const char *name)
{
    for (const struct relume_pattern *const *p = relume_patterns; *p; p++)
        if (!strcmp((*p)->name, name))
            return *p;
    return NULL;
}

relume_status relume_directions_make(struct relume_vec3 *out, int n,
                                     const struct relume_pattern *pattern,
                                     const struct relume_directions_params *params)
{
    const struct relume_directions_params p = PARAMS(relume_directions_params, params);
    if (n < 1)
        return RELUME_EINVAL;
    double(*square)[2] = mem_array((size_t)n, sizeof *square);
    if (!square)
        return RELUME_ENOMEM;
    const relume_status status = pattern->fill(square, n, p.seed, p.hemisphere);
    for (int k = 0; k < n && !status; k++) {
        // No light lies in the horizon's plane itself, whatever a random number says.
        if (p.hemisphere)
            square[k][1] = fmax(square[k][1], 1e-9);
        out[k] = world_from_pole(on_sphere(square[k], p.hemisphere), p.pole_y);
    }
    mem_free(square);
    return status;
}
