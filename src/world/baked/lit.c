// lit.c - baked objects under lights: every mean and component becomes a map of colours over the
// views, and a texel the sum of those of its cluster (Meseth 2008, 10.1.3)
#include "world/baked/baked.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "relight/light/environment.h"

#include <math.h>

struct baked_lit {
    float (*colour)[3];  // [vectors]
};

// ---------------------------------------------------------------- views

// Towards the eye a surface is never seen from below, but where normals are interpolated its frame
// may say so; these take the lowest view.
static const double LOWEST = 1e-3;

void view_place(double place[2], int side, vec3 v)
{
    const double z = fmax(v.z, LOWEST), across = sqrt(v.x * v.x + v.y * v.y);
    // what is lower goes to the rim at its azimuth
    const double scale = v.z < LOWEST && across > 0.0 ? 1.0 / across : 1.0;
    const double x = fmin(fmax(v.x * scale / (1.0 + z), -1.0), 1.0);
    const double y = fmin(fmax(v.y * scale / (1.0 + z), -1.0), 1.0);
    place[0] = (x + 1.0) * 0.5 * (side - 1);
    place[1] = (y + 1.0) * 0.5 * (side - 1);
}

vec3 view_direction(int side, int number)
{
    if (side == 1)
        return vec3_of(0, 0, 1);
    double s = 2.0 * (number % side) / (side - 1) - 1.0,
           t = 2.0 * (number / side) / (side - 1) - 1.0;
    const double square = s * s + t * t, most = (1.0 - LOWEST) / (1.0 + LOWEST);
    if (square > most) {
        s *= sqrt(most / square);
        t *= sqrt(most / square);
    }
    const double q = s * s + t * t;
    return vec3_unit(vec3_of(2.0 * s / (1.0 + q), 2.0 * t / (1.0 + q), (1.0 - q) / (1.0 + q)));
}

// ---------------------------------------------------------------- lights

static void add_light(float *weights, const relume_baked *b, const struct frame *stands,
                      const struct relume_light *light)
{
    int n;
    if (light->kind == RELUME_LIGHT_DIRECTIONAL)
        basis_add(weights, &b->basis, frame_turned_back(stands, light->direction), light->rgb);
    if (light->kind != RELUME_LIGHT_ENVIRONMENT)
        return;
    const struct relume_environment_cell *cell = relume_environment_cells(&n, light->environment);
    for (int i = 0; i < n; i++) {
        const vec3 d = relume_environment_turn(cell[i].direction, light->rotate_deg);
        const float rgb[3] = {cell[i].rgb[0] * light->rgb[0], cell[i].rgb[1] * light->rgb[1],
                              cell[i].rgb[2] * light->rgb[2]};
        basis_add(weights, &b->basis, frame_turned_back(stands, d), rgb);
    }
}

// One vector under weights.
static void vector_colour(float rgb[3], const relume_baked *b, size_t vector, const float *weights)
{
    const size_t kept = (size_t)b->kept, n = (size_t)b->basis.count;
    const float *value = b->value + 3 * vector * kept;
    const uint16_t *place = b->place ? b->place + vector * kept : NULL;
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (size_t k = 0; k < kept; k++)
        for (size_t c = 0; c < 3; c++)
            rgb[c] += value[3 * k + c] * weights[c * n + (place ? place[k] : k)];
}

enum { CHUNK = 256 };

struct lighting_up {
    const relume_baked *b;
    const float *weights;
    float (*colour)[3];
};

static void light_chunk(void *context, size_t item, int worker)
{
    (void)worker;
    const struct lighting_up *l = context;
    const size_t end = (item + 1) * CHUNK;
    for (size_t i = item * CHUNK; i < end && i < l->b->vectors; i++)
        vector_colour(l->colour[i], l->b, i, l->weights);
}

relume_status lit_create(baked_lit **out, const relume_baked *b, const struct frame *stands,
                         const struct relume_light *lights, int n, int threads)
{
    baked_lit *lit = mem_zeroed(1, sizeof *lit);
    float *weights = mem_zeroed(3 * (size_t)b->basis.count, sizeof *weights);
    *out = lit;
    if (lit)
        lit->colour = mem_array(b->vectors, sizeof *lit->colour);
    if (!lit || !weights || !lit->colour) {
        mem_free(weights);
        lit_destroy(out);
        return RELUME_ENOMEM;
    }
    for (int i = 0; i < 3 && b->info.fixed; i++)
        weights[i] = 1.0f;
    for (int i = 0; i < n && !b->info.fixed; i++)
        add_light(weights, b, stands, &lights[i]);
    basis_finish(weights, &b->basis);
    thread_for(threads, (b->vectors + CHUNK - 1) / CHUNK, light_chunk,
               &(struct lighting_up){b, weights, lit->colour});
    mem_free(weights);
    return RELUME_OK;
}

void lit_destroy(baked_lit **lit)
{
    if (*lit)
        mem_free((*lit)->colour);
    mem_free(*lit);
    *lit = NULL;
}

float (*lit_take(baked_lit **lit))[3]
{
    float(*colour)[3] = (*lit)->colour;
    (*lit)->colour = NULL;
    lit_destroy(lit);
    return colour;
}

// ---------------------------------------------------------------- looking

// What vectors show, under light that they have been seen in, or under weights.
struct shown {
    const relume_baked *b;
    const baked_lit *lit;
    const float *weights;
};

static void add_vector(float rgb[3], const struct shown *s, size_t vector, double factor)
{
    float own[3];
    const float *colour = own;
    if (s->lit)
        colour = s->lit->colour[vector];
    else
        vector_colour(own, s->b, vector, s->weights);
    for (int c = 0; c < 3; c++)
        rgb[c] += (float)factor * colour[c];
}

// A texel in one view of the map.
static void add_view(float rgb[3], const struct shown *s, size_t texel, int view, double factor)
{
    const relume_baked *b = s->b;
    const size_t texels = (size_t)b->info.width * (size_t)b->info.height;
    const int block = b->blocks > 1 ? view : 0;
    const size_t own = (size_t)block * texels + texel, n = (size_t)b->info.components;
    const size_t first =
        baked_vector(b, block, b->cluster[own]) + (size_t)(b->blocks > 1 ? 0 : view);
    add_vector(rgb, s, first, factor);
    for (size_t i = 0; i < n; i++)
        add_vector(rgb, s, first + (i + 1) * (size_t)b->views,
                   factor * (double)b->weight[own * n + i]);
}

static vec3 view_of(const relume_baked *b, size_t texel, vec3 eye)
{
    const vec3 normal = vec3_floats(b->frame[texel]), tangent = vec3_floats(b->frame[texel] + 3);
    return vec3_of(vec3_dot(eye, tangent), vec3_dot(eye, vec3_cross(normal, tangent)),
                   vec3_dot(eye, normal));
}

static void add_texel(float rgb[3], const struct shown *s, size_t texel, vec3 eye, double factor)
{
    const int side = s->b->info.side;
    if (side == 1) {
        add_view(rgb, s, texel, 0, factor);
        return;
    }
    double at[2];
    view_place(at, side, view_of(s->b, texel, eye));
    const int left = (int)fmin(floor(at[0]), side - 2), top = (int)fmin(floor(at[1]), side - 2);
    const double x = at[0] - left, y = at[1] - top;
    for (int k = 0; k < 4; k++) {
        const double share = (k % 2 ? x : 1.0 - x) * (k / 2 ? y : 1.0 - y);
        if (share > 0.0)
            add_view(rgb, s, texel, (top + k / 2) * side + left + k % 2, factor * share);
    }
}

// The four texels around the place, those of them that hold something.
static void look_up(float rgb[3], const struct shown *s, const struct baked_look *look)
{
    const struct relume_baked_info *info = &s->b->info;
    const double x = fmin(fmax(look->place[0] * info->width - 0.5, 0.0), info->width - 1.0);
    const double y = fmin(fmax(look->place[1] * info->height - 0.5, 0.0), info->height - 1.0);
    const int left = (int)floor(x), top = (int)floor(y);
    double sum = 0.0;
    float all[3] = {0.0f, 0.0f, 0.0f};
    for (int k = 0; k < 4; k++) {
        const double share =
            (k % 2 ? x - left : 1.0 - (x - left)) * (k / 2 ? y - top : 1.0 - (y - top));
        const size_t texel = (size_t)(top + k / 2) * (size_t)info->width + (size_t)(left + k % 2);
        if (!(share > 0.0) || s->b->cluster[texel] == BAKED_NONE)
            continue;
        add_texel(all, s, texel, look->view, share);
        sum += share;
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = sum > 0.0 ? fmaxf(all[c] / (float)sum, 0.0f) : 0.0f;
}

void lit_colour(float rgb[3], const relume_baked *b, const baked_lit *lit,
                const struct baked_look *look)
{
    look_up(rgb, &(struct shown){b, lit, NULL}, look);
}

void baked_lamp(float rgb[3], const relume_baked *b, const struct baked_look *look, vec3 direction,
                const float light[3])
{
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (b->info.fixed)
        return;
    float *weights = mem_zeroed(3 * (size_t)b->basis.count, sizeof *weights);
    if (!weights)
        return;
    basis_add(weights, &b->basis, direction, light);
    basis_finish(weights, &b->basis);
    look_up(rgb, &(struct shown){b, NULL, weights}, look);
    mem_free(weights);
}
