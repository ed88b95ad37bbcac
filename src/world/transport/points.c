// points.c - surfaces as points
//
// Point i lies at the i-th number of van der Corput's sequence in the running sum of the triangles'
// areas, and within its triangle at Halton's (1960) next two.
#include "world/transport/points.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/distribution.h"
#include "core/math/random.h"

// The digits of i in a base, mirrored at the point.
static double mirrored(size_t i, size_t base)
{
    double sum = 0.0, digit = 1.0 / (double)base;
    for (; i; i /= base, digit /= (double)base)
        sum += digit * (double)(i % base);
    return sum;
}

static void put(struct point *p, const struct mesh *mesh, const struct distribution *areas,
                size_t i)
{
    vec3 corner[3];
    size_t triangle = 0;
    (void)distribution_draw(&triangle, areas, mirrored(i, 2));
    mesh_corners(corner, mesh, triangle);
    const double r = sqrt(mirrored(i + 1, 3)), s = mirrored(i + 1, 5);  // (Turk 1990)
    const double u = r * (1.0 - s), v = r * s;
    p->place = vec3_add(vec3_scale(corner[0], 1.0 - u - v),
                        vec3_add(vec3_scale(corner[1], u), vec3_scale(corner[2], v)));
    p->normal = vec3_unit(mesh_twice_area(corner));
    p->triangle = (uint32_t)triangle;
    p->u = (float)u, p->v = (float)v;
}

static relume_status spread(struct points *out, const struct mesh *mesh, size_t count)
{
    struct distribution areas = {0};
    double *area = mem_array(mesh->triangle_count, sizeof *area), all = 0.0;
    *out = (struct points){0};
    if (!area)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        vec3 corner[3];
        mesh_corners(corner, mesh, i);
        const double twice = vec3_length(mesh_twice_area(corner));
        area[i] = isfinite(twice) ? 0.5 * twice : 0.0;
        all += area[i];
    }
    distribution_make(&areas, area, mesh->triangle_count);
    if (all > 0.0 && count > 0)
        out->at = mem_zeroed(count, sizeof *out->at);
    relume_status status = all > 0.0 && count > 0 && !out->at ? RELUME_ENOMEM : RELUME_OK;
    out->count = out->at ? count : 0;
    for (size_t i = 0; i < out->count; i++) {
        put(&out->at[i], mesh, &areas, i);
        out->at[i].area = all / (double)count;
    }
    distribution_free(&areas);
    return status;
}

void points_forget(struct points *p)
{
    mem_free(p->at);
    *p = (struct points){0};
}

// ---------------------------------------------------------------- the side that light gets to

static bool leaves(const tracer *objects, const struct point *p, vec3 normal, vec3 direction)
{
    float at[3], off[3], from[3], along[3];
    struct trace_hit hit;
    vec3_store(at, p->place);
    vec3_store(off, normal);
    vec3_store(along, direction);
    trace_leave(at, off, from);
    return !trace_closest(objects, from, along, &hit);
}

// Whether one of some rays around a normal leaves the objects: number 0 goes straight away.
static bool is_open(const tracer *objects, const struct point *p, vec3 normal, uint64_t key,
                    int first, int end)
{
    if (!first && leaves(objects, p, normal, normal))
        return true;
    for (int i = first > 1 ? first : 1; i < end; i++) {
        struct random r = random_stream(3, key, 2 * (uint64_t)i + (normal.z < 0.0));
        const double z = random_range(&r, -1.0, 1.0), turn = random_range(&r, 0.0, 2.0 * M_PI);
        const double across = sqrt(1.0 - z * z);
        const vec3 ball = vec3_of(across * cos(turn), across * sin(turn), z);  // about its end
        const vec3 direction = vec3_add(normal, vec3_scale(ball, 0.99));
        if (leaves(objects, p, normal, vec3_unit(direction)))
            return true;
    }
    return false;
}

enum { AT_ONCE = 256 };
// Rays for each side; where some point is open on both sides the objects are no closed bodies, and
// more are looked for: of a box without a lid few rays find the way out.
enum { FEW = 6, MANY = 40 };

struct sides {
    struct points *points;
    const tracer *objects;
    int first, end;  // rays
};

static void find_sides(void *context, size_t item, int worker)
{
    (void)worker;
    const struct sides *s = context;
    for (size_t i = item * AT_ONCE; i < (item + 1) * AT_ONCE && i < s->points->count; i++) {
        struct point *p = &s->points->at[i];
        const vec3 back = vec3_scale(p->normal, -1.0);
        if (p->both)
            continue;
        // what has been found open before is on the side of the normal
        const bool known = s->first && p->open;
        const bool before = known || is_open(s->objects, p, p->normal, i, s->first, s->end);
        const bool behind = is_open(s->objects, p, back, i, s->first, s->end);
        p->open = before || behind;
        p->both = before && behind;
        p->normal = behind && !before ? back : p->normal;
    }
}

static void find_all_sides(struct points *p, const tracer *objects, int threads)
{
    struct sides sides = {p, objects, 0, FEW};
    bool is_sheet = false;
    thread_for(threads, (p->count + AT_ONCE - 1) / AT_ONCE, find_sides, &sides);
    for (size_t i = 0; i < p->count; i++)
        is_sheet |= p->at[i].both;
    sides.first = FEW, sides.end = MANY;
    if (is_sheet)
        thread_for(threads, (p->count + AT_ONCE - 1) / AT_ONCE, find_sides, &sides);
}

// Those that are there.
static void leave_out_holes(struct points *p, const tracer *objects)
{
    size_t kept = 0;
    for (size_t i = 0; i < p->count; i++) {
        float direction[3];
        vec3_store(direction, p->at[i].normal);
        if (!trace_lets_through(objects, p->at[i].triangle, p->at[i].u, p->at[i].v, direction))
            p->at[kept++] = p->at[i];
    }
    p->count = kept;
}

relume_status points_of_objects(struct points *out, const struct mesh *mesh, const tracer *objects,
                                size_t count, int threads)
{
    const relume_status status = spread(out, mesh, count);
    if (!status) {
        leave_out_holes(out, objects);
        find_all_sides(out, objects, threads);
    }
    return status;
}

relume_status points_of_scene(struct points *out, const struct scenery *c, size_t count)
{
    const vec3 eye = scenery_eye(c);
    const relume_status status = spread(out, scenery_mesh(c), count);
    for (size_t i = 0; i < out->count; i++) {
        struct point *p = &out->at[i];
        if (vec3_dot(p->normal, vec3_sub(eye, p->place)) < 0.0)
            p->normal = vec3_scale(p->normal, -1.0);
    }
    return status;
}

// ---------------------------------------------------------------- light

void points_scene_sent(float rgb[3], const struct scenery *c, const struct point *p)
{
    scenery_sent(rgb, c, p->triangle, p->u, p->v);
}

void points_object_sent(float rgb[3], const struct world *w, const struct point *p, uint64_t key,
                        const struct arrival *arrivals, int n)
{
    const struct trace_hit hit = {p->triangle, p->u, p->v, 1.0f, 0};
    w->sent(rgb, w->context, &hit, vec3_add(p->place, p->normal), vec3_scale(p->normal, -1.0), key,
            arrivals, n);
}

// ---------------------------------------------------------------- of what shines

// Of the disc of directions before a point.
struct disc {
    vec3 x, y;  // unit
};

static struct disc disc_of(const struct point *p)
{
    const vec3 any = fabs(p->normal.x) < 0.7 ? vec3_of(1, 0, 0) : vec3_of(0, 1, 0);
    const vec3 x = vec3_unit(vec3_cross(any, p->normal));
    return (struct disc){x, vec3_cross(p->normal, x)};
}

vec3 points_direction(const struct point *p, double u, double v)
{
    const struct disc disc = disc_of(p);
    const double off = sqrt(u), turn = 2.0 * M_PI * v;
    return vec3_along(vec3_along(vec3_scale(disc.x, off * cos(turn)), disc.y, off * sin(turn)),
                      p->normal, sqrt(1.0 - u));
}

enum { SIDE = 4, MERGED = SIDE * SIDE };

static int within(double x)
{
    const int i = (int)(0.5 * SIDE * (x + 1.0));
    return i < 0 ? 0 : i < SIDE ? i : SIDE - 1;
}

// What arrives from one square of the disc becomes one arrival: so that asking the surface for some
// directions does not take a thousand answers.
static int merge(struct arrival out[MERGED], const struct point *p, const struct arrival *arrivals,
                 int n)
{
    const struct disc disc = disc_of(p);
    double sum[MERGED][3] = {{0.0}};
    vec3 towards[MERGED] = {{0.0, 0.0, 0.0}};
    int count = 0;
    for (int i = 0; i < n; i++) {
        const struct arrival *a = &arrivals[i];
        const int k =
            within(vec3_dot(a->towards, disc.y)) * SIDE + within(vec3_dot(a->towards, disc.x));
        for (int c = 0; c < 3; c++)
            sum[k][c] += a->share * (double)a->with[c];
        towards[k] = vec3_along(towards[k], a->towards,
                                a->share * (double)(a->with[0] + a->with[1] + a->with[2]));
    }
    for (int k = 0; k < MERGED; k++) {
        if (!(vec3_length(towards[k]) > 0.0))
            continue;
        out[count] = (struct arrival){.towards = vec3_unit(towards[k]), .share = 1.0};
        for (int c = 0; c < 3; c++)
            out[count].with[c] = (float)sum[k][c];
        count++;
    }
    return count;
}

void points_object_mean(float rgb[3], const struct world *w, const struct point *p, uint64_t key,
                        const struct arrival *arrivals, int n)
{
    enum { DIRECTIONS = 32 };
    const double GOLDEN = 0.6180339887498949;
    const struct trace_hit hit = {p->triangle, p->u, p->v, 1.0f, 0};
    struct random r = random_stream(7, key, 0);
    struct arrival merged[MERGED];
    const int count = merge(merged, p, arrivals, n);
    const double first = random_next(&r);
    double sum[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < DIRECTIONS; i++) {
        const vec3 d =
            points_direction(p, (i + random_next(&r)) / DIRECTIONS, first + GOLDEN * (double)i);
        float sent[3];
        w->sent(sent, w->context, &hit, vec3_add(p->place, d), vec3_scale(d, -1.0), key, merged,
                count);
        for (int c = 0; c < 3; c++)
            sum[c] += isfinite(sent[c]) ? fmax((double)sent[c], 0.0) : 0.0;
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(sum[c] / DIRECTIONS);
}
