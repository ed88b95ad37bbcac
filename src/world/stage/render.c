// render.c - the stage itself: places are found once per tile, then lit by every light
//
// Within a tile the loop runs over lights outside and places inside. The shadow rays of one light
// are parallel; places are put in Morton order (Morton 1966) first, so that rays of one packet also
// start close together, even from places that indirect light has found all over the scene.
#include "world/stage/render.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "image/geometry/geometry.h"

#include <string.h>

enum { TILE = 16, TILE_PIXELS = TILE * TILE, BATCH = 64 };

// Where a place stands along the Morton curve.
struct key {
    uint64_t morton;
    uint32_t index;
};

// What one worker reuses from tile to tile.
struct scratch {
    struct places places;
    struct key *keys;  // [key_capacity]
    size_t key_capacity;
    float sum[TILE_PIXELS][3];
};

struct render {
    const struct render_job *job;
    struct relume_image *out;
    struct scratch *scratch;  // [threads]
    int tiles_across;
    size_t first_tile;
};

struct tile {
    int x, y, width, height;
};

static struct tile tile_of(const struct render *r, size_t index)
{
    const struct camera *c = &r->job->camera;
    const int x = (int)(index % (size_t)r->tiles_across) * TILE;
    const int y = (int)(index / (size_t)r->tiles_across) * TILE;
    return (struct tile){x, y, c->width - x < TILE ? c->width - x : TILE,
                         c->height - y < TILE ? c->height - y : TILE};
}

static double radical_inverse(int base, int k)
{
    double inverse = 0.0;
    for (double digit = 1.0 / base; k; k /= base, digit /= base)
        inverse += (k % base) * digit;
    return inverse;
}

static double wrapped(double x)
{
    return x - floor(x);
}

// Rounding to float must not reach 1.
static float unit_float(double x)
{
    return fminf((float)wrapped(x), 0x1.fffffep-1f);
}

// A Hammersley set per pixel and first bounce, shifted around by a random amount of the pixel's own
// (Cranley and Patterson 1976): stratified for every number of samples.
static void walk_pixel(const struct render_job *job, struct places *places, int x, int y,
                       uint32_t pixel)
{
    const uint64_t number = (uint64_t)y << 32 | (uint64_t)x;
    struct random shift = random_stream(job->seed, number, UINT64_MAX);
    double by[4];
    for (int d = 0; d < 4; d++)
        by[d] = random_next(&shift);
    for (int i = 0; i < job->samples; i++) {
        const double sx = wrapped((double)i / job->samples + by[0]);
        const double sy = wrapped(radical_inverse(2, i) + by[1]);
        struct walk walk = {
            .scene = job->scene,
            .bounces = job->bounces,
            .random = random_stream(job->seed, number, (uint64_t)i),
            .first_bounce = {unit_float(radical_inverse(3, i) + by[2]),
                             unit_float(radical_inverse(5, i) + by[3])},
            .places = places,
            .pixel = pixel,
        };
        walk_from_eye(&walk, camera_ray_at(&job->camera, x + sx, y + sy));
    }
}

static bool is_shown(const struct render_job *job, int x, int y)
{
    const struct camera *c = &job->camera;
    return relume_geometry_shows(&c->geometry, c->width, c->height, x, y);
}

// Every third bit of the result is one of the low 21 bits of x.
static uint64_t spread_bits(uint64_t x)
{
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffffu;
    x = (x | x << 16) & 0x1f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

static uint64_t morton(const float p[3], const struct bounds *b)
{
    const double low[3] = {b->min.x, b->min.y, b->min.z}, high[3] = {b->max.x, b->max.y, b->max.z};
    uint64_t code = 0;
    for (int c = 0; c < 3; c++) {
        const double t = (p[c] - low[c]) / fmax(high[c] - low[c], 1e-30);
        code |= spread_bits((uint64_t)(fmin(fmax(t, 0.0), 1.0) * 0x1fffff)) << c;
    }
    return code;
}

static int by_key(const void *a, const void *b)
{
    const struct key *x = a, *y = b;
    if (x->morton != y->morton)
        return x->morton < y->morton ? -1 : 1;
    return x->index < y->index ? -1 : x->index > y->index;
}

// Order `places` into s->keys; false when memory runs out.
static bool sort_places(struct scratch *s, const struct bounds *bounds)
{
    const size_t n = s->places.count;
    if (n > s->key_capacity) {
        mem_free(s->keys);
        s->keys = mem_array(2 * n, sizeof *s->keys);
        s->key_capacity = s->keys ? 2 * n : 0;
        if (!s->keys)
            return false;
    }
    for (size_t i = 0; i < n; i++)
        s->keys[i] = (struct key){morton(s->places.at[i].origin, bounds), (uint32_t)i};
    if (n)
        qsort(s->keys, n, sizeof *s->keys, by_key);
    return true;
}

// Lit places that wait for their shadow rays.
struct batch {
    int count;
    float origin[BATCH][3];
    float value[BATCH][3];
    uint32_t pixel[BATCH];
};

static void flush(struct batch *b, const tracer *rays, const float light[3], bool near,
                  float (*sum)[3])
{
    bool seen[BATCH];
    if (near)
        trace_seen(rays, b->origin, b->count, light, seen);
    else
        trace_unblocked(rays, b->origin, b->count, light, seen);
    for (int i = 0; i < b->count; i++)
        for (int c = 0; seen[i] && c < 3; c++)
            sum[b->pixel[i]][c] += b->value[i][c];
    b->count = 0;
}

// Its direction from `place`, and how much stronger it is there than at the world's origin.
static float towards(const float lamp[3], const float place[3], float out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = lamp[c] - place[c];
    const float squared = fmaxf(dot3(out, out), 1e-12f), inverse = 1.0f / sqrtf(squared);
    for (int c = 0; c < 3; c++)
        out[c] *= inverse;
    return dot3(lamp, lamp) / squared;
}

static void light_tile(const tracer *rays, struct scratch *s, const float light[3], bool near)
{
    struct batch b = {.count = 0};
    memset(s->sum, 0, sizeof s->sum);
    for (size_t i = 0; i < s->places.count; i++) {
        const struct place *p = &s->places.at[s->keys[i].index];
        float value[3], wi[3] = {light[0], light[1], light[2]};
        const float strength = near ? towards(light, p->origin, wi) : 1.0f;
        if (!surface_lit(&p->surface, wi, value))
            continue;
        for (int c = 0; c < 3; c++) {
            b.value[b.count][c] = value[c] * strength * p->weight[c];
            b.origin[b.count][c] = p->origin[c];
        }
        b.pixel[b.count] = p->pixel;
        if (++b.count == BATCH)
            flush(&b, rays, light, near, s->sum);
    }
    flush(&b, rays, light, near, s->sum);
}

static void store_tile(const struct tile *t, float (*sum)[3], float scale, struct relume_image *out)
{
    for (int y = 0; y < t->height; y++) {
        const size_t first = (size_t)(t->y + y) * (size_t)out->width + (size_t)t->x;
        float *row = out->data + first * 3;
        for (int x = 0; x < t->width; x++)
            for (int c = 0; c < 3; c++)
                row[3 * x + c] = sum[y * TILE + x][c] * scale;
    }
}

static void render_tile(void *context, size_t item, int worker)
{
    const struct render *r = context;
    const struct render_job *job = r->job;
    struct scratch *s = &r->scratch[worker];
    const struct tile t = tile_of(r, r->first_tile + item);
    s->places.count = 0;
    for (int y = 0; y < t.height; y++)
        for (int x = 0; x < t.width; x++)
            if (is_shown(job, t.x + x, t.y + y))
                walk_pixel(job, &s->places, t.x + x, t.y + y, (uint32_t)(y * TILE + x));
    s->places.failed |= !sort_places(s, &job->scene->bounds);
    for (int l = 0; l < job->light_count && !s->places.failed; l++) {
        const vec3 d = job->lights[l];
        const float light[3] = {(float)d.x, (float)d.y, (float)d.z};
        light_tile(job->scene->tracer, s, light, job->near);
        store_tile(&t, s->sum, 1.0f / (float)job->samples, &r->out[l]);
    }
}

static bool any_failed(const struct scratch *scratch, int threads)
{
    for (int i = 0; i < threads; i++)
        if (scratch[i].places.failed)
            return true;
    return false;
}

relume_status render_lights(const struct render_job *job, struct relume_image *out,
                            render_progress *progress, void *user)
{
    const int threads = thread_count(job->threads);
    struct render r = {
        .job = job,
        .out = out,
        .scratch = mem_zeroed((size_t)threads, sizeof *r.scratch),
        .tiles_across = (job->camera.width + TILE - 1) / TILE,
    };
    if (!r.scratch)
        return RELUME_ENOMEM;
    const size_t tiles = (size_t)r.tiles_across * (size_t)((job->camera.height + TILE - 1) / TILE);
    // In groups, so that this thread can report progress and be cancelled.
    const size_t group = (size_t)threads * 8;
    relume_status status = RELUME_OK;
    for (size_t done = 0; done < tiles && !status; done += group) {
        r.first_tile = done;
        thread_for(threads, tiles - done < group ? tiles - done : group, render_tile, &r);
        if (any_failed(r.scratch, threads))
            status = RELUME_ENOMEM;
        else if (!progress(user, fmin((double)(done + group) / (double)tiles, 1.0)))
            status = RELUME_ECANCEL;
    }
    for (int i = 0; i < threads; i++) {
        places_destroy(&r.scratch[i].places);
        mem_free(r.scratch[i].keys);
    }
    mem_free(r.scratch);
    return status;
}

struct depth {
    const struct render_job *job;
    struct relume_image *out;
};

static void depth_row(void *context, size_t item, int worker)
{
    (void)worker;
    const struct depth *d = context;
    float *row = d->out->data + item * (size_t)d->out->width;
    for (int x = 0; x < d->out->width; x++) {
        const struct camera_ray ray = camera_ray_at(&d->job->camera, x + 0.5, (double)item + 0.5);
        const float origin[3] = {(float)ray.origin.x, (float)ray.origin.y, (float)ray.origin.z};
        const float direction[3] = {(float)ray.direction.x, (float)ray.direction.y,
                                    (float)ray.direction.z};
        struct trace_hit hit;
        row[x] = is_shown(d->job, x, (int)item) &&
                         trace_closest(d->job->scene->tracer, origin, direction, &hit)
                     ? hit.distance
                     : INFINITY;
    }
}

void render_depth(const struct render_job *job, struct relume_image *out)
{
    struct depth d = {job, out};
    thread_for(job->threads, (size_t)out->height, depth_row, &d);
}
