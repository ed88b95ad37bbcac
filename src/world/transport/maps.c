// maps.c - imperfect shadow maps
//
// Each map draws a run of the points as squares of the area that a point stands for, seen from its
// place. Few points leave holes. Levels of half the size are made of the nearest depths that belong
// together; where two of four do, they are a surface ("pull"). Where three do, the fourth becomes
// it if it is empty or, at the finest level, shows something behind ("push"). So outlines stay
// where they are; the paper fills wherever one texel is known.
#include "world/transport/maps.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/random.h"

// ---------------------------------------------------------------- how a map looks

static struct map_look look_along(enum map_kind kind, vec3 place, vec3 z, double width)
{
    const vec3 any = fabs(z.x) < 0.7 ? vec3_of(1, 0, 0) : vec3_of(0, 1, 0);
    const vec3 x = vec3_unit(vec3_cross(any, z));
    return (struct map_look){kind, place, x, vec3_cross(z, x), z, width};
}

struct map_look map_of_hemisphere(vec3 place, vec3 normal)
{
    return look_along(MAP_HEMISPHERE, place, normal, 1.0);
}

struct map_look map_of_ball(vec3 place, vec3 normal, vec3 middle, double radius)
{
    const double NEAR = 1.25;  // radii: from there a ball takes up 106 degrees
    const vec3 to = vec3_sub(middle, place);
    const double away = vec3_length(to);
    if (!(away > NEAR * radius))
        return map_of_hemisphere(place, normal);
    return look_along(MAP_CONE, place, vec3_scale(to, 1.0 / away),
                      radius / sqrt(away * away - radius * radius));
}

struct map_look map_of_far(vec3 towards, vec3 middle, double radius)
{
    return look_along(MAP_FAR, middle, vec3_scale(towards, -1.0), radius);
}

// Where a place lies in a map: -1 to 1 along both sides; its depth, and how much of a side one unit
// of length across the way there takes up.
struct in_map {
    double x, y, depth, scale;
};

static bool find(struct in_map *out, const struct map_look *l, vec3 place)
{
    const double LOWEST = 0.02;  // cosine to the horizon: what lies in one plane with the map
    const vec3 to = vec3_sub(place, l->place);
    const double x = vec3_dot(to, l->x), y = vec3_dot(to, l->y), z = vec3_dot(to, l->z);
    if (l->kind == MAP_FAR) {
        const double across = sqrt(x * x + y * y), s = 1.0 / (across + l->width);
        *out = (struct in_map){s * x, s * y, z, s * sqrt(s * l->width)};
        return true;
    }
    const double distance = vec3_length(to);
    if (l->kind == MAP_NONE || !(z > LOWEST * distance))
        return false;
    const double s = l->kind == MAP_CONE ? 1.0 / (z * l->width) : 1.0 / (distance + z);
    *out = (struct in_map){s * x, s * y, distance, s};
    return fabs(out->x) < 1.0 && fabs(out->y) < 1.0;
}

static vec3 way_to(const struct map_look *l, vec3 place)
{
    return l->kind == MAP_FAR ? l->z : vec3_unit(vec3_sub(place, l->place));
}

// ---------------------------------------------------------------- points

// The texels whose middles lie in a square, at least the one that holds its middle.
static void find_texels(int *first, int *end, double middle, double side, int size)
{
    const double most = size / 4.0, half = 0.5 * (side < most ? side : most);
    const int at = (int)middle;
    *first = (int)ceil(middle - half - 0.5), *end = (int)ceil(middle + half - 0.5);
    if (*first >= *end)
        *first = at, *end = at + 1;
    *first = *first < 0 ? 0 : *first;
    *end = *end > size ? size : *end;
}

static const double LEAST = 0.2;  // cosine: of a surface that is seen from its edge
static const double SHEET = 1.6;  // wider, where there is no other side that covers holes

// `chance` in [0, 1) thins out points that are denser than texels: each texel that one falls into
// is covered, and where all along an outline are, it grows by half a texel. Where 1.4 of them fall
// into one, half of an outline's texels are.
static void splat(float *depth, int size, const struct map_look *l, const struct point *p,
                  double area, double chance)
{
    const double IN_TEXEL = 1.4;
    struct in_map at;
    int left, right, top, bottom;
    if (!find(&at, l, p->place))
        return;
    const double facing = fmax(fabs(vec3_dot(p->normal, way_to(l, p->place))), LEAST);
    const double wider = p->both ? SHEET : 1.0;
    const double side = wider * 0.5 * size * at.scale * sqrt(area * facing);
    if (chance > IN_TEXEL * side * side)
        return;
    find_texels(&left, &right, 0.5 * size * (at.x + 1.0), side, size);
    find_texels(&top, &bottom, 0.5 * size * (at.y + 1.0), side, size);
    const float value = (float)at.depth;
    for (int y = top; y < bottom; y++)
        for (int x = left; x < right; x++) {
            float *texel = depth + (size_t)y * (size_t)size + (size_t)x;
            *texel = value < *texel ? value : *texel;
        }
}

// ---------------------------------------------------------------- holes

// The nearest two or more of four depths that belong together: their mean; where there are none, it
// is infinite.
static struct map_level together(const float depth[4], float apart)
{
    struct map_level best = {INFINITY, 0.0f, 0};
    for (int i = 0; i < 4; i++) {
        float sum = 0.0f, most = 0.0f;
        int n = 0;
        for (int k = 0; k < 4 && depth[i] < INFINITY; k++)
            if (depth[k] >= depth[i] && depth[k] - depth[i] <= apart) {
                sum += depth[k];
                most = fmaxf(most, depth[k] - depth[i]);
                n++;
            }
        if (n > 1 && sum / (float)n < best.depth)
            best = (struct map_level){sum / (float)n, most, n};
    }
    return best;
}

// What a level says of a texel below it. Of a straight outline half of the texels are known, which
// is not enough.
static float pushed(float depth, const struct map_level *over, float apart)
{
    const bool is_hole = !(depth < INFINITY);
    const bool is_behind = depth - over->depth > apart + 2.0f * over->spread;
    return over->members > 2 && (is_hole || is_behind) ? over->depth : depth;
}

static void pull(struct map_level *coarse, const float *fine, size_t size, float apart)
{
    for (size_t y = 0; y < size; y += 2)
        for (size_t x = 0; x < size; x += 2) {
            const float *at = fine + y * size + x;
            const float four[4] = {at[0], at[1], at[size], at[size + 1]};
            coarse[(y / 2) * (size / 2) + x / 2] = together(four, apart);
        }
}

static void push(float *fine, const struct map_level *coarse, size_t size, float apart)
{
    for (size_t y = 0; y < size; y++)
        for (size_t x = 0; x < size; x++)
            fine[y * size + x] =
                pushed(fine[y * size + x], &coarse[(y / 2) * (size / 2) + x / 2], apart);
}

void maps_fill(float *depth, int size, double apart, struct map_level *levels)
{
    const size_t n = (size_t)size, half = n / 2;
    struct map_level *first = levels, *second = levels + half * half;
    float *middle = (float *)(second + half * half / 4);
    const float near = (float)apart;
    pull(first, depth, n, near);
    for (size_t i = 0; i < half * half; i++)
        middle[i] = first[i].depth;
    pull(second, middle, half, 2.0f * near);
    push(middle, second, half, INFINITY);  // rounded surfaces look as if they had leaks there
    for (size_t i = 0; i < half * half; i++)
        if (middle[i] != first[i].depth)
            first[i] = (struct map_level){middle[i], 0.0f, 4};
    push(depth, first, n, near);
}

// ---------------------------------------------------------------- maps

// Surfaces are apart by more than a twentieth of what a map sees.
static double apart_in(const float *depth, size_t texels)
{
    const double PART = 0.05;
    float least = INFINITY, most = -INFINITY;
    for (size_t i = 0; i < texels; i++)
        if (depth[i] < INFINITY) {
            least = fminf(least, depth[i]);
            most = fmaxf(most, depth[i]);
        }
    return most > least ? PART * (double)(most - least) : 0.0;
}

struct drawing {
    struct maps *maps;
    const struct points *points;
    const struct maps_params *params;
    struct map_level *levels;  // of each worker
};

static void draw_map(void *context, size_t map, int worker)
{
    const struct drawing *d = context;
    const struct maps *m = d->maps;
    const struct points *p = d->points;
    const size_t texels = (size_t)m->size * (size_t)m->size;
    const size_t run = d->params->points < p->count ? d->params->points : p->count;
    const size_t first = p->count ? random_mix(map) % p->count : 0;
    float *depth = m->depth + map * texels;
    struct random r = random_stream(6, map, 0);
    for (size_t i = 0; i < texels; i++)
        depth[i] = INFINITY;
    if (m->look[map].kind == MAP_NONE)
        return;
    for (size_t i = 0; i < run; i++) {
        const struct point *point = &p->at[(first + i) % p->count];
        splat(depth, m->size, &m->look[map], point, point->area * (double)p->count / (double)run,
              random_next(&r));
    }
    if (!d->params->unfilled)
        maps_fill(depth, m->size, apart_in(depth, texels),
                  d->levels + (size_t)worker * (texels / 2));
}

relume_status maps_draw(struct maps *m, const struct points *points, const struct maps_params *p)
{
    const size_t texels = (size_t)m->size * (size_t)m->size;
    const size_t run = p->points < points->count ? p->points : points->count;
    struct drawing d = {m, points, p, NULL};
    d.levels = mem_array((size_t)thread_count(p->threads), texels / 2 * sizeof *d.levels);
    if (!d.levels)
        return RELUME_ENOMEM;
    m->square = run ? sqrt(points->at->area * (double)points->count / (double)run) : 0.0;
    thread_for(p->threads, m->count, draw_map, &d);
    mem_free(d.levels);
    return RELUME_OK;
}

// How far a surface may lie behind the depth that is drawn for it: as far as its plane goes back
// over half of the square that stands for a point of it, as wide as it is drawn. (Over a whole one,
// as wide as a point's piece is, light of grazing ways passed through walls beside a place: into a
// box without a lid, 10 % of what its walls hide.)
static double bias(const struct map_look *l, const struct in_map *at, vec3 place, vec3 normal,
                   int size, double square)
{
    const double STEEPEST = 0.05;
    const double texel = 2.0 / (size * at->scale);
    const double cosine = fmin(fabs(vec3_dot(normal, way_to(l, place))), 1.0);
    const double side = SHEET * square * sqrt(fmax(cosine, LEAST) * (1.0 - cosine * cosine));
    return fmax(texel, 0.5 * side) / fmax(cosine, STEEPEST);
}

bool maps_open(const struct maps *m, size_t map, vec3 place, vec3 normal)
{
    const struct map_look *l = &m->look[map];
    struct in_map at;
    if (!find(&at, l, place))
        return true;
    const size_t x = (size_t)(0.5 * m->size * (at.x + 1.0)),
                 y = (size_t)(0.5 * m->size * (at.y + 1.0));
    const size_t size = (size_t)m->size;
    const float depth =
        m->depth[(map * size + (y < size ? y : size - 1)) * size + (x < size ? x : size - 1)];
    return !(depth < INFINITY) ||
           at.depth <= (double)depth + bias(l, &at, place, normal, m->size, m->square);
}
