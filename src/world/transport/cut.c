// cut.c - the cut through a tree of points, drawn into a picture of a few hundred pixels (Ritschel,
// Engelhardt, Grosch, Seidel, Kautz, Dachsbacher 2009, "Micro-rendering for scalable, parallel
// final gathering")
//
// From the root on a node is replaced by its children until its ball takes no more than a pixel's
// solid angle. In the paper such a node fills the pixel that its middle lies in, so that all things
// are wider by half a pixel on each side. Here a pixel adds up the solid angles of what lies in it,
// shared with its neighbours (bilinear), and what objects cover is right on average.
#include "world/transport/cut.h"

#include "core/math/bilinear.h"
#include "world/transport/warp.h"

#include <math.h>

// ---------------------------------------------------------------- nodes

// Children of a node as a place sees them; lengths over the disc.
struct seen {
    float u[HIERARCHY_WAYS], v[HIERARCHY_WAYS];
    float depth[HIERARCHY_WAYS];
    float sine[HIERARCHY_WAYS];    // of the angle that the ball spreads to each side
    float spread[HIERARCHY_WAYS];  // of the ball, at most
    float wide[HIERARCHY_WAYS];    // of the surfaces, from both sides
    float back[HIERARCHY_WAYS];    // how much more of it is backs than fronts
    bool up[HIERARCHY_WAYS];       // the middle lies above the place's surface
    bool hidden[HIERARCHY_WAYS];   // all of it lies below, or there is nothing
    bool turned[HIERARCHY_WAYS];   // all of it shows its back
};

static void look(struct seen *s, const struct group *g, const struct cut_place *place)
{
    const float(*f)[3] = place->frame;
    for (int k = 0; k < HIERARCHY_WAYS; k++) {
        const float x = g->x[k] - place->at[0], y = g->y[k] - place->at[1],
                    z = g->z[k] - place->at[2], radius = g->radius[k];
        const float square = x * x + y * y + z * z + 1e-30f, depth = sqrtf(square);
        const float once = 1.0f / depth, sine = radius * once;
        const float height = (x * f[2][0] + y * f[2][1] + z * f[2][2]);
        const float facing = x * g->facing[0][k] + y * g->facing[1][k] + z * g->facing[2][k];
        const float up = height * once, above = up > 0.0f ? up : 0.0f;
        const float most = up + sine < 1.0f ? up + sine : 1.0f;
        const float size = once * once * above;
        s->u[k] = (x * f[0][0] + y * f[0][1] + z * f[0][2]) * once;
        s->v[k] = (x * f[1][0] + y * f[1][1] + z * f[1][2]) * once;
        s->depth[k] = depth;
        s->sine[k] = sine;
        s->spread[k] = (float)M_PI * sine * sine * most;
        s->wide[k] = (fabsf(facing) * once + g->turned[k]) * size;
        s->back[k] = facing * once * size;
        s->up[k] = up > 0.0f;
        s->hidden[k] = height <= -radius || radius < 0.0f;
        s->turned[k] = facing > g->cone[k] * depth + g->edge[k];
    }
}

// ---------------------------------------------------------------- cells

// What is nearer by a fifth hides the rest.
static const float NEARER = 0.8f;

static inline void add_light(struct cut_light *restrict to, const struct cut_light *restrict light,
                             float weight)
{
    const float *from = &light->covers;
    float *sum = &to->covers;
    for (int i = 0; i < 8; i++)
        sum[i] += weight * from[i];
}

static inline void put_scene(struct cut_cell *cell, const struct cut_light *light, float depth,
                             float weight)
{
    if (cell->near.covers > 0.0f && depth * NEARER > cell->depth) {
        add_light(&cell->far, light, weight);
        cell->far_depth = fmaxf(cell->far_depth, depth);
        return;
    }
    if (cell->near.covers > 0.0f && depth < cell->depth * NEARER) {
        add_light(&cell->far, &cell->near, 1.0f);
        cell->far_depth = fmaxf(cell->far_depth, cell->depth);
        cell->near = (struct cut_light){.covers = 0.0f};
    }
    cell->depth = cell->near.covers > 0.0f ? (cell->depth < depth ? cell->depth : depth) : depth;
    add_light(&cell->near, light, weight);
}

static inline void put_object(struct cut_cell *cell, const struct cut_light *light, float depth,
                              float weight)
{
    cell->covered += weight * light->covers;
    if (cell->object.covers > 0.0f && depth * NEARER > cell->object_depth)
        return;
    if (cell->object.covers > 0.0f && depth < cell->object_depth * NEARER)
        cell->object = (struct cut_light){.covers = 0.0f};
    cell->object_depth = cell->object.covers > 0.0f
                             ? (cell->object_depth < depth ? cell->object_depth : depth)
                             : depth;
    add_light(&cell->object, light, weight);
}

// The four pixels about a place.
static inline void square_parts(struct warp_parts *out, int side, float u, float v)
{
    const float half = 0.5f * (float)side;
    const float x = (u + 1.0f) * half + 0.5f, y = (v + 1.0f) * half + 0.5f;
    const int i = (int)x, j = (int)y;
    const float right = x - (float)i, down = y - (float)j;
    const int left = index_clamped(i - 1, side), next = index_clamped(i, side);
    const int top = index_clamped(j - 1, side) * side, bottom = index_clamped(j, side) * side;
    *out = (struct warp_parts){{top + left, top + next, bottom + left, bottom + next},
                               {(1.0f - right) * (1.0f - down), right * (1.0f - down),
                                (1.0f - right) * down, right * down}};
}

// Shared among the pixels about its place.
static inline void draw(struct cut_cell *cells, const struct cut_place *place,
                        const struct seen *seen, int k, const struct sent *sent, bool objects)
{
    const int side = place->view->side;
    const float pixels = place->warp ? 1.0f : 0.25f * (float)(side * side);
    const float covers =
        (objects ? 0.5f * (seen->wide[k] - seen->back[k]) : seen->wide[k]) * pixels;
    if (!(covers > 0.0f))
        return;
    struct cut_light light = {.covers = covers};
    for (int c = 0; c < 3; c++) {
        light.without[c] = covers * sent->without[c];
        light.with[c] = covers * sent->with[c];
    }
    struct warp_parts to;
    if (place->warp)
        warp_parts(&to, place->warp, seen->u[k], seen->v[k]);
    else
        square_parts(&to, side, seen->u[k], seen->v[k]);
    for (int n = 0; n < 4; n++)
        if (!(to.weight[n] > 0.0f))
            continue;
        else if (objects)
            put_object(&cells[to.pixel[n]], &light, seen->depth[k], to.weight[n]);
        else
            put_scene(&cells[to.pixel[n]], &light, seen->depth[k], to.weight[n]);
}

// A leaf as a disc, in the frame of the place.
struct disc {
    float middle[3], normal[3], radius;
};

static struct disc disc_of(const struct group *g, int k, const struct cut_place *place)
{
    const float at[] = {g->x[k] - place->at[0], g->y[k] - place->at[1], g->z[k] - place->at[2]};
    const float facing[] = {g->facing[0][k], g->facing[1][k], g->facing[2][k]};
    const float size = sqrtf(facing[0] * facing[0] + facing[1] * facing[1] + facing[2] * facing[2]);
    struct disc d = {.radius = g->radius[k]};
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++) {
            d.middle[i] += at[c] * place->frame[i][c];
            d.normal[i] += facing[c] * place->frame[i][c] / fmaxf(size, 1e-30f);
        }
    return d;
}

static bool is_met(const struct disc *d, const float direction[3])
{
    const float *n = d->normal, *m = d->middle;
    const float along = n[0] * direction[0] + n[1] * direction[1] + n[2] * direction[2];
    const float away = n[0] * m[0] + n[1] * m[1] + n[2] * m[2];
    const float distance = away / (along != 0.0f ? along : 1e-30f);
    float square = 0.0f;
    for (int c = 0; c < 3; c++)
        square += (distance * direction[c] - m[c]) * (distance * direction[c] - m[c]);
    return distance > 0.0f && square <= d->radius * d->radius;
}

static inline void mark_one(struct cut_cell *cell, const struct cut_pixel *pixel,
                            const struct disc *disc, bool objects)
{
    if (!is_met(disc, pixel->direction))
        return;
    if (objects)
        cell->object_close = true;
    else
        cell->close = true;
}

static void mark_warped(struct cut_cell *cells, const struct warp *warp, float u, float v,
                        float reach, const struct disc *disc, bool objects)
{
    const int side = warp->view.side;
    int columns[2], rows[2];
    warp_columns(columns, warp, u, reach);
    for (int x = columns[0]; x <= columns[1]; x++) {
        warp_rows(rows, warp, x, v, reach);
        for (int y = rows[0]; y <= rows[1]; y++)
            mark_one(&cells[y * side + x], &warp->view.pixel[y * side + x], disc, objects);
    }
}

// All pixels whose middle it covers.
static void mark(struct cut_cell *cells, const struct cut_place *place, const struct seen *seen,
                 int k, const struct disc *disc, bool objects)
{
    const struct cut_view *view = place->view;
    const int side = view->side;
    const float half = 0.5f * (float)side, sine = fminf(seen->sine[k], 1.0f);
    // the chord, by which places on the disc are apart at most
    const float chord = sine < 1.0f ? sqrtf(2.0f - 2.0f * sqrtf(1.0f - sine * sine)) : 2.0f;
    if (place->warp) {
        mark_warped(cells, place->warp, seen->u[k], seen->v[k], chord, disc, objects);
        return;
    }
    const float u = (seen->u[k] + 1.0f) * half, v = (seen->v[k] + 1.0f) * half, r = chord * half;
    const int left = index_clamped((int)(u - r), side), right = index_clamped((int)(u + r), side);
    const int top = index_clamped((int)(v - r), side), bottom = index_clamped((int)(v + r), side);
    for (int y = top; y <= bottom; y++)
        for (int x = left; x <= right; x++)
            mark_one(&cells[y * side + x], &view->pixel[y * side + x], disc, objects);
}

// ---------------------------------------------------------------- the cut

// Whether a leaf is the place's own surface, or so low that it hides next to nothing: its disc does
// not rise over that by half of its radius.
static bool is_low(const struct disc *d)
{
    const float LOW = 0.5f, tilt = sqrtf(fmaxf(1.0f - d->normal[2] * d->normal[2], 0.0f));
    return d->middle[2] + d->radius * tilt < LOW * d->radius;
}

// The area of the pixel that the middle of a node lies in.
static inline float pixel_at(const struct cut_place *place, const struct seen *seen, int k)
{
    const float LEAST = 1e-6f;
    if (!place->warp)
        return 4.0f / (float)(place->view->side * place->view->side);
    return fmaxf(warp_area(place->warp, seen->u[k], seen->v[k]), LEAST);
}

// Down to nodes of `part` of a pixel.
static inline void cut(struct cut_cell *cells, struct cut_list *close, const struct hierarchy *h,
                       const struct cut_place *place, float part, bool objects)
{
    const float LISTED = 2.0f;
    struct {
        int level;
        uint32_t group;  // of its level
    } stack[HIERARCHY_LEVELS * HIERARCHY_WAYS] = {{0, 0}};
    for (int n = h->levels ? 1 : 0; n > 0;) {
        const int level = stack[--n].level;
        const uint32_t group = stack[n].group;
        const size_t at = h->first[level] + group;
        struct seen seen;
        look(&seen, &h->groups[at], place);
        for (int k = 0; k < HIERARCHY_WAYS; k++) {
            const size_t node = HIERARCHY_WAYS * at + (size_t)k;
            if (seen.hidden[k] || (objects && seen.turned[k]))
                continue;
            const float pixel = pixel_at(place, &seen, k);
            const bool large = seen.spread[k] > part * pixel || seen.sine[k] >= 1.0f;
            if (large && level + 1 < h->levels) {
                stack[n].level = level + 1;
                stack[n++].group = HIERARCHY_WAYS * group + (uint32_t)k;
            } else if (large && seen.wide[k] > LISTED * pixel && close->count < CUT_LISTED) {
                const struct disc disc = disc_of(&h->groups[at], k, place);
                if (is_low(&disc))
                    continue;
                close->node[close->count++] = (uint32_t)node;
                mark(cells, place, &seen, k, &disc, objects);
            } else if (seen.up[k]) {
                draw(cells, place, &seen, k, &h->sent[node], objects);
            }
        }
    }
}

void cut_scene(struct cut_cell *cells, struct cut_list *close, const struct hierarchy *h,
               const struct cut_place *place)
{
    cut(cells, close, h, place, 4.0f, false);
}

// Of objects the border counts.
void cut_objects(struct cut_cell *cells, struct cut_list *close, const struct hierarchy *h,
                 const struct cut_place *place)
{
    cut(cells, close, h, place, 0.25f, true);
}

float cut_nearest(uint32_t *node, const struct cut_list *close, const struct hierarchy *h, vec3 at,
                  vec3 towards)
{
    float least = INFINITY;
    const float x = (float)at.x, y = (float)at.y, z = (float)at.z;
    for (int i = 0; i < close->count; i++) {
        const struct group *g = &h->groups[close->node[i] / HIERARCHY_WAYS];
        const size_t k = close->node[i] % HIERARCHY_WAYS;
        const float dx = g->x[k] - x, dy = g->y[k] - y, dz = g->z[k] - z;
        const float square = dx * dx + dy * dy + dz * dz;
        const vec3 facing =
            vec3_of((double)g->facing[0][k], (double)g->facing[1][k], (double)g->facing[2][k]);
        if (square >= least || vec3_dot(facing, towards) > 0.0)
            continue;
        least = square;
        *node = close->node[i];
    }
    return sqrtf(least);
}
