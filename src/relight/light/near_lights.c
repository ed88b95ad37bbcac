// near_lights.c - point, spot, slide, area and goniometric lights: every pixel sees them from a
// direction of its own (Wong 1998, 7.5.5)
//
// Pixels go in blocks, planes outside and pixels inside: each pixel's weights stand in a lane. In
// the linear domain the weights of many lights are added in a pixel before its coefficients are
// read, as those of distant lights are; in the display domain each light is decoded and made
// linear.
#include "relight/light/near_lights.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/vec.h"
#include "format/coder/coding.h"
#include "relight/light/environment.h"
#include "relight/light/grid.h"
#include "relight/light/refit.h"

#include <string.h>

// Lanes are fewer where there are many coefficients, so that weights stay in the cache.
enum { LANES = 64, LEAST_LANES = 4, MOST_FLOATS = 3 * RELUME_MOST_COEFFICIENTS * LEAST_LANES };

// ---------------------------------------------------------------- sources

static void cut(struct near_source *to, const struct relume_light *area, int side)
{
    struct relume_light_patch patches[RELUME_LIGHT_PATCHES_MOST * RELUME_LIGHT_PATCHES_MOST];
    relume_light_patches(patches, area, side);
    for (int i = 0; i < side * side; i++)
        to[i].patch = patches[i];
}

// Into how many patches along a side light `i` is cut; said when it lights nothing.
static int patches_of(const struct near_lights *near, const struct relume_light *lights, int i)
{
    const double distance = relume_area_distance(&lights[i], near->surface);
    if (isinf(distance))
        log_line(near->log, RELUME_WARNING,
                 "light %d shines away from all that is seen; exchange the two half edges of the "
                 "area to turn it round",
                 i + 1);
    return relume_light_patch_side(&lights[i], distance);
}

relume_status near_lights_create(struct near_lights *near, const struct relume_light *lights, int n)
{
    int *side = mem_zeroed((size_t)n, sizeof *side);
    size_t count = 0;
    for (int i = 0; side && i < n; i++) {
        if (lights[i].kind == RELUME_LIGHT_AREA)
            side[i] = patches_of(near, lights, i);
        else
            side[i] = relume_light_is_near(lights[i].kind);
        count += (size_t)side[i] * (size_t)side[i];
    }
    near->source = side && count <= INT32_MAX ? mem_zeroed(count, sizeof *near->source) : NULL;
    for (int i = 0; near->source && i < n; i++) {
        struct near_source *to = &near->source[near->count];
        if (lights[i].kind == RELUME_LIGHT_AREA)
            cut(to, &lights[i], side[i]);
        else if (side[i])
            to->light = &lights[i];
        near->count += side[i] * side[i];
    }
    mem_free(side);
    return near->source ? RELUME_OK : RELUME_ENOMEM;
}

void near_lights_destroy(struct near_lights *near)
{
    mem_free(near->source);
    *near = (struct near_lights){0};
}

static bool is_captured(const struct near_lights *near, vec3 towards)
{
    const struct relume_coder_info *info = relume_coder_info(near->codes->coder);
    return !info->hemispherical || pole_from_world(towards, info->pole_y).z >= 0.0;
}

// Areas are integrals: from below the horizon of a hemispherical capture they add nothing.
static bool reaches(vec3 *towards, float rgb[3], const struct near_lights *near,
                    const struct near_source *e, vec3 point)
{
    if (e->light)
        return relume_light_at(towards, rgb, e->light, point);
    return relume_light_patch_at(towards, rgb, &e->patch, point) && is_captured(near, *towards);
}

// Where the light is taken from, as with directional lights, and its share of what reaches a point.
static bool arrives(vec3 *from, float rgb[3], const struct near_lights *near,
                    const struct near_source *e, vec3 point)
{
    vec3 towards;
    if (!reaches(&towards, rgb, near, e, point))
        return false;
    const float share = (float)relume_coder_clamp(from, near->codes->coder, towards);
    for (int c = 0; c < 3; c++)
        rgb[c] *= share;
    return true;
}

// ---------------------------------------------------------------- blocks

// Pixels that are relit together; [n] means `lanes` floats.
struct block {
    size_t first;
    int n, lanes;
    bool lit;  // something arrives at one of them
    float rgb[3][LANES];
    float constant[3][LANES];
    float *weight;  // [3 or 1][coefficients][n]
    float *one;     // [3][coefficients] and three constants: of one pixel
};

static void put_lane(float *to, int lanes, const float *from, int n)
{
    for (int i = 0; i < n; i++)
        to[i * lanes] = from[i];
}

static void clear_lane(float *to, int lanes, int n)
{
    for (int i = 0; i < n; i++)
        to[i * lanes] = 0.0f;
}

static bool point_of(vec3 *point, const struct near_lights *near, size_t pixel)
{
    const float *p = near->surface->data + 3 * pixel;
    *point = vec3_of((double)p[0], (double)p[1], (double)p[2]);
    return isfinite(point->x) && isfinite(point->y) && isfinite(point->z);
}

// ---------------------------------------------------------------- coefficients

static void add_product(float *restrict sum, const float *restrict a, const float *restrict b,
                        int n)
{
    for (int i = 0; i < n; i++)
        sum[i] += a[i] * b[i];
}

static void multiply(float *restrict to, const float *restrict by, int n)
{
    for (int i = 0; i < n; i++)
        to[i] *= by[i];
}

static bool all_zero(const float *w, int n)
{
    int some = 0;
    for (int i = 0; i < n; i++)
        some |= w[i] != 0.0f;
    return !some;
}

// What the weights, `sets` of them, make of the coefficients: value[3][n]. Interpolation leaves
// most of them out.
static void decode(float value[3][LANES], const struct near_lights *near, struct block *b, int sets)
{
    const struct relume_codes *codes = near->codes;
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    const int k = info->coefficients;
    float plane[LANES];
    memcpy(value, b->constant, sizeof b->constant);
    for (int i = 0; i < k; i++) {
        const float *shared = b->weight + i * b->lanes;
        bool read = false;
        if (sets == 1 && all_zero(shared, b->n))
            continue;
        for (int c = 0; c < 3; c++) {
            const float *w = sets == 1 ? shared : shared + c * k * b->lanes;
            if (sets == 3 && all_zero(w, b->n))
                continue;
            if (!read || !info->joint)
                relume_codes_plane(codes, relume_coder_plane(info, i, c), b->first, (size_t)b->n,
                                   plane);
            read = true;
            add_product(value[c], w, plane, b->n);
        }
    }
    for (int c = 0; info->luminance && c < 3; c++) {
        relume_codes_plane(codes, k + c, b->first, (size_t)b->n, plane);
        multiply(value[c], plane, b->n);
    }
}

// ---------------------------------------------------------------- lights

// The basis at the direction towards one source, in every lane; what it sends stays apart.
static void weigh_one(const struct near_lights *near, struct block *b, const struct near_source *e)
{
    const struct relume_weight_grid_info *grid = relume_weight_grid_info(near->grid);
    const int used = grid->sets * grid->coefficients;
    float *at = b->one, rgb[3];
    vec3 point, towards;
    b->lit = false;
    memset(b->constant, 0, sizeof b->constant);
    for (int i = 0; i < b->n; i++) {
        const bool lit =
            point_of(&point, near, b->first + (size_t)i) && arrives(&towards, rgb, near, e, point);
        for (int c = 0; c < 3; c++)
            b->rgb[c][i] = lit ? rgb[c] : 0.0f;
        if (!lit) {
            clear_lane(b->weight + i, b->lanes, used);
            continue;
        }
        b->lit = true;
        grid_blend(at, near->grid, towards);
        put_lane(b->weight + i, b->lanes, at, used);
        for (int c = 0; grid->sets == 3 && c < 3; c++)
            b->constant[c][i] = at[used + c];
    }
}

static void add_each(const struct near_lights *near, struct block *b, float *out)
{
    const int sets = relume_weight_grid_info(near->grid)->sets;
    float value[3][LANES];
    for (int e = 0; e < near->count; e++) {
        weigh_one(near, b, &near->source[e]);
        if (!b->lit)
            continue;
        decode(value, near, b, sets);
        for (int i = 0; i < b->n; i++)
            for (int c = 0; c < 3; c++)
                out[3 * i + c] +=
                    b->rgb[c][i] *
                    (near->display ? curve_decode(near->display, value[c][i]) : value[c][i]);
    }
}

// All sources in one weight vector of every lane. False where none arrives.
static bool weigh_all(float *weights, float constant[3], const struct near_lights *near, vec3 point)
{
    const size_t used = 3 * (size_t)relume_coder_info(near->codes->coder)->coefficients;
    bool lit = false;
    float rgb[3];
    vec3 towards;
    memset(weights, 0, used * sizeof *weights);
    constant[0] = constant[1] = constant[2] = 0.0f;
    for (int e = 0; e < near->count; e++)
        if (arrives(&towards, rgb, near, &near->source[e], point)) {
            relume_weight_grid_add(weights, constant, near->grid, towards, rgb);
            lit = true;
        }
    return lit;
}

static void add_folded(const struct near_lights *near, struct block *b, float *out)
{
    const int used = 3 * relume_coder_info(near->codes->coder)->coefficients;
    float value[3][LANES], *weights = b->one, constant[3];
    vec3 point;
    b->lit = false;
    memset(b->constant, 0, sizeof b->constant);
    for (int i = 0; i < b->n; i++) {
        if (!point_of(&point, near, b->first + (size_t)i) ||
            !weigh_all(weights, constant, near, point)) {
            clear_lane(b->weight + i, b->lanes, used);
            continue;
        }
        b->lit = true;
        put_lane(b->weight + i, b->lanes, weights, used);
        for (int c = 0; c < 3; c++)
            b->constant[c][i] = constant[c];
    }
    if (!b->lit)
        return;
    decode(value, near, b, 3);
    for (int i = 0; i < b->n; i++)
        for (int c = 0; c < 3; c++)
            out[3 * i + c] += value[c][i];
}

static size_t weights_of(const struct near_lights *near)
{
    return 3 * (size_t)relume_coder_info(near->codes->coder)->coefficients;
}

static size_t lanes_for(const struct near_lights *near)
{
    const size_t lanes = MOST_FLOATS / weights_of(near);
    return lanes < LANES ? lanes : LANES;
}

size_t near_lights_scratch(const struct near_lights *near)
{
    return near->count ? (lanes_for(near) + 1) * weights_of(near) + 3 : 0;
}

void near_lights_add(const struct near_lights *near, size_t first, size_t n, float *out,
                     float *scratch)
{
    struct block b = {.lanes = (int)lanes_for(near), .weight = scratch};
    const bool fold = !near->display && near->count > 1;
    b.one = scratch + (size_t)b.lanes * weights_of(near);
    for (size_t done = 0; done < n; done += (size_t)b.n) {
        b.first = first + done;
        b.n = n - done < (size_t)b.lanes ? (int)(n - done) : b.lanes;
        (fold ? add_folded : add_each)(near, &b, out + 3 * done);
    }
}
