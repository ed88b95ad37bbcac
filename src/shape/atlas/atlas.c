// atlas.c - which texel holds which place
#include "shape/atlas/atlas.h"

#include "core/base/memory.h"
#include "core/math/vec.h"
#include "shape/atlas/charts.h"

#include <math.h>
#include <string.h>

// Texels beside a triangle that hold some of it: lookups between texels reach one.
static const double REACH = 1.5;

struct corners {
    double x[3], y[3];  // texels, their middles at whole numbers
};

static struct corners corners_of(const struct atlas_corner t[3], int width, int height)
{
    struct corners c;
    for (int k = 0; k < 3; k++) {
        c.x[k] = (double)t[k].place[0] * width - 0.5;
        c.y[k] = (double)t[k].place[1] * height - 0.5;
    }
    return c;
}

static double least(const double v[3])
{
    return fmin(v[0], fmin(v[1], v[2]));
}

static double most(const double v[3])
{
    return fmax(v[0], fmax(v[1], v[2]));
}

static int column_from(double low, double reach)
{
    return (int)fmax(ceil(low - reach), 0.0);
}

static int column_to(double high, double reach, int n)
{
    return (int)fmin(floor(high + reach), n - 1.0);
}

// The nearest place of the side from corner i to j: how far along it, and the square of the
// distance.
static double along_side(double *square, const struct corners *c, int i, int j, double x, double y)
{
    const double ex = c->x[j] - c->x[i], ey = c->y[j] - c->y[i];
    const double length = ex * ex + ey * ey;
    const double t = length > 0.0 ? ((x - c->x[i]) * ex + (y - c->y[i]) * ey) / length : 0.0;
    const double at = fmin(fmax(t, 0.0), 1.0);
    const double dx = c->x[i] + at * ex - x, dy = c->y[i] + at * ey - y;
    *square = dx * dx + dy * dy;
    return at;
}

// The nearest place of a triangle to a texel; returns the square of the distance, 0 within.
static double nearest(double weight[3], const struct corners *c, double x, double y)
{
    const double area =
        (c->x[1] - c->x[0]) * (c->y[2] - c->y[0]) - (c->x[2] - c->x[0]) * (c->y[1] - c->y[0]);
    double best = INFINITY;
    for (int k = 0; k < 3 && area != 0.0; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        weight[k] = ((c->x[i] - x) * (c->y[j] - y) - (c->x[j] - x) * (c->y[i] - y)) / area;
    }
    if (area != 0.0 && least(weight) >= 0.0)
        return 0.0;
    for (int k = 0; k < 3; k++) {
        double square;
        const int j = (k + 1) % 3;
        const double t = along_side(&square, c, k, j, x, y);
        if (!(square < best))
            continue;
        best = square;
        weight[k] = 1.0 - t;
        weight[j] = t;
        weight[(k + 2) % 3] = 0.0;
    }
    return best;
}

// ---------------------------------------------------------------- whether triangles overlap

// Triangles with a texel's middle well within them that another one has too; true: there are some.
static bool find_doubles(bool *twice, struct atlas_corner (*triangle)[3], size_t n, uint32_t *owner,
                         int width, int height)
{
    const double WELL = 1e-3;
    bool any = false;
    memset(owner, 0xff, (size_t)width * (size_t)height * sizeof *owner);
    for (size_t i = 0; i < n; i++) {
        const struct corners c = corners_of(triangle[i], width, height);
        for (int y = column_from(least(c.y), 0.0); y <= column_to(most(c.y), 0.0, height); y++)
            for (int x = column_from(least(c.x), 0.0); x <= column_to(most(c.x), 0.0, width); x++) {
                double weight[3];
                uint32_t *o = &owner[(size_t)y * (size_t)width + (size_t)x];
                if (nearest(weight, &c, x, y) > 0.0 || least(weight) < WELL)
                    continue;
                if (*o != UINT32_MAX)
                    twice[i] = any = true;
                else
                    *o = (uint32_t)i;
            }
    }
    return any;
}

// Within the picture, and of some extent.
static bool lies_within(struct atlas_corner (*triangle)[3], size_t n)
{
    double area = 0.0;
    for (size_t i = 0; i < n; i++) {
        const struct corners c = corners_of(triangle[i], 1, 1);
        if (!(least(c.x) >= -0.5 && most(c.x) <= 0.5 && least(c.y) >= -0.5 && most(c.y) <= 0.5))
            return false;
        area += 0.5 *
                fabs((c.x[1] - c.x[0]) * (c.y[2] - c.y[0]) - (c.x[2] - c.x[0]) * (c.y[1] - c.y[0]));
    }
    return area > 0.05;
}

// ---------------------------------------------------------------- texels

static void fill(struct atlas *a, struct atlas_corner (*triangle)[3], size_t n, float *square)
{
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height; i++) {
        a->texel[i] = (struct atlas_texel){.triangle = UINT32_MAX};
        square[i] = (float)(REACH * REACH);
    }
    for (size_t i = 0; i < n; i++) {
        const struct corners c = corners_of(triangle[i], a->width, a->height);
        const int last = column_to(most(c.y), REACH, a->height);
        const int end = column_to(most(c.x), REACH, a->width);
        for (int y = column_from(least(c.y), REACH); y <= last; y++)
            for (int x = column_from(least(c.x), REACH); x <= end; x++) {
                double weight[3];
                const size_t at = (size_t)y * (size_t)a->width + (size_t)x;
                const double d = nearest(weight, &c, x, y);
                if (!(d < (double)square[at]))
                    continue;
                a->used += a->texel[at].triangle == UINT32_MAX;
                square[at] = (float)d;
                a->texel[at] =
                    (struct atlas_texel){(uint32_t)i, (float)weight[1], (float)weight[2]};
            }
    }
}

// The area of so many texels, where half of the picture holds the surface.
static double area_of(struct atlas_corner (*triangle)[3], size_t n, const struct atlas *a,
                      double texels)
{
    double area = 0.0;
    for (size_t i = 0; i < n; i++) {
        vec3 p[3];
        for (int k = 0; k < 3; k++)
            p[k] = vec3_floats(triangle[i][k].position);
        area += 0.5 * vec3_length(vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0])));
    }
    return area * texels / (0.5 * a->width * a->height);
}

// Charts that fold over themselves lose the triangles on top, which become charts.
static relume_status make_places(struct atlas *a, struct atlas_corner (*triangle)[3], size_t n,
                                 bool *alone, uint32_t *owner, double small_texels,
                                 const struct relume_log *log)
{
    enum { ROUNDS = 4 };
    const double small = area_of(triangle, n, a, small_texels);
    relume_status status = RELUME_OK;
    memset(alone, 0, n * sizeof *alone);
    for (int i = 0; i < ROUNDS && !status; i++) {
        struct charts charts;
        status = charts_make(&charts, triangle, n, alone, small);
        if (!status)
            status = charts_place(&charts, triangle, n, a->width, a->height, log);
        a->charts = (int)charts.count;
        charts_free(&charts);
        if (!status && !find_doubles(alone, triangle, n, owner, a->width, a->height))
            break;
    }
    return status;
}

relume_status atlas_make(struct atlas *out, struct atlas_corner (*triangle)[3], size_t n, int width,
                         int height, double small, const struct relume_log *log)
{
    const size_t texels = (size_t)width * (size_t)height;
    *out = (struct atlas){.width = width, .height = height};
    out->texel = mem_array(texels, sizeof *out->texel);
    uint32_t *owner = mem_array(texels, sizeof *owner);
    float *square = mem_array(texels, sizeof *square);
    bool *alone = mem_zeroed(n, sizeof *alone);
    relume_status status = out->texel && owner && square && alone ? RELUME_OK : RELUME_ENOMEM;
    if (!status &&
        (!lies_within(triangle, n) || find_doubles(alone, triangle, n, owner, width, height)))
        status = make_places(out, triangle, n, alone, owner, small, log);
    if (!status)
        fill(out, triangle, n, square);
    mem_free(owner);
    mem_free(square);
    mem_free(alone);
    if (status)
        atlas_free(out);
    return status;
}

void atlas_free(struct atlas *atlas)
{
    mem_free(atlas->texel);
    atlas->texel = NULL;
}
