// virtual.c - virtual lights, drawn by how much light they stand for
//
// The connection of a site and a light of area A is A cos cos / (pi d^2), which has no bound as
// they come together. Here d is never taken to be less than the radius of a disc of that area, so
// that no light is more than the whole sky: what is lost is light from nearer than that, and falls
// with the number of lights.
#include "world/transport/virtual.h"

#include "core/base/memory.h"
#include "core/math/distribution.h"
#include "core/math/random.h"

static double luminous(const float rgb[3])
{
    return (double)rgb[0] + (double)rgb[1] + (double)rgb[2];
}

// ---------------------------------------------------------------- of the scene

struct triangle_of {
    vec3 corner[3], area;  // the area times the normal
};

static struct triangle_of triangle_of(const struct mesh *mesh, size_t i)
{
    struct triangle_of t;
    mesh_corners(t.corner, mesh, i);
    t.area = vec3_scale(mesh_twice_area(t.corner), 0.5);
    return t;
}

// What arrives of each triangle, and behind them of each piece of the background, somewhere about
// the objects.
static relume_status find_senders(struct distribution *out, const struct world *w)
{
    const struct mesh *mesh = scenery_mesh(w->scenery);
    const struct bounds b = mesh_bounds(w->mesh);
    const vec3 middle = vec3_scale(vec3_add(b.min, b.max), 0.5);
    const size_t triangles = mesh->triangle_count, pieces = scenery_pieces(w->scenery);
    double *light = mem_array(triangles + pieces, sizeof *light);
    float sent[3];
    vec3 direction;
    if (!light)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < triangles; i++) {
        const struct triangle_of t = triangle_of(mesh, i);
        const double away = vec3_length(vec3_sub(t.corner[0], middle));
        scenery_sent(sent, w->scenery, i, 1.0f / 3.0f, 1.0f / 3.0f);
        light[i] = luminous(sent) * vec3_length(t.area) / (away * away + w->radius * w->radius);
    }
    for (size_t i = 0; i < pieces; i++) {
        const double angle = scenery_piece(&direction, sent, w->scenery, i, 0.5, 0.5);
        light[triangles + i] = angle > 0.0 ? angle * luminous(sent) : 0.0;
    }
    for (size_t i = 0; i < triangles + pieces; i++)
        light[i] = isfinite(light[i]) ? light[i] : 0.0;
    distribution_make(out, light, triangles + pieces);
    return RELUME_OK;
}

// The part of a number of lights that `chance` gives.
static double per(double chance, size_t count)
{
    return chance > 0.0 ? 1.0 / (chance * (double)count) : 0.0;
}

static void put_far(struct virtual_light *v, const struct world *w, size_t piece, double share,
                    double x, double y)
{
    *v = (struct virtual_light){.far = true};
    v->size = share * scenery_piece(&v->normal, v->without, w->scenery, piece, x, y);
    for (int c = 0; c < 3; c++)
        v->with[c] = v->without[c];
}

static void put_near(struct virtual_light *v, const struct world *w, size_t triangle, double share,
                     const double random[2], uint64_t key)
{
    const struct triangle_of t = triangle_of(scenery_mesh(w->scenery), triangle);
    const double r = sqrt(random[0]), a = r * (1.0 - random[1]), b = r * random[1];
    const vec3 place = vec3_add(vec3_scale(t.corner[0], 1.0 - a - b),
                                vec3_add(vec3_scale(t.corner[1], a), vec3_scale(t.corner[2], b)));
    vec3 normal = vec3_unit(t.area);
    if (vec3_dot(normal, vec3_sub(scenery_eye(w->scenery), place)) < 0.0)
        normal = vec3_scale(normal, -1.0);
    *v = (struct virtual_light){.place = scenery_leave(w->scenery, place, normal),
                                .normal = normal,
                                .size = share * vec3_length(t.area)};
    scenery_sent(v->without, w->scenery, triangle, (float)a, (float)b);
    const float part = (float)w->dimmed(w->context, place, normal, key);
    for (int c = 0; c < 3; c++)
        v->with[c] = part * v->without[c];
}

relume_status virtual_of_scene(struct virtual_light *out, size_t *found, const struct world *w,
                               size_t count)
{
    const size_t triangles = scenery_mesh(w->scenery)->triangle_count;
    struct distribution senders = {0};
    const relume_status status = find_senders(&senders, w);
    *found = 0;
    for (size_t i = 0; i < count && !status; i++) {
        struct random r = random_stream(4, i, 0);
        const double u = random_next(&r), inside[2] = {random_next(&r), random_next(&r)};
        size_t source;
        if (!distribution_draw(&source, &senders, ((double)i + u) / (double)count))
            break;
        const double share = per(distribution_chance(&senders, source), count);
        if (source >= triangles)
            put_far(&out[i], w, source - triangles, share, inside[0], inside[1]);
        else
            put_near(&out[i], w, source, share, inside, i);
        *found = i + 1;
    }
    distribution_free(&senders);
    return status;
}

// ---------------------------------------------------------------- of objects

static void add_sender(struct sender *s, const struct world *w, const struct point *point,
                       vec3 normal)
{
    const struct trace_hit hit = {point->triangle, point->u, point->v, 1.0f, 0};
    *s = (struct sender){.point = *point};
    s->point.normal = normal;
    w->site(&s->site, w->context, &hit, vec3_scale(normal, -1.0));
}

relume_status virtual_senders(struct sender **out, size_t *found, const struct world *w,
                              const struct points *points, size_t count)
{
    count = count < points->count ? count : points->count;
    const double area = count ? (double)points->count / (double)count : 0.0;
    struct sender *s = mem_array(2 * count, sizeof *s);
    size_t n = 0;
    *out = s, *found = 0;
    if (!s)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < count; i++) {
        const struct point *p = &points->at[i];
        add_sender(&s[n++], w, p, p->normal);
        if (p->both)
            add_sender(&s[n++], w, p, vec3_scale(p->normal, -1.0));
    }
    for (size_t i = 0; i < n; i++)
        s[i].point.area *= area;
    *found = n;
    return RELUME_OK;
}

relume_status virtual_of_senders(struct virtual_light *out, size_t *number, size_t *found,
                                 const struct sender *senders, size_t n, size_t count)
{
    struct distribution light_sent = {0};
    double *light = mem_array(n, sizeof *light);
    *found = 0;
    if (!light)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        const double sent = luminous(senders[i].sent);
        light[i] = isfinite(sent) && sent > 0.0 ? sent * senders[i].point.area : 0.0;
    }
    distribution_make(&light_sent, light, n);
    for (size_t i = 0; i < count; i++) {
        struct random r = random_stream(5, i, 0);
        if (!distribution_draw(&number[i], &light_sent,
                               ((double)i + random_next(&r)) / (double)count))
            break;
        const struct sender *s = &senders[number[i]];
        out[i] = (struct virtual_light){
            .place = s->site.start,
            .normal = s->point.normal,
            .size = s->point.area * per(distribution_chance(&light_sent, number[i]), count)};
        *found = i + 1;
    }
    distribution_free(&light_sent);
    return RELUME_OK;
}

// ---------------------------------------------------------------- as sites see them

bool virtual_sight(struct sight *out, const struct virtual_light *light, const struct site *site)
{
    if (light->far) {
        const double cosine = vec3_dot(light->normal, site->normal);
        *out = (struct sight){light->normal, INFINITY, cosine * light->size / M_PI};
        return cosine > 0.0;
    }
    const vec3 to = vec3_sub(light->place, site->start);
    const double square = vec3_dot(to, to);
    const double here = vec3_dot(to, site->normal), there = -vec3_dot(to, light->normal);
    if (!(here > 0.0 && there > 0.0 && square > 0.0))
        return false;
    const double nearest = fmax(M_PI * square, light->size);
    out->distance = sqrt(square);
    out->towards = vec3_scale(to, 1.0 / out->distance);
    out->share = light->size * (here * there / square) / nearest;
    return true;
}
