// translucent.c - bodies of scattering material: light enters at points all over them and leaves
// where it is seen (world/transport/glow.h)
//
// Light that enters is weighed by what the smooth surface lets in; what leaves spreads over
// directions as the surface lets it out, so that all that leaves is what the dipole says.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "world/object/drawn_objects.h"
#include "world/object/object.h"
#include "world/transport/glow.h"

#include <string.h>

// Points of a body; of all of them together; of each of very many. Where a body is small it has as
// many as are a mean free path apart.
enum { FEWEST = 1 << 12, MOST = 1 << 17, MOST_OF_ALL = 1 << 19, OF_MANY = 1 << 9 };
// Solid angles that pieces are seen under: towards the eye, and for light that is on its way.
static const double SEEN = 0.1, ON_THE_WAY = 0.5;
static const double USUAL_MM = 100.0;  // where nobody says how large a body is

struct body {
    int object, material;
    double outwards;  // -1: its normals point inwards
    struct spread spread;
    bool *thin;  // [points]: nothing of it is below the surface
    struct glow_tree tree;
};
struct bodies {
    struct body *body;
    int count;
    int *of_part;  // [parts]; -1: none
    int *shown;    // [parts]: the materials that they were made of
    int parts;
};

// ---------------------------------------------------------------- bodies

static const struct translucent *material_of(const relume_objects *o, int part)
{
    const struct translucent *t = &o->translucent[o->part[part].material];
    return t->name ? t : NULL;
}

static int body_like(const struct bodies *b, const relume_objects *o, int part)
{
    for (int i = 0; i < b->count; i++)
        if (b->body[i].object == o->part[part].object &&
            b->body[i].material == o->part[part].material)
            return i;
    return -1;
}

// Parts of one object in one material are a body.
static relume_status find_bodies(struct bodies *b, const relume_objects *o)
{
    b->parts = o->info.parts;
    b->of_part = mem_array((size_t)b->parts, sizeof *b->of_part);
    b->shown = mem_array((size_t)b->parts, sizeof *b->shown);
    if (!b->of_part || !b->shown)
        return RELUME_ENOMEM;
    for (int i = 0; i < b->parts; i++) {
        b->shown[i] = o->part[i].material;
        b->of_part[i] = -1;
        if (!material_of(o, i))
            continue;
        b->of_part[i] = body_like(b, o, i);
        if (b->of_part[i] >= 0)
            continue;
        if (!mem_grow(&b->body, (size_t)b->count, sizeof *b->body))
            return RELUME_ENOMEM;
        b->of_part[i] = b->count;
        b->body[b->count++] =
            (struct body){.object = o->part[i].object, .material = o->part[i].material};
    }
    return RELUME_OK;
}

struct shape {
    uint32_t *triangle;
    size_t count;
    double area, volume, longest;
};

static void measure(struct shape *s, const relume_objects *o)
{
    vec3 min = vec3_of(INFINITY, INFINITY, INFINITY), max = vec3_scale(min, -1.0);
    for (size_t i = 0; i < s->count; i++) {
        vec3 p[3];
        mesh_corners(p, &o->mesh, s->triangle[i]);
        for (int k = 0; k < 3; k++) {
            min = vec3_of(fmin(min.x, p[k].x), fmin(min.y, p[k].y), fmin(min.z, p[k].z));
            max = vec3_of(fmax(max.x, p[k].x), fmax(max.y, p[k].y), fmax(max.z, p[k].z));
        }
        const vec3 first =
            vertex_position(&o->mesh.vertices[o->mesh.triangles[s->triangle[0]].vertex[0]]);
        const vec3 twice = mesh_twice_area(p);
        s->area += 0.5 * vec3_length(twice);
        s->volume += vec3_dot(twice, vec3_sub(p[0], first)) / 6.0;
    }
    s->longest = fmax(fmax(max.x - min.x, max.y - min.y), max.z - min.z);
}

static relume_status find_shape(struct shape *s, const struct bodies *b, int number,
                                const relume_objects *o)
{
    size_t total = 0;
    *s = (struct shape){.count = 0};
    for (int i = 0; i < b->parts; i++)
        total += b->of_part[i] == number ? o->part[i].count : 0;
    s->triangle = mem_array(total, sizeof *s->triangle);
    if (!s->triangle)
        return RELUME_ENOMEM;
    for (int i = 0; i < b->parts; i++)
        for (size_t k = 0; k < o->part[i].count && b->of_part[i] == number; k++)
            s->triangle[s->count++] = (uint32_t)(o->part[i].first + k);
    measure(s, o);
    return RELUME_OK;
}

// The shortest of the colours' mean free paths, mm.
static double path_of(const struct scattering *m)
{
    double path = INFINITY;
    for (int c = 0; c < 3; c++)
        path = fmin(path, 1.0 / (double)(m->absorption[c] + m->reduced[c]));
    return path;
}

static size_t points_for(const struct shape *s, const struct scattering *m, double mm, int bodies)
{
    const double path = path_of(m) / mm;
    const double most = fmax(fmin(MOST, (double)MOST_OF_ALL / bodies), OF_MANY);
    return (size_t)fmin(fmax(s->area / (path * path), FEWEST), most);
}

// A point of the body with what shading wants to know, as seen from outside, or from within.
static struct surface_point point_at(const relume_objects *o, const struct body *b, size_t i,
                                     double side)
{
    const struct spread_point *p = &b->spread.point[i];
    const vec3 normal = vec3_of((double)p->normal[0], (double)p->normal[1], (double)p->normal[2]);
    const struct trace_hit hit = {.triangle = p->triangle, .u = p->u, .v = p->v};
    struct surface_point point;
    objects_point(&point, o, &hit, vec3_scale(normal, -side * b->outwards));
    return point;
}

// Whether a ray from the surface into the body leaves it again.
static bool is_thin(const relume_objects *o, const struct body *b, size_t i)
{
    const struct surface_point from = point_at(o, b, i, -1.0);  // its normal points inwards
    struct surface_point on;
    if (!objects_hit(&on, o, point_leave(&from), from.geometric) ||
        o->part[on.part].object != b->object)
        return true;
    vec3 p[3];
    mesh_corners(p, &o->mesh, on.triangle);
    return b->outwards * vec3_dot(mesh_twice_area(p), from.geometric) < 0.0;
}

struct thinness {
    const relume_objects *o;
    struct body *body;
};

enum { AT_ONCE = 512 };  // points

static void find_thin(void *context, size_t item, int worker)
{
    (void)worker;
    const struct thinness *t = context;
    for (size_t i = AT_ONCE * item; i < AT_ONCE * (item + 1) && i < t->body->spread.count; i++)
        t->body->thin[i] = is_thin(t->o, t->body, i);
}

static size_t items_of(const struct body *b)
{
    return (b->spread.count + AT_ONCE - 1) / AT_ONCE;
}

static relume_status make_body(struct bodies *b, int number, const relume_objects *o, int threads,
                               const struct relume_log *log)
{
    struct body *body = &b->body[number];
    const struct translucent *t = &o->translucent[body->material];
    struct shape shape;
    relume_status status = find_shape(&shape, b, number, o);
    const double mm = t->mm > 0.0 ? t->mm : shape.longest > 0.0 ? USUAL_MM / shape.longest : 1.0;
    if (!status && !(t->mm > 0.0))
        log_line(
            log, RELUME_NOTE,
            "%s: nothing says how large object %d is: taken to be %g mm long (\"scale_mm\": %.3g)",
            t->name, body->object, USUAL_MM, mm);
    if (!status && shape.longest * mm < path_of(&t->scattering))
        log_line(log, RELUME_WARNING,
                 "%s: object %d is %.2g mm long, and light goes %.2g mm in it between two "
                 "scatterings: it will look black; \"scale_mm\" is how many mm a unit is",
                 t->name, body->object, shape.longest * mm, path_of(&t->scattering));
    body->outwards = shape.volume < 0.0 ? -1.0 : 1.0;
    if (!status)
        status = spread_make(&body->spread, &o->mesh, shape.triangle, shape.count,
                             points_for(&shape, &t->scattering, mm, b->count));
    mem_free(shape.triangle);
    for (size_t i = 0; i < body->spread.count && body->outwards < 0.0; i++)
        for (int k = 0; k < 3; k++)
            body->spread.point[i].normal[k] = -body->spread.point[i].normal[k];
    body->thin = mem_zeroed(body->spread.count, sizeof *body->thin);
    if (!status && !body->thin)
        status = RELUME_ENOMEM;
    if (!status)
        thread_for(threads, items_of(body), find_thin, &(struct thinness){o, body});
    return status ? status
                  : glow_tree_make(&body->tree, &body->spread, body->thin, &t->scattering, mm,
                                   threads);
}

void bodies_destroy(struct bodies **bodies)
{
    struct bodies *b = *bodies;
    *bodies = NULL;
    for (int i = 0; b && i < b->count; i++) {
        glow_tree_free(&b->body[i].tree);
        spread_free(&b->body[i].spread);
        mem_free(b->body[i].thin);
    }
    if (b) {
        mem_free(b->body);
        mem_free(b->of_part);
        mem_free(b->shown);
    }
    mem_free(b);
}

relume_status bodies_need(struct bodies **bodies, const relume_objects *o, int threads,
                          const struct relume_log *log)
{
    const struct bodies *old = *bodies;
    bool same = old;
    for (int i = 0; same && i < old->parts; i++)
        same = old->shown[i] == o->part[i].material;
    if (same)
        return RELUME_OK;
    bodies_destroy(bodies);
    struct bodies *b = mem_zeroed(1, sizeof *b);
    relume_status status = b ? find_bodies(b, o) : RELUME_ENOMEM;
    for (int i = 0; !status && i < b->count; i++) {
        status = make_body(b, i, o, threads, log);
        if (!status && !log_progress(log, "spreading points", (i + 1.0) / b->count))
            status = RELUME_ECANCEL;
    }
    if (status)
        bodies_destroy(&b);
    *bodies = b;
    return status;
}

// ---------------------------------------------------------------- light

void glows_free(struct glow **glows, const struct bodies *bodies)
{
    for (int i = 0; *glows && i < bodies->count; i++)
        glow_free(&(*glows)[i]);
    mem_free(*glows);
    *glows = NULL;
}

struct entering {
    const relume_objects *o;
    const struct lighting *lighting;
    const struct world *world;  // NULL: of lamps
    const struct relume_transport *transport;
    const struct body *body;
    struct glow *glow;
    size_t first;
};

// Of the samples of a sky one in so many is looked for at a point; its neighbours look for others.
enum { OF_SKY = 4 };

static void lamps_enter(const struct entering *e, size_t i, const struct surface_point *p)
{
    const double index = e->body->tree.dipole.index;
    const struct lighting *l = e->lighting;
    float *light = e->glow->light[i];
    for (int k = 0; k < l->light_samples; k++) {
        const struct relume_object_light *s = &l->light_sample[k];
        float rgb[3];
        double distance;
        vec3 towards;
        if ((s->is_sky && (size_t)k % OF_SKY != i % OF_SKY) ||
            !relume_object_light_at(&towards, rgb, &distance, s, p->position))
            continue;
        const double cosine = vec3_dot(towards, p->normal);
        if (!(cosine > 0.0) || !objects_lit(e->o, p, l, towards, distance))
            continue;
        const double part = cosine * dipole_passes(index, cosine) * (s->is_sky ? OF_SKY : 1);
        for (int c = 0; c < 3; c++)
            light[c] += (float)part * rgb[c];
    }
}

struct at_point {
    float *light;
    vec3 normal;
    double index;
};

static void arrive(void *context, const struct arrival *a)
{
    const struct at_point *p = context;
    const double part = a->share * dipole_passes(p->index, vec3_dot(a->towards, p->normal));
    for (int c = 0; c < 3; c++)
        p->light[c] += (float)part * a->with[c];
}

static void arrivals_enter(const struct entering *e, size_t i, const struct surface_point *p)
{
    const uint64_t n = (uint64_t)e->transport->pattern;
    struct at_point at = {e->glow->light[i], p->normal, e->body->tree.dipole.index};
    const struct site site = {.position = p->position,
                              .normal = p->normal,
                              .start = point_leave(p),
                              .key = n > 1 ? i % (n * n) : i};
    e->transport->gather(e->world, &site, arrive, &at);
}

static void enter(void *context, size_t item, int worker)
{
    (void)worker;
    const struct entering *e = context;
    const size_t from = e->first + AT_ONCE * item;
    for (size_t i = from; i < from + AT_ONCE && i < e->body->spread.count; i++)
        for (int side = 0; side < (e->body->thin[i] ? 2 : 1); side++) {
            const struct surface_point p = point_at(e->o, e->body, i, side ? -1.0 : 1.0);
            if (e->world)
                arrivals_enter(e, i, &p);
            else
                lamps_enter(e, i, &p);
        }
}

// Who stops does not wait for more than some of the points.
static relume_status enter_all(struct entering *e, int threads, const struct relume_log *log)
{
    enum { ITEMS = 16 };
    const size_t items = items_of(e->body);
    for (size_t first = 0; first < items; first += ITEMS) {
        const size_t left = items - first;
        e->first = AT_ONCE * first;
        thread_for(threads, left < ITEMS ? left : ITEMS, enter, e);
        if (!log_progress(log, "light enters objects", (double)first / (double)items))
            return RELUME_ECANCEL;
    }
    glow_sum_up(e->glow);
    return RELUME_OK;
}

static relume_status light_bodies(struct glow **out, struct entering e, int threads,
                                  const struct relume_log *log)
{
    const struct bodies *b = e.lighting->bodies;
    *out = mem_zeroed((size_t)b->count, sizeof **out);
    relume_status status = *out ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; i < b->count && !status; i++) {
        e.body = &b->body[i], e.glow = &(*out)[i];
        status = glow_make(e.glow, &b->body[i].tree);
        if (!status)
            status = enter_all(&e, threads, log);
    }
    return status;
}

relume_status lighting_enters(struct lighting *l, const relume_objects *o,
                              const struct bodies *bodies, int threads,
                              const struct relume_log *log)
{
    l->bodies = bodies;
    return light_bodies(&l->glow, (struct entering){.o = o, .lighting = l}, threads, log);
}

// Points are many, and light is smoothed below the surface: each looks in fewer directions, unless
// the way has chosen them for all.
relume_status lighting_gathers(struct lighting *l, const relume_objects *o, const struct world *w,
                               const struct relume_transport *transport,
                               const struct relume_log *log)
{
    enum { FEWER = 4, LEAST = 8 };
    struct world fewer = *w;
    if (!transport->begin)
        fewer.samples = w->samples / FEWER > LEAST ? w->samples / FEWER : LEAST;
    return light_bodies(
        &l->gathered,
        (struct entering){.o = o, .lighting = l, .world = &fewer, .transport = transport},
        w->threads, log);
}

// ---------------------------------------------------------------- what is seen

int translucent_body(const struct lighting *l, int part)
{
    return l->bodies ? l->bodies->of_part[part] : -1;
}

bool lighting_scatters(const struct lighting *l)
{
    return l->bodies && l->bodies->count > 0;
}

void translucent_leaves(float rgb[3], const struct lighting *l, int body, vec3 place, vec3 normal)
{
    (void)glow_leaves(rgb, &l->glow[body], place, normal, l->every > 1 ? ON_THE_WAY : SEEN);
}

double translucent_lets_out(const struct lighting *l, int body, const struct surface_point *p,
                            vec3 eye)
{
    const double GRAZING = 0.02;
    const struct dipole *d = &l->bodies->body[body].tree.dipole;
    const vec3 view = vec3_unit(vec3_sub(eye, p->position));
    return dipole_passes(d->index, fmax(vec3_dot(view, p->normal), GRAZING)) / d->enters;
}

bool translucent_shade(float rgb[3], const struct lighting *l, const struct surface_point *p,
                       vec3 eye)
{
    const int body = translucent_body(l, p->part);
    if (body < 0)
        return false;
    translucent_leaves(rgb, l, body, p->position, p->normal);
    for (int c = 0; c < 3; c++)
        rgb[c] *= (float)translucent_lets_out(l, body, p, eye);
    return true;
}

bool translucent_return(float rgb[3], const struct lighting *l, const struct surface_point *p,
                        vec3 eye)
{
    struct lighting other = *l;
    other.glow = l->gathered;
    return translucent_shade(rgb, &other, p, eye);
}
