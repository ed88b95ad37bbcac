// micro.c - a small picture of what surrounds each place (Ritschel, Engelhardt, Grosch, Seidel,
// Kautz, Dachsbacher 2009, "Micro-rendering for scalable, parallel final gathering")
//
// Under each light the captured scene and the objects become trees of points that know what they
// send. A place draws them (cut.h) and adds up the pixels. What objects cover lies before what the
// scene shows. Pixels that points cover which are too near to be drawn, or that no points cover,
// are looked for by a ray; of the paper's rays, which meet discs, these meet the triangles.
// Points of objects gather in the same way, once for each bounce (Jacobi's iteration).
#include "world/transport/cut.h"
#include "world/transport/pieces.h"
#include "world/transport/warp.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/random.h"

#include <stdatomic.h>
#include <string.h>

enum { SIDES = PIECES_SIDES };

struct micro {
    struct cut_view view;
    struct hierarchy scene;
    struct points points;  // of objects
    struct hierarchy side[SIDES];
    // A view's cells for each worker, and whether one has them: no stack is so large.
    struct cut_cell *cells;  // [workers][side * side]
    struct warp *warps;      // [workers]
    atomic_flag *taken;      // [workers]
    int workers;
};

// ---------------------------------------------------------------- gathering

struct gathering {
    const struct world *w;
    const struct micro *m;
    const struct site *site;
    struct cut_place place;
    struct cut_list scene, side[SIDES];
    struct cut_cell *cells;  // [side * side]
};

// There are as many as workers.
static int take_cells(const struct micro *m)
{
    int i = 0;
    while (atomic_flag_test_and_set_explicit(&m->taken[i], memory_order_acquire))
        i = (i + 1) % m->workers;
    return i;
}

static void give_cells(const struct micro *m, int i)
{
    atomic_flag_clear_explicit(&m->taken[i], memory_order_release);
}

static void draw(struct gathering *g)
{
    const struct micro *m = g->m;
    memset(g->cells, 0, (size_t)(m->view.side * m->view.side) * sizeof *g->cells);
    g->scene.count = 0;
    cut_scene(g->cells, &g->scene, &m->scene, &g->place);
    for (int k = 0; k < SIDES; k++) {
        g->side[k].count = 0;
        cut_objects(g->cells, &g->side[k], &m->side[k], &g->place);
    }
}

// Points that cover so much of a pixel fill it: a leaf more or less is chance.
static const float FULL = 0.5f;

// What a pixel shows of the scene, and how far that is.
struct shown {
    float without[3], with[3];
    float depth, hides;  // where what is nearest lies, and the part that it hides
    float deepest;       // behind this all is hidden
};

static void mix(struct shown *to, const struct cut_light *light, float part)
{
    const float weight = part / light->covers;
    for (int c = 0; c < 3; c++) {
        to->without[c] += weight * light->without[c];
        to->with[c] += weight * light->with[c];
    }
}

static void from_points(struct shown *out, const struct cut_cell *cell, float inside)
{
    const float covers = cell->near.covers / inside;
    const bool full = covers > FULL || !(cell->far.covers > 0.0f);
    *out = (struct shown){.depth = cell->depth,
                          .hides = full ? 1.0f : covers,
                          .deepest = full ? cell->depth : cell->far_depth};
    if (cell->near.covers > 0.0f)
        mix(out, &cell->near, out->hides);
    if (!full)
        mix(out, &cell->far, 1.0f - covers);
}

// By a ray. What of that the objects leave is as the points there have it.
static void from_ray(struct shown *out, const struct gathering *g, const struct cut_cell *cell,
                     vec3 towards)
{
    const struct hierarchy *h = &g->m->scene;
    const struct cut_light *near = &cell->near;
    const float *without = near->without, *with = near->with;
    struct scenery_hit hit;
    uint32_t node;
    (void)scenery_meet(&hit, g->w->scenery, g->site->start, towards);
    if (hit.distance < INFINITY &&
        cut_nearest(&node, &g->scene, h, hit.place, vec3_of(0, 0, 0)) < INFINITY)
        without = h->sent[node].without, with = h->sent[node].with;
    out->depth = out->deepest = (float)hit.distance;
    out->hides = 1.0f;
    for (int c = 0; c < 3; c++) {
        const float left = with[c] < without[c] ? with[c] / without[c] : 1.0f;
        out->without[c] = hit.sent[c];
        out->with[c] = left * hit.sent[c];
    }
}

// Where a ray meets the objects before the scene, what they send; else `rgb` stays.
static void from_objects(float rgb[3], const struct gathering *g, const struct cut_cell *cell,
                         vec3 towards, float depth)
{
    float from[3], along[3], nearest = INFINITY;
    struct trace_hit hit;
    vec3_store(from, g->site->start);
    vec3_store(along, towards);
    if (!trace_closest(g->w->objects, from, along, &hit) || !(hit.distance < depth))
        return;
    const vec3 at = vec3_along(g->site->start, towards, (double)hit.distance);
    for (int c = 0; c < 3; c++)
        rgb[c] = cell->object.covers > 0.0f ? cell->object.with[c] / cell->object.covers : 0.0f;
    for (int k = 0; k < SIDES; k++) {
        uint32_t node;
        const float away = cut_nearest(&node, &g->side[k], &g->m->side[k], at, towards);
        if (away < nearest)
            memcpy(rgb, g->m->side[k].sent[node].with, 3 * sizeof *rgb);
        nearest = fminf(nearest, away);
    }
}

// The part of a pixel that objects cover, before what the scene shows there.
static float part_of(const struct cut_cell *cell, const struct shown *scene, float inside)
{
    const float BEHIND = 1.05f;
    const float part = fminf(cell->covered / inside, 1.0f);
    if (cell->object_depth > BEHIND * scene->deepest)
        return 0.0f;
    return cell->object_depth > BEHIND * scene->depth ? part * (1.0f - scene->hides) : part;
}

static void resolve(struct arrival *out, const struct gathering *g, int i)
{
    const struct cut_cell *cell = &g->cells[i];
    const struct cut_pixel *pixel = &g->place.view->pixel[i];
    struct shown scene;
    out->towards = cut_direction(&g->place, pixel);
    out->share = (double)pixel->share;
    out->answer = g->place.warp ? g->place.warp->answer[i] : NULL;
    if (cell->close || cell->near.covers + cell->far.covers < FULL * pixel->inside)
        from_ray(&scene, g, cell, out->towards);
    else
        from_points(&scene, cell, pixel->inside);
    memcpy(out->without, scene.without, sizeof out->without);
    memcpy(out->with, scene.with, sizeof out->with);
    if (cell->object_close) {
        from_objects(out->with, g, cell, out->towards, scene.depth);
    } else if (cell->object.covers > 0.0f) {
        const float part = part_of(cell, &scene, pixel->inside);
        for (int c = 0; c < 3 && part > 0.0f; c++)
            out->with[c] =
                part * cell->object.with[c] / cell->object.covers + (1.0f - part) * out->with[c];
    }
}

static void gather(const struct world *w, const struct site *site, take_arrival *arrive,
                   void *context)
{
    const struct micro *m = w->state;
    struct gathering g;
    const int pixels = m->view.side * m->view.side, taken = take_cells(m);
    g.w = w, g.m = m, g.site = site, g.cells = m->cells + (ptrdiff_t)taken * pixels;
    cut_place_at(&g.place, &m->view, site->start, site->normal);
    if (site->answer)
        (void)warp_create(&m->warps[taken], &g.place, m->view.side, site->mirrored, site->answer,
                          site->answers);
    draw(&g);
    for (int i = 0; i < pixels; i++) {
        struct arrival arrival;
        if (!(g.place.view->pixel[i].share > 0.0f))
            continue;
        resolve(&arrival, &g, i);
        arrive(context, &arrival);
    }
    give_cells(m, taken);
}

// ---------------------------------------------------------------- the scene's points

// The background's may be of several pixels.
static void sent_of_piece(float rgb[3], const struct scenery *c, size_t i)
{
    enum { SIDE = 2 };
    const size_t triangles = scenery_mesh(c)->triangle_count;
    if (i < triangles) {
        scenery_sent(rgb, c, i, 1.0f / 3.0f, 1.0f / 3.0f);
        return;
    }
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (int k = 0; k < SIDE * SIDE; k++) {
        vec3 unused;
        float part[3];
        (void)scenery_piece(&unused, part, c, i - triangles, (k % SIDE + 0.5) / SIDE,
                            (k / SIDE + 0.5) / SIDE);
        for (int n = 0; n < 3; n++)
            rgb[n] += part[n] / (SIDE * SIDE);
    }
}

struct lighting_scene {
    const struct world *w;
    struct hierarchy *h;
    const struct piece *pieces;
};

// The part of a leaf's light that the objects leave.
static double left_of(const struct lighting_scene *l, size_t leaf)
{
    const struct hierarchy *h = l->h;
    const size_t middle = h->order[h->begins[leaf] + (h->begins[leaf + 1] - h->begins[leaf]) / 2];
    const struct piece *p = &l->pieces[middle];
    return middle < scenery_mesh(l->w->scenery)->triangle_count
               ? l->w->dimmed(l->w->context, vec3_floats(p->place), vec3_unit(vec3_floats(p->area)),
                              leaf)
               : 1.0;
}

enum { AT_ONCE = 64 };

static void light_leaves(void *context, size_t item, int worker)
{
    (void)worker;
    const struct lighting_scene *l = context;
    const struct hierarchy *h = l->h;
    for (size_t leaf = item * AT_ONCE; leaf < (item + 1) * AT_ONCE && leaf < h->leaves; leaf++) {
        double sum[3] = {0.0, 0.0, 0.0}, areas = 0.0;
        for (size_t i = h->begins[leaf]; i < h->begins[leaf + 1]; i++) {
            const double area = vec3_length(vec3_floats(l->pieces[h->order[i]].area));
            float rgb[3];
            sent_of_piece(rgb, l->w->scenery, h->order[i]);
            areas += area;
            for (int c = 0; c < 3; c++)
                sum[c] += area * (double)rgb[c];
        }
        struct sent *sent = &h->sent[hierarchy_leaf(h, leaf)];
        const float left = (float)left_of(l, leaf);
        for (int c = 0; c < 3; c++) {
            sent->without[c] = (float)(sum[c] / areas);
            sent->with[c] = left * sent->without[c];
        }
    }
}

static relume_status build_scene(struct micro *m, const struct world *w)
{
    struct piece *pieces;
    size_t count;
    relume_status status = pieces_of_scene(&pieces, &count, w->scenery, w->mesh);
    if (!status)
        status = hierarchy_create(&m->scene, pieces, count, PIECES_SCENE, w->threads);
    struct lighting_scene l = {w, &m->scene, pieces};
    if (!status) {
        thread_for(w->threads, (m->scene.leaves + AT_ONCE - 1) / AT_ONCE, light_leaves, &l);
        hierarchy_light(&m->scene);
    }
    mem_free(pieces);
    return status;
}

// ---------------------------------------------------------------- the objects' points

// The points once as they are, and those that light gets to from both sides once more, turned.
static relume_status build_objects(struct micro *m, const struct world *w)
{
    relume_status status =
        points_of_objects(&m->points, w->mesh, w->objects, PIECES_OBJECT, w->threads);
    for (int k = 0; k < 2 && !status; k++) {
        struct piece *pieces;
        status = pieces_of_points(&pieces, &m->points, k);
        if (!status)
            status =
                hierarchy_create(&m->side[k], pieces, m->points.count, PIECES_OBJECT, w->threads);
        mem_free(pieces);
    }
    return status;
}

// What arrives at a point, as light from one direction.
struct arrived {
    double rgb[3];
    vec3 towards;
};

static void add_arrival(void *context, const struct arrival *a)
{
    struct arrived *all = context;
    for (int c = 0; c < 3; c++)
        all->rgb[c] += a->share * (double)a->with[c];
    all->towards = vec3_along(all->towards, a->towards,
                              a->share * (double)(a->with[0] + a->with[1] + a->with[2]));
}

struct lighting_objects {
    const struct world *w;
    const struct micro *m;
    int side;
    struct sent *next;  // [leaves]
};

// A point that shines sends what leaves it in one direction of the disc, which is another for each
// point: together they send as much as they should, but alike in all directions.
struct seen_from {
    const struct world *w;
    struct trace_hit hit;
    vec3 origin, direction;
};

static void answer(float rgb[3], const void *context, vec3 towards)
{
    const struct seen_from *s = context;
    const struct arrival a = {.towards = towards, .share = 1.0, .with = {1.0f, 1.0f, 1.0f}};
    s->w->returned(rgb, s->w->context, &s->hit, s->origin, s->direction, &a);
}

static struct seen_from seen_from_somewhere(const struct world *w, const struct point *p,
                                            uint64_t key)
{
    struct random r = random_stream(8, key, 0);
    const double u = random_next(&r);
    const vec3 d = points_direction(p, u, random_next(&r));
    return (struct seen_from){
        w, {p->triangle, p->u, p->v, 1.0f, 0}, vec3_add(p->place, d), vec3_scale(d, -1.0)};
}

// Where the surface returns nothing there are no answers.
static void add_answer(void *context, const struct arrival *a)
{
    double *rgb = context;
    for (int c = 0; c < 3 && a->answer; c++)
        rgb[c] += (double)(a->answer[c] * a->with[c]);
}

static void light_shining(float rgb[3], const struct lighting_objects *l, const struct point *p,
                          struct site *site)
{
    const struct seen_from from = seen_from_somewhere(l->w, p, site->key);
    double returned[3] = {0.0, 0.0, 0.0};
    site->answer = answer, site->answers = &from;
    site->mirrored =
        vec3_along(from.direction, p->normal, -2.0 * vec3_dot(from.direction, p->normal));
    gather(l->w, site, add_answer, returned);
    l->w->sent(rgb, l->w->context, &from.hit, from.origin, from.direction, site->key, NULL, 0);
    for (int c = 0; c < 3; c++)
        rgb[c] += (float)returned[c];
}

static void light_matte(float rgb[3], const struct lighting_objects *l, const struct point *p,
                        const struct site *site)
{
    struct arrived all = {.towards = {0, 0, 0}};
    struct arrival one = {.share = 1.0};
    gather(l->w, site, add_arrival, &all);
    one.towards = vec3_length(all.towards) > 0.0 ? vec3_unit(all.towards) : p->normal;
    for (int c = 0; c < 3; c++)
        one.with[c] = (float)all.rgb[c];
    points_object_sent(rgb, l->w, p, site->key, &one, 1);
}

static void light_point(const struct lighting_objects *l, size_t leaf)
{
    const struct hierarchy *h = &l->m->side[l->side];
    struct point p = l->m->points.at[h->order[h->begins[leaf]]];
    const struct trace_hit hit = {p.triangle, p.u, p.v, 1.0f, 0};
    float at[3], off[3], start[3];
    struct site site;
    p.normal = l->side ? vec3_scale(p.normal, -1.0) : p.normal;
    l->w->site(&site, l->w->context, &hit, vec3_scale(p.normal, -1.0));
    vec3_store(at, p.place);
    vec3_store(off, p.normal);
    trace_leave(at, off, start);
    site.position = p.place, site.normal = p.normal, site.start = vec3_floats(start);
    site.key = leaf;
    float *rgb = l->next[leaf].with;
    if (site.shines)
        light_shining(rgb, l, &p, &site);
    else
        light_matte(rgb, l, &p, &site);
    for (int c = 0; c < 3; c++)
        rgb[c] = isfinite(rgb[c]) ? fmaxf(rgb[c], 0.0f) : 0.0f;
}

static void light_points(void *context, size_t item, int worker)
{
    (void)worker;
    const struct lighting_objects *l = context;
    const size_t leaves = l->m->side[l->side].leaves;
    for (size_t leaf = item * AT_ONCE; leaf < (item + 1) * AT_ONCE && leaf < leaves; leaf++)
        light_point(l, leaf);
}

// One more bounce, of both sides at once.
static void bounce(struct micro *m, const struct world *w, struct sent *const next[SIDES])
{
    for (int k = 0; k < SIDES; k++) {
        struct lighting_objects l = {w, m, k, next[k]};
        thread_for(w->threads, (m->side[k].leaves + AT_ONCE - 1) / AT_ONCE, light_points, &l);
    }
    for (int k = 0; k < SIDES; k++) {
        struct hierarchy *h = &m->side[k];
        if (h->leaves)
            memcpy(&h->sent[hierarchy_leaf(h, 0)], next[k], h->leaves * sizeof *next[k]);
        hierarchy_light(h);
    }
}

static relume_status light_objects(struct micro *m, const struct world *w)
{
    struct sent *next[SIDES];
    relume_status status = RELUME_OK;
    for (int k = 0; k < SIDES; k++) {
        next[k] = mem_zeroed(m->side[k].leaves ? m->side[k].leaves : 1, sizeof *next[k]);
        status = next[k] ? status : RELUME_ENOMEM;
    }
    for (int i = 0; i < w->bounces && !status; i++)
        bounce(m, w, next);
    for (int k = 0; k < SIDES; k++)
        mem_free(next[k]);
    return status;
}

// ---------------------------------------------------------------- a light

static void end(struct world *w)
{
    struct micro *m = w->state;
    if (!m)
        return;
    hierarchy_forget(&m->scene);
    for (int k = 0; k < SIDES; k++)
        hierarchy_forget(&m->side[k]);
    points_forget(&m->points);
    mem_free(m->cells);
    mem_free(m->warps);
    mem_free(m->taken);
    mem_free(m);
    w->state = NULL;
}

static relume_status make_cells(struct micro *m, int threads)
{
    m->workers = thread_count(threads);
    m->cells =
        mem_array((size_t)m->workers, (size_t)(m->view.side * m->view.side) * sizeof *m->cells);
    m->warps = mem_array((size_t)m->workers, sizeof *m->warps);
    m->taken = mem_array((size_t)m->workers, sizeof *m->taken);
    for (int i = 0; m->taken && i < m->workers; i++)
        atomic_flag_clear(&m->taken[i]);
    return m->cells && m->warps && m->taken ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status begin(struct world *w, const struct relume_log *log)
{
    (void)log;
    const int side = (int)sqrt((double)w->samples);
    struct micro *m = mem_zeroed(1, sizeof *m);
    w->state = m;
    if (!m)
        return RELUME_ENOMEM;
    cut_view_create(&m->view, side < CUT_LEAST ? CUT_LEAST : side > CUT_MOST ? CUT_MOST : side);
    relume_status status = make_cells(m, w->threads);
    if (!status)
        status = build_scene(m, w);
    if (!status)
        status = build_objects(m, w);
    return status ? status : light_objects(m, w);
}

const struct relume_transport transport_micro = {
    .name = "micro",
    .summary = "a small picture of the surroundings for each place, drawn from points",
    .samples = 64,
    .spacing = 4,
    .pattern = 1,
    .gl_version = 43,
    .begin = begin,
    .end = end,
    .gather = gather,
};
